//! Laws of walls with two ends.
//!
//! Sources: the potential of a contact is `k/2` times the square of the overlap with the nearest point of a wall, so the flat side of a strip
//! acts as a half-plane does, its end as a fixed disc of half its thickness, and both agree where they meet. Tolerances: at each test.
//! Not tested: strips that move; walls that share an end.

use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::tick::{Failure, FailureKind};
use jostle::world::Position;

use super::support::{assert_near, load, run_to};

const METHODS: [&str; 4] = [
    "method: VelocityVerlet, tick: \"10 us\"",
    "method: VelocityVerlet, tick: \"100 us\", events: Located",
    "method: RungeKutta4, tick: \"100 us\"",
    "method: Dop853, tick: \"1 ms\"",
];

fn scene(clock: &str, materials: &str, walls: &str, bodies: &str) -> Simulation {
    load(&format!(
        "Scene(format: 1, clock: (duration: 1, {clock}), gravity: (0, -9.81), materials: {{{materials}}}, walls: [{walls}], bodies: [{bodies}])"
    ))
}

fn try_to(simulation: &mut Simulation, time: f64) -> Result<(), Failure> {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick)
}

const ROUGH: &str = "\"default\": (stiffness: 1e4, restitution: 0.6, friction: 0.3)";

/// Law: far from its ends a strip without thickness is a half-plane. Tolerance: none, all bits agree; for a strip that
/// begins at its other end 1e-12, as heights are measured from there.
#[test]
fn the_flat_side_of_a_strip_is_a_half_plane() {
    let body = "(name: \"ball\", at: (0.1, 0.3), velocity: (0.4, -1), spin: 3, mass: 0.2, atoms: Disc(radius: 0.1))";
    for clock in METHODS {
        let end = |wall: &str| {
            let mut simulation = scene(clock, ROUGH, wall, body);
            run_to(&mut simulation, 1.0);
            let bodies = simulation.bodies();
            (bodies.position[0], bodies.angle[0], bodies.velocity[0], bodies.spin[0])
        };
        let plane = end("(name: \"floor\", left: (9, -0.9), right: (-9, 0.9))");
        assert_eq!(end("(name: \"floor\", from: (-9, 0.9), to: (9, -0.9))"), plane, "{clock}");
        let mirrored = end("(name: \"floor\", from: (9, -0.9), to: (-9, 0.9))");
        assert!((mirrored.0 - plane.0).length() < 1e-12, "{clock}: {mirrored:?} {plane:?}");
    }
}

/// Law: the end of a strip is a disc of half its thickness. Scene: a ball that spins falls beside the middle of an end, is thrown off, and
/// falls on it again from farther out; beside it the same on a fixed disc that does not give way. Tolerance: 1e-9, as rounding grows at
/// each touch of two convex surfaces.
#[test]
fn the_end_of_a_strip_is_a_disc() {
    let materials = format!("{ROUGH}, \"hard\": (stiffness: 1e300, restitution: 0.6, friction: 0.3)");
    let ball = "(name: \"ball\", at: (0.03, 0.6), spin: 3, mass: 0.2, atoms: Disc(radius: 0.1))";
    for clock in METHODS {
        let end = |walls: &str, more: &str| {
            let mut simulation = scene(clock, &materials, walls, &format!("{ball}, {more}"));
            run_to(&mut simulation, 0.6);
            let bodies = simulation.bodies();
            (bodies.position[0], bodies.angle[0], bodies.velocity[0])
        };
        let strip = end("(name: \"post\", from: (0, 0), to: (0, -2), thickness: 0.2)", "");
        let disc =
            end("", "(name: \"post\", fixed: true, at: (0, 0), mass: 1, material: \"hard\", atoms: Disc(radius: 0.1))");
        let off = (strip.0 - disc.0).length() + (strip.1 - disc.1).abs() + (strip.2 - disc.2).length();
        assert!(off < 1e-9, "{clock}: {off:e}, {strip:?} {disc:?}");
    }
}

/// Law: the force has a potential, also where a flat side goes over into an end: a ball that slides off a shelf without friction, and bounces
/// there, keeps its energy. Tolerance: 1e-9 of the energy that changes form, the error that is allowed.
#[test]
fn energy_stays_where_a_ball_slides_over_an_end() {
    for (thickness, clock) in [(0.0, "tolerance: 1e-10, method: Dop853"), (0.1, "tolerance: 1e-10, method: Dop853")] {
        let materials = "\"default\": (stiffness: 1e4, restitution: 1, friction: 0)";
        let wall = format!("(name: \"shelf\", from: (-1, 0), to: (0, 0), thickness: {thickness:?})");
        let height = 0.1 + 0.5 * thickness - 2e-4;
        let ball = format!(
            "(name: \"ball\", at: (-0.2, {height:?}), velocity: (0.5, 0), mass: 0.2, atoms: Disc(radius: 0.1))"
        );
        let mut simulation = scene(clock, materials, &wall, &ball);
        run_to(&mut simulation, 1.0);
        let bodies = simulation.bodies();
        assert!(bodies.position[0].y < -0.5, "{thickness}: the ball has fallen, {:?}", bodies.position[0]);
        // Before: at rest but for its speed, its overlap 2e-4 m.
        let before = 0.5 * 0.2 * 0.25 + 0.2 * 9.81 * height + 0.5 * 1e4 * 2e-4 * 2e-4;
        let after = bodies.kinetic_energy(0) + 0.2 * 9.81 * bodies.position[0].y;
        assert!((after - before).abs() < 1e-9 * 2.0, "{thickness}: {before} J, then {after} J");
    }
}

/// Law: a ball that rolls slowly over the end of a shelf turns about it as a rolling cylinder over an edge does, and leaves it where gravity
/// no longer presses it on: at `cos(angle) = 4/7` from rest (energy of a rolling disc, `v^2 = 4/3 g R (1 - cos)`, and `m v^2/R = m g cos`).
/// The speed at the start is counted. Tolerance: the place is looked at each 0.4 ms, in which the ball turns by 7.5 rad/s and 3e-3 rad; its
/// contact gives way by `m g/k`, 1e-6 of the radius.
#[test]
fn a_ball_rolls_over_an_edge_and_leaves_it_at_four_sevenths() {
    let materials = "\"default\": (stiffness: 1e7, restitution: 0.3, friction: 50)";
    let wall = "(name: \"table\", from: (-1, 0), to: (0, 0))";
    let ball = "(name: \"ball\", at: (0, 0.1), velocity: (0.02, 0), spin: -0.2, mass: 0.1, atoms: Disc(radius: 0.1))";
    let mut simulation = scene("method: VelocityVerlet, tick: \"2 us\"", materials, wall, ball);
    let mut leaves = None;
    for tick in 1..=4000_u64 {
        simulation.run_to_tick(200 * tick).expect("numbers stay finite");
        let at = simulation.bodies().position[0];
        if at.x > 0.05 && at.length() > 0.1 {
            leaves = Some(at.y / at.length());
            break;
        }
    }
    // With the speed of the beginning: `v^2 = v0^2 + 4/3 g R (1 - cos) = g R cos`.
    let expected = (4.0 / 3.0 + 0.02 * 0.02 / (9.81 * 0.1)) / (7.0 / 3.0);
    assert_near("cosine", leaves.expect("the ball leaves"), expected, 5e-3);
}

/// Law: what rests on strips rests exactly, in the hollow between two of them and on a flat one. Tolerance: none.
#[test]
fn bodies_come_to_rest_on_strips() {
    let walls = "(name: \"a\", from: (-1, 1), to: (-0.05, 0), thickness: 0.02), (name: \"b\", from: (0.05, 0), to: (1, 1), thickness: 0.02),
                 (name: \"shelf\", from: (2, 0), to: (3, 0))";
    let bodies = "(name: \"ball\", at: (0.02, 0.6), mass: 0.2, atoms: Disc(radius: 0.1)),
                  (name: \"box\", at: (2.5, 0.3), mass: 0.2, atoms: List([(at: (-0.1, 0), radius: 0.05), (at: (0.1, 0), radius: 0.05)]))";
    let materials = "\"default\": (stiffness: 1e4, restitution: 0.2, friction: 0.5)";
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 9, tick: \"0.1 ms\"), gravity: (0, -9.81), materials: {{{materials}}}, walls: [{walls}], bodies: [{bodies}])"
    ));
    run_to(&mut simulation, 4.0);
    let bodies = simulation.bodies();
    assert!(bodies.velocity.iter().all(|velocity| *velocity == DVec2::ZERO), "{:?}", bodies.velocity);
    assert!(bodies.spin.iter().all(|spin| *spin == 0.0), "{:?}", bodies.spin);
}

/// Promise: an atom that passes through a wall with ends, because its contact is soft or its tick long, ends the run with both names;
/// one that flies by or is put on the other side between ticks does not.
#[test]
fn an_atom_that_passes_through_a_wall_ends_the_run() {
    let wall = "(name: \"sheet\", from: (0, 0), to: (1, 0))";
    let ball = |x: f64, speed: f64| {
        format!("(name: \"bullet\", at: ({x:?}, 1), velocity: (0, {speed:?}), mass: 1, atoms: Disc(radius: 0.01))")
    };
    for clock in METHODS {
        let mut simulation = scene(clock, ROUGH, wall, &ball(0.5, -500.0));
        let failure = try_to(&mut simulation, 0.1).expect_err("the bullet passes");
        assert!(matches!(failure.wrong, FailureKind::Crossed(_)), "{clock}: {failure}");
        let text = failure.to_string();
        assert!(text.contains("`bullet`") && text.contains("`sheet`") && text.contains("stiffness"), "{text}");
        let mut simulation = scene(clock, ROUGH, wall, &ball(1.5, -500.0));
        run_to(&mut simulation, 0.01);
    }
    let mut simulation = scene(METHODS[0], ROUGH, wall, &ball(0.5, 0.0));
    run_to(&mut simulation, 0.01);
    let world = simulation.world_mut();
    let ball = world.query_filtered::<Entity, With<Position>>().iter(world).next().expect("the ball");
    world.get_mut::<Position>(ball).expect("its place").0.y = -1.0;
    run_to(&mut simulation, 0.02);
    assert!(simulation.bodies().position[0].y < -1.0);
}

/// Law: a sharp box meets a strip without thickness as one whose corners are round with 2 % of half its width; so it lands, slides and comes
/// to rest on either side of the strip. Tolerance: roundings of numbers near 1 in some hundred touches, 1e-9 of them.
#[test]
fn a_sharp_box_lands_on_a_strip_without_thickness() {
    let end = |clock: &str, rounding: &str, angle: &str, side: f64| {
        let wall = "(name: \"sheet\", from: (-3, 0), to: (3, 0))";
        let body = format!(
            "(name: \"box\", at: (0, {:?}), angle: {angle}, velocity: (1, {:?}), mass: 1, inertia: 0.1,
              shape: Rectangle(width: 1, height: 0.5{rounding}))",
            0.6 * side,
            -5.0 * side
        );
        let hard = "\"default\": (stiffness: 1e7, restitution: 0.6, friction: 0.3)";
        let mut simulation = scene(clock, hard, wall, &body);
        run_to(&mut simulation, 0.5);
        let bodies = simulation.bodies();
        (bodies.position[0], bodies.angle[0])
    };
    for clock in METHODS {
        for (angle, side) in [("0", 1.0), ("0.3", 1.0), ("0.3", -1.0)] {
            let (sharp, round) = (end(clock, "", angle, side), end(clock, ", rounding: 0.005", angle, side));
            let off = sharp.0.distance(round.0) + (sharp.1 - round.1).abs();
            assert!(off < 1e-9, "{clock}, {angle}: off by {off:e}, {sharp:?} {round:?}");
            assert!(sharp.0.y * side > 0.24, "{clock}, {angle}: {sharp:?}");
        }
    }
}
