//! Expectations: what a scene claims about its own physics. Each file one kind; checked while the run goes on.

mod at_rest;
mod channel;
mod inside;
mod position;

use bevy_app::App;
use bevy_ecs::prelude::*;
use serde::Serialize;

use crate::scene::{Arity, SceneAppExt};
use crate::tick::direct::{Accounts, Direct, Observer, State, exchange};
use crate::tick::energy::EnergyLedger;
use crate::tick::registered::Registered;
use crate::tick::{Clock, SimTick, Stage, TickAppExt};
use crate::world::Bodies;

/// What an expectation sees.
pub struct Sight<'a> {
    /// The world, for channels; of no use to those that say that they do not need it.
    pub world: &'a World,
    /// The state.
    pub bodies: &'a Bodies,
    /// Its time in seconds.
    pub time: f64,
    pub(crate) accounts: Accounts<'a>,
}

impl Sight<'_> {
    /// The energy ledger.
    pub fn energy(&self) -> EnergyLedger {
        EnergyLedger::with(self.accounts.totals(), self.accounts.ledger())
    }
}

/// Something that watches a run and says in the end whether it held.
pub trait Watch: Send + Sync + 'static {
    /// Looks at a state.
    fn observe(&mut self, sight: &Sight);

    /// It looks at the beginning, after every so many ticks, and at the end.
    fn every(&self) -> u64 {
        1
    }

    /// Whether it looks at [`Sight::world`].
    fn needs_world(&self) -> bool {
        true
    }

    /// Whether it claims something of all times, which it knows only at those at which it looks.
    fn samples(&self) -> bool {
        true
    }

    /// Whether it held, and what was measured. `None` for the first: the run ended before it could be judged.
    fn verdict(&self) -> (Option<bool>, String);
}

/// The expectations of the scene, in the order of the file within each kind.
#[derive(Resource, Default)]
pub struct Expectations {
    watches: Vec<(String, Box<dyn Watch>)>,
    /// Whether no tick is left out.
    all_ticks: bool,
}

/// How an expectation went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The expectation as it stands in the scene.
    pub text: String,
    /// Whether it held.
    pub holds: bool,
    /// What was measured.
    pub measured: String,
    /// Whether the run lasted long enough to judge it.
    #[serde(skip)]
    pub judged: bool,
}

impl Expectations {
    /// Adds an expectation; the first one schedules the watching.
    pub fn add(app: &mut App, text: String, watch: impl Watch) {
        if !app.world().contains_resource::<Self>() {
            app.init_resource::<Self>();
            let mark = Registered::mark(app.world());
            app.add_packed_systems(SimTick, observe_tick.in_set(Stage::Observe));
            Direct::add_observer(app.world_mut(), mark, Watcher::default());
        }
        app.world_mut().resource_mut::<Self>().watches.push((text, Box::new(watch)));
    }

    /// Whether any claims something of all times.
    pub fn sample(&self) -> bool {
        self.watches.iter().any(|(_, watch)| watch.samples())
    }

    /// From now on none leaves a tick out, as where ticks are frames.
    pub fn look_at_all_ticks(&mut self) {
        self.all_ticks = true;
    }

    /// How each expectation went so far.
    pub fn outcomes(&self) -> Vec<Outcome> {
        let outcome = |(text, watch): &(String, Box<dyn Watch>)| {
            let (holds, mut measured) = watch.verdict();
            if holds.is_none() {
                measured = format!("the run ended before it could be judged; {measured}");
            }
            Outcome { text: text.clone(), holds: holds == Some(true), measured, judged: holds.is_some() }
        };
        self.watches.iter().map(outcome).collect()
    }
}

fn observe_tick(world: &mut World) {
    look(world, false);
}

/// All expectations look at the present state: before the first tick, and after the last.
pub fn observe_all(world: &mut World) {
    look(world, true);
}

fn look(world: &mut World, all: bool) {
    let Some(mut expectations) = world.get_resource_mut::<Expectations>() else { return };
    let all = all || expectations.all_ticks;
    let mut watches = std::mem::take(&mut expectations.watches);
    let clock = *world.resource::<Clock>();
    let sight =
        Sight { world, bodies: world.resource::<Bodies>(), time: clock.time(), accounts: Accounts::World(world) };
    for watch in due(&mut watches, all, clock.ticks) {
        watch.observe(&sight);
    }
    world.resource_mut::<Expectations>().watches = watches;
}

/// Those that look after so many ticks.
fn due(watches: &mut [(String, Box<dyn Watch>)], all: bool, ticks: u64) -> impl Iterator<Item = &mut Box<dyn Watch>> {
    watches.iter_mut().map(|(_, watch)| watch).filter(move |watch| all || ticks.is_multiple_of(watch.every()))
}

/// The direct form.
#[derive(Default)]
struct Watcher(Expectations);

impl Observer for Watcher {
    fn exchange(&mut self, world: &mut World) {
        exchange(world, &mut self.0);
    }

    fn observe(&mut self, state: &State, accounts: Accounts, world: &World) -> bool {
        let Expectations { watches, all_ticks } = &mut self.0;
        if due(watches, *all_ticks, state.clock.ticks).any(|watch| watch.needs_world()) {
            return false;
        }
        let sight = Sight { world, bodies: &state.bodies, time: state.clock.time(), accounts };
        due(watches, *all_ticks, state.clock.ticks).for_each(|watch| watch.observe(&sight));
        true
    }

    fn observe_world(&mut self, world: &mut World) {
        observe_tick(world);
    }
}

/// Registers the expectations of this folder.
pub fn plugin(app: &mut App) {
    app.register_entry_section(
        "expect",
        Arity::List,
        "expect: [Position(of: \"ball\", at: 2, is: (2, 0.2), within: 1e-3)]",
    );
    app.describe_section(
        "expect",
        "What has to be true of the run: the scene is its own test. Checked by `run`, `render` and `check --run`; an \
         expectation that is broken is told, and the exit code is 1. Under a `tolerance` or `method: Reference` ticks are the \
         frames of the film: what has to hold at every tick is looked at there and not between, and the card says how far \
         apart they are.",
    );
    at_rest::plugin(app);
    channel::plugin(app);
    inside::plugin(app);
    position::plugin(app);
}

/// Places in the packed state of bodies given by their keys; the gone ones are left out.
fn places<'a>(bodies: &'a Bodies, keys: &'a [u64]) -> impl Iterator<Item = usize> + 'a {
    keys.iter().filter_map(|key| bodies.key.find(*key))
}
