//! Law: `N = k d (1 + mu)` while loading, `N = k d (1 - mu)` while unloading, gives the restitution
//! `e = sqrt((1 - mu)/(1 + mu))`, whatever the speed. Source: the work balance; truth file C02.
//!
//! Tolerances, worst of 64 phases of the impact in the tick: 1e-3 at 40 ticks per contact for `mu` up to 0.05.
//! For more inelasticity the jump of the force at the turn matters: the mode changes up to one tick late. Near the turn
//! the disc moves by no more than `w1^2 d dt^2/2` in a tick (`w1` and `d` of loading), and on it the force is wrong by
//! `2 mu k d`; the kick with the wrong force puts as much energy into the velocity again. Together that is a share
//! `4 mu (w dt)^2` of the energy before, and `2 mu (w dt)^2/e` of restitution. So restitution converges with order 2,
//! although places after the impact, which feel the delay itself, converge with order 1 (see `convergence`): the fit must
//! show order 2, less the slack of 0.25 that all fits have, and the bound must hold at every tick.
//!
//! Not tested: impacts with gravity or friction, both materials different.

use jostle::problems::{Setting, inelastic_impact as impact};

use super::support::{METHODS, fitted_order, phases, run, table};

/// The greatest error of restitution over 64 phases.
fn worst_error(method: &str, inelasticity: f64, ticks_per_contact: f64) -> (f64, f64) {
    let contact_time = impact::contact_time(inelasticity);
    let tick = contact_time / ticks_per_contact;
    let duration = impact::GAP / impact::SPEED + contact_time + 3.0 * tick;
    let error = phases(64).map(|phase| {
        let setting = Setting { method, tick, shift: phase * tick };
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
fn inelastic_impacts_converge_within_the_bound() {
    for method in METHODS {
        for inelasticity in [0.3, 0.9] {
            let ticks = [20.0, 40.0, 80.0, 160.0, 320.0, 640.0];
            let points = ticks.map(|ticks| worst_error(method, inelasticity, ticks));
            let order = fitted_order(&points);
            println!("{method}, mu {inelasticity}: order {order:.2};{}", table(&points));
            assert!(order >= 1.75, "{method}, mu {inelasticity}: order {order};{}", table(&points));
            for (tick, error) in points {
                let step = impact::OMEGA * tick;
                let bound = 2.0 * inelasticity * step * step / impact::restitution(inelasticity);
                assert!(error <= bound, "{method}, mu {inelasticity}, tick {tick}: {error:e} > {bound:e}");
            }
        }
    }
}

/// A given restitution is converted to inelasticity first, and comes out again.
#[test]
fn a_given_restitution_comes_out() {
    let tick = impact::contact_time(0.05) / 40.0;
    let setting = Setting { method: "VelocityVerlet", tick, shift: 0.4 * tick };
    let given = impact::restitution(0.05);
    let text = impact::scene(&setting, 0.07, 0.05).replace("inelasticity: 0.05", &format!("restitution: {given:?}"));
    assert!(text.contains("restitution"), "{text}");
    let simulation = run(&text);
    let error = (simulation.bodies().velocity[0].y / impact::SPEED - given).abs();
    assert!(error <= 1e-3, "{error:e}");
}
