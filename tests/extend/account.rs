//! A model from outside with a separate account: its losses appear in the ledger, in JSON and in a channel.
//!
//! Law: a brake `F = -c v` on a mass takes `m v0^2/2 (1 - e^(-2 c t/m))` in the time t. Tolerance: the global error of the method at
//! this tick, `(c dt/m)^2 = 1e-6` of what was there for velocity Verlet, which is of second order under brakes, 1e-12 for the others
//! (their powers of 1e-3). The residual of the ledger is bounded by the same. Not tested: several models with one account
//! (`what_dampers_take_stands_apart_from_drag` has two).

use std::f64::consts::E;

use bevy_app::App;
use glam::DVec2;
use jostle::scene::Source;
use jostle::sensors;
use jostle::simulation::Overrides;
use jostle::tick::{Energies, Loss, Model, State, SteadySpring, TickAppExt};
use jostle::{Simulation, SimulationExt};

struct Brake {
    damping: f64,
    power: f64,
}

impl Model for Brake {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn loss(&self) -> Option<Loss> {
        Some(Loss { account: "brake", power: self.power })
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        let velocity = bodies.velocity[0];
        let force = -self.damping * velocity;
        self.power = self.damping * velocity.length_squared();
        rates.outside(bodies.position[0], force, 0.0);
        bodies.push(0, DVec2::ZERO, force);
    }
}

fn braked(method: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: {method}),
          bodies: [(name: \"cart\", at: (0, 0), velocity: (3, 4), atoms: Disc(radius: 0.1, mass: 2))])"
    );
    let brake = |app: &mut App| {
        app.add_model(Brake { damping: 2.0, power: 0.0 });
    };
    Simulation::load_with(&Source::new("brake.ron", scene), &Overrides::default(), brake).expect("a correct scene")
}

#[test]
fn what_a_model_takes_stands_in_its_account() {
    let begin = 0.5 * 2.0 * 25.0;
    let taken = begin * (1.0 - (-2.0_f64).exp());
    for (method, tolerance) in [("VelocityVerlet", 1e-6), ("RungeKutta4", 1e-12), ("Dop853", 1e-12)] {
        let mut simulation = braked(method);
        let channel = sensors::find(simulation.world_mut(), "energy.brake").expect("the model has this account");
        simulation.run_to_end().expect("numbers stay finite");
        let energy = simulation.card().energy;
        assert!((energy.accounts["brake"] - taken).abs() <= tolerance * begin, "{method}: {energy:?}");
        assert!(energy.residual.abs() <= tolerance * begin, "{method}: {energy:?}");
        assert_eq!(energy.drag, 0.0);
        assert_eq!(simulation.value(&channel), energy.accounts["brake"]);
        let json = serde_json::to_value(&energy).expect("numbers are finite");
        assert_eq!(json["brake"], energy.accounts["brake"]);
    }
}

/// Two dampers and drag on one mass share what goes: each takes in proportion to its coefficient, 1 : 2 : 5 of the whole,
/// whatever the motion.
#[test]
fn what_dampers_take_stands_apart_from_drag() {
    for method in ["VelocityVerlet", "RungeKutta4", "Dop853"] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: {method}),
              forces: [Drag(linear: 0.5), Spring(a: \"cart\", b: World, anchor_b: (-2, 0), stiffness: 30, damping: 0.1),
                       Spring(a: \"cart\", b: World, anchor_b: (-2, 0), stiffness: 3, damping: 0.2)],
              bodies: [(name: \"cart\", at: (0, 0), velocity: (3, 0), atoms: Disc(radius: 0.1, mass: 2))])"
        );
        let mut simulation = Simulation::load(&Source::new("dampers.ron", scene)).expect("a correct scene");
        simulation.run_to_end().expect("numbers stay finite");
        let energy = simulation.card().energy;
        let damped = energy.accounts["damping"];
        assert!(energy.drag > 0.5, "{energy:?}");
        // All three see the same velocities, so the proportion is exact but for rounding of a thousand terms.
        assert!((damped / energy.drag - 0.3 / 0.5).abs() < 1e-12, "{method}: {energy:?}");
    }
}

/// A force along the motion that it books as friction: a brake, then a push from some time on.
struct Pusher {
    /// In seconds.
    from: f64,
}

impl Model for Pusher {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        let force = if state.evaluation().time < self.from { -1.0 } else { 1.0 };
        let (bodies, rates) = state.bodies_and_rates();
        let velocity = bodies.velocity[0] * force;
        rates.friction -= velocity.dot(bodies.velocity[0]);
        rates.outside(bodies.position[0], velocity, 0.0);
        bodies.push(0, DVec2::ZERO, velocity);
    }
}

/// The balance is right: the energy that the mass gains is that of the account. Friction that gives is wrong all the same, below zero
/// or back of what it took: after a second of braking `25 (1 - 1/e)` J are lost, of which half a second gives `25/e (sqrt(e) - 1)` J.
#[test]
fn the_verdict_distrusts_friction_that_gives() {
    for (from, duration, lost) in [(0.0, 1.0, 25.0 * (1.0 - E)), (1.0, 1.5, 25.0 * (1.0 - (-0.5_f64).exp()))] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: {duration:?}, tick: 0.001, method: RungeKutta4),
            bodies: [(name: \"cart\", at: (0, 0), velocity: (3, 4), atoms: Disc(radius: 0.1, mass: 2))])"
        );
        let pusher = move |app: &mut App| {
            app.add_model(Pusher { from });
        };
        let mut simulation =
            Simulation::load_with(&Source::new("pusher.ron", scene), &Overrides::default(), pusher).unwrap();
        simulation.run_to_end().expect("numbers stay finite");
        let card = simulation.card();
        // A step across the turn of the force may brake a tick too long, and errs by the square of its length.
        let turn = if from > 0.0 { 25.0 * 1e-3 } else { 0.0 };
        let (friction, residual) = (card.energy.friction - lost, card.energy.residual);
        assert!(friction.abs() <= turn + 1e-9 && residual.abs() <= 1e-3 * turn + 1e-9, "{:?}", card.energy);
        assert!(card.verdict.starts_with("Do not trust it: friction and contacts have given"), "{}", card.verdict);
    }
}
