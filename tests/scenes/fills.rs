//! `fill` with shapes: the bodies in a region.
//!
//! Tolerance: rounding. Not tested here: chance and regions, which the unit tests of `src/engine/world/sections/fill.rs` do.

use glam::DVec2;
use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

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

/// Law: radii of a fill follow their distribution, discs have the mass and inertia of their own radius, and none touches another. The mean of
/// `n` radii is that of the distribution within five standard errors `s/sqrt(n)`, here `s = (b - a)/sqrt(12)` of the uniform one. The same seed
/// gives the same discs to the last bit, another seed others.
#[test]
fn radii_of_a_fill_follow_their_distribution() {
    const COUNT: usize = 1000;
    let load = |radii: &str, seed: u64| {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), materials: {{\"tin\": (density: 3)}},
             fill: [(name: \"grain\", radius: {radii}, material: \"tin\", count: {COUNT}, within: ((0, 0), (6, 5)), gap: 0.001, seed: {seed})])"
        );
        Simulation::load(&Source::new("fill.ron", text)).unwrap_or_else(|errors| panic!("{errors}"))
    };
    let radii = "Uniform(\"2 cm\", \"6 cm\")";
    let simulation = load(radii, 5);
    let bodies = simulation.bodies();
    assert_eq!((bodies.len(), bodies.atom_count()), (COUNT, COUNT));
    let radius = |body: usize| bodies.atom_radius[bodies.atoms_of(body).next().expect("it has one")];
    for body in 0..COUNT {
        let (own, at) = (radius(body), bodies.position[body]);
        assert!((0.02..=0.06).contains(&own), "{own}");
        let mass = 3.0 * std::f64::consts::PI * own * own;
        assert!((bodies.mass[body] - mass).abs() < 1e-15 * mass.max(1.0));
        assert!((bodies.inertia[body] - mass * own * own / 2.0).abs() < 1e-15);
        assert!(at.min_element() >= own && at.x <= 6.0 - own && at.y <= 5.0 - own, "{at}");
        let apart = |other: usize| at.distance(bodies.position[other]) - own - radius(other);
        assert!((0..body).all(|other| apart(other) >= 0.001 - 1e-12), "{body} touches another");
    }
    let mean = (0..COUNT).map(radius).sum::<f64>() / COUNT as f64;
    let error = 0.04 / 12.0_f64.sqrt() / (COUNT as f64).sqrt();
    assert!((mean - 0.04).abs() < 5.0 * error, "{mean}");
    // Names go by chance, not by size.
    assert!(
        (1..COUNT).any(|body| radius(body) > radius(body - 1))
            && (1..COUNT).any(|body| radius(body) < radius(body - 1))
    );
    let hash = |radii: &str, seed: u64| load(radii, seed).card().hash;
    assert_eq!(hash(radii, 5), hash(radii, 5));
    assert_ne!(hash(radii, 5), hash(radii, 6));
    for radii in ["LogNormal(mean: 0.03, deviation: 0.01, most: 0.08)", "Choice([0.02, 0.02, \"5 cm\"])"] {
        assert_eq!(hash(radii, 5), hash(radii, 5), "{radii}");
    }
}

/// Law: a fill of one radius is the fill of that disc: chance for places does not depend on that for radii.
#[test]
fn a_fill_of_one_radius_is_that_of_equal_discs() {
    let hash = |what: &str| {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), fill: [(name: \"grain\", {what}, count: 50, within: ((0, 0), (3, 3)), seed: 2)])"
        );
        Simulation::load(&Source::new("fill.ron", text)).unwrap_or_else(|errors| panic!("{errors}")).card().hash
    };
    assert_eq!(hash("radius: Choice([0.05])"), hash("atoms: Disc(radius: 0.05)"));
}
