//! Law: a disc that strikes a wall at a slant slips throughout if `tan a >= 3 mu (1 + e)`. Then friction takes `mu (1 +
//! e)` of the normal speed off its velocity along the wall, and `2/r` of that off its spin. Otherwise it sticks for a
//! while, and a tangential spring throws the point of contact back. With full stick its speed after is `cos(w_t t_c)`
//! times that before, `w_t = sqrt(3 k_t/m)`. No impact creates energy, whatever angle, spin, friction and stiffness.
//! Source: Walton 1993; Maw, Barber and Fawcett 1976; Schaefer, Dippel and Wolf 1996; truth files C07, C08.
//!
//! Tolerances: those of `tangential_impact` for elastic impacts; restitution as in `restitution`. Truth file C07 is for
//! friction without a spring: the contact sticks with no force. A stiff spring comes near that: where the contact stops
//! slipping at the normal force `N` it sways with a speed of `mu N sqrt(3/(k_t m))` at most, which is what may be left at
//! the end; and where it starts to slip friction is missing as in `friction`. Discs are so hard that overlaps, by which
//! arms are shorter, are a thousandth of the radius.
//!
//! Not tested: rolling resistance.

use jostle::problems::tangential_impact as grip;
use jostle::problems::{ProblemSetting, Truth};

use super::support::{METHODS, assert_near, fitted_order, kinetic, load, phases, run, table};

/// Truth file C08 in all regimes, in the worst of 32 phases.
#[test]
fn a_grip_throws_the_point_of_contact_back() {
    let mut regimes = (0, 0);
    for method in METHODS {
        for ticks in [50.0, 200.0] {
            let tick = grip::CONTACT_TIME / ticks;
            for (psi1, psi2) in grip::sweep() {
                regimes = (regimes.0 + i32::from(psi2 < 0.0), regimes.1 + i32::from(psi2 > 0.0));
                let order = if method == METHODS[0] { 1 } else { 2 };
                // Four kinks of a speed of up to psi1.
                let bound = grip::leading_error(order, tick) * psi1.max(1.0) + (grip::PROBLEM.rounding)(tick);
                for phase in phases(32) {
                    let setting = ProblemSetting { method, tick, shift: phase * tick, ..ProblemSetting::default() };
                    let simulation = run(&grip::scene(&setting, 1.3 * grip::CONTACT_TIME, psi1));
                    let error = grip::error_of(&simulation, psi1);
                    assert!(error <= bound, "{method}, psi1 {psi1}, {ticks} ticks: {error:e} > {bound:e}");
                }
            }
        }
    }
    assert!(regimes.0 > 0 && regimes.1 > 0, "thrown back and slipped through: {regimes:?}");
}

/// The force has nothing but kinks: order 2. It would be 1 if what sticks at once counted the whole tick in which it
/// touches as elongation.
#[test]
fn a_contact_that_sticks_at_once_converges_with_order_two() {
    for psi1 in [0.2, 0.5] {
        let points: Vec<(f64, f64)> = (0..6)
            .map(|halving| {
                let tick = grip::CONTACT_TIME / 50.0 / f64::from(1 << halving);
                let squares = phases(16).enumerate().map(|(number, phase)| {
                    let tick = tick * (1.0 - 0.1 * (number as f64 * std::f64::consts::SQRT_2).fract());
                    let setting =
                        ProblemSetting { method: METHODS[1], tick, shift: phase * tick, ..ProblemSetting::default() };
                    grip::error_of(&run(&grip::scene(&setting, 1.3 * grip::CONTACT_TIME, psi1)), psi1).powi(2)
                });
                (tick, (squares.sum::<f64>() / 16.0).sqrt())
            })
            .collect();
        let order = fitted_order(&points);
        assert!(order >= 1.75, "psi1 {psi1}: order {order};{}", table(&points));
    }
}

/// An impact of a disc of 1 kg and 0.1 m on a wall.
struct Impact {
    /// Speed in m/s.
    speed: f64,
    /// From the normal, in rad.
    angle: f64,
    /// In rad/s.
    spin: f64,
    friction: f64,
    inelasticity: f64,
    /// Tangential over normal stiffness.
    ratio: f64,
    /// In N/m.
    stiffness: f64,
}

/// After an impact.
struct After {
    along: f64,
    away: f64,
    spin: f64,
    /// Kinetic energy after over that before.
    energy: f64,
}

impl Impact {
    fn scene(&self, method: &str, tick: f64, phase: f64) -> String {
        let (sin, cos) = libm::sincos(self.angle);
        let (along, down) = (self.speed * sin, self.speed * cos);
        let height = 0.1 + down * tick * phase;
        let Self { spin, friction, inelasticity, ratio, stiffness, .. } = self;
        format!(
            "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}),
            contacts: Penalty(tangential: Spring(ratio: {ratio:?})),
            materials: {{ \"m\": (stiffness: {stiffness:?}, friction: {friction:?}, inelasticity: {inelasticity:?}) }},
            walls: [(name: \"wall\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"disc\", at: (0, {height:?}), velocity: ({along:?}, -{down:?}), spin: {spin:?}, material: \"m\",
                      atoms: Disc(radius: 0.1, mass: 1))])"
        )
    }

    /// The normal period over `ticks`, half of it.
    fn tick(&self, ticks: f64) -> f64 {
        std::f64::consts::PI / self.stiffness.sqrt() / ticks
    }

    fn run(&self, method: &str, ticks: f64, phase: f64) -> After {
        let tick = self.tick(ticks);
        let mut simulation = load(&self.scene(method, tick, phase));
        let before = kinetic(simulation.bodies());
        loop {
            simulation.run_to_tick(simulation.clock().ticks + 10).expect("numbers stay finite");
            let bodies = simulation.bodies();
            if bodies.position[0].y > 0.1 && bodies.velocity[0].y > 0.0 {
                let velocity = bodies.velocity[0];
                let energy = kinetic(bodies) / before;
                return After { along: velocity.x, away: velocity.y, spin: bodies.spin[0], energy };
            }
            assert!(simulation.clock().ticks < 100 * ticks as u64, "it should have left");
        }
    }
}

/// The example of the catalogue of tests: `mu = 0.3`, elastic, 75 degrees, 1 m/s.
#[test]
fn gross_sliding_takes_off_friction_times_the_normal_impulse() {
    let stiffness = 1e8;
    for method in METHODS {
        for (ratio, angle) in [(0.3, 75.0_f64), (1.0, 75.0), (1.0, 61.0), (0.3, 89.0)] {
            let angle = angle.to_radians();
            let disc = Impact { speed: 1.0, angle, spin: 0.0, friction: 0.3, inelasticity: 0.0, ratio, stiffness };
            let (sin, cos) = libm::sincos(angle);
            let (along, spin) = (sin - 0.3 * 2.0 * cos, -2.0 * 0.3 * 2.0 * cos / 0.1);
            for phase in phases(16) {
                let after = disc.run(method, 200.0, phase);
                let share = (std::f64::consts::PI / 200.0).powi(2) / 4.0;
                // The overlap, at most 1e-4 m cos(angle), shortens the arm by less than a thousandth.
                assert_near("normal", after.away, cos, 2.0 * share * cos);
                assert_near("along", after.along, along, 2.0 * 0.6 * cos * share);
                assert_near("spin", after.spin / spin, 1.0, 1e-3 * cos + 2.0 * share);
                if angle == 75.0_f64.to_radians() {
                    assert_near("along, catalogue", after.along, 0.810_634_4, 2.0 * 0.6 * cos * share + 1e-7);
                }
            }
        }
    }
}

/// The critical angle: `tan a = 3 mu (1 + e)`. A spring lets go earlier the stiffer it is.
#[test]
fn below_the_critical_angle_the_contact_sticks_in_the_end() {
    let critical = libm::atan(3.0 * 0.3 * 2.0);
    assert_near("critical angle of the catalogue", critical.to_degrees(), 60.945, 1e-3);
    let slip = |angle: f64| {
        let disc =
            Impact { speed: 1.0, angle, spin: 0.0, friction: 0.3, inelasticity: 0.0, ratio: 0.5, stiffness: 1e8 };
        let after = disc.run("VelocityVerlet", 400.0, 0.5);
        (after.along + 0.1 * after.spin) / libm::cos(angle)
    };
    // Above it the point of contact keeps what friction cannot take; below it goes backwards, or stands.
    assert!(slip(critical + 0.01) > 0.02, "{}", slip(critical + 0.01));
    assert!(slip(critical - 0.01) < 0.0, "{}", slip(critical - 0.01));
}

/// The example of the catalogue: ten degrees, `k_t = 0.2 k_n`, so much friction that it never slips; and a ratio of a
/// third, for which the point of contact is thrown back with the whole of its speed. What does not change is
/// `m r v_t - I w`, but for arms shorter by the overlap.
#[test]
fn full_stick_is_half_a_period_of_a_second_oscillator() {
    let angle = 10.0_f64.to_radians();
    for method in METHODS {
        for ratio in [0.1, 0.2, 1.0 / 3.0] {
            let disc =
                Impact { speed: 1e-3, angle, spin: 0.0, friction: 10.0, inelasticity: 0.0, ratio, stiffness: 1e6 };
            let along = 1e-3 * libm::sin(angle);
            let after_exact = libm::cos(std::f64::consts::PI * (3.0 * ratio).sqrt());
            if ratio == 0.2 {
                assert_near("catalogue", libm::sin(angle) * after_exact, -0.131_900_1, 1e-7);
            }
            for phase in phases(16) {
                let after = disc.run(method, 400.0, phase);
                // The end of the contact is within a tick where it should be, and so is the phase of the oscillator; with
                // 10 for friction it slips only in the last thousandths of the contact.
                let tolerance = std::f64::consts::PI / 400.0 * (3.0 * ratio).sqrt() + 1e-2;
                assert_near("point of contact", (after.along + 0.1 * after.spin) / along, after_exact, tolerance);
                let kept = (0.1 * after.along - 0.005 * after.spin) / (0.1 * along);
                assert_near("m r v - I w", kept, 1.0, 1e-4);
            }
        }
    }
}

/// Truth file C07, the wall: with a stiff spring, in the limit of friction without one.
#[test]
fn discs_strike_a_wall_as_friction_without_a_spring_says() {
    let truth = Truth::read(include_str!("../../assets/truths/C07_disc_friction_collision.json"));
    let (friction, inelasticity, stiffness, ratio) = (0.3, 0.36, 1e9, 100.0);
    for method in METHODS {
        for degrees in [10, 30, 45, 60, 80] {
            let exact = truth.numbers(&format!("wall, {degrees} deg: v_t, v_n, omega after"));
            let angle = f64::from(degrees).to_radians();
            let disc = Impact { speed: 3.0, angle, spin: 0.0, friction, inelasticity, ratio, stiffness };
            // As many ticks as the spring's rate, fifteen times that of the normal, asks for.
            let ticks = 2000.0;
            let down = 3.0 * libm::cos(angle);
            // Greatest normal force: m v w1. What sways on the spring, and arms.
            let normal = down * (stiffness * (1.0 + inelasticity)).sqrt();
            let sways = friction * normal * (3.0 / (ratio * stiffness)).sqrt();
            let shorter = 3.0 / stiffness.sqrt() / 0.1;
            for phase in phases(4) {
                let after = disc.run(method, ticks, phase);
                assert_near("away", after.away, exact[1], 1e-3 * exact[1]);
                assert_near("along", after.along, exact[0], sways / 3.0 + 3.0 * shorter);
                assert_near("rim", 0.1 * after.spin, 0.1 * exact[2], 2.0 * sways / 3.0 + 2.0 * 3.0 * shorter);
            }
        }
    }
}

/// Truth file C07, two discs of different mass and size, with and without spin.
#[test]
fn discs_strike_each_other_as_friction_without_a_spring_says() {
    let truth = Truth::read(include_str!("../../assets/truths/C07_disc_friction_collision.json"));
    let (friction, inelasticity, stiffness, ratio) = (0.3_f64, 0.36_f64, 1e9_f64, 100.0_f64);
    for method in METHODS {
        for (degrees, spins) in [(20, [0, 0]), (60, [0, 0]), (40, [15, -5])] {
            let name =
                format!("discs hard, angle {degrees} deg, w=({},{}): v1x,v1y,w1,v2x,v2y,w2 after", spins[0], spins[1]);
            let exact = truth.numbers(&name);
            let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
            let reduced = 2.0 / 3.0;
            let tick = std::f64::consts::PI / (stiffness / reduced).sqrt() / 2000.0;
            // The first arrives along x; the line of centres points down to the right.
            let gap = 0.25 + 3.0 * cos * 0.4 * tick;
            let stiff = 2.0 * stiffness;
            let simulation = run(&format!(
                "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
                contacts: Penalty(tangential: Spring(ratio: {ratio:?})),
                materials: {{ \"m\": (stiffness: {stiff:?}, friction: {friction:?}, inelasticity: {inelasticity:?}) }}, bodies: [
                    (name: \"first\", at: ({:?}, {:?}), velocity: (3, 0), spin: {}, material: \"m\",
                     atoms: Disc(radius: 0.1, mass: 1)),
                    (name: \"second\", at: (0, 0), spin: {}, material: \"m\", atoms: Disc(radius: 0.15, mass: 2)),
                ])",
                3000.0 * tick,
                -gap * cos,
                gap * sin,
                spins[0],
                spins[1]
            ));
            let bodies = simulation.bodies();
            let (first, second) = (bodies.velocity[0], bodies.velocity[1]);
            let found = [first.x, first.y, bodies.spin[0], second.x, second.y, bodies.spin[1]];
            let normal = 3.0 * cos * (stiffness * (1.0 + inelasticity) * reduced).sqrt();
            let sways = friction * normal * (3.0 / (ratio * stiffness * reduced)).sqrt();
            // Arms are shorter, and the normal turns while they touch.
            let shorter = 3.0 * (reduced / stiffness).sqrt() / 0.1 * 3.0;
            for (which, (found, exact)) in found.into_iter().zip(exact).enumerate() {
                let tolerance = sways + 3.0 * shorter;
                let scale = [1.0, 1.0, 0.1, 1.0, 1.0, 0.15][which];
                assert_near(&format!("{name}: {which}"), found * scale, exact * scale, tolerance);
            }
        }
    }
}

/// 1080 impacts: all angles, spins both ways, coefficients, stiffness ratios. With 100 ticks per normal half period and
/// the faster of the rates `w`, kinks may change velocities by shares `(w dt)^2/4` each, and energies by twice that; there
/// are four.
#[test]
fn no_oblique_impact_gains_energy() {
    let mut greatest = (f64::NEG_INFINITY, String::new());
    for method in METHODS {
        for degrees in (0..90).step_by(5).chain([76, 89]) {
            for spin in [-60.0, 0.0, 25.0] {
                for friction in [0.1, 0.5, 2.0] {
                    for ratio in [0.3, 0.8, 2.0] {
                        for inelasticity in [0.0, 0.4] {
                            let angle = f64::from(degrees).to_radians();
                            let disc =
                                Impact { speed: 2.0, angle, spin, friction, inelasticity, ratio, stiffness: 1e6 };
                            let after = disc.run(method, 100.0, phases(997).nth(degrees as usize * 7).unwrap_or(0.5));
                            let rate = (1.0 + inelasticity).max(3.0 * ratio).sqrt();
                            let allowed = 2.0 * (rate * std::f64::consts::PI / 100.0).powi(2);
                            let what = format!(
                                "{method}, {degrees} deg, spin {spin}, mu {friction}, ratio {ratio}, mu_e {inelasticity}"
                            );
                            let gain = after.energy - 1.0;
                            assert!(gain <= allowed, "{what}: gains {gain:e} > {allowed:e}");
                            if gain / allowed > greatest.0 {
                                greatest = (gain / allowed, what);
                            }
                        }
                    }
                }
            }
        }
    }
    println!("greatest gain over what kinks may give: {greatest:?}");
}
