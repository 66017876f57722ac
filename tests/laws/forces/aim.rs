//! Laws of the force `Aim` of scenes; each test says its law and its tolerance.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// The engine flies the shot: after the time of flight of the truth file P06, in whole ticks, the ball is at its aim. In
/// vacuum velocity Verlet is exact: rounding of 64 ticks.
#[test]
fn an_aimed_ball_flies_through_its_aim() {
    for (arc, time) in [("Low", 1.807_590_318_824_812_6), ("High", 4.546_609_596_782_668)] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: {time:?}, tick: {:?}), gravity: (0, -9.81),
            bodies: [(name: \"ball\", at: (2, -1), atoms: Disc(radius: 0.1))],
            forces: [Aim(of: \"ball\", at: (42, 4), speed: 25, arc: {arc})])",
            time / 64.0
        );
        let mut simulation = Simulation::load(&Source::new("aim.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run_to_end().unwrap();
        let missed = simulation.bodies().position[0].distance(glam::DVec2::new(42.0, 4.0));
        assert!(missed < 64.0 * f64::EPSILON * 60.0, "{arc}: {missed:e}");
        let card = simulation.card();
        assert!(card.notes.iter().any(|note| note.contains("and reaches its aim")), "{:?}", card.notes);
        assert!(card.energy.work.abs() < 1e-12, "it starts with its velocity: {:?}", card.energy);
    }
}

/// Drag and wind of several entries add up; others are not meant. Tolerance: order 2, `(0.5/s x 1 ms)^2` of a
/// way of 30 m; half a tick from the aim the way bends by `20 m/s2 (dt/2)^2/2`.
#[test]
fn drag_and_wind_of_the_scene_count() {
    let scene = "Scene(format: 1, clock: (duration: 10, tick: \"1 ms\"), gravity: (0, -9.81),
        bodies: [(name: \"ball\", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1))],
        forces: [Drag(linear: 0.3), Drag(quadratic: 0.01, of: \"b*\"), Wind(velocity: (-3, 1), linear: 0.2),
                 Aim(of: \"ball\", at: (20, 3), speed: 30, arc: High)])";
    let mut simulation = Simulation::load(&Source::new("aim.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
    let mut nearest = f64::INFINITY;
    let aim = glam::DVec2::new(20.0, 3.0);
    for tick in 1..=simulation.ticks() {
        simulation.run_to_tick(tick).unwrap();
        let (place, velocity) = (simulation.bodies().position[0], simulation.bodies().velocity[0]);
        // How far the line of its motion passes by the aim.
        if place.distance(aim) < 0.05 {
            nearest = nearest.min((aim - place).perp_dot(velocity.normalize()).abs());
        }
    }
    assert!(nearest < 7.5e-6 + 2.5e-6, "{nearest:e}");
}
