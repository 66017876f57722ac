//! Expectations: claims of a scene about its physics, one kind per file. They are checked during the run.

mod at_rest;
mod channel;
mod inside;
mod position;

use std::cell::OnceCell;

use bevy_app::App;
use bevy_ecs::prelude::*;
use serde::Serialize;

use crate::scene::{Arity, SceneAppExt};
use crate::tick::energy::EnergyLedger;
use crate::tick::snapshot::{Memory, UnfitSnapshot, Unsaved, demand};
use crate::tick::{State, add_looker, read_forces_at_ends};
use crate::world::Bodies;

/// The view of an expectation.
pub struct Sight<'a> {
    /// The world, for expectations that need it.
    world: Option<&'a World>,
    /// The state of the run.
    pub state: &'a State,
    /// All bodies.
    pub bodies: &'a Bodies,
    /// The time of the state in seconds.
    pub time: f64,
    /// The energy ledger, once an expectation has asked for it.
    energy: OnceCell<EnergyLedger>,
}

impl<'a> Sight<'a> {
    fn of(state: &'a State, world: Option<&'a World>) -> Self {
        Self { world, state, bodies: &state.bodies, time: state.clock.time(), energy: OnceCell::new() }
    }

    /// Whether a moment in s has come. The time of a tick is a product, so that its last digit may be below.
    pub fn has_reached(&self, moment: f64) -> bool {
        self.time >= moment * (1.0 - 2.0 * f64::EPSILON)
    }

    /// The energy ledger.
    pub fn energy(&self) -> &EnergyLedger {
        self.energy.get_or_init(|| EnergyLedger::of(self.state))
    }

    /// The world, for channels.
    ///
    /// # Panics
    /// If [`Watch::needs_world`] is false.
    pub fn world(&self) -> &'a World {
        self.world.expect("an expectation that looks at the world says so in `needs_world`")
    }
}

/// An observer of a run that finally decides whether its claim holds.
pub trait Watch: Send + Sync + 'static {
    /// Looks at a state.
    fn observe(&mut self, sight: &Sight);

    /// It looks at the beginning, after every so many ticks, and at the end.
    fn every(&self) -> u64 {
        1
    }

    /// Whether it looks at [`Sight::world`], which takes longer. Default: no.
    fn needs_world(&self) -> bool {
        false
    }

    /// Whether it claims a property of all times but checks only some of them.
    fn samples(&self) -> bool {
        true
    }

    /// Its memory so far. Default: unknown, and snapshots refuse.
    fn save(&self) -> Memory {
        Memory::Untold
    }

    /// Goes on from what [`Watch::save`] gave. Called only if that gave bytes.
    ///
    /// # Errors
    /// If the bytes are not its own.
    fn load(&mut self, _: &[u8]) -> Result<(), UnfitSnapshot> {
        Ok(())
    }

    /// Whether it holds, and the measured value. `None` for the first: the run ended before a decision.
    fn verdict(&self) -> (Option<bool>, String);
}

/// The expectations of the scene, in the order of the file within each kind.
#[derive(Resource, Default)]
pub struct Expectations {
    watches: Vec<(String, Box<dyn Watch>)>,
    /// Whether no tick is left out.
    all_ticks: bool,
}

/// The outcome of an expectation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpectationOutcome {
    /// The expectation in the text of the scene.
    pub text: String,
    /// Whether it held.
    pub holds: bool,
    /// The measured value.
    pub measured: String,
    /// Whether the run lasted long enough to judge it.
    #[serde(skip)]
    pub judged: bool,
}

impl Expectations {
    /// Adds an expectation; the first one of a kind schedules the watching.
    pub fn add(app: &mut App, text: String, watch: impl Watch) {
        let needs_world = watch.needs_world();
        let mut expectations = app.world_mut().get_resource_or_init::<Self>();
        let first = expectations.watches.iter().all(|(_, other)| other.needs_world() != needs_world);
        expectations.watches.push((text, Box::new(watch)));
        match (first, needs_world) {
            (false, _) => {}
            (true, false) => add_looker(app.world_mut(), observe_state),
            (true, true) => {
                add_looker(app.world_mut(), observe_world);
                read_forces_at_ends(app.world_mut());
            }
        }
    }

    /// Whether any claims something of all times.
    pub fn sample(&self) -> bool {
        self.watches.iter().any(|(_, watch)| watch.samples())
    }

    /// Makes all of them check every tick, for runs whose ticks are frames.
    pub fn look_at_all_ticks(&mut self) {
        self.all_ticks = true;
    }

    /// The memories of all of them, as bytes.
    pub(crate) fn save(&self) -> Result<Vec<Option<Vec<u8>>>, Unsaved> {
        self.watches.iter().map(|(text, watch)| watch.save().bytes(|| format!("expect: {text}"))).collect()
    }

    /// Goes on from what [`Expectations::save`] gave.
    pub(crate) fn load(&mut self, saved: &[Option<Vec<u8>>]) -> Result<(), UnfitSnapshot> {
        demand(self.watches.len() == saved.len(), "the expectations")?;
        for ((_, watch), bytes) in self.watches.iter_mut().zip(saved) {
            bytes.as_ref().map_or(Ok(()), |bytes| watch.load(bytes))?;
        }
        Ok(())
    }

    /// The outcome of each expectation so far.
    pub fn outcomes(&self) -> Vec<ExpectationOutcome> {
        let outcome = |(text, watch): &(String, Box<dyn Watch>)| {
            let (holds, mut measured) = watch.verdict();
            if holds.is_none() {
                measured = format!("the run ended too early to judge it; {measured}");
            }
            ExpectationOutcome { text: text.clone(), holds: holds == Some(true), measured, judged: holds.is_some() }
        };
        self.watches.iter().map(outcome).collect()
    }
}

/// Those that need nothing but the state look at it.
fn observe_state(state: Res<State>, expectations: Option<ResMut<Expectations>>) {
    let Some(mut expectations) = expectations else { return };
    let Expectations { watches, all_ticks } = &mut *expectations;
    let sight = Sight::of(&state, None);
    due(watches, *all_ticks, state.clock.ticks).filter(|watch| !watch.needs_world()).for_each(|w| w.observe(&sight));
}

/// The others look at the world.
fn observe_world(world: &mut World) {
    look(world, false, |watch| watch.needs_world());
}

/// All expectations look at the present state: before the first tick, and after the last.
pub fn observe_all(world: &mut World) {
    look(world, true, |_| true);
}

fn look(world: &mut World, all: bool, which: fn(&dyn Watch) -> bool) {
    let Some(mut expectations) = world.get_resource_mut::<Expectations>() else { return };
    let all = all || expectations.all_ticks;
    let mut watches = std::mem::take(&mut expectations.watches);
    let state = world.resource::<State>();
    let sight = Sight::of(state, Some(world));
    due(&mut watches, all, state.clock.ticks).filter(|watch| which(&***watch)).for_each(|watch| watch.observe(&sight));
    world.resource_mut::<Expectations>().watches = watches;
}

/// Those that look after so many ticks.
fn due(watches: &mut [(String, Box<dyn Watch>)], all: bool, ticks: u64) -> impl Iterator<Item = &mut Box<dyn Watch>> {
    watches.iter_mut().map(|(_, watch)| watch).filter(move |watch| all || ticks.is_multiple_of(watch.every()))
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
        "Claims about the run, which make the scene its own test. The commands `run`, `render` and `check --run` check them. \
         They name each broken expectation, and exit with 1. Under a `tolerance` or `method: Reference` ticks are the frames of \
         the film. Expectations for every tick then look at the frames and not between. The card names their distance in time.",
    );
    at_rest::plugin(app);
    channel::plugin(app);
    inside::plugin(app);
    position::plugin(app);
}

/// Places in the packed state of bodies given by their keys; the gone ones are left out.
fn indices<'a>(bodies: &'a Bodies, keys: &'a [u64]) -> impl Iterator<Item = usize> + 'a {
    keys.iter().filter_map(|key| bodies.key.find(*key))
}
