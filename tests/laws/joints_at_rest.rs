//! Jointed bodies that touch something come exactly to rest, and stay so to the bit.
//!
//! Laws: at rest, forces balance (Newton 1687), and the state of a scene at rest does not change. Tolerances: forces at rest balance up to
//! the share of 1e-9 that the search for rest allows; positions and the state hash have to be the same bits. Not tested: how fast rest
//! is found.

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

const G: f64 = 9.81;

fn load(clock: &str, scene: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1000, {clock}), gravity: (0, -{G}),
            materials: {{\"default\": (stiffness: 1e5, restitution: 0.2, friction: 0.6)}}, {scene})"
    );
    Simulation::load_with(&Source::new("rest.ron", scene), &Overrides::default(), |_| {})
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn channel(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
    simulation.value(&channel)
}

/// Runs to two ticks: at the first nothing moves, and the second has the same places to the bit.
#[track_caller]
fn rests(simulation: &mut Simulation, by: u64, until: u64) {
    simulation.run_to_tick(by).unwrap();
    let bodies = simulation.bodies();
    let kinetic: f64 = (0..bodies.len()).map(|body| bodies.kinetic_energy(body)).sum();
    assert_eq!(kinetic, 0.0, "not at rest after {by} ticks");
    let places = |simulation: &Simulation| -> Vec<_> {
        let bodies = simulation.bodies();
        (0..bodies.len()).map(|body| (bodies.position[body], bodies.angle[body])).collect()
    };
    let before = places(simulation);
    simulation.run_to_tick(until).unwrap();
    assert_eq!(before, places(simulation), "something moved");
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance, "{found} instead of {exact}");
}

/// A row of atoms of radius 0.1 m from one place to another along x.
fn bar(from: f64, to: f64) -> String {
    let count = ((to - from) / 0.1).round() as usize;
    let atoms =
        (0..=count).map(|i| format!("(at: ({}, 0), radius: 0.1)", from + (to - from) * i as f64 / count as f64));
    format!("List([{}])", atoms.collect::<Vec<_>>().join(", "))
}

/// Planks with stiff hinges hang between two posts, and discs fall onto them.
fn bridge(planks: usize, discs: usize) -> String {
    let (length, turn) = (0.6, 0.06);
    let (mut at, mut bodies, mut joints) = ((0.0, 0.0), Vec::new(), Vec::new());
    let hinge = |name: usize, a: &str, b: &str| {
        format!("Revolute(name: \"pin_{name}\", a: {a}, b: {b}, friction: 2, collide: false)")
    };
    let end = format!("anchor_a: ({}, 0)", 0.5 * length);
    let begin = format!("anchor_b: ({}, 0)", -0.5 * length);
    for plank in 0..planks {
        let angle = turn * (plank as f64 - 0.5 * (planks as f64 - 1.0));
        let along = (length * angle.cos(), length * angle.sin());
        let (x, y) = (at.0 + 0.5 * along.0, at.1 + 0.5 * along.1);
        let atoms = bar(-0.2, 0.2);
        bodies
            .push(format!("(name: \"plank_{plank}\", at: ({x:?}, {y:?}), angle: {angle:?}, mass: 4, atoms: {atoms})"));
        let before = match plank {
            0 => "World, anchor_a: (0, 0)".to_owned(),
            _ => format!("\"plank_{}\", {end}", plank - 1),
        };
        joints.push(hinge(plank, &before, &format!("\"plank_{plank}\", {begin}")));
        at = (at.0 + along.0, at.1 + along.1);
    }
    let post = format!("World, anchor_b: ({:?}, {:?})", at.0, at.1);
    joints.push(hinge(planks, &format!("\"plank_{}\", {end}", planks - 1), &post));
    for disc in 0..discs {
        let x = at.0 * (0.2 + 0.6 * disc as f64 / (discs as f64 - 1.0));
        bodies.push(format!("(name: \"disc_{disc}\", at: ({x:?}, 0.5), mass: 2, atoms: Disc(radius: 0.15))"));
    }
    let sensed = "sensors: [Joint(of: \"*\")]";
    let rolling = "contacts: Penalty(rolling: Spring(friction: 0.02))";
    format!("bodies: [{}], joints: [{}], {sensed}, {rolling}", bodies.join(", "), joints.join(", "))
}

/// The posts bear the weight of planks and discs.
#[test]
fn a_bridge_with_ten_discs_on_it_comes_exactly_to_rest() {
    for (planks, discs) in [(10, 10), (7, 4)] {
        let mut simulation = load("tick: 0.001, method: VelocityVerlet", &bridge(planks, discs));
        rests(&mut simulation, 15_000, 16_000);
        let weight = (4 * planks + 2 * discs) as f64 * G;
        let first = channel(&mut simulation, "pin_0.force.y");
        // That on the world, which is side B of the last pin.
        let last = -channel(&mut simulation, &format!("pin_{planks}.force.y"));
        near(first + last, weight, 1e-9 * weight);
        let apart =
            channel(&mut simulation, "pin_0.force.x") - channel(&mut simulation, &format!("pin_{planks}.force.x"));
        near(apart, 0.0, 1e-9 * weight);
    }
}

/// An arm lies on its limit, two discs lie on the arm: the torque of the limit is that of all weights.
#[test]
fn an_arm_at_its_limit_comes_exactly_to_rest_with_its_load() {
    for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4"] {
        let mut simulation = load(
            &format!("tick: 0.001, method: {method}"),
            &format!(
                "bodies: [(name: \"arm\", at: (0.7, 0), mass: 5, atoms: {}),
                    (name: \"first\", at: (0.4, 0.6), mass: 2, atoms: Disc(radius: 0.1)),
                    (name: \"second\", at: (0.9, 0.4), mass: 3, atoms: Disc(radius: 0.15))],
                joints: [Revolute(name: \"shoulder\", a: World, anchor_a: (0, 0), b: \"arm\", anchor_b: (-0.7, 0),
                    limits: (0, \"40 deg\"))],
                sensors: [Joint(of: \"shoulder\")]",
                bar(-0.5, 0.5)
            ),
        );
        rests(&mut simulation, 8000, 9000);
        near(channel(&mut simulation, "shoulder.force.y"), 10.0 * G, 1e-8 * G);
        let bodies = simulation.bodies();
        let moment: f64 = (0..bodies.len()).map(|body| bodies.position[body].x * bodies.mass[body] * G).sum();
        near(channel(&mut simulation, "shoulder.torque"), moment, 1e-8 * moment);
    }
}

/// A top on four legs that turn in stiff hinges, and a ball on it: the floor bears all of it.
#[test]
fn a_table_on_four_jointed_legs_comes_exactly_to_rest() {
    let legs = [(1, -0.9), (2, -0.3), (3, 0.3), (4, 0.9)];
    let bodies = legs.map(|(leg, x)| {
        format!(
            "(name: \"leg_{leg}\", at: ({x}, 0.5), mass: 1, atoms: List([(at: (0, -0.4), radius: 0.1),
                (at: (0, -0.2), radius: 0.1), (at: (0, 0), radius: 0.1), (at: (0, 0.2), radius: 0.1)]))"
        )
    });
    let joints = legs.map(|(leg, x)| {
        format!("Revolute(a: \"top\", anchor_a: ({x}, -0.2), b: \"leg_{leg}\", anchor_b: (0, 0.4), friction: 20, collide: false)")
    });
    let scene = format!(
        "walls: [(name: \"floor\", left: (5, 0), right: (-5, 0))],
         bodies: [(name: \"top\", at: (0, 1.1), mass: 10, atoms: {}), {},
            (name: \"ball\", at: (0.2, 1.5), mass: 3, atoms: Disc(radius: 0.2))],
         joints: [{}], contacts: Penalty(rolling: Spring(friction: 0.02)), sensors: [ContactForce(on: \"floor\")]",
        bar(-1.0, 1.0),
        bodies.join(", "),
        joints.join(", ")
    );
    let mut simulation = load("tick: 0.0005, method: VelocityVerlet", &scene);
    rests(&mut simulation, 20_000, 22_000);
    near(channel(&mut simulation, "floor.force.y"), -17.0 * G, 1e-8 * G);
}
