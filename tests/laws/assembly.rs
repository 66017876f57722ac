//! Laws of the start: bodies are brought onto their joints.
//!
//! Closing is a matter of places, and full turns change none. Tolerance: rounding. Not tested: which of several ways to close is taken.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// Law: a body that closes its joints is turned by half a turn at most, for a full turn more leads to the same place. This four-bar is
/// so far from closed that the search turns two of its bars by several turns on the way.
#[test]
fn bodies_are_closed_without_full_turns() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: 0.001), contacts: None,
         bodies: [(name: \"b0\", at: (-0.490771,1.16189), angle: 0.634228, mass: 1, inertia: 0.1, atoms: Disc(radius: 0.05)),
            (name: \"b1\", at: (1.09079,1.84837), angle: -2.7436, mass: 1, inertia: 0.001, atoms: Disc(radius: 0.05)),
            (name: \"b2\", at: (1.13209,-0.931139), angle: -0.198432, mass: 1, inertia: 0.1, atoms: Disc(radius: 0.05))],
         joints: [Revolute(a: World, anchor_a: (0,0), b: \"b0\", anchor_b: (-0.617679,0), assemble: true),
            Revolute(a: \"b0\", anchor_a: (0.617679,0), b: \"b1\", anchor_b: (-0.438369,0), assemble: true),
            Revolute(a: \"b1\", anchor_a: (0.438369,0), b: \"b2\", anchor_b: (-0.311674,0), assemble: true),
            Revolute(a: World, anchor_a: (1.17733,0), b: \"b2\", anchor_b: (0.311674,0), assemble: true)])";
    let mut simulation =
        Simulation::load(&Source::new("open.ron", scene.to_owned())).unwrap_or_else(|errors| panic!("{errors}"));
    for (body, angle) in [0.634228, -2.7436, -0.198432].into_iter().enumerate() {
        let turned: f64 = simulation.bodies().angle[body] - angle;
        assert!(turned.abs() <= std::f64::consts::PI, "body {body} was turned by {turned} rad");
    }
    simulation.run_to_tick(1).unwrap();
    let drift = simulation.card().largest_joint_drift.expect("there are joints");
    assert!(drift.meters < 1e-12, "{drift:?}");
}
