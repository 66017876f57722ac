//! Laws of bodies of several parts: concave shapes, compounds, gears.
//!
//! Source: a cut changes nothing: a shape in parts touches, weighs and moves as the whole does. Tolerances: at each test. Not tested: a
//! corner that bends inwards by little, pressed so hard that the other side touches both its sides.

use jostle::world::hash::state_hash;
use jostle::{Simulation, SimulationExt};

use super::support::{load, run_to};

const METHODS: [&str; 3] = [
    "method: VelocityVerlet, tick: \"20 us\"",
    "method: RungeKutta4, tick: \"100 us\"",
    "method: Dop853, tick: \"1 ms\"",
];

fn scene(clock: &str, rest: &str) -> Simulation {
    let materials = "\"default\": (stiffness: 1e4, restitution: 0.6, friction: 0.3), \
        \"hard\": (stiffness: 1e300, restitution: 0.6, friction: 0.3)";
    load(&format!("Scene(format: 1, clock: (duration: 6, {clock}), materials: {{{materials}}}, {rest})"))
}

/// Place, angle, velocity and spin of a body.
fn state(simulation: &Simulation, body: usize) -> [f64; 6] {
    let bodies = simulation.bodies();
    let (place, velocity) = (bodies.position[body], bodies.velocity[body]);
    [place.x, place.y, bodies.angle[body], velocity.x, velocity.y, bodies.spin[body]]
}

fn assert_same(found: [f64; 6], exact: [f64; 6], tolerance: f64, what: &str) {
    let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off <= tolerance, "{what}: off by {off:e}, {found:?} {exact:?}");
}

/// Law: two halves of a box, side by side or one over the other, are the box: mass, inertia, corners and sides. A ball hits it beside the
/// cut, and it lands on the floor. Tolerance: rounding of places, which grows at each of some ten touches.
#[test]
fn a_box_in_two_halves_is_the_box() {
    let whole = "Rectangle(width: 1, height: 0.4)";
    let halves = [
        "Compound([Rectangle(width: 0.5, height: 0.4, at: (-0.25, 0)), Rectangle(width: 0.5, height: 0.4, at: (0.25, 0))])",
        "Compound([Rectangle(width: 1, height: 0.2, at: (0, 0.1)), Rectangle(width: 1, height: 0.2, at: (0, -0.1))])",
    ];
    for clock in METHODS {
        let end = |shape: &str| {
            let mut simulation = scene(
                clock,
                &format!(
                    "gravity: (0, -9.81), walls: [(name: \"floor\", left: (9, 0), right: (-9, 0))],
                    bodies: [(name: \"box\", at: (0, 0.6), angle: 0.2, spin: 1, shape: {shape}),
                    (name: \"ball\", at: (0.03, 1.1), velocity: (0, -3), atoms: Disc(radius: 0.1))]"
                ),
            );
            run_to(&mut simulation, 0.6);
            state(&simulation, 0)
        };
        let exact = end(whole);
        assert!(exact[2] != 0.2 && exact[1] < 0.5, "the box was hit: {exact:?}");
        for shape in halves {
            assert_same(end(shape), exact, 1e-9, &format!("{clock} {shape}"));
        }
    }
}

/// Law: the hollow of a fixed bracket that does not give way is a corner of two half-planes, one of which the ball leaves before it
/// comes to the ends of the bracket. Tolerance: as above.
#[test]
fn the_hollow_of_a_bracket_is_a_corner_of_two_walls() {
    let ball = "(name: \"ball\", at: (0.8, 0.6), velocity: (-2, -1), spin: 2, mass: 0.2, atoms: Disc(radius: 0.1))";
    for clock in METHODS {
        let end = |rest: &str| {
            let mut simulation = scene(clock, &format!("gravity: (0, -9.81), {rest}"));
            run_to(&mut simulation, 0.7);
            state(&simulation, 0)
        };
        let walls = end(&format!(
            "bodies: [{ball}], walls: [(name: \"floor\", left: (9, 0), right: (-9, 0)), (name: \"side\", left: (0, -9), right: (0, 9))]"
        ));
        assert!(walls[3] > 0.0, "the ball has left the side: {walls:?}");
        let bracket = "(name: \"bracket\", datum: Origin, fixed: true, material: \"hard\",
            shape: Polygon(points: [(0, 0), (3, 0), (3, -1), (-1, -1), (-1, 3), (0, 3)]))";
        assert_same(end(&format!("bodies: [{ball}, {bracket}]")), walls, 1e-9, clock);
    }
}

/// Law: masses of parts add up, with Steiner's theorem about the common centre; parts that touch nothing weigh too. Source: two rods of
/// length l = 1 and mass 1 and 3, whose middles are 0.5 apart along y, of width w = 0.2: I = sum m (l^2 + w^2) / 12 + 0.75 * 0.5^2.
#[test]
fn parts_weigh_for_themselves() {
    for collides in [true, false] {
        let simulation = scene(
            METHODS[2],
            &format!(
                "bodies: [(name: \"two\", at: (0, 0), shape: Compound([
                Rectangle(width: 1, height: 0.2, mass: 1), Rectangle(width: 1, height: 0.2, at: (0, 0.5), mass: 3, collides: {collides})]))]"
            ),
        );
        let bodies = simulation.bodies();
        let exact = 4.0 * (1.0 + 0.04) / 12.0 + 0.75 * 0.25;
        // Rounding of a handful of operations on numbers near one.
        assert!((bodies.mass[0] - 4.0).abs() < 1e-14, "{}", bodies.mass[0]);
        assert!((bodies.inertia[0] - exact).abs() < 1e-14, "{}", bodies.inertia[0]);
        assert_eq!(bodies.hulls.len(), if collides { 2 } else { 1 });
    }
}

/// Law: gears of 12 and 20 teeth that mesh turn as 20 to 12, but for play and overlap. Source: each tooth pushes one. Tolerance: play along
/// the pitch circle over its radius, and as much again for overlaps of a millionth of a metre and chords.
#[test]
fn gears_turn_as_their_teeth() {
    let module = 0.02;
    let apart = 16.0 * module;
    let mut simulation = scene(
        "method: VelocityVerlet, tick: \"100 us\"",
        &format!(
            "bodies: [(name: \"pinion\", at: (0, 0), shape: Gear(teeth: 12, module: {module}, backlash: 0.001), mass: 1),
            (name: \"wheel\", at: ({apart}, 0), angle: \"9 deg\", shape: Gear(teeth: 20, module: {module}, backlash: 0.001), mass: 1)],
            joints: [Revolute(name: \"a\", a: World, b: \"pinion\"), Revolute(name: \"b\", a: World, b: \"wheel\", friction: 0.01)],
            controllers: [Motor(of: \"a\", speed: 3)]"
        ),
    );
    let begin = [0, 1].map(|body| simulation.bodies().angle[body]);
    run_to(&mut simulation, 5.0);
    let turned = [0, 1].map(|body| simulation.bodies().angle[body] - begin[body]);
    assert!(turned[0] > 14.9, "the pinion turns: {turned:?}");
    let off = turned[0] * 12.0 + turned[1] * 20.0;
    assert!(off.abs() * module / 2.0 < 2.0 * 0.001, "{turned:?}: {off}");
}

/// Law: shapes that touch nothing move as shapes that meet nothing, to the last bit: joints weigh their turning by how far they reach, not by
/// their corners. Scene: a pendulum that drives a wheel by gears. Tolerance: none; the account of energy as the method allows.
#[test]
fn what_touches_nothing_moves_as_what_meets_nothing() {
    let end = |collides: &str| {
        let mut simulation = load(&format!(
            r#"Scene(
                format: 1,
                clock: (duration: 2, tick: "1 ms", method: VelocityVerlet),
                gravity: (0, -9.81),
                bodies: [
                    (name: "arm", at: (0, 0), datum: Origin, {collides} mass: 1, shape: Rectangle(at: (0.5, 0), width: 1, height: 0.1)),
                    (name: "wheel", at: (3, 0), {collides} mass: 1, shape: Regular(sides: 6, radius: 0.4)),
                ],
                joints: [
                    Revolute(name: "hinge", a: World, anchor_a: (0, 0), b: "arm", anchor_b: (0, 0)),
                    Revolute(name: "axle", a: World, anchor_a: (3, 0), b: "wheel"),
                    GearPair(of: ("hinge", "axle"), ratio: -2),
                ],
            )"#
        ));
        run_to(&mut simulation, 2.0);
        (state_hash(simulation.bodies()), simulation.card().energy.residual.abs())
    };
    let ((meets, _), (touches, residual)) = (end(""), end("collides: false,"));
    assert_eq!(meets, touches);
    assert!(residual < 1e-3, "{residual}");
}

/// Law: bodies do not touch the groups that they ignore, whichever of the two says so, and touch all others. Scene: discs thrown at each other
/// in four lanes. Tolerance: none for what passes. What is hit stands still or goes on, which 1e-6 tells apart; how exactly is another law.
#[test]
fn ignored_groups_are_not_touched() {
    let pair = |lane: u32, left: &str, right: &str| {
        format!(
            "(name: \"left_{lane}\", at: (0, {lane}), velocity: (1, 0), atoms: Disc(radius: 0.1){left}),
             (name: \"right_{lane}\", at: (1, {lane}), atoms: Disc(radius: 0.1){right}),"
        )
    };
    let bodies = [
        pair(0, "", ""),
        pair(1, ", ignores: [\"ghosts\"]", ", groups: [\"others\", \"ghosts\"]"),
        pair(2, ", groups: [\"arm\"], ignores: [\"arm\"]", ", groups: [\"arm\"]"),
        pair(3, ", groups: [\"arm\"]", ""),
    ];
    let materials = "\"default\": (stiffness: 1e4, restitution: 1)";
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 2, tick: \"1 ms\", method: Dop853), materials: {{{materials}}}, bodies: [{}])",
        bodies.join("")
    ));
    run_to(&mut simulation, 2.0);
    let speed = |body: usize| simulation.bodies().velocity[body].x;
    for (lane, passes) in [(0, false), (1, true), (2, true), (3, false)] {
        let (left, right) = (speed(2 * lane), speed(2 * lane + 1));
        if passes {
            assert_eq!((left, right), (1.0, 0.0), "lane {lane}");
        } else {
            assert!(left.abs() < 1e-6 && (right - 1.0).abs() < 1e-6, "lane {lane}: {left} {right}");
        }
    }
}
