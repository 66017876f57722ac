//! `fill` with shapes: what stands in a region.
//!
//! Tolerance: rounding. Not tested here: chance and regions, which the unit tests of `src/engine/world/sections/fill.rs` do.

use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;

/// Law: circles about bodies with sides that fill a box do not touch, and corners are within it. Each body is turned by chance,
/// with mass and inertia of the same shape in `bodies`.
#[test]
fn shapes_that_fill_a_box_stand_apart() {
    let shape =
        "Compound([Rectangle(width: 0.3, height: 0.1), Polygon(points: [(0, 0), (0.2, 0), (0, 0.2)], density: 5)])";
    let text = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), materials: {{\"tin\": (density: 3)}},
         bodies: [(name: \"one\", at: (9, 9), material: \"tin\", shape: {shape})],
         fill: [(name: \"chip\", shape: {shape}, material: \"tin\", count: 40, within: ((0, 0), (6, 5)), seed: 3)])"
    );
    let simulation = Simulation::load(&Source::new("fill.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
    let (bodies, high) = (simulation.bodies(), DVec2::new(6.0, 5.0));
    assert_eq!(bodies.len(), 41);
    // No corner is farther from the centre of mass.
    let reach = |body: usize| bodies.atoms_of(body).map(|atom| bodies.atom_offset(atom).length()).fold(0.0, f64::max);
    for body in 0..41 {
        assert_eq!((bodies.mass[body], bodies.inertia[body]), (bodies.mass[0], bodies.inertia[0]));
        for other in 0..body {
            let apart = bodies.position[body].distance(bodies.position[other]);
            assert!(apart > reach(body) + reach(other) - 1e-12, "{body} and {other}");
        }
        let mut corners = bodies.atoms_of(body).map(|atom| bodies.atom_place(atom));
        let is_in_box = corners.all(|at| at.min(DVec2::ZERO) == DVec2::ZERO && at.max(high) == high);
        assert_eq!(is_in_box, body > 0, "{body}");
    }
    let angles: Vec<f64> = bodies.angle.to_vec();
    assert!(angles.iter().any(|angle| (angle - angles[5]).abs() > 1.0), "they are turned by chance");
}
