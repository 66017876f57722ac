//! Ticks without schedules.
//!
//! To look a resource up takes some hundred instructions, to have a system run some hundred more: in a world of a few bodies
//! that is nearly as much as its physics. So models of the engine have a *direct form* beside their systems: a [`Part`], which
//! owns what it works on while ticks run. Where the parts stand for every system of the three schedules, and for all that models
//! tell methods with several stages, a batch of ticks takes the state out of the world once and calls one part after the other.
//! A system or a watch more, whoever wrote it, and all ticks go through the schedules.
//!
//! Both ways call the same functions in the same order, so not a bit of the state depends on which is taken.

use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::Schedule;

use super::balance::{EnergyTerms, Totals};
use super::drive::Drive;
use super::registered::Registered;
use super::stages::Stages;
use super::stopwatch::{self, Stopwatch};
use super::{Balance, Clock, EvaluateStage, Evaluation, Ledger, Models, Responses, Span, Stability};
use crate::tick::bounds::Bounds;
use crate::world::Bodies;

/// What every part works on. While it is here, the world holds nothing of it.
#[derive(Default)]
pub(crate) struct State {
    pub bodies: Bodies,
    pub balance: Balance,
    pub ledger: Ledger,
    pub evaluation: Evaluation,
    pub span: Span,
    pub clock: Clock,
    /// Where pairs are searched for.
    pub bounds: Option<Bounds>,
    pub(super) drive: Drive,
    stopwatch: Option<Stopwatch>,
}

impl State {
    fn exchange(&mut self, world: &mut World) {
        self.bodies.catch_up();
        exchange(world, &mut self.bodies);
        exchange(world, &mut self.balance);
        exchange(world, &mut self.ledger);
        exchange(world, &mut self.evaluation);
        exchange(world, &mut self.span);
        exchange(world, &mut self.clock);
        exchange_any(world, &mut self.bounds);
        exchange(world, &mut self.drive);
    }

    /// From now on the time counts for another part of the tick, if it is measured.
    #[inline]
    pub fn turn_to(&mut self, part: stopwatch::Part) {
        if let Some(stopwatch) = &mut self.stopwatch {
            stopwatch.turn_to(part);
        }
    }
}

/// A resource and what is held of it change places: to take it out of the world, and to give it back.
pub(crate) fn exchange<R: Resource<Mutability = Mutable>>(world: &mut World, held: &mut R) {
    std::mem::swap(held, &mut *world.resource_mut::<R>());
}

/// The same for a resource that may not be there.
pub(crate) fn exchange_any<R: Resource<Mutability = Mutable> + Default>(world: &mut World, held: &mut Option<R>) {
    *held =
        world.get_resource_mut::<R>().map(|mut there| std::mem::replace(&mut *there, held.take().unwrap_or_default()));
}

/// The direct form of the systems of a model.
pub(crate) trait Part: Send + Sync + 'static {
    /// Takes resources of its own out of the world, or gives them back: each changes places with what is held of it.
    fn exchange(&mut self, _: &mut World) {}

    /// What its systems in [`Modes`](super::Modes) do.
    fn choose_modes(&mut self, _: &mut State) {}

    /// What its systems do in a stage of [`Evaluate`](super::Evaluate).
    fn evaluate(&mut self, _: EvaluateStage, _: &mut State) {}

    /// What it adds to [`EnergyTerms`].
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    /// What it tells methods that take several stages per step, if anything.
    fn stages(&mut self) -> Option<&mut dyn Stages> {
        None
    }

    /// What it adds to [`Stability::sources`].
    fn responses(&self) -> Responses {
        Responses::default()
    }
}

/// Energies in J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// In fields.
    pub potential: f64,
    /// In springs and contacts.
    pub elastic: f64,
}

/// The direct form of a system in [`Stage::Observe`](super::Stage::Observe).
pub(crate) trait Observer: Send + Sync + 'static {
    /// See [`Part::exchange`].
    fn exchange(&mut self, _: &mut World);

    /// Looks at the new state. If it has to see the whole world it does nothing and says so; then [`Observer::observe_world`] is
    /// called with all state in its place.
    fn observe(&mut self, state: &State, accounts: Accounts, world: &World) -> bool;

    /// Looks at the new state in the world.
    fn observe_world(&mut self, _: &mut World) {}
}

/// The accounts of the present state, wherever it is.
#[derive(Clone, Copy)]
pub(crate) enum Accounts<'a> {
    World(&'a World),
    Held(&'a State, &'a [Box<dyn Part>]),
}

impl<'a> Accounts<'a> {
    /// Energies and momenta.
    pub fn totals(self) -> Totals {
        let (state, parts) = match self {
            Self::World(world) => return Totals::of(world),
            Self::Held(state, parts) => (state, parts),
        };
        let mut sum = Energies::default();
        for part in parts {
            let Energies { potential, elastic } = part.energies(state);
            sum.potential += potential;
            sum.elastic += elastic;
        }
        Totals::with(&state.bodies, sum.potential, sum.elastic)
    }

    /// What has gone in and out.
    pub fn ledger(self) -> &'a Ledger {
        match self {
            Self::World(world) => world.resource(),
            Self::Held(state, _) => &state.ledger,
        }
    }
}

/// How many energies there are in [`EnergyTerms`], and what else is asked of models inside a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Asked {
    pub energies: usize,
    /// See [`Models::blocks`].
    pub blocks: usize,
    /// Watches, edges, handovers and crowds of [`Models`].
    pub watches: usize,
    pub edges: usize,
    pub handovers: usize,
    pub crowds: usize,
    /// See [`Stability::sources`].
    pub sources: usize,
}

impl Asked {
    /// What is asked of all models of a world.
    fn of(world: &World) -> Self {
        let terms = world.get_resource::<EnergyTerms>();
        let energies = terms.map_or(0, |terms| terms.potential.len() + terms.elastic.len());
        let models = world.resource::<Models>();
        Self {
            energies,
            blocks: models.blocks.len(),
            watches: models.watches.len(),
            edges: models.edges.len(),
            handovers: models.handovers.len(),
            crowds: models.crowds.len(),
            sources: world.resource::<Stability>().sources.len(),
        }
    }
}

/// Whether there is a part for each of the systems in the schedules of ticks, evaluations and modes, and for all else that models
/// are asked.
pub(crate) fn stands_for_all(world: &World, schedules: [&Schedule; 3]) -> bool {
    world.resource::<Direct>().asked == Asked::of(world) && world.resource::<Registered>().all_direct(schedules)
}

/// The parts of a world, and what they work on.
#[derive(Resource, Default)]
pub(crate) struct Direct {
    pub state: Box<State>,
    parts: Vec<Box<dyn Part>>,
    observers: Vec<Box<dyn Observer>>,
    /// What the parts answer besides systems.
    asked: Asked,
}

impl Direct {
    /// Adds a part that stands for the systems registered since the `mark`.
    pub fn add(world: &mut World, mark: usize, asked: Asked, part: impl Part) {
        Registered::cover(world, mark);
        let mut direct = world.get_resource_or_init::<Self>();
        direct.parts.push(Box::new(part));
        direct.answer(asked);
    }

    /// Adds the direct form of the system in [`Stage::Observe`](super::Stage::Observe) registered since the `mark`.
    pub fn add_observer(world: &mut World, mark: usize, observer: impl Observer) {
        Registered::cover(world, mark);
        world.get_resource_or_init::<Self>().observers.push(Box::new(observer));
    }

    /// So much more is answered.
    pub fn answer(&mut self, asked: Asked) {
        self.asked.energies += asked.energies;
        self.asked.blocks += asked.blocks;
        self.asked.watches += asked.watches;
        self.asked.edges += asked.edges;
        self.asked.handovers += asked.handovers;
        self.asked.crowds += asked.crowds;
        self.asked.sources += asked.sources;
    }

    /// Takes the state out of the world while `see` goes on.
    pub fn hold<U>(&mut self, world: &mut World, see: impl FnOnce(&mut World, &mut Self) -> U) -> U {
        self.exchange(world);
        self.state.stopwatch = world.remove_resource();
        let seen = see(world, self);
        if let Some(stopwatch) = self.state.stopwatch.take() {
            world.insert_resource(stopwatch);
        }
        self.exchange(world);
        seen
    }

    /// Shows the world with all state in its place, while it is held.
    pub fn show<U>(&mut self, world: &mut World, see: impl FnOnce(&mut World) -> U) -> U {
        self.exchange(world);
        let seen = see(world);
        self.exchange(world);
        seen
    }

    fn exchange(&mut self, world: &mut World) {
        self.state.exchange(world);
        for part in &mut self.parts {
            part.exchange(world);
        }
        for observer in &mut self.observers {
            observer.exchange(world);
        }
    }

    /// What [`Modes`](super::Modes) does.
    pub fn choose_modes(&mut self) {
        use stopwatch::Part::{Integrate, ModesOfContacts};
        self.state.turn_to(ModesOfContacts);
        for part in &mut self.parts {
            part.choose_modes(&mut self.state);
        }
        self.state.turn_to(Integrate);
    }

    /// What [`Evaluate`](super::Evaluate) does.
    pub fn evaluate(&mut self) {
        use stopwatch::Part as Timed;
        let stages = [
            (Timed::Bounds, EvaluateStage::Bounds),
            (Timed::Forces, EvaluateStage::Forces),
            (Timed::Search, EvaluateStage::Contacts),
            (Timed::Joints, EvaluateStage::Joints),
        ];
        for (timed, stage) in stages {
            self.state.turn_to(timed);
            for part in &mut self.parts {
                part.evaluate(stage, &mut self.state);
            }
        }
        self.state.turn_to(Timed::Integrate);
    }

    /// Shows what parts tell methods that take several stages per step.
    pub fn each_staged(&mut self, mut see: impl FnMut(&mut dyn Stages, &mut State)) {
        for part in &mut self.parts {
            if let Some(stages) = part.stages() {
                see(stages, &mut self.state);
            }
        }
    }

    /// Whether any part has something to tell them.
    pub fn has_stages(&mut self) -> bool {
        self.parts.iter_mut().any(|part| part.stages().is_some())
    }

    /// How fast parts respond, as far as it was measured.
    pub fn responses(&self) -> Responses {
        Responses::of_all(self.parts.iter().map(|part| part.responses()))
    }

    /// What [`Stage::Observe`](super::Stage::Observe) does.
    pub fn observe(&mut self, world: &mut World) {
        self.state.turn_to(stopwatch::Part::Observe);
        if !self.observers.is_empty() {
            self.state.bodies.catch_up();
        }
        for number in 0..self.observers.len() {
            let accounts = Accounts::Held(&self.state, &self.parts);
            if !self.observers[number].observe(&self.state, accounts, world) {
                self.exchange(world);
                self.observers[number].observe_world(world);
                self.exchange(world);
            }
        }
        self.state.turn_to(stopwatch::Part::Between);
    }
}

/// State that is looked up in the world, unless a [`State`] holds it.
pub(crate) trait Held: Resource<Mutability = Mutable> {
    fn of(state: &State) -> &Self;
    fn of_mut(state: &mut State) -> &mut Self;
}

macro_rules! held {
    ($($type:ty: $field:ident),*) => {
        $(impl Held for $type {
            #[inline(always)]
            fn of(state: &State) -> &Self {
                &state.$field
            }

            #[inline(always)]
            fn of_mut(state: &mut State) -> &mut Self {
                &mut state.$field
            }
        })*
    };
}

held!(Bodies: bodies, Balance: balance, Ledger: ledger, Evaluation: evaluation, Span: span, Clock: clock, Drive: drive);

/// State wherever it is.
#[inline(always)]
pub(super) fn held<'a, R: Held>(world: &'a World, direct: Option<&'a Direct>) -> &'a R {
    match direct {
        Some(direct) => R::of(&direct.state),
        None => world.resource(),
    }
}

/// State wherever it is, to be changed.
#[inline(always)]
pub(super) fn held_mut<'a, R: Held>(world: &'a mut World, direct: Option<&'a mut Direct>) -> &'a mut R {
    match direct {
        Some(direct) => R::of_mut(&mut direct.state),
        None => world.resource_mut::<R>().into_inner(),
    }
}

#[cfg(test)]
mod tests;
