//! What contacts tell methods with several stages: functions that look for contacts in the world, and their direct form.

use bevy_ecs::prelude::*;

use super::apply::PenaltyContacts;
use super::direct::Contacts;
use super::handover;
use super::normal::NormalForce;
use super::rolling::RollingContacts;
use super::switching::{self, View};
use super::{Penalty, RollingLaw, TangentialLaw, rolling_stages};
use crate::contacts::DeepestOverlap;
use crate::contacts::events::Touches;
use crate::tick::direct::{Asked, Direct, State};
use crate::tick::{Clock, Evaluation, Indicator, Ledger, Models, Objection, Stages, StateBlock, Style, Watch};
use crate::world::{Bodies, lend, lend_any};

/// The elongations of all tangential springs that stick.
const ELONGATIONS: StateBlock = StateBlock {
    length: |world| switching::length(world.resource()),
    read: |world, state| switching::read(world.resource(), state),
    write: |world, state| switching::write(&mut world.resource_mut(), state),
    rates: |world, rates| switching::rates((world.resource(), world.resource()), world.resource(), rates),
};

/// The angles of all rolling springs that stick.
const ANGLES: StateBlock = StateBlock {
    length: |world| rolling_stages::length(world.resource(), world.resource()),
    read: |world, state| rolling_stages::read(world.resource(), world.resource(), state),
    write: |world, state| {
        lend(world, |world, rolling| rolling_stages::write(world.resource::<PenaltyContacts>(), rolling, state));
    },
    rates: |world, rates| {
        let springs = (world.resource(), world.resource());
        rolling_stages::rates((world.resource(), world.resource()), springs, rates);
    },
};

/// Registers contacts with this law for methods with several stages.
pub(super) fn install<N: NormalForce>(world: &mut World) {
    let rolls = world.contains_resource::<RollingContacts>();
    let mut models = world.get_resource_or_init::<Models>();
    models.blocks.push(ELONGATIONS);
    if rolls {
        models.blocks.push(ANGLES);
    }
    models.watches.push(Watch {
        tell: tell::<N>,
        switch: switch::<N>,
        settle: |world| view(world, |view| view.settle::<N>()),
        take_stock: |world| view(world, |view| view.take_stock::<N>()),
        tidy,
    });
    models.objections.push(object);
    models.handovers.push(|world, style| {
        let dt = world.resource::<Clock>().dt;
        view(world, |view| handover::hand_over::<N>(view, style, dt));
    });
    models.crowds.push(|world| handover::crowded(world.resource(), world.get_resource()));
    let blocks = 1 + usize::from(rolls);
    let asked = Asked { blocks, watches: 1, handovers: 1, crowds: 1, ..Asked::default() };
    world.get_resource_or_init::<Direct>().answer(asked);
}

/// What these contacts cannot do yet, or cannot do at all.
fn object(world: &World, style: Style) -> Option<Objection> {
    let settings = world.resource::<Penalty>();
    let friction = world.resource::<PenaltyContacts>().materials.any_friction();
    let (path, message, help) = match (style, settings.tangential) {
        (Style::Following, TangentialLaw::Exact) => (
            "contacts.Penalty.tangential",
            "`Exact` friction needs a method that locates events inside a tick",
            "write `clock: (.., method: RungeKutta4)`, `method: Dop853` or `events: Located`; or `tangential: Spring(ratio: 0.8)`",
        ),
        (Style::Instant, TangentialLaw::Spring { .. }) if friction => (
            "clock.events",
            "tangential springs need their events located under a method with several stages",
            "write `events: Located`, or `tangential: Exact` or `None`, or `method: VelocityVerlet`",
        ),
        (Style::Instant, _) if settings.rolling != RollingLaw::None => (
            "clock.events",
            "rolling springs need their events located under a method with several stages",
            "write `events: Located`, or `rolling: None`, or `method: VelocityVerlet`",
        ),
        _ => return None,
    };
    Some(Objection { path, message: message.to_owned(), help })
}

/// All candidate pairs of the world.
fn view<R>(world: &mut World, see: impl FnOnce(&mut View) -> R) -> R {
    lend(world, |world, contacts: &mut PenaltyContacts| {
        lend_any(world, |world, rolling: Option<&mut RollingContacts>| {
            see(&mut View { bodies: world.resource(), pairs: world.resource(), contacts, rolling })
        })
    })
}

fn tell<N: NormalForce>(world: &mut World, told: &mut Vec<Indicator>) {
    let mut contacts = world.resource_mut::<PenaltyContacts>();
    if contacts.is_idle() {
        return contacts.told.clear();
    }
    view(world, |view| view.tell::<N>(told));
}

fn switch<N: NormalForce>(world: &mut World, fired: &[usize]) {
    let dt = world.resource::<Clock>().dt;
    lend(world, |world, ledger: &mut Ledger| {
        lend(world, |world, bodies: &mut Bodies| {
            switching::stand_still((bodies, ledger), &mut world.resource_mut(), dt);
        });
        lend_any(world, |world, touches: Option<&mut Touches>| {
            view(world, |view| view.switch::<N>(fired, ledger, touches));
        });
    });
}

fn tidy(world: &mut World) -> bool {
    if world.resource::<PenaltyContacts>().is_idle() {
        return false;
    }
    let times = (world.resource::<Evaluation>().time, world.resource::<Clock>().dt);
    lend(world, |world, bodies: &mut Bodies| {
        lend(world, |world, ledger: &mut Ledger| {
            lend(world, |world, deepest: &mut DeepestOverlap| {
                lend(world, |world, contacts: &mut PenaltyContacts| {
                    lend_any(world, |world, rolling: Option<&mut RollingContacts>| {
                        switching::tidy((bodies, ledger), times, (world.resource(), contacts, rolling), deepest)
                    })
                })
            })
        })
    })
}

impl<N: NormalForce> Contacts<N> {
    fn view<'a>(&'a mut self, bodies: &'a Bodies) -> View<'a> {
        View { bodies, pairs: &self.pairs, contacts: &mut self.contacts, rolling: self.rolling.as_mut() }
    }
}

/// Elongations first, then angles if there are rolling springs.
impl<N: NormalForce> Stages for Contacts<N> {
    fn blocks(&self) -> usize {
        1 + usize::from(self.rolling.is_some())
    }

    fn length(&self, block: usize) -> usize {
        match &self.rolling {
            Some(rolling) if block > 0 => rolling_stages::length(&self.contacts, rolling),
            _ => switching::length(&self.contacts),
        }
    }

    fn read(&self, block: usize, numbers: &mut [f64]) {
        match &self.rolling {
            Some(rolling) if block > 0 => rolling_stages::read(&self.contacts, rolling, numbers),
            _ => switching::read(&self.contacts, numbers),
        }
    }

    fn write(&mut self, block: usize, numbers: &[f64]) {
        match &mut self.rolling {
            Some(rolling) if block > 0 => rolling_stages::write(&self.contacts, rolling, numbers),
            _ => switching::write(&mut self.contacts, numbers),
        }
    }

    fn rates(&self, block: usize, state: &State, rates: &mut [f64]) {
        let seen = (&state.bodies, &self.pairs);
        match &self.rolling {
            Some(rolling) if block > 0 => rolling_stages::rates(seen, (&self.contacts, rolling), rates),
            _ => switching::rates(seen, &self.contacts, rates),
        }
    }

    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        if self.contacts.is_idle() {
            return self.contacts.told.clear();
        }
        self.view(&state.bodies).tell::<N>(told);
    }

    fn switch(&mut self, state: &mut State, fired: &[usize]) {
        let Self { pairs, contacts, rolling, touches, .. } = self;
        switching::stand_still((&mut state.bodies, &mut state.ledger), contacts, state.clock.dt);
        let mut view = View { bodies: &state.bodies, pairs, contacts, rolling: rolling.as_mut() };
        view.switch::<N>(fired, &mut state.ledger, touches.as_mut());
    }

    fn settle(&mut self, state: &State) -> bool {
        self.view(&state.bodies).settle::<N>()
    }

    fn take_stock(&mut self, state: &State) {
        self.view(&state.bodies).take_stock::<N>();
    }

    fn tidy(&mut self, state: &mut State) -> bool {
        let Self { pairs, contacts, rolling, deepest, .. } = self;
        let times = (state.evaluation.time, state.clock.dt);
        let own = (&*pairs, &mut *contacts, rolling.as_mut());
        !own.1.is_idle() && switching::tidy((&mut state.bodies, &mut state.ledger), times, own, deepest)
    }

    fn hand_over(&mut self, state: &State, style: Style) {
        handover::hand_over::<N>(&mut self.view(&state.bodies), style, state.clock.dt);
    }

    fn is_crowded(&self) -> bool {
        handover::crowded(&self.contacts, self.rolling.as_ref())
    }
}
