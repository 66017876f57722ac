//! Law: a few contacts have few events, however softly they end. Runs under every tolerance locate them all, and agree with
//! `Reference` to within what both state.
//!
//! The scenes end modes at the edge of what numbers tell. A held force leaves its band slowly. Springs stretch below the last
//! digit of places. The modes of two contacts of one body depend on each other.
//!
//! Tolerance: three times the sum of what two runs state. Not tested: that a run of many contacts locates all events.

use glam::DVec2;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

/// The same factor by which runs of chance may disagree.
const STATED: f64 = 3.0;

fn end(text: &str, overrides: Overrides) -> (Vec<DVec2>, f64) {
    let load = Simulation::load_with(&Source::new("few.ron", text), &overrides, |_| {});
    let mut simulation = load.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{overrides:?}: {failure}\n{text}"));
    assert_eq!(simulation.state().located().given_up, 0, "{overrides:?}: not all events were located\n{text}");
    let stated = simulation.card().error.and_then(|error| error.position.discretisation);
    let stated = stated.unwrap_or_else(|| panic!("{overrides:?} states nothing\n{text}"));
    (simulation.bodies().position.clone(), stated)
}

fn agree(text: &str) {
    let reference = Overrides { method: Some("Reference".to_owned()), ..Overrides::default() };
    let (exact, exactly) = end(text, reference);
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let (places, stated) = end(text, Overrides { tolerance: Some(tolerance), ..Overrides::default() });
        let off = places.iter().zip(&exact).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let allowed = STATED * (stated + exactly) + 1e-13;
        assert!(off <= allowed, "tolerance {tolerance:e}: off by {off:e}, {stated:e} and {exactly:e} stated\n{text}");
    }
}

/// A force that changes in straight lines presses a disc down and lifts it. Its held contact leaves the band slowly.
#[test]
fn a_held_force_that_leaves_its_band_slowly_is_let_go_once() {
    for (restitution, stiffness) in [(0.3, 3e4), (0.3, 1e6), (0.8, 3e4), (0.8, 1e6)] {
        agree(&format!(
            "Scene(format: 1, clock: (duration: 1.6), gravity: (0, -9.81),
            materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: {restitution:?}, friction: 0.5) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"a\", at: (0, 0.1), mass: 1.2, material: \"m\", shape: Disc(radius: 0.1))],
            forces: [Drive(of: \"a\", force: (0, 21.6), course:
                           Piecewise([(0, 0), (0.5, -0.8), (0.8, 0.95), (1.2, -0.8), (1.7, 0.9)]))])"
        ));
    }
}

/// A box begins on a slope without an overlap, 5 m from the origin. At first its springs stretch by less than the last digit of
/// its place.
#[test]
fn a_box_put_down_without_an_overlap_slides_or_holds_without_a_crowd_of_events() {
    for (friction, angle) in [(0.62, 30.0_f64), (0.62, 17.0), (0.9, 30.0), (0.3, 10.0)] {
        let (along, up) = (DVec2::from_angle(angle.to_radians()), DVec2::from_angle(angle.to_radians()).perp());
        let (top, place) = (10.0 * along, 5.0 * along + 0.1 * up);
        agree(&format!(
            "Scene(format: 1, clock: (duration: 1), contacts: Penalty(start: AsPlaced), gravity: (0, -9.81),
            materials: {{ \"m\": (stiffness: 8e4, restitution: 0.2, friction: {friction:?}) }},
            walls: [(name: \"ramp\", left: ({:?}, {:?}), right: (0, 0), material: \"m\")],
            bodies: [(name: \"a\", at: ({:?}, {:?}), angle: \"{angle} deg\", mass: 2, material: \"m\",
                      shape: Rectangle(width: 0.3, height: 0.2))])",
            top.x, top.y, place.x, place.y
        ));
    }
}

/// Two atoms of a body press on one disc. As one contact turns, the other one is let go, and drawn back.
#[test]
fn contacts_of_one_body_find_their_modes_together() {
    let path = format!("{}/assets/defects/two_turns.ron", env!("CARGO_MANIFEST_DIR"));
    agree(&std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}")));
}
