//! Laws of the force `Spring` of scenes; each test says its law and its tolerance.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

fn load(forces: &str, bodies: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), bodies: [{bodies}], forces: [{forces}], contacts: None)"
    );
    Simulation::load(&Source::new("spring.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"))
}

const BLOCK: &str = "(name: \"block\", at: (3, 0), angle: \"90 deg\", mass: 2, inertia: 0.5, atoms: Disc(radius: 0.1))";

/// Force and torque of one evaluation against numbers by hand; rounding only.
#[test]
fn a_spring_pulls_at_its_anchors() {
    // The anchor (0, -1) of the turned block stands at (4, 0); the other end at (4, 3).
    let spring = "Spring(a: \"block\", b: World, anchor_a: (0, -1), anchor_b: (4, 3), stiffness: 10, length: 1)";
    let mut simulation = load(spring, BLOCK);
    simulation.run_to_tick(1).unwrap();
    let bodies = simulation.bodies();
    // 20 N upwards, 1 m to the right of the centre; half a tick's motion changes that by less than 1e-5.
    assert!((bodies.velocity[0].y - 20.0 / 2.0 * 1e-3).abs() < 1e-7, "{}", bodies.velocity[0]);
    assert!((bodies.spin[0] - 20.0 / 0.5 * 1e-3).abs() < 1e-6, "{}", bodies.spin[0]);
}

/// Without `length` a spring begins without force: nothing moves, to the last bit.
#[test]
fn the_length_is_the_distance_at_the_start() {
    let other = "(name: \"other\", at: (0.1, 0.7), atoms: Disc(radius: 0.1))";
    let mut simulation =
        load("Spring(a: \"block\", b: \"other\", stiffness: 1000, damping: 3)", &format!("{BLOCK}, {other}"));
    simulation.run_to_end().unwrap();
    assert_eq!(simulation.bodies().velocity[0], glam::DVec2::ZERO);
    assert_eq!(simulation.card().energy.elastic, 0.0);
}

/// A damped pair that is pulled by a prescribed body: what the drive brings is there or was lost. Tolerance: order 2,
/// `(omega dt)^2 = 1e-4` of what went round.
#[test]
fn what_a_moving_end_brings_is_booked() {
    let cart = "(name: \"cart\", at: (0, 0), kinematic: (velocity: (2, 0)), atoms: Disc(radius: 0.1))";
    let mut simulation = load(
        "Spring(a: \"cart\", b: \"block\", anchor_a: (0.2, 0.3), anchor_b: (0.1, 0.2), stiffness: 200, damping: 4)",
        &format!("{BLOCK}, {cart}"),
    );
    simulation.run_to_end().unwrap();
    let card = simulation.card();
    assert!(card.energy.work > 1.0 && card.energy.accounts["damping"] > 0.1, "{:?}", card.energy);
    assert!(card.energy_error() < 1e-4, "{:e}", card.energy_error());
    assert!(card.momentum_residual[0].abs() < 1e-12 && card.angular_momentum_residual.abs() < 1e-12);
}

/// The frequency of two masses on a spring, `sqrt(k (1/m1 + 1/m2))`, is exact after two products.
#[test]
fn a_stiff_spring_shortens_the_tick_and_stands_on_the_card() {
    let scene = "Scene(format: 1, clock: (duration: 1, method: VelocityVerlet), contacts: None,
        bodies: [(name: \"a\", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1)),
                 (name: \"b\", at: (1, 0), mass: 2, atoms: Disc(radius: 0.1))],
        forces: [Spring(a: \"a\", b: \"b\", stiffness: 1e6)])";
    let mut simulation = Simulation::load(&Source::new("stiff.ron", scene)).unwrap();
    // pi/(40 x 1000/s) = 7.9e-5 s, rounded down to 5e-5.
    assert_eq!(simulation.clock().dt, 5e-5);
    simulation.run_to_tick(3).unwrap();
    let critical = simulation.card().critical_tick.unwrap();
    assert!((critical - 2e-3).abs() < 1e-12, "{critical}");
}
