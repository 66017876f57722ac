//! Law: a sticking contact is a spring along the relative path of the two bodies (Mindlin 1949 to first order; Cundall
//! and Strack 1979), followed to second order in the tick. Its energy at the parting of the bodies is lost to friction,
//! and the ledger has it.
//!
//! A disc meets off centre another one, or one end of a bar, so rough that they never slip. Tolerances: during the contact all forces are continuous,
//! so that errors fall with order 2, less the slack of 0.25 of all fits (see `convergence`); the reference is a run with
//! a tick 16 times shorter than the finest. At separation the spring is dropped in a tick's time: the residual of the
//! ledger falls with order 1 at least, less the same slack.
//!
//! Not tested: slip (see `friction`), inelastic impacts (see `restitution`).

use glam::DVec2;
use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, fitted_order, load, phases, table};

const SPEED: f64 = 1.0;
const RADIUS: f64 = 0.1;
const OFFSET: f64 = 0.12;
const STIFFNESS: f64 = 2000.0;

/// What is met: a disc, and a bar of which one end is where the disc would be.
const MET: [&str; 2] = [
    "atoms: Disc(radius: 0.1, mass: 1)",
    "datum: Origin, atoms: List([(at: (0, 0), radius: 0.1, mass: 1), (at: (0.3, -0.4), radius: 0.1, mass: 1)])",
];

/// The first disc comes from the left, `early` seconds before it touches.
fn scene(method: &str, met: &str, tick: f64, early: f64) -> Simulation {
    let reach = 2.0 * RADIUS;
    let x = -(reach * reach - OFFSET * OFFSET).sqrt() - SPEED * early;
    load(&format!(
        "Scene(format: 1, clock: (duration: 1, tick: {tick:?}, method: {method}),
        materials: {{ \"rough\": (stiffness: {STIFFNESS:?}, friction: 1000) }},
        bodies: [
            (name: \"first\", at: ({x:?}, {OFFSET:?}), velocity: ({SPEED:?}, 0), spin: 2, material: \"rough\",
             atoms: Disc(radius: {RADIUS:?}, mass: 1)),
            (name: \"second\", at: (0, 0), material: \"rough\", {met}),
        ])"
    ))
}

/// Half a swing of the discs' spring: 1000 N/m on half a kilogram. A bar is heavier: up to sqrt(4/3) times as long.
fn contact_time() -> f64 {
    std::f64::consts::PI / (STIFFNESS / 2.0 / 0.5).sqrt()
}

/// State of both bodies in the middle of the contact.
fn in_the_middle(method: &str, met: &str, ticks: u32) -> [f64; 6] {
    let time = 0.4 * contact_time();
    // A whole number of ticks before the touch, so that it falls on one, at every tick.
    let early = time / 4.0;
    let tick = (time + early) / f64::from(ticks);
    let mut simulation = scene(method, met, tick, early);
    simulation.run_to_tick(u64::from(ticks)).expect("numbers stay finite");
    assert!(simulation.card().energy.elastic > 0.0, "they should touch");
    let bodies = simulation.bodies();
    let velocity = bodies.velocity[0] / SPEED;
    let position = bodies.position[0] / (SPEED * time);
    [velocity.x, velocity.y, position.x, position.y, bodies.spin[0] * RADIUS, bodies.spin[1] * RADIUS]
}

#[test]
fn a_contact_that_sticks_is_followed_to_second_order() {
    let method = "VelocityVerlet";
    for met in MET {
        let exact = in_the_middle(method, met, 16 * 640);
        let points = [40, 80, 160, 320, 640].map(|ticks| {
            let found = in_the_middle(method, met, ticks);
            let error = found.iter().zip(exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
            (1.0 / f64::from(ticks), error)
        });
        let order = fitted_order(&points);
        println!("{met}: order {order:.2};{}", table(&points));
        assert!(order >= 1.75, "{met}: order {order};{}", table(&points));
    }
}

#[test]
fn what_the_spring_holds_at_separation_is_in_the_ledger() {
    for (method, met) in METHODS.iter().flat_map(|method| MET.map(|met| (method, met))) {
        let points = [20.0, 40.0, 80.0, 160.0, 320.0, 640.0].map(|ticks| {
            let tick = contact_time() / ticks;
            let residuals = phases(32).map(|phase| {
                let mut simulation = scene(method, met, tick, (2.0 + phase) * tick);
                simulation.run_to_tick((2.0 * ticks) as u64).expect("numbers stay finite");
                let energy = simulation.card().energy;
                assert_eq!(energy.elastic, 0.0, "they should have parted");
                assert!(energy.friction > 1e-3 * SPEED * SPEED, "the spring should hold something: {energy:?}");
                energy.residual.abs()
            });
            (tick, residuals.fold(0.0, f64::max))
        });
        let order = fitted_order(&points);
        println!("{method}, {met}: order {order:.2};{}", table(&points));
        assert!(order >= 0.75, "{method}, {met}: order {order};{}", table(&points));
    }
}

/// The third law for the pair, by its own sum: momentum of the two is that of the first before.
#[test]
fn the_pair_keeps_its_momentum() {
    let mut simulation = scene("VelocityVerlet", MET[0], contact_time() / 100.0, 1e-3);
    simulation.run_to_tick(200).expect("numbers stay finite");
    let bodies = simulation.bodies();
    let sum = bodies.velocity[0] + bodies.velocity[1];
    // 200 ticks of equal and opposite kicks, each rounded.
    assert!((sum - DVec2::new(SPEED, 0.0)).length() < 200.0 * f64::EPSILON * SPEED, "{sum}");
}
