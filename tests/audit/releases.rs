//! Law: a contact, a friction or a limit at rest lets go when the load on it reaches its bound, whatever the length of steps.
//! While everything rests, no error shortens the steps, so each of these releases lies inside a step that could span it.
//!
//! The references are closed forms of the motion behind the release, for rigid contacts. The contacts here are springs, so places
//! may differ by the static depth `m g/k`, along the surface by the elongation `mu m g/k_t`. Not tested: landings.

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const G: f64 = 9.81;

fn settings() -> Vec<Overrides> {
    let tolerances = [1e-3, 1e-6, 1e-9].map(|wanted| Overrides { tolerance: Some(wanted), ..Overrides::default() });
    let methods = ["Reference", "Dop853", "RungeKutta4", "VelocityVerlet"];
    let methods = methods.map(|name| Overrides { method: Some(name.to_owned()), ..Overrides::default() });
    tolerances.into_iter().chain(methods).collect()
}

fn end(text: &str, overrides: &Overrides) -> Simulation {
    let load = Simulation::load_with(&Source::new("release.ron", text), overrides, |_| {});
    let mut simulation = load.unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{overrides:?}: {failure}\n{text}"));
    simulation
}

/// A force that grows as `force sin(omega t)` against a constant load, on a mass at rest.
#[derive(Clone, Copy)]
struct Push {
    force: f64,
    omega: f64,
    load: f64,
    mass: f64,
}

impl Push {
    /// A push of so many times the load.
    fn new(times: f64, frequency: f64, load: f64, mass: f64) -> Self {
        Self { force: times * load, omega: std::f64::consts::TAU * frequency, load, mass }
    }

    /// When the force reaches the load.
    fn begins(&self) -> f64 {
        libm::asin(self.load / self.force) / self.omega
    }

    /// When the force falls below the load again: the mass moves on.
    fn ends(&self) -> f64 {
        std::f64::consts::PI / self.omega - self.begins()
    }

    /// The way of the mass until `time`, by two integrations from rest.
    fn way(&self, time: f64) -> f64 {
        let Self { force, omega, load, mass } = *self;
        let begin = self.begins();
        let passed = time - begin;
        let turned = (libm::sin(omega * time) - libm::sin(omega * begin)) / omega;
        force / (mass * omega) * (libm::cos(omega * begin) * passed - turned) - 0.5 * load / mass * passed * passed
    }
}

/// A disc on the floor, pulled up by a sine: it lifts off when the force is its weight.
#[test]
fn a_pulled_disc_lifts_off_when_the_force_is_its_weight() {
    for (mass, times, frequency, stiffness) in [(1.0, 1.5, 2.0, 1e5), (0.3, 1.05, 0.25, 1e7), (5.0, 3.0, 11.0, 1e7)] {
        let push = Push::new(times, frequency, mass * G, mass);
        let Push { force, .. } = push;
        let text = format!(
            "Scene(format: 1, clock: (duration: {:?}), gravity: (0, -{G}),
            materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: 0, friction: 0.5) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"b\", at: (0, 0.1), material: \"m\", atoms: Disc(radius: 0.1, mass: {mass:?}))],
            forces: [Drive(of: \"b\", force: (0, {force:?}), course: Sine(frequency: {frequency:?}))])",
            push.ends()
        );
        // The disc begins a static depth higher or lower, and is released earlier by the time of that way.
        let depth = 4.0 * mass * G / stiffness;
        for overrides in settings() {
            let simulation = end(&text, &overrides);
            let (y, risen) = (simulation.bodies().position[0].y - 0.1, push.way(simulation.clock().time()));
            assert!((y - risen).abs() <= depth + 0.01 * risen, "{overrides:?}: {y} instead of {risen}");
            assert!(risen > 10.0 * depth, "the case shows nothing: {risen}");
        }
    }
}

/// A slide on its lower limit, pulled up by a sine: it leaves the limit when the force is its weight. Limits do not give, so
/// the error is that of the run. Methods from tick to tick leave it at the end of a tick: order 1.
#[test]
fn a_limit_lets_go_when_the_force_is_the_weight() {
    for (mass, times, frequency) in [(1.0, 1.5, 2.0), (0.3, 1.02, 0.25), (5.0, 3.0, 11.0)] {
        let push = Push::new(times, frequency, mass * G, mass);
        let Push { force, omega, .. } = push;
        let text = format!(
            "Scene(format: 1, clock: (duration: {:?}), gravity: (0, -{G}), contacts: None,
            bodies: [(name: \"b\", at: (0, -1), mass: {mass:?}, atoms: Disc(radius: 0.1))],
            joints: [Prismatic(name: \"j\", a: World, anchor_a: (0, 0), b: \"b\", axis: (0, 1), limits: (-1, 5))],
            forces: [Drive(of: \"b\", force: (0, {force:?}), course: Sine(frequency: {frequency:?}))])",
            push.ends()
        );
        for overrides in settings() {
            let simulation = end(&text, &overrides);
            let (time, tick) = (simulation.clock().time(), simulation.clock().dt);
            let risen = push.way(time);
            let off = (simulation.bodies().position[0].y + 1.0 - risen).abs();
            let by_ticks = overrides.method.as_deref() == Some("VelocityVerlet");
            let allowed = match (overrides.tolerance, by_ticks) {
                (Some(tolerance), _) => 3.0 * tolerance * risen,
                // A release a tick late loses the speed that the force gives in two ticks, over the rest of the time.
                (None, true) => 2.0 * force * omega / mass * tick * tick * (time - push.begins()),
                // Order 4 with forty steps in half a swing.
                (None, false) => 1e-6 * risen,
            };
            assert!(off <= allowed + 1e-13, "{overrides:?}: off by {off:e}, allowed {allowed:e}");
        }
    }
}

/// A box on the floor, pushed by a sine: it slips when the force is the greatest friction.
#[test]
fn a_pushed_box_slips_when_the_force_is_the_friction() {
    for (mass, friction, times, frequency) in [(1.0, 0.5, 2.0, 0.5), (4.0, 0.2, 1.2, 0.7), (0.2, 0.9, 5.0, 1.3)] {
        let push = Push::new(times, frequency, friction * mass * G, mass);
        let Push { force, load, .. } = push;
        let stiffness = 1e7;
        let text = format!(
            "Scene(format: 1, clock: (duration: {:?}), gravity: (0, -{G}),
            materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: 0, friction: {friction:?}) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"b\", at: (0, 0.05), mass: {mass:?}, material: \"m\",
                      shape: Rectangle(width: 0.4, height: 0.1, rounding: 0.005))],
            forces: [Drive(of: \"b\", force: ({force:?}, 0), at: (0, -0.05), course: Sine(frequency: {frequency:?}))])",
            push.ends()
        );
        // Springs of a share 0.8 of the stiffness, at two corners, stretch by this, and swing by as much again.
        let give = 4.0 * load / (0.8 * stiffness);
        for overrides in settings() {
            let simulation = end(&text, &overrides);
            let (x, gone) = (simulation.bodies().position[0].x, push.way(simulation.clock().time()));
            assert!((x - gone).abs() <= give + 2e-3 * gone, "{overrides:?}: {x} instead of {gone}");
            assert!(gone > 10.0 * give, "the case shows nothing: {gone}");
        }
    }
}

/// Events that lie there and back inside one step: a corner that touches the floor while the box turns, a motor and frictions
/// that let go and hold. All tolerances lead to one motion, that of short steps, within what they state.
#[test]
fn tolerances_miss_no_event_inside_a_step() {
    for name in ["missed_corner", "motor_limit", "motor_limit_friction", "limit_under_a_load"] {
        let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"));
        let short = end(&text, &Overrides { method: Some("Dop853".to_owned()), ..Overrides::default() });
        for wanted in [1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-8] {
            let simulation = end(&text, &Overrides { tolerance: Some(wanted), ..Overrides::default() });
            let stated = simulation.card().error.and_then(|error| error.position.discretisation).expect("stated");
            let ends = simulation.bodies().position.iter().zip(&short.bodies().position);
            let apart = ends.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
            assert!(apart <= 10.0 * stated + 1e-9, "{name} at {wanted:e}: {apart:e} apart, {stated:e} stated");
        }
    }
}
