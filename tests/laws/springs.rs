//! Law: a body held by springs responds with the frequencies of `K phi = w^2 M phi`, lever arms included. A method that
//! is stable up to `w dt = 2` allows a tick of `2/w_max`. Source: Hairer, Lubich, Wanner 2006, I.5; truth file O05, a 3
//! x 3 eigenvalue to 40 digits.
//!
//! The springs hold a body of 2 kg and 0.05 kg m2 off its centre, by 10 m of length each, without force at the start, so that
//! they are linear to a share of displacement over length, 1e-8 here.
//!
//! Tolerances: the eigenvalue of three degrees of freedom is found exactly but for that share. Below the critical tick, at 0.99
//! of it, energy swings by at most `1/(1 - 0.99^2) = 50`; above, at 1.01, the fastest mode grows by `exp(0.28)` in a tick.
//!
//! Not tested: how errors fall (see `convergence`), damping (see `problems`).

use jostle::SimulationExt;
use std::fmt::Write;

use jostle::problems::Truth;

use super::support::{METHODS, assert_near, kinetic, load};

/// Stiffness in N/m, arm in m, direction.
const SPRINGS: [(f64, [f64; 2], [f64; 2]); 3] =
    [(1e5, [-0.3, -0.1], [0.0, 1.0]), (1e5, [0.25, -0.1], [0.0, 1.0]), (4e4, [0.3, 0.05], [-1.0, 0.0])];

fn truth() -> Truth {
    Truth::read(include_str!("../../assets/truths/O05_cluster_stability_limit.json"))
}

fn held(method: &str, tick: &str) -> String {
    let mut springs = String::new();
    for (stiffness, [x, y], [along, up]) in SPRINGS {
        let (far_x, far_y) = (x - 10.0 * along, y - 10.0 * up);
        let _ = write!(
            springs,
            "Spring(a: \"block\", b: World, anchor_a: ({x:?}, {y:?}), anchor_b: ({far_x:?}, {far_y:?}), \
             stiffness: {stiffness:?}),"
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 1, {tick} method: {method}), forces: [{springs}],
        bodies: [(name: \"block\", at: (0, 0), spin: 1e-6, mass: 2, inertia: 0.05, atoms: Disc(radius: 0.1))])"
    )
}

/// Kinetic energy over that of the beginning, the greatest of `ticks` ticks.
fn growth(method: &str, tick: f64, ticks: u64) -> f64 {
    let mut simulation = load(&held(method, &format!("tick: {tick:?},")));
    let start = kinetic(simulation.bodies());
    let mut greatest = 0.0_f64;
    for tick in 1..=ticks {
        // Energy out of nowhere stops a run.
        if simulation.run_to_tick(tick).is_err() {
            return f64::INFINITY;
        }
        greatest = greatest.max(kinetic(simulation.bodies()) / start);
    }
    greatest
}

#[test]
fn springs_off_the_centre_limit_the_tick() {
    let critical = truth().number("dt_crit symplectic euler / verlet");
    let naive = truth().number("naive dt 2 sqrt(m/sum k) (too large => unstable)");
    for method in METHODS {
        let mut simulation = load(&held(method, "tick: 1e-4,"));
        assert_near("before the first tick", simulation.card().critical_tick.unwrap(), critical, 1e-7 * critical);
        simulation.run_to_tick(1000).expect("numbers stay finite");
        assert_near("critical tick", simulation.card().critical_tick.unwrap(), critical, 1e-7 * critical);
        let (below, above) = (growth(method, 0.99 * critical, 500), growth(method, 1.01 * critical, 50));
        println!("{method}: {below:.2} below, {above:.2e} above");
        // Turning, up and across swing with frequencies of their own.
        assert!(below < 3.0 * 51.0, "{method}: {below}");
        assert!(above > 1e6, "{method}: {above}");
        assert!(growth(method, naive, 12) > 1e6, "{method}: the naive tick holds");
    }
}

#[test]
fn the_chosen_tick_and_the_warning_know_springs() {
    let simulation = load(&held("Auto", ""));
    // pi/40 over 555 rad/s is 1.4e-4 s.
    assert_eq!(simulation.clock().dt, 1e-4);
    let notes = simulation.card().notes.join("\n");
    assert!(notes.contains("half a swing of the fastest springs lasts at least 40 of them"), "{notes}");
    let mut simulation = load(&held("VelocityVerlet", "tick: 0.004,"));
    simulation.run_to_tick(2).expect("numbers stay finite");
    let card = simulation.card();
    let warned = card.warnings.iter().any(|warning| warning.contains("The springs of `block` set it"));
    assert!(
        warned && card.verdict.contains("longer than the springs can bear"),
        "{:?} {}",
        card.warnings,
        card.verdict
    );
}

/// Contacts and springs hold one body together: `w^2 = (k1 + k2)/m`. The floor bears the weight, so it is touched all the time.
/// Tolerance: the normal of a floor does not turn, the spring is vertical: rounding of a hundred operations.
#[test]
fn contacts_and_springs_count_together() {
    let mut simulation = load(
        "Scene(format: 1, clock: (duration: 1, tick: 1e-3), gravity: (0, -10), contacts: Penalty(tangential: None),
        materials: { \"m\": (stiffness: 3000) }, walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        forces: [Spring(a: \"ball\", b: World, anchor_b: (0, 2), stiffness: 1000)],
        bodies: [(name: \"ball\", at: (0, 0.09), material: \"m\", atoms: Disc(radius: 0.1, mass: 2))])",
    );
    simulation.run_to_tick(20).expect("numbers stay finite");
    let critical = 2.0 / (4000.0_f64 / 2.0).sqrt();
    assert_near("critical tick", simulation.card().critical_tick.unwrap(), critical, 1e-12);
}
