//! Law: a head-on impact of two discs on a linear spring lasts `pi sqrt(m/k)` with the reduced mass and the stiffnesses in
//! series, is `v sqrt(m/k)` deep and loses nothing; with different stiffness for loading and unloading
//! `e = sqrt(k2/k1)`, at every speed. Source: textbook; truth file C01; Walton and Braun 1986 for the idea of two
//! stiffnesses (their unloading ends at a residual overlap; here it ends at none, so that only `e` and the length agree).
//!
//! Tolerances: kinks inside ticks change the velocity by up to a share `(w dt)^2/4` (see `bounce`), the deepest overlap is
//! seen at ticks only, `(w dt)^2/8` more; inelasticity as in `restitution`. The law is homogeneous: with all lengths and
//! speeds scaled by a power of two every bit is the same.
//!
//! Not tested: impacts off centre (see `oblique`).

use jostle::SimulationExt;
use std::f64::consts::{FRAC_PI_2, PI};

use jostle::problems::{Truth, elastic_bounce};

use super::support::{METHODS, assert_near, contact_forces, load, phases, run};

/// In m.
const RADIUS: f64 = 0.5;
/// Of each disc in kg: one per square metre.
const MASS: f64 = PI / 4.0;
/// Of the pair in N/m.
const STIFFNESS: f64 = 1e5;

/// Two equal discs that meet at `speed` m/s, after a gap of `gap` m.
fn head_on(method: &str, tick: f64, duration: f64, inelasticity: f64, speed: f64, gap: f64) -> String {
    let (x, each, stiffness) = (RADIUS + gap / 2.0, speed / 2.0, 2.0 * STIFFNESS);
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}),
        materials: {{ \"steel\": (stiffness: {stiffness:?}, inelasticity: {inelasticity:?}) }}, bodies: [
            (name: \"a\", at: (-{x:?}, 0), velocity: ({each:?}, 0), material: \"steel\",
             atoms: Disc(radius: {RADIUS:?}, mass: {MASS:?})),
            (name: \"b\", at: ({x:?}, 0), velocity: (-{each:?}, 0), material: \"steel\",
             atoms: Disc(radius: {RADIUS:?}, mass: {MASS:?})),
        ])"
    )
}

/// Contact time in s, deepest overlap in m and ratio of speeds of an impact at 1 m/s.
fn observed(method: &str, tick: f64, inelasticity: f64, phase: f64) -> [f64; 3] {
    let gap = (1.0 + phase) * tick;
    let simulation = run(&head_on(method, tick, 0.02, inelasticity, 1.0, gap));
    let bodies = simulation.bodies();
    let speed = bodies.velocity[1].x - bodies.velocity[0].x;
    let apart = bodies.position[1].x - bodies.position[0].x - 2.0 * RADIUS;
    assert!(apart > 0.0 && speed > 0.0, "they should have parted");
    [simulation.clock().time() - gap - apart / speed, simulation.card().largest_overlap.meters, speed]
}

#[test]
fn two_equal_discs_exchange_their_velocities() {
    let omega = (STIFFNESS / (MASS / 2.0)).sqrt();
    // The numbers of the catalogue of tests for this example.
    assert_near("contact time", PI / omega, 6.225_580_0e-3, 1e-10);
    assert_near("overlap", 1.0 / omega, 1.981_663_6e-3, 1e-10);
    for method in METHODS {
        let tick = PI / omega / 100.0;
        let share = (omega * tick).powi(2) / 4.0;
        for phase in phases(32) {
            let [lasted, deepest, speed] = observed(method, tick, 0.0, phase);
            assert_near("contact time", lasted * omega / PI, 1.0, share);
            assert_near("deepest overlap", deepest * omega, 1.0, 1.5 * share);
            assert_near("speed", speed, 1.0, share);
        }
    }
}

/// Unloading with a quarter of the stiffness: `e = 1/2`, `t_c = (pi/2) (sqrt(m/k1) + sqrt(m/k2))`.
#[test]
fn two_stiffnesses_make_restitution_and_contact_time() {
    let inelasticity = 0.6;
    let reduced = MASS / 2.0;
    let loading = (reduced / (STIFFNESS * (1.0 + inelasticity))).sqrt();
    let unloading = (reduced / (STIFFNESS * (1.0 - inelasticity))).sqrt();
    let lasts = FRAC_PI_2 * (loading + unloading);
    let tick = lasts / 200.0;
    let step = (STIFFNESS / reduced).sqrt() * tick;
    for method in METHODS {
        for phase in phases(32) {
            let [lasted, deepest, speed] = observed(method, tick, inelasticity, phase);
            assert_near("restitution", speed, 0.5, (2.0 * inelasticity / 0.5 + 0.5 / 2.0) * step * step);
            assert_near("contact time in ticks", lasted / tick, 200.0, 1.0 + 2.0 * inelasticity / (1.0 - inelasticity));
            assert_near("deepest overlap", deepest / loading, 1.0, (1.0 + inelasticity) * step * step);
        }
    }
}

/// A disc against a wall, so that no length but gap and overlap plays a part. (The disc's centre is its radius above the
/// wall: both are scaled.)
#[test]
fn restitution_does_not_depend_on_speed() {
    let outcome = |scale: f64| {
        let (height, speed, radius) = (1.01 * scale, 2.0 * scale, scale);
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 0.08, tick: 1e-3, method: VelocityVerlet),
            materials: {{ \"clay\": (stiffness: 1e4, inelasticity: 0.5) }},
            walls: [(name: \"floor\", left: ({scale:?}, 0), right: (0, 0), material: \"clay\")],
            bodies: [(name: \"ball\", at: (0, {height:?}), velocity: (0, -{speed:?}), material: \"clay\",
                      atoms: Disc(radius: {radius:?}, mass: 1))])"
        ));
        simulation.bodies().velocity[0].y / speed
    };
    let one = outcome(1.0);
    assert!(one > 0.5, "{one}");
    for power in [-30, -10, 10, 30] {
        assert_eq!(outcome(2.0_f64.powi(power)), one, "2^{power}");
    }
}

/// Truth file C01: both bodies of 20 kN/m make a contact of 10 kN/m, with a greatest force of 200 N.
#[test]
fn stiffnesses_add_in_series() {
    let truth = Truth::read(elastic_bounce::TRUTH);
    let contact_time = truth.number("contact time, no gravity = pi sqrt(m/k)");
    let (greatest, deepest) = (truth.number("max force, no gravity"), truth.number("max overlap, no gravity"));
    let tick = contact_time / 100.0;
    let share = (PI / 100.0_f64).powi(2) / 4.0;
    for method in METHODS {
        for phase in phases(8) {
            let height = 0.2 + 2.0 * (1.0 + phase) * tick;
            let mut simulation = load(&format!(
                "Scene(format: 1, clock: (duration: 0.05, tick: {tick:?}, method: {method}),
                materials: {{ \"a\": (stiffness: 20000), \"b\": (stiffness: 20000) }}, sensors: [ContactForce(on: \"ball\")],
                bodies: [
                    (name: \"anvil\", at: (0, 0), fixed: true, material: \"a\", atoms: Disc(radius: 0.1, mass: 1)),
                    (name: \"ball\", at: (0, {height:?}), velocity: (0, -2), material: \"b\",
                     atoms: Disc(radius: 0.1, mass: 1)),
                ])"
            ));
            let mut force = 0.0_f64;
            while simulation.clock().ticks < simulation.ticks() {
                simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
                force = force.max(contact_forces(&simulation).on_body[1].y);
            }
            assert_near("speed", simulation.bodies().velocity[1].y / 2.0, 1.0, share);
            assert_near("greatest force", force / greatest, 1.0, 1.5 * share);
            let found = simulation.card().largest_overlap.meters;
            assert_near("deepest overlap", found / deepest, 1.0, 1.5 * share);
            // The force law itself: to the rounding of an overlap.
            assert_near("stiffness", force / found, truth.number("pair stiffness"), 1e4 * 1e-13);
        }
    }
}
