//! Law: momentum and angular momentum of a closed system are constant. Those of an open one change by the external
//! impulses. Source: Newton's third law; Noether.
//!
//! Tolerance: rounding. A kick rounds each velocity once, by at most half a unit in the last place, 1.1e-16 of it; with
//! errors of the same sign a thousand ticks of two kicks make 2.2e-13, and contacts as many again: 1e-12 per 1000
//! ticks, relative to the sum of absolute values.
//!
//! Not tested: whether forces are right, only that they come in pairs and are booked.

use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, load, momenta, run};

const PER_THOUSAND_TICKS: f64 = 1e-12;

/// Four clumps that meet in the middle, rough and inelastic, and nothing else.
fn closed_scene(method: &str) -> String {
    let rows = "atoms: Picture(spacing: 0.1, mass: 0.02, rows: [\"##..\", \"##..\", \"####\", \"####\"])";
    format!(
        "Scene(format: 1, clock: (duration: 4, tick: 0.0002, method: {method}),
        materials: {{
            \"rough\": (stiffness: 2000, friction: 0.5, inelasticity: 0.2),
            \"slick\": (stiffness: 5000, friction: (static: 0.3, dynamic: 0.2)),
        }},
        bodies: [
            (name: \"west\", at: (-0.8, 0.05), velocity: (1.3, 0.1), spin: 2, material: \"rough\", {rows}),
            (name: \"east\", at: (0.8, -0.1), velocity: (-0.9, 0), spin: -3, angle: 1, material: \"slick\", {rows}),
            (name: \"north\", at: (0.1, 0.9), velocity: (0.1, -1.1), spin: 5, angle: 2, material: \"rough\", {rows}),
            (name: \"south\", at: (-0.1, -0.8), velocity: (0, 0.7), material: \"slick\", {rows}),
        ])"
    )
}

#[test]
fn a_closed_scene_keeps_both() {
    for method in METHODS {
        let mut simulation = load(&closed_scene(method));
        let ((momentum, turning), (scale, turning_scale)) = momenta(simulation.bodies());
        for thousands in 1..=20 {
            simulation.run_to_tick(1000 * thousands).expect("numbers stay finite");
            let ((momentum_now, turning_now), _) = momenta(simulation.bodies());
            let allowed = PER_THOUSAND_TICKS * thousands as f64;
            let (lost, lost_turning) =
                ((momentum_now - momentum).length() / scale, (turning_now - turning).abs() / turning_scale);
            assert!(lost <= allowed, "{method}: momentum after {thousands} thousand ticks: {lost:e}");
            assert!(lost_turning <= allowed, "{method}: angular momentum after {thousands} thousand: {lost_turning:e}");
        }
        let energy = simulation.card().energy;
        assert!(energy.friction > 1e-3 && energy.inelasticity > 1e-3, "they should have met: {energy:?}");
        println!("{method}: {:?}", (momenta(simulation.bodies()).0, momentum, turning, energy));
    }
}

/// The same among walls, with every force from outside that there is.
fn open_scene(method: &str) -> String {
    closed_scene(method).replace(
        "bodies: [",
        "gravity: (0.3, -9.81),
        walls: [
            (name: \"floor\", left: (1, -1.2), right: (0, -1.2), material: \"rough\"),
            (name: \"left\", left: (-1.2, 0), right: (-1.2, 1), material: \"slick\"),
            (name: \"right\", left: (1.2, 1), right: (1.2, 0), material: \"rough\"),
        ],
        forces: [
            Drag(linear: 0.05, of: [\"west\", \"north\"]),
            Drag(quadratic: 0.02),
            Thrust(of: \"east\", at: (0.1, 0.05), force: (0.3, 2), frame: Body, from: 0.5, to: 2),
            Thrust(of: \"south\", at: (0, 0.1), force: (1, 0)),
            Torque(of: \"north\", value: 0.05),
        ],
        bodies: [
            (name: \"peg\", fixed: true, at: (0.4, -0.6), material: \"rough\", atoms: Disc(radius: 0.15)),",
    )
}

/// What the scene's impulses add up to at most, in N s: the measure of what rounding may lose.
fn impulses(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    let weight: f64 = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(|body| bodies.mass[body] * 9.81).sum();
    weight * simulation.clock().time()
}

#[test]
fn the_card_accounts_for_every_impulse_from_outside() {
    for method in METHODS {
        let mut simulation = load(&open_scene(method));
        simulation.run_to_end().expect("numbers stay finite");
        let card = simulation.card();
        let allowed = PER_THOUSAND_TICKS * 20.0 * impulses(&simulation);
        let [x, y] = card.momentum_residual;
        assert!(x.hypot(y) <= allowed, "{method}: momentum residual {x:e}, {y:e} N s of {allowed:e}");
        // Everything happens within two metres of the origin.
        let residual = card.angular_momentum_residual;
        assert!(residual.abs() <= 2.0 * allowed, "{method}: angular momentum residual {residual:e} of {allowed:e}");
        let energy = &card.energy;
        let exchanged = [energy.friction, energy.inelasticity, energy.drag, energy.work];
        assert!(exchanged.iter().all(|&energy| energy > 1.0), "nothing happened: {energy:?}");
        println!("{method}: {x:e} {y:e} {residual:e} of {allowed:e}; {:?}", card.energy);
    }
}

/// Law: what goes in from outside is booked while a mechanism comes to rest and leaves it again, beside a body that falls: on the ground a cart on
/// soft axles is pushed against a latch that a rope holds. Tolerance: as above; the falling body alone gains 24 N s.
#[test]
fn what_rests_and_wakes_beside_a_fall_is_booked() {
    let scene = r#"Scene(format: 1, clock: (duration: 3, tick: "0.2 ms", method: VelocityVerlet), gravity: (0, -9.81),
        materials: { "default": (stiffness: "50 kN/m", friction: 0.3, restitution: 0.2, density: 12), "rubber": (stiffness: "50 kN/m", friction: 0.8, restitution: 0.2, density: 20) },
        pairs: [(between: ("default", "default"), friction: 0.02)],
        walls: [(name: "ground", left: (3, 0.15), right: (0, 0.15))],
        bodies: [
            (name: "falling", at: (30, 300), atoms: Disc(radius: 0.1, mass: 1)),
            (name: "lever", at: (1.48, 1.32), shape: Capsule(from: (-0.26, 0), to: (0.26, 0), radius: 0.012)),
            (name: "latch", at: (1.22, 0.4), shape: Capsule(from: (0, -0.11), to: (0, 0.11), radius: 0.012, mass: 0.06)),
            (name: "cart", at: (0, 0), datum: Origin, shape: Compound([
                Rectangle(width: 0.56, height: 0.05, rounding: 0.01, at: (1.45, 0.25)),
                Rectangle(width: 0.03, height: 0.12, rounding: 0.01, at: (1.193, 0.3)),
            ])),
            (name: "rear", at: (1.27, 0.21), material: "rubber", atoms: Disc(radius: 0.06)),
            (name: "front", at: (1.62, 0.21), material: "rubber", atoms: Disc(radius: 0.06)),
            (name: "nut", at: (1.34, 0.3183), shape: Regular(sides: 6, radius: 0.05, rounding: 0.003)),
        ],
        joints: [
            Revolute(a: World, b: "lever", limits: ("-25 deg", 0)),
            Prismatic(a: World, b: "latch", axis: (0, 1)),
            Rope(a: "lever", anchor_a: (-0.26, 0), b: "latch", anchor_b: (0, 0.11)),
            Revolute(a: "cart", anchor_a: (1.27, 0.21), b: "rear", softness: (6, 0.4)),
            Revolute(a: "cart", anchor_a: (1.62, 0.21), b: "front", softness: (6, 0.4)),
        ],
        forces: [Wind(velocity: (2.5, 0), quadratic: 0.25, of: "cart")])"#;
    let card = run(scene).card();
    let [x, y] = card.momentum_residual;
    assert!(x.hypot(y) < 15.0 * PER_THOUSAND_TICKS * 24.0, "{x:e} {y:e}");
}
