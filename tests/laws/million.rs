//! Law: rounding errors add up like a random walk, with the square root of the number of ticks, not with the number
//! (Brouwer 1937); a symplectic method lets energy swing, not drift. Source: Hairer, McLachlan and Razakarivony 2008; truth
//! file O06, which has the exact solution of both discrete methods after a million ticks.
//!
//! The oscillator of the truth file is a disc pressed so deep into the floor by gravity that it never parts, and a mass on a spring. Tolerances: a
//! state after `n` ticks is off by up to `n` roundings of the velocity of half an ulp, as a walk `sqrt(n)` of them, and each
//! changes the phase in proportion to the ticks that follow, by `n^(3/2)` in all: `1e9 x 1e-16 x 3`, which is 3e-7; the truth
//! itself knows the tick to an ulp. The momentum residual is a walk of roundings of the momentum: two a tick, each of half
//! an ulp at most; six standard deviations of `sqrt(2 n) ulp(p)/sqrt(12)` are allowed. Energy: each rounding of a velocity
//! is also one of the energy, `m v ulp(v)`.
//!
//! Not tested: angular momentum (see `momentum`).

use jostle::Simulation;
use jostle::problems::Truth;

use super::support::{METHODS, assert_near, load};

const STIFFNESS: f64 = 39.0;
const AMPLITUDE: f64 = 0.5;
/// Overlap about which the disc swings, in m: deeper than the amplitude.
const MEAN: f64 = 0.6;
const RADIUS: f64 = 2.0;

fn oscillator(method: &str) -> (Truth, f64, Simulation) {
    let truth = Truth::read(include_str!("../../assets/truths/O06_million_steps.json"));
    let tick = truth.number("dt");
    let (gravity, height) = (STIFFNESS * MEAN, RADIUS - MEAN + AMPLITUDE);
    let simulation = load(&format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}), gravity: (0, -{gravity:?}),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        bodies: [(name: \"disc\", at: (0, {height:?}), material: \"rubber\", atoms: Disc(radius: {RADIUS:?}, mass: 1))])",
        2e6 * tick
    ));
    (truth, tick, simulation)
}

/// The same oscillator as a mass on a spring without a length of its own.
fn sprung(method: &str) -> (Truth, Simulation) {
    let truth = Truth::read(include_str!("../../assets/truths/O06_million_steps.json"));
    let tick = truth.number("dt");
    let simulation = load(&format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
        forces: [Spring(a: \"mass\", b: World, stiffness: {STIFFNESS:?}, length: 0)],
        bodies: [(name: \"mass\", at: ({AMPLITUDE:?}, 0), atoms: Disc(radius: 0.1, mass: 1))])",
        2e6 * tick
    ));
    (truth, simulation)
}

/// Displacement in m and velocity in m/s.
fn state(simulation: &Simulation) -> (f64, f64) {
    let bodies = simulation.bodies();
    (bodies.position[0].y - (RADIUS - MEAN), bodies.velocity[0].y)
}

#[test]
fn a_million_ticks_arrive_where_the_discrete_solution_does() {
    for (method, observable) in METHODS.into_iter().zip([
        "symplectic euler (v then x) discrete-exact x,v after n steps",
        "verlet discrete-exact x,v after n steps",
    ]) {
        let (truth, _, mut simulation) = oscillator(method);
        let exact = truth.numbers(observable);
        simulation.run_to_tick(1_000_000).expect("numbers stay finite");
        let (x, v) = state(&simulation);
        println!("{method}: x off by {:e}, v by {:e}", x - exact[0], v - exact[1]);
        assert_near("x", x, exact[0], 3e-7 * AMPLITUDE);
        assert_near("v", v, exact[1], 3e-7 * AMPLITUDE * STIFFNESS.sqrt());
    }
}

#[test]
fn a_million_ticks_on_a_spring_arrive_where_the_discrete_solution_does() {
    for (method, observable) in METHODS.into_iter().zip([
        "symplectic euler (v then x) discrete-exact x,v after n steps",
        "verlet discrete-exact x,v after n steps",
    ]) {
        let (truth, mut simulation) = sprung(method);
        let exact = truth.numbers(observable);
        simulation.run_to_tick(1_000_000).expect("numbers stay finite");
        let (x, v) = (simulation.bodies().position[0].x, simulation.bodies().velocity[0].x);
        println!("{method}: x off by {:e}, v by {:e}", x - exact[0], v - exact[1]);
        assert_near("x", x, exact[0], 3e-7 * AMPLITUDE);
        assert_near("v", v, exact[1], 3e-7 * AMPLITUDE * STIFFNESS.sqrt());
    }
}

/// The largest of the residuals at ten times up to `ticks`.
fn residuals(method: &str, ticks: u64) -> (f64, f64) {
    let (_, tick, mut simulation) = oscillator(method);
    // What a tick of this length leaves of `v^2/2 + w^2 x^2/2` exactly, for an oscillator.
    let z = STIFFNESS * tick * tick;
    let invariant = |simulation: &Simulation| {
        let (x, v) = state(simulation);
        let correction = if method == METHODS[0] { STIFFNESS * tick * x * v } else { 0.25 * z * STIFFNESS * x * x };
        0.5 * (v * v + STIFFNESS * x * x - correction)
    };
    let start = invariant(&simulation);
    let (mut energy, mut momentum) = (0.0_f64, 0.0_f64);
    for part in 1..=10 {
        simulation.run_to_tick(ticks * part / 10).expect("numbers stay finite");
        energy = energy.max((invariant(&simulation) / start - 1.0).abs());
        momentum = momentum.max(simulation.card().momentum_residual[1].abs());
        let residual = simulation.card().energy.residual;
        // The card's own residual swings by the error of the method: `z/4`, or `sqrt(z)/2` with the first order.
        let swing = if method == METHODS[0] { 0.5 * z.sqrt() / (1.0 - 0.5 * z.sqrt()) } else { 0.25 * z };
        let scale = 0.5 * STIFFNESS * AMPLITUDE * AMPLITUDE;
        assert!(residual.abs() <= swing * scale * (1.0 + 1e-9), "{method}: {residual:e} after {part}/10");
    }
    (energy, momentum)
}

#[test]
fn residuals_grow_like_rounding() {
    let speed = AMPLITUDE * STIFFNESS.sqrt();
    for method in METHODS {
        for ticks in [1_000_u64, 30_000, 1_000_000] {
            let (energy, momentum) = residuals(method, ticks);
            let walk = 6.0 * (2.0 * ticks as f64 / 12.0).sqrt();
            // Speeds up to 3.1 m/s have an ulp of 2 eps; heights, up to 2 m, of eps, and they enter with w.
            let ulp = 2.0 * f64::EPSILON;
            let allowed = (walk * ulp, walk * 3.0 * ulp / speed);
            println!(
                "{method}, {ticks} ticks: momentum {momentum:.1e} of {:.1e}, energy {energy:.1e} of {:.1e}",
                allowed.0, allowed.1
            );
            assert!(momentum <= allowed.0, "{method}, {ticks} ticks: momentum {momentum:e} > {:e}", allowed.0);
            assert!(energy <= allowed.1, "{method}, {ticks} ticks: energy {energy:e} > {:e}", allowed.1);
        }
    }
}
