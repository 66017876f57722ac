//! What models have beside forces in methods that take several stages per step, wherever their state is: in the world, told by
//! the functions of [`Models`], or held by their [`Part`](super::direct::Part).

use bevy_ecs::prelude::*;

use super::direct::State;
use super::{Indicator, Models, Responses, StateBlock, Style, Tick, Watch};
use crate::tick::bounds::Bounds;

/// The direct form of what a model registers in [`Models`]: state of its own and one [`Watch`], a handover and a crowd.
pub(crate) trait Stages {
    /// How many [`StateBlock`]s it has.
    fn blocks(&self) -> usize;

    /// See [`StateBlock::length`].
    fn length(&self, block: usize) -> usize;

    /// See [`StateBlock::read`].
    fn read(&self, block: usize, numbers: &mut [f64]);

    /// See [`StateBlock::write`].
    fn write(&mut self, block: usize, numbers: &[f64]);

    /// See [`StateBlock::rates`].
    fn rates(&self, block: usize, state: &State, rates: &mut [f64]);

    /// See [`Watch::tell`].
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>);

    /// See [`Watch::switch`].
    fn switch(&mut self, state: &mut State, fired: &[usize]);

    /// See [`Watch::settle`].
    fn settle(&mut self, state: &State) -> bool;

    /// See [`Watch::take_stock`].
    fn take_stock(&mut self, state: &State);

    /// See [`Watch::tidy`].
    fn tidy(&mut self, state: &mut State) -> bool;

    /// See [`Models::handovers`].
    fn hand_over(&mut self, state: &State, style: Style);

    /// See [`Models::crowds`].
    fn is_crowded(&self) -> bool;
}

/// A model that is watched.
pub(super) enum Watched<'a> {
    World(&'a mut World, Watch),
    Held(&'a mut dyn Stages, &'a mut State),
}

impl Watched<'_> {
    pub fn tell(self, told: &mut Vec<Indicator>) {
        match self {
            Self::World(world, watch) => (watch.tell)(world, told),
            Self::Held(stages, state) => stages.tell(state, told),
        }
    }

    pub fn switch(self, fired: &[usize]) {
        match self {
            Self::World(world, watch) => (watch.switch)(world, fired),
            Self::Held(stages, state) => stages.switch(state, fired),
        }
    }

    pub fn settle(self) -> bool {
        match self {
            Self::World(world, watch) => (watch.settle)(world),
            Self::Held(stages, state) => stages.settle(state),
        }
    }

    pub fn take_stock(self) {
        match self {
            Self::World(world, watch) => (watch.take_stock)(world),
            Self::Held(stages, state) => stages.take_stock(state),
        }
    }

    pub fn tidy(self) -> bool {
        match self {
            Self::World(world, watch) => (watch.tidy)(world),
            Self::Held(stages, state) => stages.tidy(state),
        }
    }
}

/// State that a model keeps of its own.
pub(super) enum Block<'a> {
    World(&'a mut World, StateBlock),
    Held(&'a mut dyn Stages, &'a State, usize),
}

impl Block<'_> {
    pub fn length(self) -> usize {
        match self {
            Self::World(world, block) => (block.length)(world),
            Self::Held(stages, _, block) => stages.length(block),
        }
    }

    pub fn read(self, numbers: &mut [f64]) {
        match self {
            Self::World(world, block) => (block.read)(world, numbers),
            Self::Held(stages, _, block) => stages.read(block, numbers),
        }
    }

    pub fn write(self, numbers: &[f64]) {
        match self {
            Self::World(world, block) => (block.write)(world, numbers),
            Self::Held(stages, _, block) => stages.write(block, numbers),
        }
    }

    pub fn rates(self, rates: &mut [f64]) {
        match self {
            Self::World(world, block) => (block.rates)(world, rates),
            Self::Held(stages, state, block) => stages.rates(block, state, rates),
        }
    }
}

impl Tick<'_> {
    /// Shows all models that are watched, in the order of registration.
    pub(super) fn each_watched(&mut self, mut see: impl FnMut(Watched)) {
        if let Some(direct) = &mut self.direct {
            return direct.each_staged(|stages, state| see(Watched::Held(stages, state)));
        }
        let mut place = 0;
        while let Some(&watch) = self.world.resource::<Models>().watches.get(place) {
            see(Watched::World(self.world, watch));
            place += 1;
        }
    }

    /// Shows all state of models' own, in the order of registration.
    pub(super) fn each_block(&mut self, mut see: impl FnMut(Block)) {
        if let Some(direct) = &mut self.direct {
            return direct.each_staged(|stages, state| {
                (0..stages.blocks()).for_each(|block| see(Block::Held(stages, state, block)));
            });
        }
        let mut place = 0;
        while let Some(&block) = self.world.resource::<Models>().blocks.get(place) {
            see(Block::World(self.world, block));
            place += 1;
        }
    }

    /// Whether some model is watched.
    pub(super) fn is_watched(&mut self) -> bool {
        match &mut self.direct {
            Some(direct) => direct.has_stages(),
            None => !self.world.resource::<Models>().watches.is_empty(),
        }
    }

    /// Whether a model holds more than can be resolved exactly in steps from event to event.
    pub(crate) fn is_crowded(&mut self) -> bool {
        if let Some(direct) = &mut self.direct {
            let mut crowded = false;
            direct.each_staged(|stages, _| crowded |= stages.is_crowded());
            return crowded;
        }
        self.world.resource::<Models>().crowds.iter().any(|crowded| crowded(self.world))
    }

    /// What changes in models when states become stages of steps, or follow one another from now on.
    pub(super) fn hand_over(&mut self, style: Style) {
        if let Some(direct) = &mut self.direct {
            return direct.each_staged(|stages, state| stages.hand_over(state, style));
        }
        let models = self.world.resource::<Models>().handovers.clone();
        models.into_iter().for_each(|handover| handover(self.world, style));
    }

    /// How fast models respond, as far as it was measured.
    pub(crate) fn responses(&self) -> Responses {
        match &self.direct {
            Some(direct) => direct.responses(),
            None => Responses::of(self.world),
        }
    }

    /// Bounding boxes, where there are any.
    pub(crate) fn bounds(&self) -> Option<&Bounds> {
        match &self.direct {
            Some(direct) => direct.state.bounds.as_ref(),
            None => self.world.get_resource(),
        }
    }

    /// Bounding boxes, where there are any, to be changed.
    pub(crate) fn bounds_mut(&mut self) -> Option<&mut Bounds> {
        match &mut self.direct {
            Some(direct) => direct.state.bounds.as_mut(),
            None => self.world.get_resource_mut().map(Mut::into_inner),
        }
    }
}
