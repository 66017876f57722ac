//! Law: `N = k d (1 + mu)` while loading, `N = k d (1 - mu)` while unloading, gives the restitution
//! `e = sqrt((1 - mu)/(1 + mu))`, whatever the speed. Source: the work balance; truth file C02.
//!
//! Tolerances, worst of 200 phases of the impact in the tick: 1e-3 at 40 ticks per contact for `mu` up to 0.05. In general,
//! with `s = w dt`: the mode changes up to one tick late. Near the turn the disc moves by no more than `w1^2 d dt^2/2` in a
//! tick (`w1` and `d` of loading), and on it the force is wrong by `2 mu k d`; the kick with the wrong force puts as much
//! energy into the velocity again. Together that is a share `4 mu s^2` of the energy before, and `2 mu s^2/e` of
//! restitution. Touch and parting are kinks: each changes the velocity then by up to a share `(1 +- mu) s^2/4`, together
//! `e s^2/2` of restitution. So the error is at most `(2 mu/e + e/2) s^2`: with at least 20 ticks in a contact of the length
//! `t_c` that is at most `C dt/t_c` with `C = (2 mu/e + e/2) (w t_c)^2/20`. The fit must show order 1 at least (in fact
//! restitution converges with order 2, although places after the impact, which feel the delay of the turn itself,
//! converge with order 1; see `convergence`).
//!
//! The end of a contact is late by up to `1 + 2 mu/(1 - mu)` ticks (see the problem), the deepest overlap is seen at ticks
//! only. Energy lost: `m v^2 (1 - e^2)/2`, so its error is `e m v^2` times that of `e`. Gravity changes speeds in the contact
//! by a share `g t_c/v` of at most a quarter, and the bounds by less than that: a half more is allowed.
//!
//! Not tested: impacts with friction (see `oblique`), both materials different (see `impacts`).

use jostle::SimulationExt;
use jostle::problems::{ProblemSetting, Truth, inelastic_impact as impact};

use super::support::{METHODS, assert_near, fitted_order, load, phases, run, table};

const PHASES: u32 = 200;

/// Bound of the error of restitution; see above.
fn bound(inelasticity: f64, tick: f64) -> f64 {
    let restitution = impact::restitution(inelasticity);
    (2.0 * inelasticity / restitution + restitution / 2.0) * (impact::OMEGA * tick).powi(2)
}

/// The greatest error of restitution over 200 phases.
fn worst_error(method: &str, inelasticity: f64, ticks_per_contact: f64) -> (f64, f64) {
    let contact_time = impact::contact_time(inelasticity);
    let tick = contact_time / ticks_per_contact;
    let duration = impact::GAP / impact::SPEED + contact_time + 3.0 * tick;
    let error = phases(PHASES).map(|phase| {
        let setting = ProblemSetting { method, tick, shift: phase * tick, ..ProblemSetting::default() };
        let simulation = run(&impact::scene(&setting, duration, inelasticity));
        let bodies = simulation.bodies();
        assert!(bodies.position[0].y > impact::RADIUS, "the disc should have left the wall");
        (bodies.velocity[0].y / impact::SPEED - impact::restitution(inelasticity)).abs()
    });
    (tick, error.fold(0.0, f64::max))
}

#[test]
fn nearly_elastic_impacts_are_right_to_a_thousandth_at_40_ticks() {
    for method in METHODS {
        for inelasticity in [0.0, 0.05] {
            let (_, error) = worst_error(method, inelasticity, 40.0);
            println!("{method}, mu {inelasticity}: {error:.2e}");
            assert!(error <= 1e-3, "{method}, mu {inelasticity}: {error:e}");
        }
    }
}

#[test]
fn restitution_converges_within_the_bound() {
    for method in METHODS {
        for inelasticity in [0.0, 0.05, 0.3, 0.7, 0.9] {
            let points = [20.0, 40.0, 80.0, 160.0, 320.0].map(|ticks| worst_error(method, inelasticity, ticks));
            let order = fitted_order(&points);
            println!("{method}, mu {inelasticity}: order {order:.2};{}", table(&points));
            assert!(order >= 0.75, "{method}, mu {inelasticity}: order {order};{}", table(&points));
            let contact_time = impact::contact_time(inelasticity);
            let first_order = bound(inelasticity, contact_time) / 20.0;
            for (tick, error) in points {
                let (bound, coarse) = (bound(inelasticity, tick), first_order * tick / contact_time);
                assert!(bound <= coarse * (1.0 + 1e-12), "{bound:e} {coarse:e}");
                assert!(error <= bound, "{method}, mu {inelasticity}, tick {tick}: {error:e} > {bound:e}");
            }
        }
    }
}

/// How late a contact may end, in ticks.
fn late(inelasticity: f64) -> f64 {
    1.0 + 2.0 * inelasticity / (1.0 - inelasticity)
}

/// Energy in J that went to inelasticity, deepest overlap in m, contact time in s and speed in m/s after an impact of
/// 2 m/s, with or without gravity.
fn observed(method: &str, inelasticity: f64, gravity: f64, tick: f64, phase: f64) -> [f64; 4] {
    // So far above the floor that it arrives with 2 m/s.
    let gap = impact::SPEED * (phase + 1.0) * tick;
    let speed = (impact::SPEED.powi(2) - 2.0 * gravity * gap).sqrt();
    let (height, stiffness) = (impact::RADIUS + gap, impact::OMEGA.powi(2));
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1, tick: {tick:?}, method: {method}), gravity: (0, -{gravity:?}),
        materials: {{ \"clay\": (stiffness: {stiffness:?}, inelasticity: {inelasticity:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")],
        bodies: [(name: \"ball\", at: (0.5, {height:?}), velocity: (0, -{speed:?}), material: \"clay\",
                  atoms: Disc(radius: {:?}, mass: 1))])",
        impact::RADIUS
    ));
    loop {
        simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
        let bodies = simulation.bodies();
        let (gap, velocity) = (bodies.position[0].y - impact::RADIUS, bodies.velocity[0].y);
        if gap <= 0.0 || velocity <= 0.0 {
            continue;
        }
        let left_with = (velocity * velocity + 2.0 * gravity * gap).sqrt();
        let flight = |speed: f64, later: f64, gap: f64| 2.0 * gap / (speed + later);
        let touched = flight(impact::SPEED, speed, impact::SPEED * (phase + 1.0) * tick);
        let lasted = simulation.clock().time() - touched - flight(left_with, velocity, gap);
        let card = simulation.card();
        return [card.energy.inelasticity, card.largest_overlap.meters, lasted, left_with];
    }
}

#[test]
fn contact_time_overlap_and_loss_are_those_of_the_closed_form() {
    let truth = Truth::read(impact::TRUTH);
    for method in METHODS {
        for inelasticity in [0.1, 0.5, 0.9] {
            let number = |what: &str| truth.number(&format!("{what} (mu_e={inelasticity})"));
            let (lasts, restitution) = (number("contact time"), number("e"));
            let tick = lasts / 200.0;
            let bound = bound(inelasticity, tick);
            let seen_at_ticks = (1.0 + inelasticity) * (impact::OMEGA * tick).powi(2);
            for phase in phases(16) {
                let [lost, deepest, lasted, speed] = observed(method, inelasticity, 0.0, tick, phase);
                assert_near("restitution", speed / impact::SPEED, restitution, bound);
                assert_near("contact time over tick", lasted / tick, lasts / tick, late(inelasticity));
                assert_near("deepest overlap", deepest / number("max overlap"), 1.0, seen_at_ticks);
                let scale = restitution * impact::SPEED.powi(2);
                assert_near("energy lost", lost, number("energy lost"), 1.5 * scale * bound);
                if inelasticity == 0.9 {
                    // With gravity it would not get off.
                    continue;
                }
                let [_, _, lasted, speed] = observed(method, inelasticity, 9.81, tick, phase);
                let (lasts, left_with) = (number("with gravity: contact time"), number("with gravity: rebound speed"));
                // Semi-implicit Euler arrives faster by half a tick of gravity.
                let faster = if method == METHODS[0] { 9.81 * tick } else { 0.0 };
                assert_near("rebound speed", speed, left_with, 1.5 * impact::SPEED * bound + faster);
                assert_near("contact time over tick", lasted / tick, lasts / tick, 1.5 * late(inelasticity));
            }
        }
    }
}

/// A given restitution is converted to inelasticity first, and comes out again.
#[test]
fn a_given_restitution_comes_out() {
    let tick = impact::contact_time(0.05) / 40.0;
    let setting = ProblemSetting { method: "VelocityVerlet", tick, shift: 0.4 * tick, ..ProblemSetting::default() };
    let given = impact::restitution(0.05);
    let text = impact::scene(&setting, 0.07, 0.05).replace("inelasticity: 0.05", &format!("restitution: {given:?}"));
    assert!(text.contains("restitution"), "{text}");
    let simulation = run(&text);
    let error = (simulation.bodies().velocity[0].y / impact::SPEED - given).abs();
    assert!(error <= 1e-3, "{error:e}");
}
