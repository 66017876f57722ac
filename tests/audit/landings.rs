//! Landings by two ways that share no step: discs and clumps that come down on a slope, bounce, slip, stick and come to
//! rest.
//!
//! Velocity Verlet searches each tick for the forces that stop a contact. Methods with located events go from mode to
//! mode. Both follow one law, so that their difference falls with the tick. Two modes that end within one tick are left
//! to chance. The share of scenes that have to agree allows for that. More clumps disagree: when a stretched spring
//! comes to rest, a force that holds it for one tick only takes its energy.

use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

use super::draw::Draw;

/// A landing within some hundredths of a second; `clump`: of two atoms, whose normal forces depend on friction.
fn landing(seed: u64, clump: bool) -> String {
    let mut draw = Draw::new(seed);
    let (radius, mass, stiffness) = (draw.scale(0.03, 0.12), draw.scale(0.2, 3.0), draw.scale(1.5e3, 1e5));
    let (restitution, dynamic) = (draw.between(0.0, 0.6), draw.between(0.1, 0.9));
    let fixed = dynamic * if draw.happens(0.5) { 1.0 } else { draw.between(1.0, 2.0) };
    let (along, down, spin) = (draw.between(-1.0, 1.0), draw.between(0.05, 1.0), draw.between(-15.0, 15.0));
    let slope = DVec2::from_angle(draw.between(-0.5, 0.5)) * 9.81;
    let milliseconds = draw.between(20.0, 120.0).round();
    let (height, beside, second, lighter) = (1.001 * radius, 0.8 * radius, 0.7 * radius, 0.4 * mass);
    let atoms = match clump {
        true => format!(
            "List([(at: (0, 0), radius: {radius}, mass: {mass}), (at: ({beside}, 0), radius: {second}, mass: {lighter})])"
        ),
        false => format!("Disc(radius: {radius}, mass: {mass})"),
    };
    format!(
        "Scene(format: 1, clock: (duration: {}), gravity: ({}, {}),
            materials: {{\"m\": (stiffness: {stiffness}, friction: (static: {fixed}, dynamic: {dynamic}), restitution: {restitution})}},
            walls: [(name: \"floor\", left: (4, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"b\", at: (0, {height}), velocity: ({along}, -{down}), spin: {spin}, material: \"m\", atoms: {atoms})])",
        milliseconds / 1000.0,
        slope.y,
        -slope.x,
    )
}

/// Place and angle at the end.
fn end(scene: &str, method: &str, tick: f64) -> (DVec2, f64) {
    let overrides = Overrides { method: Some(method.to_owned()), tick: Some(tick), ..Overrides::default() };
    let mut simulation = Simulation::load_with(&Source::new("landing.ron", scene), &overrides, |_| {}).unwrap();
    simulation.run_to_end().unwrap();
    (simulation.bodies().position[0], simulation.bodies().angle[0])
}

/// How many of `count` landings agree: to what bodies of 1 m/s that stop within a tick are apart after it, for each of some modes
/// that end in one tick or in the next.
fn agree(count: u64, first: u64, clump: bool) -> usize {
    const TICK: f64 = 4e-6;
    const SPEEDS: f64 = 5.0;
    (first..first + count)
        .filter(|&seed| {
            let scene = landing(seed, clump);
            let (exact, verlet) = (end(&scene, "Dop853", 1e-3), end(&scene, "VelocityVerlet", TICK));
            (exact.0 - verlet.0).length() + 0.1 * (exact.1 - verlet.1).abs() < SPEEDS * TICK
        })
        .count()
}

#[test]
fn discs_land_alike_by_ticks_and_by_located_events() {
    assert!(agree(100, 70_000, false) >= 98);
}

#[test]
fn clumps_land_alike_by_ticks_and_by_located_events() {
    assert!(agree(100, 80_000, true) >= 85);
}
