//! Law: a load on the line through the centre of a box that stands on a level floor neither turns the box nor moves it sideways. Both of
//! its corners leave the floor, and land, at the same moments.
//!
//! Steps under a tolerance reach behind the moment at which the corners are let go. The forces that their stages find there go on
//! smoothly, with all friction of the corners.
//!
//! Tolerance: 1e-12 of the size for places and angles, the rounding of some thousand steps. Heights agree to three times the sum of what
//! both runs state. Not tested: boxes that land on one corner.

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const STATED: f64 = 3.0;

/// The place along the floor, the angle and the height at the end, with the stated error.
fn end(text: &str, overrides: &Overrides) -> ([f64; 3], f64) {
    let load = Simulation::load_with(&Source::new("lifted.ron", text), overrides, |_| {});
    let mut simulation = load.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{overrides:?}: {failure}\n{text}"));
    let stated = simulation.card().error.and_then(|error| error.position.discretisation).unwrap_or_default();
    let bodies = simulation.bodies();
    ([bodies.position[0].x, bodies.angle[0], bodies.position[0].y], stated)
}

#[test]
fn a_load_through_the_centre_lifts_a_box_without_turning_it() {
    for (restitution, size) in [(0.3, 1.0), (0.5, 1.0), (0.3, 0.01), (0.15, 30.0)] {
        let (stiffness, lift) = (2e4 * size * size, 12.0 * size * size * size);
        for force in [
            format!("Drive(of: \"b\", force: (0, {lift:?}), course: Sine(frequency: 1, amplitude: 1, phase: 0))"),
            format!(
                "Drive(of: \"b\", force: (0, {lift:?}), course: Piecewise([(0, 0), (0.4, 1), (0.6, 1), (0.7, -1)]))"
            ),
            format!("Thrust(of: \"b\", force: (0, {lift:?}), from: 0.3, to: 0.5)"),
        ] {
            let text = format!(
                "Scene(format: 1, clock: (duration: 1.5), gravity: (0, -9.81),
                materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: {restitution:?}, friction: 0.5) }},
                walls: [(name: \"floor\", left: (2, 0), right: (0, 0), material: \"m\")],
                bodies: [(name: \"b\", at: (0, {:?}), material: \"m\",
                          shape: Rectangle(width: {:?}, height: {:?}, mass: {:?}))],
                forces: [{force}])",
                0.1 * size,
                0.4 * size,
                0.2 * size,
                size * size * size,
            );
            let reference = Overrides { method: Some("Reference".to_owned()), ..Overrides::default() };
            let tolerance = |share: f64| Overrides { tolerance: Some(share * size), ..Overrides::default() };
            let mut heights: Vec<(f64, f64)> = Vec::new();
            for overrides in [reference, tolerance(1e-3), tolerance(1e-6), tolerance(1e-9)] {
                let ([along, angle, height], stated) = end(&text, &overrides);
                assert!(along.abs() <= 1e-12 * size, "{overrides:?}: {along:e} m aside\n{text}");
                assert!(angle.abs() <= 1e-12, "{overrides:?}: turned by {angle:e}\n{text}");
                for (other, also) in &heights {
                    let (off, allowed) = ((height - other).abs(), STATED * (stated + also) + 1e-12 * size);
                    assert!(off <= allowed, "{overrides:?}: {off:e} m off, {stated:e} and {also:e} stated\n{text}");
                }
                heights.push((height, stated));
            }
        }
    }
}
