//! Laws of contacts of shapes with sides.
//!
//! Source: the potential of two hulls is the sum of `k/2` times the squares of the overlaps of corners with the other hull. So the side of
//! a hull that does not give way is a wall, its corner is a disc, and contacts of bodies that move keep momentum, angular momentum and
//! energy. Tolerances: at each test. Not tested: concave shapes, which are refused.

use glam::DVec2;
use jostle::{Simulation, SimulationExt};

use super::support::{load, run_to};

const METHODS: [&str; 4] = [
    "method: VelocityVerlet, tick: \"10 us\"",
    "method: VelocityVerlet, tick: \"100 us\", events: Located",
    "method: RungeKutta4, tick: \"100 us\"",
    "method: Dop853, tick: \"1 ms\"",
];

const ROUGH: &str = "\"default\": (stiffness: 1e4, restitution: 0.6, friction: 0.3), \
    \"hard\": (stiffness: 1e300, restitution: 0.6, friction: 0.3)";

fn scene(clock: &str, materials: &str, rest: &str) -> Simulation {
    load(&format!("Scene(format: 1, clock: (duration: 3, {clock}), materials: {{{materials}}}, {rest})"))
}

/// Place, angle, velocity and spin of the first body.
fn first(simulation: &Simulation) -> [f64; 6] {
    let bodies = simulation.bodies();
    let (place, velocity) = (bodies.position[0], bodies.velocity[0]);
    [place.x, place.y, bodies.angle[0], velocity.x, velocity.y, bodies.spin[0]]
}

fn assert_same(found: [f64; 6], exact: [f64; 6], tolerance: f64, what: &str) {
    let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off <= tolerance, "{what}: off by {off:e}, {found:?} {exact:?}");
}

/// Law: the side of a fixed box that does not give way is a half-plane, with friction and turned by any angle. Tolerance: roundings of places
/// in the frame of the box, which grow at each of some five touches: 1e-10.
#[test]
fn the_side_of_a_hard_box_is_a_wall() {
    let ball = "(name: \"ball\", at: (0.1, 0.3), velocity: (0.4, -1), spin: 3, mass: 0.2, atoms: Disc(radius: 0.1))";
    for clock in METHODS {
        let end = |rest: &str| {
            let mut simulation = scene(clock, ROUGH, &format!("gravity: (0, -9.81), {rest}"));
            run_to(&mut simulation, 1.0);
            first(&simulation)
        };
        let angle = libm::atan2(-0.1, 1.0);
        let wall = end(&format!("walls: [(name: \"floor\", left: (9, -0.9), right: (-9, 0.9))], bodies: [{ball}]"));
        for shape in ["Rectangle(width: 20, height: 2)", "Rectangle(width: 20, height: 2, rounding: 0.3)"] {
            let below = DVec2::new(angle.sin(), -angle.cos());
            let floor = format!(
                "(name: \"floor\", at: ({:?}, {:?}), angle: {angle:?}, fixed: true, shape: {shape}, material: \"hard\")",
                below.x, below.y
            );
            assert_same(end(&format!("bodies: [{ball}, {floor}]")), wall, 1e-10, clock);
        }
    }
}

/// Law: the round corner of a hull is a disc: a capsule moves as two discs at its ends do that have its mass, where other discs hit its
/// ends, with friction and spin. Tolerance: rounding, which grows at touches of two convex surfaces: 1e-9.
#[test]
fn the_corner_of_a_hull_is_a_disc() {
    let ball = "(name: \"ball\", at: (1.2, 0.07), velocity: (-3, 0), spin: 4, mass: 0.3, atoms: Disc(radius: 0.1))";
    for clock in METHODS {
        let end = |shape: &str| {
            let bar = format!("(name: \"bar\", at: (0, 0), spin: 0.3, mass: 1, inertia: 0.1, {shape})");
            let mut simulation = scene(clock, ROUGH, &format!("bodies: [{bar}, {ball}]"));
            run_to(&mut simulation, 0.5);
            first(&simulation)
        };
        let discs = end("atoms: List([(at: (-0.5, 0), radius: 0.1), (at: (0.5, 0), radius: 0.1)])");
        assert!(discs[3].abs() > 0.5, "the bar was hit: {discs:?}");
        assert_same(end("shape: Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.1)"), discs, 1e-9, clock);
    }
}

/// Law: contacts between sides, corners and discs of bodies that turn keep momentum, angular momentum and the sum of all energies: what
/// friction takes stands in the ledger. Tolerance: rounding of some thousand evaluations of numbers near 1.
#[test]
fn what_collides_keeps_momentum_and_energy() {
    let others = [
        "atoms: Disc(radius: 0.2)",
        "shape: Rectangle(width: 0.5, height: 0.3, rounding: 0.05)",
        "shape: Capsule(from: (0, -0.3), to: (0, 0.3), radius: 0.1)",
    ];
    for friction in ["0", "0.4"] {
        let materials = format!("\"default\": (stiffness: 1e4, restitution: 1, friction: {friction})");
        for other in others {
            let bodies = format!(
                "bodies: [(name: \"box\", at: (0, 0), angle: 0.3, spin: 3, mass: 1, shape: Rectangle(width: 0.8, height: 0.6, rounding: 0.1)),
                (name: \"other\", at: (1.5, 0.1), velocity: (-2, 0), spin: 5, mass: 0.5, {other})]"
            );
            let mut simulation = scene(METHODS[3], &materials, &bodies);
            run_to(&mut simulation, 1.0);
            let card = simulation.card();
            assert!(first(&simulation)[3].abs() > 0.1, "{other}: the box was hit");
            let [x, y] = card.momentum_residual.map(f64::abs);
            let worst = x.max(y).max(card.angular_momentum_residual.abs()).max(card.energy.residual.abs());
            assert!(worst < 1e-12, "{other}, friction {friction}: {worst:e}");
        }
    }
}

/// Law: errors of a collision with the flat side of a turning box fall with the order of the method. Halving the tick divides them by
/// `2^order`; a quarter of the order less is left to higher orders.
#[test]
fn methods_keep_their_orders_on_a_side_that_turns() {
    let materials = "\"default\": (stiffness: 2000, restitution: 1, friction: 0.1)";
    let bodies = "bodies: [(name: \"box\", at: (0, 0), spin: 0.5, mass: 1, shape: Rectangle(width: 4, height: 1)),
        (name: \"ball\", at: (0.3, 0.8), velocity: (0.2, -2), spin: 1, mass: 0.5, atoms: Disc(radius: 0.2))]";
    let end = |clock: &str| {
        let mut simulation = scene(clock, materials, bodies);
        run_to(&mut simulation, 0.5);
        first(&simulation)
    };
    let exact = end("method: Dop853, tick: 0.0005");
    for (method, order, tick) in
        [("method: RungeKutta4", 4.0, 0.005), ("method: VelocityVerlet, events: Located", 2.0, 0.001)]
    {
        let error = |tick: f64| {
            let found = end(&format!("{method}, tick: {tick:?}"));
            found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(tick), error(0.5 * tick));
        let found = (coarse / fine).log2();
        assert!(found > 0.75 * order, "{method}: order {found}, {coarse:e} and {fine:e}");
    }
}

/// Law: a box that falls with a side onto the end of a strip, in line with its centre, leaves it as fast as it came, after half a swing:
/// `pi sqrt(m/k)`. Tolerance: rounding.
#[test]
fn the_end_of_a_strip_hits_a_side() {
    let materials = "\"default\": (stiffness: 1e4, restitution: 1, friction: 0)";
    let rest = "walls: [(name: \"post\", from: (0, -1), to: (0, 0), thickness: 0.1)],
        bodies: [(name: \"box\", at: (0, 0.75), velocity: (0, -2), mass: 1, shape: Rectangle(width: 2, height: 1, rounding: 0.1))]";
    let mut simulation = scene(METHODS[3], materials, rest);
    run_to(&mut simulation, 0.5);
    // It falls 0.2 m, swings, and rises.
    let rises = 0.5 - 0.1 - std::f64::consts::PI / 100.0;
    assert_same(first(&simulation), [0.0, 0.55 + 2.0 * rises, 0.0, 0.0, 2.0, 0.0], 1e-12, "box");
}

/// A stack of `count` equal shapes on a floor, 0.2 m high each and 2 kg heavy.
fn stack(shape: &str, count: u32) -> String {
    let boxes: Vec<String> = (0..count)
        .map(|index| {
            let y = 0.1 + 0.201 * f64::from(index);
            format!("(name: \"box_{index}\", at: (0, {y:?}), mass: 2, shape: {shape})")
        })
        .collect();
    format!(
        "gravity: (0, -9.81), walls: [(name: \"floor\", left: (1, 0), right: (-1, 0))], bodies: [{}],
        sensors: [ContactForce(on: \"floor\")]",
        boxes.join(", ")
    )
}

/// Law: a stack of boxes comes exactly to rest, and the floor bears its weight. Two equal boxes meet with the corners of both, sharp ones
/// too, whose corners are exactly on the sides of the other. Tolerance: none for rest; rounding of a sum of forces for the weight.
#[test]
fn a_stack_of_boxes_rests_exactly() {
    let materials = "\"default\": (stiffness: 1e5, restitution: 0.2, friction: 0.5)";
    let shapes = [
        "Rectangle(width: 0.4, height: 0.2, rounding: 0.01)",
        "Rectangle(width: 0.4, height: 0.2)",
        "Polygon(points: [(-0.2, -0.1), (0.2, -0.1), (0.15, 0.1), (-0.15, 0.1)])",
        "Polygon(points: [(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (0.1, 0.1), (0.1, 0), (-0.1, 0), (-0.1, 0.1), (-0.2, 0.1)])",
    ];
    for shape in shapes {
        for clock in ["method: VelocityVerlet, tick: \"1 ms\"", "method: Dop853, tick: \"1 ms\""] {
            let mut simulation = scene(clock, materials, &stack(shape, 4));
            run_to(&mut simulation, 3.0);
            let bodies = simulation.bodies();
            for body in 0..bodies.len() {
                assert_eq!(
                    (bodies.velocity[body], bodies.spin[body]),
                    (DVec2::ZERO, 0.0),
                    "{shape}, {clock}: body {body}"
                );
                let height = bodies.position[body].y - bodies.position[0].y;
                assert!((height - 0.2 * body as f64).abs() < 0.01, "{shape}, {clock}: body {body} at {height}");
            }
            let channel = jostle::sensors::find(simulation.world_mut(), "floor.force.y").expect("the sensor is there");
            let force = simulation.value(&channel);
            assert!((force + 8.0 * 9.81).abs() < 1e-9, "{shape}, {clock}: {force}");
        }
    }
}

/// Law: a stack of sharp boxes that is too heavy for its stiffness never falls through in silence. From tick to tick the run ends with two
/// names: corners sink in so deep that the way they came is not known. Steps with stages keep the sides that were touched, so the stack comes
/// to rest, and the floor bears its weight. Tolerance: rounding of a sum of forces.
#[test]
fn a_stack_that_is_too_soft_ends_the_run_or_stands() {
    let materials = "\"default\": (stiffness: 1000, restitution: 0.2, friction: 0.5)";
    let stack = |clock: &str| scene(clock, materials, &stack("Rectangle(width: 0.4, height: 0.2)", 4));
    let failure =
        stack("method: VelocityVerlet, tick: \"1 ms\"").run_to_tick(3000).expect_err("corners sink in").to_string();
    assert!(failure.contains("a sharp corner has sunk") && failure.contains("`box_"), "{failure}");
    let mut simulation = stack("method: Dop853, tick: \"1 ms\"");
    run_to(&mut simulation, 3.0);
    let bodies = simulation.bodies();
    for body in 0..bodies.len() {
        assert_eq!((bodies.velocity[body], bodies.spin[body]), (DVec2::ZERO, 0.0), "body {body}");
    }
    assert!(bodies.position.windows(2).all(|two| two[1].y > two[0].y + 0.1), "{:?}", bodies.position);
    let channel = jostle::sensors::find(simulation.world_mut(), "floor.force.y").expect("the sensor is there");
    assert!((simulation.value(&channel) + 8.0 * 9.81).abs() < 1e-9);
}

/// Law: what passes through a shape ends the run with both names, whether it lies in it at the end of a tick or is behind it. Scene: a bullet at
/// 500 m/s against plates of 1 mm and a bar of 2 mm, with ticks in which it goes 1 to 5 mm.
#[test]
fn what_passes_through_a_thin_shape_ends_the_run() {
    let plates = ["Rectangle(width: 0.001, height: 2)", "Capsule(from: (0, -1), to: (0, 1), radius: 0.001)"];
    let bullets = ["shape: Rectangle(width: 0.03, height: 0.01, rounding: 0.002)", "atoms: Disc(radius: 0.005)"];
    for (plate, bullet) in plates.iter().flat_map(|plate| bullets.iter().map(move |bullet| (plate, bullet))) {
        for clock in ["method: VelocityVerlet, tick: \"10 us\"", "method: VelocityVerlet, tick: \"2 us\"", METHODS[3]] {
            let bodies = format!(
                "bodies: [(name: \"plate\", at: (0.1, 0), fixed: true, shape: {plate}),
                (name: \"bullet\", at: (0, 0.013), velocity: (500, 0), mass: 0.01, {bullet})]"
            );
            let materials = "\"default\": (stiffness: 1e6, restitution: 0.3)";
            let mut simulation = scene(clock, materials, &bodies);
            let failure = simulation.run_to_tick(2000).expect_err("the bullet is through").to_string();
            assert!(failure.contains("`bullet` has passed through `plate`"), "{clock}, {plate}, {bullet}: {failure}");
        }
    }
}

/// A semicircular arch of 15 stones of mean radius 1 m, from a sharp polygon each.
fn arch(thickness: f64) -> String {
    let (inner, outer) = (1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness);
    let stone = |number: u32| {
        let [from, to] = [number, number + 1].map(|end| std::f64::consts::PI * f64::from(end) / 15.0);
        let point =
            |radius: f64, angle: f64| format!("({:?}, {:?})", radius * libm::cos(angle), radius * libm::sin(angle));
        let points = [point(inner, from), point(outer, from), point(outer, to), point(inner, to)].join(", ");
        format!("(name: \"stone_{number}\", at: (0, 0), datum: Origin, shape: Polygon(points: [{points}]))")
    };
    let stones: Vec<String> = (0..15).map(stone).collect();
    format!(
        "gravity: (0, -9.81), walls: [(name: \"ground\", left: (3, 0), right: (-3, 0))], bodies: [{}]",
        stones.join(", ")
    )
}

/// Law: an arch held by friction alone stands if its thickness is above 0.10607 of its radius, and falls below (Milankovitch 1907, for 15 stones
/// by linear programming). Tried at 1.3 and 0.85 times that. It stands exactly at rest. Its crown sinks by no more than the turns of
/// all joints, each by two overlaps across the thickness, at a lever of the radius.
#[test]
fn an_arch_stands_if_it_is_thick_enough() {
    let materials = "\"default\": (stiffness: 1e7, restitution: 0.2, friction: 1, density: 100)";
    let least = 0.10607;
    let run = |thickness: f64| {
        let built = |start: &str| {
            scene("method: VelocityVerlet, tick: \"0.1 ms\"", materials, &format!("{start}{}", arch(thickness)))
        };
        let before = built("contacts: Penalty(start: AsPlaced), ").bodies().position[7].y;
        let mut simulation = built("");
        run_to(&mut simulation, 2.0);
        let overlap = simulation.card().largest_overlap.meters;
        (before - simulation.bodies().position[7].y, overlap, simulation)
    };
    let thickness = 1.3 * least;
    let (sunk, overlap, stands) = run(thickness);
    assert!(sunk > 0.0 && sunk < 15.0 * 2.0 * overlap / thickness, "the crown sank by {sunk}, overlaps {overlap}");
    assert!(stands.bodies().velocity.iter().all(|velocity| *velocity == DVec2::ZERO), "it stands");
    let (fallen, ..) = run(0.85 * least);
    assert!(fallen > 0.5, "the crown fell by {fallen}");
}
