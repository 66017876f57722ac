//! Z06: time reversal. Methods that are symmetric in time return up to rounding if forces are smooth. With events their
//! symmetric steps reach up to the event, but the tick is cut elsewhere on the way back. So they err by twice the error
//! of the run, like all other methods.
//!
//! Rounding: each tick rounds positions and velocities once, and what it does to an orbit grows with the time that is left: at
//! most `2 n^2 eps` of the motion for `n` ticks, which is 1e-9 here; found are 1e-12. The bound is chosen between that and the error of
//! the method, which is 1e-4 and more.

use jostle::problems::{EventTiming, ProblemSetting, elastic_bounce, kepler, spring_mass};
use jostle::report::reversal::Reversal;

use super::support::load;

#[test]
fn symmetric_methods_come_back_to_rounding() {
    for method in ["SemiImplicitEuler", "VelocityVerlet", "ImplicitMidpoint", "Symplectic4"] {
        let setting = ProblemSetting { method, tick: 1e-3, ..ProblemSetting::default() };
        let back = Reversal::of(&mut load(&(spring_mass::PROBLEM.scene)(&setting, 2.0))).expect("numbers stay finite");
        // Kick and drift in the other order is not the same map: semi-implicit Euler comes back to its own error.
        let bound = if method == "SemiImplicitEuler" { 2.0 * 1e-3 * 10.0 * 0.1 } else { 1e-9 };
        assert!(back.position <= bound && back.because.is_none(), "{method}: {back:?}");
    }
}

#[test]
fn other_methods_come_back_to_their_error() {
    for (method, order) in [("RungeKutta4", 4), ("Dop853", 8), ("ExplicitEuler", 1)] {
        let returned = |tick: f64| {
            let setting = ProblemSetting { method, tick, ..ProblemSetting::default() };
            let back =
                Reversal::of(&mut load(&(spring_mass::PROBLEM.scene)(&setting, 0.2))).expect("numbers stay finite");
            back.position
        };
        let ticks = if order == 8 { (0.1, 0.05) } else { (1e-3, 5e-4) };
        let (coarse, fine) = (returned(ticks.0), returned(ticks.1));
        let seen = (coarse / fine).log2();
        // What is left of the error after there and back falls with the order, or one more where the leading term cancels.
        assert!(seen >= f64::from(order) - 0.3, "{method}: {coarse:e} {fine:e}, order {seen}");
    }
}

#[test]
fn an_orbit_and_a_bounce_come_back() {
    let setting = ProblemSetting { method: "VelocityVerlet", tick: kepler::PROBLEM.tick, ..ProblemSetting::default() };
    let back = Reversal::of(&mut load(&(kepler::PROBLEM.scene)(&setting, 1.3 * std::f64::consts::TAU)));
    let back = back.expect("numbers stay finite");
    assert!(back.position < 1e-9, "{back:?}");
    let setting =
        ProblemSetting { method: "Dop853", tick: 1e-3, events: EventTiming::Located, ..ProblemSetting::default() };
    let back = Reversal::of(&mut load(&(elastic_bounce::PROBLEM.scene)(&setting, 1.0))).expect("numbers stay finite");
    assert!(back.position < 1e-9 && back.because.is_none(), "{back:?}");
}

#[test]
fn what_was_lost_does_not_come_back_and_is_said() {
    let text = r#"Scene(format: 1, clock: (duration: 1, tick: "1 ms"), forces: [Drag(linear: 1)],
        bodies: [(name: "a", at: (0, 0), velocity: (1, 0), atoms: Disc(radius: 0.1, mass: 1))])"#;
    let back = Reversal::of(&mut load(text)).expect("numbers stay finite");
    assert!(back.velocity > 0.1, "{back:?}");
    assert_eq!(back.because.as_deref(), Some("energy was lost on the way (drag), and does not come back"));
}
