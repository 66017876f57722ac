//! Laws of lines: surfaces of many pieces.
//!
//! Source: an atom is kept out of the line moved by its radius to the open side. So a straight line of pieces is a
//! half-plane for every body that slides or rolls over it, and a line with corners keeps energy. Tolerances: at each
//! test. Not tested: lines whose corners are narrower than an overlap.

use glam::DVec2;
use jostle::{Simulation, SimulationExt};

use super::support::{load, run_to};

const METHODS: [&str; 4] = [
    "method: VelocityVerlet, tick: \"10 us\"",
    "method: VelocityVerlet, tick: \"100 us\", events: Located",
    "method: RungeKutta4, tick: \"100 us\"",
    "method: Dop853, tick: \"1 ms\"",
];

fn scene(clock: &str, material: &str, rest: &str) -> Simulation {
    load(&format!(
        "Scene(format: 1, clock: (duration: 10, {clock}), materials: {{\"default\": ({material})}}, gravity: (0, -9.81), {rest})"
    ))
}

/// Place, angle, velocity and spin of the first body.
fn first(simulation: &Simulation) -> [f64; 6] {
    let bodies = simulation.bodies();
    let (place, velocity) = (bodies.position[0], bodies.velocity[0]);
    [place.x, place.y, bodies.angle[0], velocity.x, velocity.y, bodies.spin[0]]
}

/// A line through points, as scenes write it.
fn line(points: impl IntoIterator<Item = DVec2>) -> String {
    let points: Vec<String> = points.into_iter().map(|point| format!("({:?}, {:?})", point.x, point.y)).collect();
    format!("(name: \"ground\", line: [{}])", points.join(", "))
}

fn channel(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the sensor is there");
    simulation.value(&channel)
}

/// Law: two hundred pieces of a straight line are one half-plane for a box that slides, one with round corners, and a disc that bounces and
/// then rolls: contacts take their springs over the joints. Tolerance: normals of pieces are off by 1e-14, which moves a body by 1e-13 and
/// its touches by as much: 1e-9 is far above and far below what a lost spring makes (1e-5).
#[test]
fn a_straight_line_of_pieces_is_a_wall() {
    let slope = DVec2::new(1.0, -0.3);
    let shapes = [
        ("shape: Rectangle(width: 0.3, height: 0.2)", 0.1),
        ("shape: Rectangle(width: 0.3, height: 0.2, rounding: 0.05)", 0.1),
        ("atoms: Disc(radius: 0.1)", 0.12),
    ];
    let angle = libm::atan2(slope.y, slope.x);
    let normal = DVec2::new(-slope.y, slope.x).normalize();
    for (shape, height) in shapes {
        let at = slope * -4.0 + normal * height;
        let body = format!(
            "bodies: [(name: \"box\", at: ({:?}, {:?}), angle: {angle:?}, velocity: (1, -0.3), mass: 2, {shape})],
            sensors: [Contacts(of: \"ground\"), ContactForce(on: \"ground\")]",
            at.x, at.y
        );
        for clock in METHODS {
            let end = |wall: &str| {
                let material = "stiffness: 2e4, restitution: 0.5, friction: 0.2";
                let mut simulation = scene(clock, material, &format!("walls: [{wall}], {body}"));
                run_to(&mut simulation, 1.0);
                let begun = channel(&mut simulation, "ground.contacts.begun");
                let force = channel(&mut simulation, "ground.force.y");
                (first(&simulation), [begun, force])
            };
            let ends = [slope * -5.0, slope * 5.0];
            let wall = end(&format!(
                "(name: \"ground\", left: ({:?}, {:?}), right: ({:?}, {:?}))",
                ends[1].x, ends[1].y, ends[0].x, ends[0].y
            ));
            let many = end(&line((0..=200).map(|index| slope * (0.05 * f64::from(index) - 5.0))));
            let off = many.0.iter().zip(wall.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(wall.0[0] - at.x > 1.0, "{shape}, {clock}: it crossed twenty joints: {wall:?}");
            assert!(off < 1e-9, "{shape}, {clock}: off by {off:e}, {many:?} {wall:?}");
            // The corners of a box land at once, in the order that rounding makes.
            if !shape.contains("Rectangle") {
                assert_eq!(many.1[0], wall.1[0], "{shape}, {clock}: touches begun");
            }
            assert!((many.1[1] - wall.1[1]).abs() < 1e-5, "{shape}, {clock}: {many:?} {wall:?}");
        }
    }
}

/// The points of a valley, a hill and a step, with corners of 0.02 to 0.9 rad in both directions.
fn landscape() -> Vec<DVec2> {
    let mut points: Vec<DVec2> = (0..=100)
        .map(|index| {
            let x = 0.05 * f64::from(index) - 4.0;
            DVec2::new(x, 0.4 * x * x * libm::exp(-0.3 * x * x))
        })
        .collect();
    points.insert(0, DVec2::new(-4.0, 3.0));
    points.extend([DVec2::new(1.6, 0.7), DVec2::new(2.0, 1.5), DVec2::new(2.0, 3.0)]);
    points
}

/// Law: without losses the energy of what slides, rolls and tumbles over valleys, hills and sharp corners stays, as forces have a
/// potential. Tolerance: in a corner the direction of a force turns within its overlap of a tenth of a millimetre, so steps of 0.02 mm have
/// errors of order 2 that are those of a force that bends: 4 % of 20 N over 2e-5 m at each of a hundred corners, 2e-3 J. A contact that is
/// lost or counted twice makes 0.1 J and more.
#[test]
fn a_landscape_keeps_energy() {
    for (shape, radius) in [
        ("atoms: Disc(radius: 0.15)", 0.15),
        ("shape: Rectangle(width: 0.3, height: 0.3, rounding: 0.05)", 0.22),
        ("shape: Rectangle(width: 0.3, height: 0.2)", 0.2),
    ] {
        for x in [-2.9, -1.0, 0.3] {
            let y = 0.4 * x * x * libm::exp(-0.3 * x * x) + 1.3 * radius;
            let rest = format!(
                "walls: [{}], bodies: [(name: \"body\", at: ({x:?}, {y:?}), velocity: (1, 0), mass: 1, {shape})]",
                line(landscape())
            );
            for clock in ["method: Dop853, tick: \"20 us\"", "method: VelocityVerlet, tick: \"20 us\""] {
                let mut simulation = scene(clock, "stiffness: 2e4, restitution: 1, friction: 0", &rest);
                run_to(&mut simulation, 2.0);
                let residual = simulation.card().energy.residual.abs();
                assert!(residual < 2e-3, "{shape} from {x}, {clock}: {residual:e}");
            }
        }
    }
}

/// Law: a disc in a sharp groove rests on both sides, each of which bears `m g / (2 cos a)`; friction of a disc that turns there is that of
/// both. Tolerance: 1e-3 of overlaps that turn the normals.
#[test]
fn both_sides_of_a_groove_bear_and_rub() {
    let groove = line([DVec2::new(-1.0, 1.0), DVec2::ZERO, DVec2::new(1.0, 1.0)]);
    let planes = "(name: \"a\", left: (0, 0), right: (-1, 1)), (name: \"b\", left: (1, 1), right: (0, 0))";
    let end = |walls: &str| {
        let body = "bodies: [(name: \"disc\", at: (0, 0.28284), spin: 30, mass: 1, atoms: Disc(radius: 0.2))]";
        let material = "stiffness: 1e5, restitution: 0.2, friction: 0.3";
        let mut simulation = scene(METHODS[3], material, &format!("walls: [{walls}], {body}"));
        run_to(&mut simulation, 0.05);
        first(&simulation)
    };
    let (found, exact) = (end(&groove), end(planes));
    let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(exact[5] < 29.0 && off < 1e-9, "off by {off:e}, {found:?} {exact:?}");
}

/// Law: a strip that is hit from its left only is a line at half its thickness; from its right it is one for whoever comes from there. What goes
/// through, or comes from behind, ends the run with both names.
#[test]
fn sides_are_open_or_end_the_run() {
    let end = |sides: &str, velocity: f64, clock: &str| {
        let rest = format!(
            "walls: [(name: \"sheet\", from: (0, -1), to: (0, 1), thickness: 0.02, sides: {sides})],
            bodies: [(name: \"ball\", at: ({:?}, 0), velocity: ({velocity:?}, 0), mass: 1, atoms: Disc(radius: 0.1))]",
            -0.5 * velocity.signum()
        );
        let mut simulation = scene(clock, "stiffness: 1e5, restitution: 1", &rest);
        simulation.run_to_tick((1.0 / simulation.clock().dt) as u64).map_err(|failure| failure.to_string())?;
        Ok::<_, String>(first(&simulation)[3])
    };
    for clock in METHODS {
        // The way goes up: its left is where x is below zero.
        for (sides, velocity) in [("Left", 2.0), ("Right", -2.0), ("Both", 2.0), ("Both", -2.0)] {
            let found = end(sides, velocity, clock).unwrap();
            assert!((found + velocity).abs() < 1e-5, "{sides}, {clock}: {found}");
        }
        for (sides, velocity, how) in [("Left", -2.0, "come"), ("Right", 2.0, "come"), ("Left", 300.0, "passed")] {
            let failure = end(sides, velocity, clock).unwrap_err();
            assert!(failure.contains(&format!("`ball` has {how} through `sheet`")), "{sides}, {clock}: {failure}");
            assert_eq!(failure.contains("stiffness"), how == "passed", "{sides}, {clock}: {failure}");
        }
    }
}

/// Law: in a corner of a line a sharp box touches floor and wall as it does two half-planes, also behind the joint, where its corner has sunk
/// into both. Tolerance: roundings of numbers near 1 in some five touches, 1e-9.
#[test]
fn a_box_is_pressed_into_a_corner() {
    let corner = line([DVec2::new(-3.0, 0.0), DVec2::ZERO, DVec2::new(0.0, 2.0)]);
    let planes = "(name: \"floor\", left: (0, 0), right: (-3, 0)), (name: \"wall\", left: (0, 2), right: (0, 0))";
    for clock in METHODS {
        let end = |walls: &str| {
            let body = "bodies: [(name: \"box\", at: (-0.6, 0.2), velocity: (4, 0), mass: 1, shape: Rectangle(width: 0.6, height: 0.4))]";
            let material = "stiffness: 1e4, restitution: 0.5, friction: 0.2";
            let mut simulation = scene(clock, material, &format!("walls: [{walls}], {body}"));
            run_to(&mut simulation, 0.3);
            first(&simulation)
        };
        let (found, exact) = (end(&corner), end(planes));
        let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(exact[3] < 0.0 && off < 1e-9, "{clock}: off by {off:e}, {found:?} {exact:?}");
    }
}

/// Law: a line whose points stand in the wrong order is open downwards; the card says so if all bodies begin behind it, and only then.
#[test]
fn a_line_that_is_turned_around_is_noted() {
    let notes = |points: [DVec2; 3], y: f64| {
        let body =
            format!("bodies: [(name: \"box\", at: (1, {y:?}), mass: 1, shape: Rectangle(width: 0.6, height: 0.4))]");
        let simulation = scene(METHODS[0], "stiffness: 1e4", &format!("walls: [{}], {body}", line(points)));
        simulation
            .card()
            .notes
            .iter()
            .any(|note| note.contains("all bodies that move by forces are behind `ground`. They enter it"))
    };
    let ground = [DVec2::ZERO, DVec2::new(1.0, 0.2), DVec2::new(2.0, 0.0)];
    let [first, middle, last] = ground;
    assert!(!notes(ground, 1.0) && notes(ground, -1.0));
    assert!(notes([last, middle, first], 1.0) && !notes([last, middle, first], -1.0));
}

/// Promise: the card says of each kind of wall what may be turned around, if all bodies that move by forces begin behind it, and only then. A
/// fixed body on the open side changes nothing.
#[test]
fn a_wall_that_is_turned_around_is_noted_in_its_own_words() {
    let notes = |wall: &str, y: f64| {
        let rest = format!(
            "walls: [(name: \"shelf\", {wall})],
            bodies: [(name: \"post\", at: (0, 5), fixed: true, atoms: Disc(radius: 0.1)),
                     (name: \"ball\", at: (1, {y:?}), mass: 1, atoms: Disc(radius: 0.1))]"
        );
        let notes = scene(METHODS[0], "stiffness: 1e4", &rest).card().notes;
        notes.into_iter().find(|note| note.contains("all bodies that move by forces are behind `shelf`"))
    };
    for (wall, words) in [
        ("left: (2, 0), right: (0, 0)", "`left` and `right` are swapped"),
        ("from: (0, 0), to: (2, 0), sides: Left", "`Left` and `Right` are swapped in its `sides`"),
        ("from: (2, 0), to: (0, 0), sides: Right", "`Left` and `Right` are swapped in its `sides`"),
        ("line: [(0, 0), (2, 0)]", "its points stand in the wrong order"),
    ] {
        assert_eq!(notes(wall, 1.0), None, "{wall}");
        let note = notes(wall, -1.0).unwrap_or_else(|| panic!("{wall}: no note"));
        assert!(note.contains(words), "{note}");
    }
}

/// Promise: a sharp box that comes from behind a line ends the run with both names before it gains any energy; one that rests on it, its corners
/// pressed behind it, does not, nor does one that begins so.
#[test]
fn a_sharp_box_from_behind_ends_the_run() {
    let ground = "(name: \"ground\", line: [(-2, 0), (0, 0.001), (2, 0)])";
    for clock in METHODS {
        let run = |y: f64, angle: f64, speed: f64| {
            let rest = format!(
                "walls: [{ground}], bodies: [(name: \"box\", at: (0.1, {y:?}), angle: {angle:?}, velocity: (0, {speed:?}), mass: 1, shape: Rectangle(width: 0.4, height: 0.4))]"
            );
            let mut simulation = scene(clock, "stiffness: 1e5, restitution: 0.5", &rest);
            let outcome =
                simulation.run_to_tick((0.6 / simulation.clock().dt) as u64).map_err(|error| error.to_string());
            let bodies = simulation.bodies();
            (outcome, bodies.position[0], bodies.velocity[0].length())
        };
        let (outcome, _, speed) = run(-0.5, 0.3, 3.0);
        assert!(
            outcome.clone().unwrap_err().contains("`box` has come through `ground` from behind"),
            "{clock}: {outcome:?}"
        );
        assert!(speed < 3.0, "{clock}: {speed}");
        for (y, angle) in [(0.4, 0.3), (0.2, 0.0), (0.199, 0.0)] {
            let (outcome, place, _) = run(y, angle, 0.0);
            assert!(outcome == Ok(()) && place.y > 0.19, "{clock}: {outcome:?}, {place}");
        }
    }
}

/// A star whose tips lie 0.2 m from its middle, and what is between them `inner` metres.
fn star(tips: u32, inner: f64, rounding: f64) -> String {
    let corner = |index: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::PI / f64::from(tips) * f64::from(index));
        let radius = if index.is_multiple_of(2) { 0.2 } else { inner };
        format!("({:?}, {:?})", radius * cos, radius * sin)
    };
    let corners = (0..2 * tips).map(corner).collect::<Vec<_>>().join(", ");
    format!("Polygon(points: [{corners}], rounding: {rounding:?})")
}

/// Law: a straight line is a half-plane too for shapes whose round corners sink in deeper than they are round, and for concave ones, of
/// which parts share corners, be they slender spikes. Tolerance: as above.
#[test]
fn a_line_is_a_wall_for_soft_and_concave_shapes() {
    let ell = "Polygon(points: [(0, 0), (0.2, 0), (0.2, 0.05), (0.05, 0.05), (0.05, 0.2), (0, 0.2)], rounding: 0.002)";
    let (star, spikes) = (star(4, 0.07, 0.001), star(7, 0.08, 0.0));
    let (rectangle, pentagon) =
        ("Rectangle(width: 0.2, height: 0.1, rounding: 0.002)", "Regular(sides: 5, radius: 0.1, rounding: 0.001)");
    for shape in [rectangle, pentagon, ell, &star, &spikes] {
        for clock in METHODS {
            let end = |wall: &str| {
                let body = format!(
                    "bodies: [(name: \"b\", at: (0, 0.3), angle: 0.4, velocity: (0.3, -1), mass: 0.4, shape: {shape})]"
                );
                let material = "stiffness: 2e4, restitution: 0.9, friction: 0.2";
                let mut simulation = scene(clock, material, &format!("walls: [{wall}], {body}"));
                run_to(&mut simulation, 0.6);
                let deepest = simulation.card().largest_overlap.meters;
                assert!(deepest > 0.002, "{deepest} m: the centre of no corner has sunk in");
                first(&simulation)
            };
            let pieces = (0..=7).map(|piece| DVec2::new(0.5 * f64::from(piece) - 2.0, 0.0));
            let (found, exact) = (end(&line(pieces)), end("(name: \"ground\", left: (1, 0), right: (0, 0))"));
            let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-9, "{shape} {clock}: off by {off:e}, {found:?} {exact:?}");
        }
    }
}
