//! A contact law from outside has every method of a model. The engine calls each of them, and counts its results.
//!
//! Law: a law that is added by `add_law` is a model like any other. The names of the methods come from the text of the trait. So a
//! method that is new there is wanted here. The closed forms are
//! `m v^2/2 (1 - e^(-2 c t/m))` for a brake, `F' (T - t0)^2/(2 m)` for a force that grows from an edge on.
//! A row holds a coordinate. The tick that the engine chooses divides half a swing of the drive into 40. Tolerance: rounding of a thousand ticks, for the brake `(c dt/m)^2`.
//! Not tested: what laws make of pairs, see `contact_law` and `axis_wise`.

use std::any::Any;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

use bevy_app::App;
use bevy_ecs::world::World;
use glam::DVec2;
use jostle::constraints::{Row, RowKind, RowSide, Rows};
use jostle::contacts::{ContactLaw, ContactPoint, LawTouch, add_law};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use jostle::tick::{
    Bend, Blow, BlowAtJoint, Departure, Dependence, Energies, EvaluationMode, Events, ForceOn, ForcePart, Indicator,
    Loss, Model, Objection, Rhythm, State, SteadySpring, TimeScales,
};
use jostle::world::Bodies;
use jostle::{Simulation, SimulationExt};

/// The methods that were called.
type Called = Arc<Mutex<BTreeSet<&'static str>>>;

/// The parts of the law that act.
#[derive(Clone, Copy, Default)]
struct Parts {
    /// A brake on body 0, in N s/m.
    brake: f64,
    /// A force on body 0 along x that grows, in N/s, and the time in s from which it does.
    push: (f64, f64),
    /// A row holds the x coordinate of body 0.
    holds: bool,
    /// A blow at the first step.
    strikes: bool,
    /// An event turns the force on body 0 at x = 0, in N.
    turns: f64,
    /// In rad/s.
    rhythm: f64,
}

struct Whole {
    parts: Parts,
    called: Called,
    power: f64,
    blows: u32,
    after: u32,
    turned: bool,
    row: usize,
    inner: u8,
}

impl Whole {
    fn called(&self, method: &'static str) {
        self.called.lock().unwrap().insert(method);
    }

    fn force(&self, time: f64, velocity: DVec2) -> DVec2 {
        let Parts { brake, push, turns, .. } = self.parts;
        let pushed = push.0 * (time - push.1).max(0.0);
        let turned = if self.turned { -turns } else { turns };
        DVec2::new(pushed + turned, 0.0) - brake * velocity
    }
}

impl ContactLaw for Whole {
    fn law(&self) -> &'static str {
        "Whole"
    }

    fn pair_stiffness(&self, _: &State, _: &LawTouch) -> (f64, f64) {
        (1.0, 0.0)
    }
}

impl Model for Whole {
    fn name(&self) -> &'static str {
        self.called("name");
        "Whole"
    }

    fn energies(&self, _: &State) -> Energies {
        self.called("energies");
        Energies::default()
    }

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        self.called("force_on");
        let force = self.force(state.time(), state.bodies().velocity[body]);
        Some(ForceOn { part: ForcePart::Spring, force, point: state.bodies().position[body] })
    }

    fn loss(&self) -> Option<Loss> {
        self.called("loss");
        Some(Loss { account: "sole", power: self.power })
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {
        self.called("stiffness");
    }

    fn dependence(&self) -> Dependence {
        self.called("dependence");
        Dependence::Velocity
    }

    fn flies(&self) -> bool {
        self.called("flies");
        false
    }

    fn contact_law(&self) -> Option<&'static str> {
        self.called("contact_law");
        None
    }

    fn start(&mut self, _: &mut World) {
        self.called("start");
    }

    fn find_pairs(&mut self, _: &mut State) {
        self.called("find_pairs");
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.called("apply_forces");
        let time = state.evaluation().time;
        let (bodies, rates) = state.bodies_and_rates();
        let velocity = bodies.velocity[0];
        let force = self.force(time, velocity);
        self.power = self.parts.brake * velocity.length_squared();
        rates.work += (force + self.parts.brake * velocity).dot(velocity);
        rates.outside(bodies.position[0], force, 0.0);
        bodies.push(0, DVec2::ZERO, force);
    }

    fn add_rows(&mut self, bodies: &Bodies, _: f64, rows: &mut Rows) {
        self.called("add_rows");
        self.row = rows.len();
        if self.parts.holds {
            let side = RowSide { body: 0, direction: DVec2::X, force: DVec2::X, ..RowSide::default() };
            let (kind, gap) = (RowKind::Position, bodies.position[0].x);
            rows.add(Row { sides: [None, Some(side)], kind, gap, size: 1.0, ..Row::default() });
        }
    }

    fn take_rows(&mut self, state: &mut State) {
        self.called("take_rows");
        if self.parts.holds {
            state.apply_rows(self.row..self.row + 1);
        }
    }

    fn has_rows(&self) -> bool {
        self.called("has_rows");
        self.parts.holds
    }

    fn settle(&mut self, _: &mut State) {
        self.called("settle");
    }

    fn settles(&self) -> bool {
        self.called("settles");
        true
    }

    fn break_force(&self) -> Option<f64> {
        self.called("break_force");
        Some(1e12)
    }

    fn take_blow(&mut self, _: BlowAtJoint, _: bool) {
        self.called("take_blow");
    }

    fn after_blow(&mut self, _: &mut State) {
        self.called("after_blow");
        self.after += 1;
    }

    fn begin_step(&mut self, state: &mut State) {
        self.called("begin_step");
        if self.parts.strikes && self.blows == 0 {
            self.blows += 1;
            state.strike(Blow::Stops);
        }
    }

    fn has_modes(&self) -> bool {
        self.called("has_modes");
        true
    }

    fn begins_with_velocities(&self) -> bool {
        self.called("begins_with_velocities");
        true
    }

    fn finds_pairs(&self) -> bool {
        self.called("finds_pairs");
        true
    }

    fn end_tick(&mut self, _: &mut State) {
        self.called("end_tick");
    }

    fn looks_at_ticks(&self) -> bool {
        self.called("looks_at_ticks");
        true
    }

    fn time_scales(&self) -> TimeScales {
        self.called("time_scales");
        TimeScales::default()
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        self.called("events");
        Some(self)
    }

    fn has_edges(&self) -> bool {
        self.called("has_edges");
        true
    }

    fn next_edge(&self, now: f64) -> f64 {
        self.called("next_edge");
        if now < self.parts.push.1 { self.parts.push.1 } else { f64::INFINITY }
    }

    fn objection(&self, _: EvaluationMode) -> Option<Objection> {
        self.called("objection");
        None
    }

    fn departures(&self, _: &State, _: EvaluationMode) -> Vec<Departure> {
        self.called("departures");
        Vec::new()
    }

    fn rhythm(&self) -> Option<Rhythm> {
        self.called("rhythm");
        Some(Rhythm { path: "contacts".to_owned(), angular_frequency: self.parts.rhythm })
    }

    fn remarks(&self, _: &State) -> Vec<String> {
        self.called("remarks");
        vec!["the whole law remarks".to_owned()]
    }

    fn contact_points(&self, _: &State) -> Option<Vec<ContactPoint>> {
        self.called("contact_points");
        Some(Vec::new())
    }

    fn save(&self) -> Memory {
        self.called("save");
        Memory::of(&self.turned)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.called("load");
        self.turned = recall(bytes)?;
        Ok(())
    }

    fn fits(&self, state: &State) -> Result<(), UnfitSnapshot> {
        self.called("fits");
        demand(state.bodies().len() == 1, "the cart of the whole law")
    }

    fn inner(&self) -> Option<&dyn Any> {
        self.called("inner");
        Some(&self.inner)
    }

    fn inner_mut(&mut self) -> Option<&mut dyn Any> {
        self.called("inner_mut");
        Some(&mut self.inner)
    }
}

impl Events for Whole {
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        let (place, velocity) = (state.bodies().position[0], state.bodies().velocity[0]);
        let value = if self.turned { 1.0 } else { -place.x };
        let slope = if self.turned { 0.0 } else { -velocity.x };
        told.push(Indicator::new(value, slope, Bend::AtMost(10.0)));
    }

    fn switch(&mut self, _: &mut State, _: &[usize]) {
        self.turned = true;
    }
}

fn load(method: &str, clock: &str, sensors: &str, parts: Parts) -> (Simulation, Called) {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, {clock} method: {method}), {sensors} contacts: None,
          bodies: [(name: \"cart\", at: (0, 0.0), velocity: (3, 4), atoms: Disc(radius: 0.1, mass: 2))])"
    );
    let called = Called::default();
    let given = called.clone();
    let law = move |app: &mut App| {
        let law = Whole {
            parts,
            called: given.clone(),
            power: 0.0,
            blows: 0,
            after: 0,
            turned: parts.turns == 0.0,
            row: 0,
            inner: 7,
        };
        add_law(app, law);
    };
    let simulation = Simulation::load_with(&Source::new("whole.ron", scene), &Overrides::default(), law)
        .unwrap_or_else(|errors| panic!("{errors}"));
    (simulation, called)
}

const TICK: &str = "tick: 0.001,";

/// The names of the methods of the trait, from its text.
fn methods() -> BTreeSet<String> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/engine/tick/model.rs");
    let text = std::fs::read_to_string(path).unwrap();
    let begin = text.find("pub trait Model").unwrap();
    let text = &text[begin..begin + text[begin..].find("\n}").unwrap()];
    let names = text.lines().filter_map(|line| line.trim_start().strip_prefix("fn ")?.split_once('('));
    names.map(|(name, _)| name.to_owned()).collect()
}

#[test]
fn every_method_of_a_law_from_outside_is_called() {
    let parts = Parts { brake: 1.0, push: (1.0, 0.2), holds: true, strikes: true, ..Parts::default() };
    let mut all = BTreeSet::new();
    for method in ["VelocityVerlet", "Dop853"] {
        let sensors = "sensors: [Force(of: \"cart\", part: Spring)],";
        let (mut simulation, called) = load(method, TICK, sensors, parts);
        simulation.run_to_tick(50).unwrap();
        let snapshot = simulation.snapshot().unwrap();
        simulation.run_to_tick(80).unwrap();
        simulation.restore(&snapshot).unwrap();
        simulation.run_to_end().unwrap();
        let channel = jostle::sensors::find(simulation.world_mut(), "cart.spring_force.y").unwrap();
        let velocity = simulation.bodies().velocity[0].y;
        assert_eq!(simulation.value(&channel), -velocity, "{method}");
        let state = simulation.state();
        assert_eq!(state.contact_law(), Some("Whole"));
        assert_eq!(state.model::<Whole>().unwrap().after, 1, "{method}");
        assert!(state.contact_points().is_some());
        assert!(state.models().any(|model| model.name() == "Whole"));
        assert_eq!(state.model::<u8>(), Some(&7));
        assert!(simulation.bodies().position[0].x.abs() < 1e-15, "{method}: a row holds it");
        let card = simulation.card();
        assert!(card.to_string().contains("the whole law remarks"), "{card}");
        // Forgets nothing from here on: it is the last look.
        let mut state = simulation.world_mut().resource_mut::<State>();
        *state.model_mut::<u8>().unwrap() = 8;
        all.extend(called.lock().unwrap().iter().map(|name| (*name).to_owned()));
    }
    let missing: Vec<String> = methods().into_iter().filter(|name| !all.contains(name)).collect();
    assert!(missing.is_empty() && all.len() > 30, "not called: {missing:?}");
}

#[test]
fn its_account_is_booked() {
    let begin = 0.5 * 2.0 * 25.0;
    for (method, tolerance) in [("VelocityVerlet", 1e-6), ("RungeKutta4", 1e-12), ("Dop853", 1e-12)] {
        let (mut simulation, _) = load(method, TICK, "", Parts { brake: 2.0, ..Parts::default() });
        simulation.run_to_end().unwrap();
        let energy = simulation.card().energy;
        let taken = begin * (1.0 - (-2.0_f64).exp());
        assert!((energy.accounts["sole"] - taken).abs() < tolerance * begin, "{method}: {energy:?}");
        assert!(energy.residual.abs() < tolerance * begin, "{method}: {energy:?}");
    }
}

#[test]
fn its_edges_end_steps() {
    for (force, from) in [(3.0, 0.20371), (-40.0, 0.9003)] {
        let parts = Parts { push: (force, from), ..Parts::default() };
        let (mut simulation, _) = load("Dop853", "tick: 0.1,", "", parts);
        simulation.run_to_end().unwrap();
        let velocity = 3.0 + force * (1.0 - from) * (1.0 - from) / 4.0;
        assert!((simulation.bodies().velocity[0].x - velocity).abs() < 1e-13, "{}", simulation.card());
    }
}

/// The cart turns round at x = 0 again and again no more: one event. From there it has the opposite force.
#[test]
fn its_events_are_located() {
    for force in [1.0, 0.3] {
        let parts = Parts { turns: force, ..Parts::default() };
        let (mut simulation, _) = load("Dop853", "tick: 0.1,", "", parts);
        let world = simulation.world_mut();
        let entity = world.resource::<State>().bodies().entity[0];
        world.get_mut::<jostle::world::Position>(entity).unwrap().0.x = -1.0;
        simulation.run_to_end().unwrap();
        // 1 = 3 t + a t^2/2 ends the way to the event.
        let a = force / 2.0;
        let time = (-3.0 + (9.0 + 2.0 * a).sqrt()) / a;
        let (left, velocity) = (1.0 - time, 3.0 + a * time);
        let place = velocity * left - 0.5 * a * left * left;
        assert!((simulation.bodies().position[0].x - place).abs() < 1e-13, "{}", simulation.card());
        assert!(simulation.state().located().count > 0);
    }
}

#[test]
fn its_rhythm_bounds_the_tick() {
    for frequency in [200.0, 3000.0] {
        let (simulation, _) = load("VelocityVerlet", "", "", Parts { rhythm: frequency, ..Parts::default() });
        let tick = simulation.clock().dt;
        let wanted = PI / (40.0 * frequency);
        // Rounded down to a first digit of 1, 2 or 5.
        assert!(tick <= wanted && tick > wanted / 2.6, "{tick} {wanted}");
    }
}

/// Forces that are added later act before the law: contact laws are last.
#[test]
fn it_acts_behind_models_that_come_later() {
    use jostle::tick::TickAppExt;
    struct Late;
    impl Model for Late {
        fn name(&self) -> &'static str {
            "Late"
        }
        fn energies(&self, _: &State) -> Energies {
            Energies::default()
        }
        fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}
    }
    let law = |app: &mut App| {
        let (parts, called) = (Parts::default(), Called::default());
        add_law(app, Whole { parts, called, power: 0.0, blows: 0, after: 0, turned: true, row: 0, inner: 0 });
        app.add_model(Late);
    };
    let scene = "Scene(format: 1, clock: (duration: 1), contacts: None, bodies: [(name: \"cart\", at: (0, 0), atoms: Disc(radius: 0.1))])";
    let simulation = Simulation::load_with(&Source::new("late.ron", scene), &Overrides::default(), law).unwrap();
    let names: Vec<&str> = simulation.state().models().map(Model::name).collect();
    let place = |name: &str| names.iter().position(|own| *own == name).unwrap();
    assert!(place("Late") < place("Whole"), "{names:?}");
}
