//! Law: a body with prescribed motion is where its prescription says. It pushes others as a wall of infinite mass would
//! (`v' = u + e (u - v)`), receives nothing, and its work is booked. Source: kinematics; Newton's law of impact in the
//! frame of the wall; energy balance.
//!
//! Tolerances: places are functions of time, so rounding of the product and the sum is all. Impacts and the ledger have
//! the order of the method; a body that is carried has the platform's velocity but for the rounding of velocities.
//!
//! Not tested: two prescribed bodies that squeeze a third.

use jostle::SimulationExt;
use jostle::problems;

use super::support::{METHODS, assert_near, fitted_order, fitted_order_above, load, phases, run, table};

const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e4;
const INELASTICITY: f64 = 0.3;

/// Times and places are products and sums of a few numbers: each rounds once, by half a unit in the last place.
fn rounding(size: f64) -> f64 {
    4.0 * f64::EPSILON * size
}

#[test]
fn uniform_motion_is_exact_after_a_million_ticks() {
    for method in METHODS {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 1000, tick: 0.001, method: {method}), gravity: (0, -9.81),
            bodies: [(name: \"cart\", at: (1, 2), angle: 0.5, kinematic: (velocity: (0.1, -0.3), spin: 0.7),
                      atoms: Disc(radius: 0.1))])"
        ));
        let bodies = simulation.bodies();
        assert_near("x", bodies.position[0].x, 1.0 + 0.1 * 1000.0, rounding(101.0));
        assert_near("y", bodies.position[0].y, 2.0 - 0.3 * 1000.0, rounding(300.0));
        assert_near("angle", bodies.angle[0], 0.5 + 0.7 * 1000.0, rounding(700.5));
        assert_eq!((bodies.velocity[0].x, bodies.velocity[0].y, bodies.spin[0]), (0.1, -0.3, 0.7));
        let card = simulation.card();
        assert_eq!((card.energy.kinetic, card.energy.work, card.momentum_residual), (0.0, 0.0, [0.0, 0.0]));
    }
}

/// Between two stops the way is `3 s^2 - 2 s^3` of the whole, and what is led is the datum point.
#[test]
fn a_path_leads_the_point_that_at_names() {
    let mut simulation = load(
        "Scene(format: 1, clock: (duration: 5, tick: 0.001),
        bodies: [(name: \"paddle\", at: (1, 1), datum: Origin, atoms: List([(at: (0.5, 0), radius: 0.1)]),
                  kinematic: (path: [(time: 2, by: (0.8, 0), turn: 3), (time: 4, by: (0, 0.4), turn: -1)], repeat: true))])",
    );
    for tick in [0, 500, 1000, 2000, 3000, 4000, 5000] {
        simulation.run_to_tick(tick).expect("numbers stay finite");
        let time = tick as f64 * 0.001;
        let smooth = |s: f64| s * s * (3.0 - 2.0 * s);
        let (rounds, within) = ((time / 4.0).floor(), time % 4.0);
        let (x, y, turn) = if within < 2.0 {
            let s = smooth(within / 2.0);
            (0.8 * s, 0.4 * rounds, 3.0 * s - rounds)
        } else {
            let s = smooth(within / 2.0 - 1.0);
            (0.8 - 0.8 * s, 0.4 * rounds + 0.4 * s, 3.0 - 4.0 * s - rounds)
        };
        let found = simulation.bodies().position[0];
        assert_near("angle", simulation.bodies().angle[0], turn, rounding(10.0));
        assert_near("x", found.x, 1.0 + x + 0.5 * turn.cos(), rounding(10.0));
        assert_near("y", found.y, 1.0 + y + 0.5 * turn.sin(), rounding(10.0));
    }
}

/// A wall of discs that moves with 0.7 m/s meets a ball that comes with 0.4 m/s.
fn bat(method: &str, tick: f64, inelasticity: f64, gap: f64) -> String {
    let place = 10.1 + gap;
    format!(
        "Scene(format: 1, clock: (duration: 0.5, tick: {tick:?}, method: {method}),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, inelasticity: {inelasticity:?}) }},
        bodies: [
            (name: \"bat\", at: (0, 0), material: \"rubber\", kinematic: (velocity: (0.7, 0)), atoms: Disc(radius: 10)),
            (name: \"ball\", at: ({place:?}, 0), velocity: (-0.4, 0), material: \"rubber\",
             atoms: Disc(radius: 0.1, mass: 0.5)),
        ])"
    )
}

/// As on a wall at rest the error of the restitution is of order two (the normal force jumps where the speed is zero).
#[test]
fn what_it_hits_leaves_as_from_a_moving_wall() {
    for method in METHODS {
        for inelasticity in [0.0, INELASTICITY] {
            let restitution = ((1.0 - inelasticity) / (1.0 + inelasticity)).sqrt();
            let exact = 0.7 + restitution * 1.1;
            let points: Vec<(f64, f64)> = (0..5)
                .map(|halving| {
                    let tick = 1e-3 / f64::from(1 << halving);
                    let error = |phase: f64| {
                        let simulation = run(&bat(method, tick, inelasticity, 0.05 + 1.1e-3 * phase));
                        let card = simulation.card();
                        let energy = card.energy;
                        // What the bat did is what the ball gained and lost, but for what the method is in error.
                        let gained = 0.25 * (exact * exact - 0.16);
                        let lost = 0.25 * 1.1 * 1.1 * (1.0 - restitution * restitution);
                        let error = (simulation.bodies().velocity[1].x - exact).abs();
                        (error, (energy.work - gained - lost).abs(), energy.residual.abs())
                    };
                    let worst = phases(20)
                        .map(error)
                        .fold((0.0_f64, 0.0_f64, 0.0_f64), |w, e| (w.0.max(e.0), w.1.max(e.1), w.2.max(e.2)));
                    println!("{method} {inelasticity} {tick:e}: {worst:?}");
                    (tick, worst.0.max(worst.1).max(worst.2))
                })
                .collect();
            let order = fitted_order(&points);
            // Order one at least, from a first error below 5 % of the speed.
            assert!(order > 0.75 && points[0].1 < 0.05 * exact, "{method} {inelasticity}: {order}: {}", table(&points));
        }
    }
}

/// A ball that never leaves a plate which is shaken smoothly, without any loss: a driven oscillator.
#[test]
fn the_work_of_a_shaken_plate_is_booked() {
    for method in problems::methods() {
        let points: Vec<(f64, f64)> = (0..5)
            .map(|halving| {
                let tick = 4e-3 / f64::from(1 << halving);
                let height = 10.1 - GRAVITY / STIFFNESS * 2.0;
                let simulation = run(&format!(
                    "Scene(format: 1, clock: (duration: 1.9, tick: {tick:?}, method: {}), gravity: (0, -{GRAVITY:?}),
                    materials: {{ \"steel\": (stiffness: {STIFFNESS:?}) }},
                    bodies: [
                        (name: \"plate\", at: (0, 0), material: \"steel\", atoms: Disc(radius: 10),
                         kinematic: (path: [(time: 0.2, by: (0, 0.01)), (time: 0.4, by: (0, 0))], repeat: true)),
                        (name: \"ball\", at: (0, {height:?}), material: \"steel\", atoms: Disc(radius: 0.1, mass: 1)),
                    ])",
                    method.name
                ));
                let card = simulation.card();
                assert!(card.energy.work.abs() > 1e-3, "nothing was moved: {:?}", card.energy);
                let [x, y] = card.momentum_residual;
                // Two kicks a tick, each rounds by half a unit of the impulses so far.
                assert!(x.hypot(y) <= 1e-12 * GRAVITY * 1.9, "{x:e} {y:e}");
                (tick, card.energy.residual.abs())
            })
            .collect();
        // Sums of a hundred joules: a hundred times their rounding over some thousand ticks.
        let Some(order) = fitted_order_above(1e-11, &points) else { continue };
        assert!(order > f64::from(method.order) - 0.25, "{}: order {order}: {}", method.name, table(&points));
    }
}

/// A block on a platform.
fn carried(kinematic: &str, duration: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: 0.0002), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"wood\": (stiffness: {STIFFNESS:?}, friction: 0.4, inelasticity: {INELASTICITY:?}) }},
        bodies: [
            (name: \"platform\", at: (0, 0), material: \"wood\", kinematic: ({kinematic}),
             atoms: List([(at: (-0.4, 0), radius: 0.2), (at: (0.4, 0), radius: 0.2)])),
            (name: \"block\", at: (0, 0.351), material: \"wood\",
             atoms: List([(at: (-0.4, 0), radius: 0.15, mass: 0.5), (at: (0.4, 0), radius: 0.15, mass: 0.5)])),
        ],
        sensors: [ContactForce(on: \"block\")])"
    )
}

/// In the frame of a platform in uniform motion a block rests: it has the platform's velocity to the last bits, the
/// platform bears its weight, and lifts it with the power `m g v`.
#[test]
fn a_block_rides_on_a_platform_in_uniform_motion() {
    let mut simulation = load(&carried("velocity: (0.3, 0.2)", 3.0));
    simulation.run_to_tick(10_000).expect("numbers stay finite");
    let (before, at) = (simulation.card().energy.work, simulation.bodies().position[1]);
    simulation.run_to_end().expect("numbers stay finite");
    let (bodies, card) = (simulation.bodies(), simulation.card());
    assert_near("vx", bodies.velocity[1].x, 0.3, rounding(0.3));
    assert_near("vy", bodies.velocity[1].y, 0.2, rounding(0.2));
    // Forces over a tick carry the rounding of velocities: 1e-16 m/s over 2e-4 s are 1e-12 N.
    assert_near("power", card.energy.work - before, GRAVITY * 0.2, 1e-10);
    // 5000 ticks round the place once each.
    assert_near("way", (bodies.position[1] - at).x, 0.3, 5000.0 * rounding(1.0));
    assert!(card.energy_error() < 1e-3, "{card}");
    let [x, y] = card.momentum_residual;
    assert!(x.hypot(y) <= 15e-12 * GRAVITY * 3.0, "{x:e} {y:e}");
}

/// It rests while the platform stands, moves with it, and rests again where it was set down; what it may differ by is the
/// band of overlaps that bear it: `mg/2k (1/(1 - mu_e) - 1/(1 + mu_e))` for two contacts in series of two.
#[test]
fn a_block_at_rest_is_taken_along_and_set_down() {
    let mut simulation = load(&carried("path: [(time: 2, by: (0, 0)), (time: 3, by: (0.1, 0.2))]", 6.0));
    simulation.run_to_tick(9_950).expect("numbers stay finite");
    let before = simulation.bodies().position[1];
    let stands = |simulation: &jostle::Simulation| {
        simulation.bodies().velocity[1] == glam::DVec2::ZERO && simulation.bodies().spin[1] == 0.0
    };
    assert!(stands(&simulation), "before: {:?}", simulation.bodies().velocity[1]);
    simulation.run_to_tick(12_500).expect("numbers stay finite");
    // Half way the platform has 1.5 times its mean velocity. A method of order two lags by its forces of one tick.
    let velocity = simulation.bodies().velocity[1];
    assert_near("vy", velocity.y, 0.3, 6.0 * 0.2 * 0.0002);
    assert_near("vx", velocity.x, 0.15, 6.0 * 0.1 * 0.0002);
    simulation.run_to_end().expect("numbers stay finite");
    assert!(stands(&simulation), "after: {:?}", simulation.bodies().velocity[1]);
    let moved = simulation.bodies().position[1] - before;
    let weight = GRAVITY / 2.0 / (STIFFNESS / 2.0);
    let band = weight * (1.0 / (1.0 - INELASTICITY) - 1.0 / (1.0 + INELASTICITY));
    assert_near("y", moved.y, 0.2, band);
    assert_near("x", moved.x, 0.1, 2.0 * 0.4 * weight / 0.8);
}
