//! Law: a spring takes time to be drawn. As a support starts, a contact of a box leaves its band at once. Its friction begins with
//! the spring as it was drawn before. Runs that locate events and runs from tick to tick then move alike.
//!
//! Reference: velocity Verlet with fine ticks, whose springs follow the displacements of their ends.
//!
//! Tolerance: the way that the box goes in two ticks of the reference. The box that falls on its side agrees to the coarsest tolerance
//! of its runs. Not tested: boxes that land, from tick to tick.

use super::ran::demand_agreement;
use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

/// Ticks of the reference in s.
const FINE: f64 = 1e-6;

/// A box on a plate that starts to turn and to move after `start` s.
fn plate(duration: f64, start: f64, friction: f64, (width, height): (f64, f64), (by, turn): (f64, f64)) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -9.81),
        materials: {{ \"m\": (stiffness: 2e4, restitution: 0.5, friction: {friction:?}) }},
        bodies: [(name: \"plate\", at: (0, -0.1), material: \"m\", shape: Rectangle(width: 10, height: 0.2),
                  kinematic: (path: [(time: {start:?}), (time: {:?}, by: ({by:?}, 0), turn: {turn:?})])),
                 (name: \"box\", at: (0.2, {:?}), mass: 1.6, material: \"m\",
                  shape: Rectangle(width: {width:?}, height: {height:?}))])",
        start + 0.25,
        0.5 * height,
    )
}

fn end(text: &str, overrides: Overrides) -> (DVec2, DVec2) {
    let load = Simulation::load_with(&Source::new("plate.ron", text), &overrides, |_| {});
    let mut simulation = load.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{overrides:?}: {failure}\n{text}"));
    assert_eq!(simulation.state().located().given_up, 0, "{overrides:?}: not all events were located\n{text}");
    let bodies = simulation.bodies();
    (bodies.position[1], bodies.velocity[1])
}

#[test]
fn friction_of_a_contact_that_leaves_its_band_begins_with_the_spring_as_drawn() {
    const AFTER: f64 = 0.003;
    let mut moved = 0;
    for friction in [0.2, 0.48, 0.6, 1.2] {
        for (size, path) in [((0.31, 0.36), (0.0, 0.34)), ((0.5, 0.2), (-0.2, 0.3)), ((0.2, 0.2), (0.1, -0.25))] {
            let text = plate(0.1 + AFTER, 0.1, friction, size, path);
            let fine =
                Overrides { tick: Some(FINE), method: Some("VelocityVerlet".to_owned()), ..Overrides::default() };
            let (place, velocity) = end(&text, fine);
            let allowed = 2.0 * FINE * velocity.length();
            for tolerance in [1e-5, 1e-9] {
                let (other, _) = end(&text, Overrides { tolerance: Some(tolerance), ..Overrides::default() });
                let off = other.distance(place);
                assert!(off <= allowed, "tolerance {tolerance:e}: off by {off:e} of {allowed:e}\n{text}");
            }
            moved += usize::from(velocity.length() > 1e-3);
        }
    }
    assert!(moved > 6, "only {moved} boxes were set in motion");
}

/// The box falls on its side, and comes to rest. One contact stops to slide in a state that neither holds it by friction within
/// its cone nor within its band.
#[test]
fn a_slide_that_ends_beyond_the_cone_goes_on_the_other_way() {
    let text = "Scene(format: 1, clock: (duration: 1.7), gravity: (0, -9.81),
        materials: { \"m\": (stiffness: 20000, restitution: 0.5, friction: 0.48) },
        bodies: [(name: \"plate\", at: (0, -0.1), material: \"m\", shape: Rectangle(width: 10, height: 0.2),
                  kinematic: (path: [(time: 0.527), (time: 0.764, by: (-0.207, 0), turn: 0.338),
                                     (time: 1.337, by: (-0.23, 0), turn: -0.366)])),
                 (name: \"box\", at: (0.2, 0.18), mass: 1.6, material: \"m\", shape: Rectangle(width: 0.31, height: 0.36))])";
    let tolerance = |tolerance: f64| Overrides { tolerance: Some(tolerance), ..Overrides::default() };
    let steps = |method: &str, tick: f64| Overrides {
        tick: Some(tick),
        method: Some(method.to_owned()),
        ..Overrides::default()
    };
    const COARSEST: f64 = 1e-6;
    let (exact, _) = end(text, tolerance(1e-9));
    for overrides in [tolerance(COARSEST), steps("RungeKutta4", 1e-4), steps("Dop853", 1e-3)] {
        let (place, _) = end(text, overrides.clone());
        assert!(place.distance(exact) < COARSEST, "{overrides:?}: {place} instead of {exact}");
    }
}

/// A push that swings takes a box along its belt and back. Each slide stops and turns round in a state that rounding would decide: the
/// contact that is let go then keeps the spring that the slide before has drawn. Runs agree within three times what they state.
#[test]
fn slides_that_turn_round_on_a_belt_lead_to_one_place() {
    let clocks = [
        ", tolerance: 1e-4",
        ", tolerance: 1e-5",
        ", tolerance: 1e-7",
        ", method: Reference",
        ", method: Dop853, tick: 1e-3",
    ];
    for (duration, speed, push, frequency, friction) in [
        (1.5, -0.3, 9.0, 2.0, 0.5),
        (0.45, -0.3, 9.0, 2.0, 0.5),
        (1.5, 0.25, 12.0, 1.3, 0.4),
        (1.5, -0.2, 9.0, 2.0, 0.5),
    ] {
        demand_agreement(&format!("{duration} s, {speed} m/s, {push} N"), &clocks, 3, |clock| {
            format!(
                "Scene(format: 1, clock: (duration: {duration:?}{clock}), gravity: (0, -9.81),
                    materials: {{ \"m\": (stiffness: 1e5, friction: {friction:?}, restitution: 0.2) }},
                    walls: [(name: \"belt\", left: (1, 0), right: (0, 0), material: \"m\", surface_velocity: ({speed:?}, 0))],
                    bodies: [(name: \"b\", at: (0, 0.1), mass: 1, material: \"m\",
                              shape: Rectangle(width: 0.3, height: 0.2, rounding: 0.01))],
                    forces: [Drive(of: \"b\", force: ({push:?}, 0), course: Sine(frequency: {frequency:?}))])"
            )
        });
    }
}
