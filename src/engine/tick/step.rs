//! A tick.

use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut};
use bevy_ecs::prelude::*;

use super::batch::{Others, Running, take_up};
use super::context::{Tick, Users};
use super::failure::{Failure, FailureKind, Trouble};
use super::flight_permission;
use super::looks::Lookers;
use super::stopwatch::TickPart;
use super::{Method, State};
use crate::world::{Name, finite};

/// The system of [`Stage::Integrate`].
pub(super) fn integrate(mut state: ResMut<State>) {
    // Systems of users may have written to the lists. To look at them is no change.
    let alone = state.progress.running.as_ref().is_some_and(|running| running.alone);
    if !alone && state.bypass_change_detection().heal() {
        return;
    }
    let changed = state.last_changed();
    state.see_writers(changed);
    state.integrate(None);
    let changed = state.last_changed();
    state.note_looks(changed);
}

/// The system of [`Stage::Integrate`] in runs with systems of users in the tick or in evaluations. Runs with sensors that look
/// inside ticks have it too.
pub(super) fn integrate_among_systems(world: &mut World) {
    let changed = world.resource_ref::<State>().last_changed();
    world.resource_mut::<State>().see_writers(changed);
    world.resource_mut::<State>().bypass_change_detection().heal();
    if world.resource::<Others>().in_tick {
        take_up(world);
    }
    if world.resource::<State>().progress.trouble.is_some() {
        return;
    }
    let mut state = std::mem::take(&mut *world.resource_mut::<State>());
    state.integrate(Some(world));
    *world.resource_mut::<State>() = state;
    flight_permission::note_looks(world);
}

impl State {
    /// A tick. `world` is there if systems of users are part of it.
    fn integrate(&mut self, world: Option<&mut World>) {
        self.turn_to(TickPart::Integrate);
        // A system of a user may have added models, or taken some out.
        self.find_roles();
        let mut running = self.progress.running.take().expect("ticks run inside `step`");
        let Running { method, schedules, alone, looked_at: seen } = &mut *running;
        let (mode, clock) = (method.0.mode(), self.clock);
        let touched = std::mem::take(&mut self.bodies.touched);
        let before = self.progress.before.take();
        let fresh = !self.progress.current || touched || before.is_some();
        let velocity_dependent = self.velocity_dependent();
        let looks = world.as_deref().is_some_and(Lookers::some_inside);
        let (users, lookers) = match (world, schedules.as_mut()) {
            (Some(world), Some([evaluate, modes])) => (Some(Users { world, evaluate, modes, looks }), None),
            (world, _) => (None, world.filter(|_| looks)),
        };
        let looked_at = users.is_some();
        let (begin, end) = (clock.time(), clock.time_of(clock.ticks + 1));
        self.progress.alone = *alone && !looked_at;
        let may_wait = self.progress.alone && !*seen;
        let mut tick = Tick {
            state: self,
            users,
            lookers,
            velocity_dependent,
            mode,
            fresh,
            looked_at,
            may_wait,
            dt: clock.dt,
            begin,
            end,
            alert: false,
        };
        if tick.fresh {
            tick.state.bodies.wake_all();
        }
        if tick.fresh && mode.is_staged() {
            tick.begin_anew();
            tick.state.each_with_events(|model, state| model.begin_account(state));
        } else if tick.fresh {
            tick.evaluate(0.0);
        }
        if let Some(before) = before {
            tick.state.book_exchange(before);
        }
        // If all bodies sleep, the end of the tick equals its beginning.
        if !tick.state.bodies.all_asleep() {
            if !mode.is_staged() {
                tick.choose_modes(tick.begin, tick.end);
            }
            let beginning = tick.exact_beginning();
            method.0.advance(&mut tick);
            if let Some(beginning) = beginning {
                tick.look_between(&beginning);
            }
        }
        let alert = tick.alert;
        self.progress.running = Some(running);
        self.end_tick(alert);
        self.turn_to(TickPart::Observe);
    }

    fn end_tick(&mut self, alert: bool) {
        self.clock.ticks += 1;
        self.watch_springs();
        let progress = &mut self.progress;
        progress.current = true;
        progress.energy.alert |= alert | self.springs.alert();
        let ticks = self.clock.ticks;
        if progress.looked_at || progress.looks.binary_search(&ticks).is_ok() {
            self.bodies.catch_up();
            self.land();
        }
        self.show_to_models();
        if !self.progress.travelled.is_finite() {
            self.bodies.catch_up();
            self.land();
            self.note_failure();
        } else if self.progress.energy.is_due(ticks, self.progress.travel) {
            self.look_at_energy();
        }
    }

    /// Sees whether the energy of the present state can be.
    #[cold]
    fn look_at_energy(&mut self) {
        self.bodies.catch_up();
        self.land();
        let mut energy = self.progress.energy;
        let created = energy.look(self, self.progress.travel);
        self.progress.energy = energy;
        if let Some((body, created)) = created {
            let wrong = if created.energy.is_finite() {
                FailureKind::Energy(created)
            } else {
                FailureKind::NotFinite("energy")
            };
            self.progress.trouble.get_or_insert(Trouble::at(&self.clock, Some(body), wrong));
        }
    }

    /// Looks for a NaN or infinite number, after all bodies have landed.
    pub(super) fn note_failure(&mut self) {
        if let Some((body, quantity)) = finite::first_not_finite(&self.bodies) {
            let trouble = Trouble::at(&self.clock, Some(body), FailureKind::NotFinite(quantity));
            self.progress.trouble.get_or_insert(trouble);
        }
    }
}

/// After a batch of ticks forces are those of the present state.
pub(super) fn refresh(world: &mut World) {
    let mut state = std::mem::take(&mut *world.resource_mut::<State>());
    let mut running = state.progress.running.take().expect("put there by `step`");
    let Running { method, schedules, .. } = &mut *running;
    let (mode, now, dt, velocity_dependent) =
        (method.0.mode(), state.clock.time(), state.clock.dt, state.velocity_dependent());
    let users = schedules.as_mut().map(|[evaluate, modes]| Users { world, evaluate, modes, looks: false });
    let mut tick = Tick {
        state: &mut state,
        users,
        lookers: None,
        velocity_dependent,
        mode,
        fresh: false,
        looked_at: true,
        may_wait: false,
        dt,
        begin: now,
        end: now,
        alert: false,
    };
    tick.evaluate_stage(now);
    // The state may lie inside a step, whose lists are known to reach far enough.
    tick.recall_bounds();
    state.progress.running = Some(running);
    *world.resource_mut::<State>() = state;
}

impl Trouble {
    /// The failure with the name of the body.
    pub(super) fn named(self, world: &World) -> Failure {
        let placed = || world.resource::<State>().bodies.entity.get(self.body?).copied();
        let entity = self.entity.or_else(placed);
        let name = |entity: Option<Entity>| world.get::<Name>(entity?).map(Name::to_string);
        let body = name(entity).unwrap_or_default();
        let other = match self.wrong {
            FailureKind::Crossed(other) | FailureKind::Behind(other) | FailureKind::Sunk(other) => name(Some(other)),
            FailureKind::Jumps { model: Some(model), .. } => {
                world.resource::<State>().models().nth(model).and_then(|model| model.rhythm()).map(|rhythm| rhythm.path)
            }
            _ => None,
        };
        Failure { body, other: other.unwrap_or_default(), wrong: self.wrong, tick: self.tick, time: self.time }
    }
}

/// Sets the integrator.
pub fn set_method(world: &mut World, method: Method) {
    let mut state = world.get_resource_or_init::<State>();
    state.progress.method = Some(method);
    state.progress.version += 1;
}

/// The greatest turnover of energy so far, in J: of motion and springs, and the release of fields. It is sampled every
/// few hundred ticks.
pub fn energy_seen(state: &State) -> f64 {
    state.progress.energy.seen()
}
