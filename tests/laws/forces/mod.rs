//! Laws: an impulse is force times time, and a torque is arm times force. Bodies attract each other by `G m1 m2/r^2`
//! with equal and opposite forces. Drag acts on its given bodies. A body that does not collide touches no body. Source:
//! Newton; the force files state each law.
//!
//! Tolerances: forces are constant over the intervals compared, so both methods are exact: `ticks` roundings. Forces that
//! turn with a body are sampled at ticks: the trapezoidal rule errs by `(omega dt)^2/12`.
//!
//! Not tested: how drag slows (see `problems`).

mod aim;
mod drive;
mod spring;
mod thrust;
mod torsion_spring;
mod wind;

use glam::DVec2;
use jostle::Simulation;

use super::support::{METHODS, assert_near, load, run};

/// A body of 2 kg with an inertia of 0.5 kg m2 and its forces, in ticks of a millisecond.
fn pushed(method: &str, duration: f64, forces: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: 0.001, method: {method}), forces: [{forces}],
        bodies: [(name: \"block\", at: (0, 0), inertia: 0.5, atoms: Disc(radius: 0.5, mass: 2))])"
    )
}

#[track_caller]
fn assert_impulse(what: &str, simulation: &Simulation, exact: DVec2) {
    let found = simulation.bodies().velocity[0] * simulation.bodies().mass[0];
    let tolerance = (simulation.clock().ticks as f64 + 8.0) * f64::EPSILON * exact.length();
    assert!((found - exact).length() <= tolerance, "{what}: impulse {found} N s instead of {exact}");
}

const FORCE: DVec2 = DVec2::new(3.0, -1.0);

#[test]
fn a_thrust_between_two_ticks_gives_force_times_time() {
    for method in METHODS {
        let forces = "Thrust(of: \"block\", force: (3, -1), from: 0.25, to: 0.5)";
        assert_impulse(method, &run(&pushed(method, 1.0, forces)), FORCE * 0.25);
    }
}

#[test]
fn a_thrust_without_end_gives_force_times_time() {
    for method in METHODS {
        assert_impulse(method, &run(&pushed(method, 1.0, "Thrust(of: \"block\", force: (3, -1))")), FORCE);
    }
}

#[test]
fn a_thrust_from_the_beginning_gives_force_times_time() {
    for method in METHODS {
        let forces = "Thrust(of: \"block\", force: (3, -1), from: 0, to: 0.25)";
        assert_impulse(method, &run(&pushed(method, 1.0, forces)), FORCE * 0.25);
    }
}

#[test]
fn a_thrust_to_the_end_of_the_run_gives_force_times_time() {
    for method in METHODS {
        let forces = "Thrust(of: \"block\", force: (3, -1), from: 0.75, to: 1)";
        assert_impulse(method, &run(&pushed(method, 1.0, forces)), FORCE * 0.25);
    }
}

/// Decimal times on the grid of ticks are not always the same number as tick times count, 5 x 0.3 ms is less than
/// 1.5 ms: the impulse must not care.
#[test]
fn every_decimal_edge_falls_on_its_tick() {
    let mut wrong = Vec::new();
    for method in METHODS {
        for tenths_per_tick in [10, 3] {
            for tick in 1..300 {
                let (from, to) = (tick * tenths_per_tick, (tick + 25) * tenths_per_tick);
                let forces = format!("Thrust(of: \"block\", force: (3, -1), from: {from}e-4, to: {to}e-4)");
                let text = pushed(method, 0.35, &forces).replace("tick: 0.001", &format!("tick: {tenths_per_tick}e-4"));
                let impulse = run(&text).bodies().velocity[0] * 2.0;
                let exact = FORCE * f64::from(to - from) * 1e-4;
                // A tenth of a tick: far above rounding, far below what one tick or half of one makes.
                if (impulse - exact).length() > 0.1 * exact.length() / 25.0 {
                    wrong.push(format!("{method} {from}e-4 to {to}e-4"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of 1196 thrusts have a wrong impulse: {wrong:?}", wrong.len());
}

#[test]
fn a_thrust_off_the_centre_turns_the_body() {
    for method in METHODS {
        let forces = "Thrust(of: \"block\", at: (0.1, 0.4), force: (0.5, 0.25), frame: Body, from: 0.25, to: 0.5)";
        let simulation = run(&pushed(method, 1.0, forces));
        // Arm x force = 0.1 x 0.25 - 0.4 x 0.5 N m for 0.25 s; arm and force turn together.
        let exact = (0.1 * 0.25 - 0.4 * 0.5) * 0.25 / 0.5;
        assert_near("spin", simulation.bodies().spin[0], exact, 1000.0 * f64::EPSILON * exact.abs());
    }
}

#[test]
fn a_thrust_in_the_frame_of_the_body_turns_with_it() {
    let spin = 2.0;
    let text = pushed("VelocityVerlet", 1.0, "Thrust(of: \"block\", force: (3, 0), frame: Body)");
    let simulation = run(&text.replace("inertia: 0.5", &format!("inertia: 0.5, spin: {spin:?}")));
    // v = F/(m omega) (sin, 1 - cos); the trapezoidal rule has a share (omega dt)^2/12 less.
    let exact = DVec2::new(libm::sin(spin), 1.0 - libm::cos(spin)) * (3.0 / (2.0 * spin));
    let error = (simulation.bodies().velocity[0] - exact).length() / exact.length();
    let share = (spin * 0.001).powi(2) / 12.0;
    assert!(error <= share * (1.0 + 1e-3), "{error:e} > {share:e}");
    assert!(error > 0.9 * share, "{error:e}: forces are sampled at ticks");
}

#[test]
fn a_torque_gives_spin_in_proportion_to_time() {
    for method in METHODS {
        let simulation = run(&pushed(method, 1.0, "Torque(of: \"block\", value: -0.75)"));
        assert_near("spin", simulation.bodies().spin[0], -1.5, 1000.0 * f64::EPSILON * 1.5);
        assert_eq!(simulation.bodies().velocity[0], DVec2::ZERO);
        // Half of it times a second; order 1 is off by half a tick.
        let late = if method == "VelocityVerlet" { 0.0 } else { 0.75 * 0.001 };
        assert_near("angle", simulation.bodies().angle[0], -0.75 - late, 1000.0 * f64::EPSILON);
    }
}

fn attracted(constant: f64, softening: f64) -> Simulation {
    run(&format!(
        "Scene(format: 1, clock: (duration: 0.001, tick: 0.001, method: SemiImplicitEuler),
        forces: [Attraction(constant: {constant:?}, softening: {softening:?})], bodies: [
            (name: \"light\", at: (-1, 0.5), collides: false, atoms: Disc(radius: 0.1, mass: 1)),
            (name: \"heavy\", at: (0.2, 2.1), collides: false, atoms: Disc(radius: 0.1, mass: 3)),
        ])"
    ))
}

#[test]
fn attraction_has_its_strength_and_its_opposite() {
    // The distance is 2 m, along (0.6, 0.8).
    let along = DVec2::new(0.6, 0.8);
    for (constant, softening) in [(0.7, 0.0), (-0.7, 0.0), (0.7, 1.5)] {
        let simulation = attracted(constant, softening);
        let velocity = &simulation.bodies().velocity;
        let force = constant * 3.0 * 2.0 / (4.0_f64 + softening * softening).powf(1.5);
        let impulse = along * (force * 0.001);
        // One tick: a dozen roundings.
        let tolerance = 12.0 * f64::EPSILON * impulse.length();
        assert!((velocity[0] - impulse).length() <= tolerance, "{constant} {softening}: {} {impulse}", velocity[0]);
        assert!((3.0 * velocity[1] + impulse).length() <= tolerance, "{constant} {softening}: {}", velocity[1]);
    }
}

#[test]
fn who_does_not_collide_neither_touches_nor_is_touched() {
    for method in METHODS {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 4, tick: 0.001, method: {method}),
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0))], bodies: [
                (name: \"ghost\", at: (0, 1), velocity: (0.5, -0.5), collides: false, atoms: Disc(radius: 0.2, mass: 1)),
                (name: \"solid\", at: (0.5, 0.5), atoms: Disc(radius: 0.2, mass: 1)),
                (name: \"above\", at: (0.5, 2), velocity: (0, -1), atoms: Disc(radius: 0.2, mass: 1)),
            ])"
        ));
        let bodies = simulation.bodies();
        // Through the solid one and the floor, as if there were neither.
        assert_eq!(bodies.velocity[0], DVec2::new(0.5, -0.5), "{method}");
        assert_near("ghost", (bodies.position[0] - DVec2::new(2.0, -1.0)).length(), 0.0, 1e-14);
        // The one above hit the solid one, so contacts are there at all: without them it would be at -2.
        assert!(bodies.position[2].y > 0.0 && bodies.velocity[1] != DVec2::ZERO, "{method}: {:?}", bodies.position);
    }
}

#[test]
fn drag_acts_on_those_it_names_alone() {
    for method in METHODS {
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: {method}),
            forces: [Drag(linear: 0.5, of: \"a*\"), Drag(quadratic: 0.2, of: [\"c\"])], bodies: [
                (name: \"a1\", at: (0, 0), velocity: (4, 0), collides: false, atoms: Disc(radius: 0.1, mass: 2)),
                (name: \"b\", at: (0, 1), velocity: (4, 0), collides: false, atoms: Disc(radius: 0.1, mass: 2)),
                (name: \"c\", at: (0, 2), velocity: (4, 0), collides: false, atoms: Disc(radius: 0.1, mass: 2)),
                (name: \"a2\", at: (0, 3), velocity: (0, 4), collides: false, atoms: Disc(radius: 0.1, mass: 2)),
            ])"
        ));
        simulation.run_to_end().expect("numbers stay finite");
        let velocity = &simulation.bodies().velocity;
        assert_eq!(velocity[1], DVec2::new(4.0, 0.0), "{method}");
        // Order 1: half a tick of the greatest deceleration, r v dt/2 with r below 0.4/s, twice.
        let tolerance = 4.0 * 0.4 * 0.001;
        assert_near("linear", velocity[0].x, 4.0 * libm::exp(-0.25), tolerance);
        assert_near("linear", velocity[3].y, 4.0 * libm::exp(-0.25), tolerance);
        assert_near("quadratic", velocity[2].x, 4.0 / (1.0 + 0.1 * 4.0), tolerance);
        // Where there was nothing there stays nothing.
        assert_eq!((velocity[0].y, velocity[3].x), (0.0, 0.0));
    }
}
