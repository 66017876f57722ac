//! Systems on components and systems on the state in one run, and models that come in mid-run.
//!
//! Laws: a kick of `v` metres per second counts once, however it is given and however a run is cut into batches. Energy
//! that a model from outside takes is booked from the moment at which it acts. Tolerance: rounding of sums, 1e-12;
//! batches: none.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::critical_step::Spring;
use jostle::tick::{Energies, Loss, Model, SimTick, Stage, State, SteadySpring, TickAppExt};
use jostle::world::{Position, Velocity, hash::state_hash};
use jostle::{Simulation, SimulationExt};

fn load(method: &str, plugins: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 0.1, tick: 0.001, method: {method}),
          bodies: [(name: \"ball\", at: (0, 0), velocity: (2, 0), atoms: Disc(radius: 0.1, mass: 2))])"
    );
    Simulation::load_with(&Source::new("mixed.ron", scene), &Overrides::default(), plugins).expect("a correct scene")
}

const METHODS: [&str; 3] = ["VelocityVerlet", "RungeKutta4", "Dop853"];

fn kick(mut bodies: Query<&mut Velocity>) {
    bodies.iter_mut().for_each(|mut velocity| velocity.0.y += 0.5);
}

/// One kick in each of a hundred ticks, after the step: all of them count, the last one too, and places follow.
#[test]
fn what_is_written_after_the_step_counts_in_batches_of_any_length() {
    for method in METHODS {
        let run = |batch: u64| {
            let mut simulation = load(method, |app| {
                app.add_systems(SimTick, kick.in_set(Stage::Observe));
            });
            while simulation.ticks() > simulation.clock().ticks {
                simulation.run_to_tick((simulation.clock().ticks + batch).min(simulation.ticks())).unwrap();
            }
            assert!((simulation.bodies().velocity[0].y - 50.0).abs() < 1e-12, "{method}, {batch}");
            let world = simulation.world_mut();
            let shown = world.query::<&Velocity>().single(world).unwrap().0;
            assert_eq!(shown, simulation.bodies().velocity[0]);
            state_hash(simulation.bodies())
        };
        let whole = run(1000);
        assert_eq!([run(1), run(7)], [whole; 2], "{method}");
    }
}

fn look(bodies: Query<&Position>, mut seen: ResMut<Seen>) {
    seen.0 += bodies.iter().map(|position| position.0.x).sum::<f64>();
}

#[derive(Resource, Default)]
struct Seen(f64);

fn push_state(mut state: ResMut<State>) {
    let tick = state.clock().ticks;
    if tick == 5 {
        state.bodies_mut().velocity[0].x += 1.0;
        state.bodies_mut().touched = true;
    }
}

/// A system that works on the state is not undone by the components, which are older.
#[test]
fn what_is_written_into_the_state_stays_beside_systems_on_components() {
    for method in METHODS {
        let mut simulation = load(method, |app| {
            app.init_resource::<Seen>();
            app.add_systems(SimTick, (push_state.in_set(Stage::Begin), look.in_set(Stage::Observe)));
        });
        simulation.run_to_end().unwrap();
        let bodies = simulation.bodies();
        assert!((bodies.velocity[0].x - 3.0).abs() < 1e-12, "{method}: {}", bodies.velocity[0].x);
        assert!((bodies.position[0].x - (0.2 + 0.095)).abs() < 1e-12, "{method}: {}", bodies.position[0].x);
    }
}

struct Brake {
    damping: f64,
    power: f64,
    account: &'static str,
}

impl Brake {
    fn new(account: &'static str) -> Self {
        Self { damping: 20.0, power: 0.0, account }
    }
}

impl Model for Brake {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn loss(&self) -> Option<Loss> {
        Some(Loss { account: self.account, power: self.power })
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        let force = -self.damping * bodies.velocity[0];
        self.power = self.damping * bodies.velocity[0].length_squared();
        rates.outside(bodies.position[0], force, 0.0);
        bodies.push(0, DVec2::ZERO, force);
    }
}

fn brake_at_5(mut state: ResMut<State>) {
    if state.clock().ticks == 5 {
        state.add_model(Brake::new("brake"));
    }
}

#[test]
fn a_model_that_comes_within_a_batch_is_accounted_for_at_once() {
    for (method, tolerance) in [("RungeKutta4", 1e-9), ("Dop853", 1e-12)] {
        let mut simulation = load(method, |app| {
            app.add_packed_systems(SimTick, brake_at_5.in_set(Stage::Begin));
        });
        simulation.run_to_end().unwrap();
        let energy = simulation.card().energy;
        let taken = 4.0 * (1.0 - libm::exp(-2.0 * 20.0 / 2.0 * 0.095));
        assert!((energy.accounts["brake"] - taken).abs() < 4.0 * tolerance, "{method}: {energy:?}");
        assert!(energy.residual.abs() < 4.0 * tolerance, "{method}: {energy:?}");
    }
}

#[test]
#[should_panic(expected = "an account cannot be called `drag`")]
fn an_account_has_a_name_of_its_own() {
    load("VelocityVerlet", |app| {
        app.add_model(Brake::new("drag"));
    });
}

struct Adder;

impl Model for Adder {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        state.add_model(Brake::new("brake"));
    }
}

#[test]
#[should_panic(expected = "a model cannot add another one while it acts")]
fn a_model_that_adds_another_one_is_told_where_to_do_so() {
    let mut simulation = load("VelocityVerlet", |app| {
        app.add_model(Adder);
    });
    let _ = simulation.run_to_end();
}

struct Stiff(f64);

impl Model for Stiff {
    fn energies(&self, state: &State) -> Energies {
        Energies { potential: 0.0, elastic: 0.5 * self.0 * state.bodies().position[0].length_squared() }
    }

    fn stiffness(&self, _: &State, springs: &mut Vec<SteadySpring>) {
        let (b, stiffness) = ((0, DVec2::ZERO), (self.0, self.0));
        let spring = Spring { a: None, b, normal: DVec2::X, stiffness, damped: 0.0, turning: 0.0 };
        springs.push(SteadySpring { spring, damping: 0.0, turning_damping: 0.0 });
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        let force = bodies.position[0] * -self.0;
        bodies.push(0, DVec2::ZERO, force);
        rates.outside(bodies.position[0], force, 0.0);
    }
}

fn stiffen_at_5(mut state: ResMut<State>) {
    if state.clock().ticks == 5 {
        state.model_mut::<Stiff>().unwrap().0 = 20_000.0;
    }
}

/// Law: velocity Verlet is stable up to `2/w`, `w = sqrt(k/m)`: 0.02 s with k = 20 000 N/m and m = 2 kg.
#[test]
fn the_critical_tick_follows_a_model_that_changes() {
    let mut simulation = load("VelocityVerlet", |app| {
        app.add_model(Stiff(50.0)).add_packed_systems(SimTick, stiffen_at_5.in_set(Stage::Begin));
    });
    simulation.run_to_end().unwrap();
    let critical = simulation.card().critical_tick.unwrap();
    assert!((critical - 0.02).abs() < 1e-9, "{critical}");
}
