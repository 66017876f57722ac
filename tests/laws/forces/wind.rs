//! Laws of the force `Wind` of scenes; each test says its law and its tolerance.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// `v = u (1 - exp(-c t/m))` from rest. Tolerance: order 2 in the tick, `(c dt/m)^2 = 1e-6` of `u`. Not tested: the
/// quadratic part, which is drag's in another frame.
#[test]
fn a_body_at_rest_is_taken_along() {
    let scene = r#"Scene(
        format: 1,
        clock: (duration: 2, tick: "1 ms"),
        bodies: [(name: "kite", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1)),
                 (name: "stone", at: (5, 0), mass: 2, atoms: Disc(radius: 0.1))],
        forces: [Wind(velocity: (3, -1), linear: 2, of: "kite")],
    )"#;
    let mut simulation = Simulation::load(&Source::new("wind.ron", scene)).unwrap();
    simulation.run_to_end().unwrap();
    let expected = glam::DVec2::new(3.0, -1.0) * (1.0 - libm::exp(-2.0));
    let velocity = simulation.bodies().velocity[0];
    assert!((velocity - expected).length() < 3e-6, "{velocity} for {expected}");
    assert_eq!(simulation.bodies().velocity[1], glam::DVec2::ZERO, "only the bodies named");
    // What the wind brought is in the body or was lost.
    assert!(simulation.card().energy_error() < 1e-6);
}
