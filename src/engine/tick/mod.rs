//! The stages of a tick, and how state, models and systems of users work together in them.
//!
//! | schedule | stage | action |
//! |---|---|---|
//! | [`SimTick`] | [`Stage::Begin`] | plugins look at the state and change it: spawn, despawn, steer |
//! | | [`Stage::Integrate`] | the integrator advances the state by `dt`; it runs [`Modes`] and [`Evaluate`] as often as its method needs |
//! | | [`Stage::Observe`] | expectations and guards look at the new state |
//! | [`Modes`] | | models choose the modes that stay frozen during the step |
//! | [`Evaluate`] | [`EvaluateStage::Bounds`] | the search checks bounding boxes against the current positions of bodies, and finds candidate pairs |
//! | | [`EvaluateStage::Systems`] | systems of users add to `Force` and `Torque` |
//! | | [`EvaluateStage::Forces`] | the models of the scene add their forces in order, contact laws last |
//! | | [`EvaluateStage::Constraints`] | the engine solves the constraints of models, all rows at once |
//! | | [`EvaluateStage::Settle`] | models do the work that depends on all forces |
//!
//! **State and models.** [`State`] is the one resource that all stages work on. A [`Model`] is any active part of a
//! scene. It is added with [`TickAppExt::add_model`], and a scene may have many of a kind. The stages of [`Evaluate`]
//! and [`Modes`] are systems that take `ResMut<State>` (`stages.rs`). Each is present only if some model needs it.
//!
//! Under methods with several stages per step an evaluation is a pure function of the state: state in, forces out.
//! Under methods that go from tick to tick contacts remember the state before. The forces of the last evaluation are
//! kept. So an integrator whose steps begin at the last evaluated state evaluates once per tick.
//!
//! **Systems of users.** A system that works on [`State`] alone is registered with [`TickAppExt::add_packed_systems`].
//! Around any other system the engine keeps the components (`Position`, `Velocity` ...) up to date. A scene without
//! such systems pays nothing for that. A system in [`Stage::Begin`] may change components, spawn or despawn. The engine
//! notices that, and evaluates the forces again before the tick. A system that changes any other input of forces
//! announces it with [`Bodies::touched`](crate::world::Bodies::touched).

pub mod after_load;
mod batch;
mod blows;
pub mod bounds;
mod breaking;
pub mod clock;
mod components;
mod context;
pub mod critical_step;
pub mod differential_equations;
mod drifted;
pub mod energy;
mod failure;
mod finite_start;
mod flight_permission;
mod following;
mod guard;
pub mod kept;
pub mod ledger;
mod loads;
mod looks;
mod method;
mod model;
mod notes;
mod ode;
mod outside;
pub mod pairs;
mod progress;
mod registered;
mod roles;
mod saved;
pub mod snapshot;
mod stabilisation;
pub mod stability;
pub mod stages;
mod state;
pub mod steady;
mod step;
mod stop;
pub mod stopwatch;
pub mod touch;
mod travel;
mod undo;
mod work;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};

pub use after_load::{AfterLoad, LoadErrors};
pub use batch::step;
pub(crate) use batch::{advance, foresee_components, open, rebuild};
pub use blows::Blow;
pub use breaking::{BLOW, BlowAtJoint};
pub use clock::{Clock, Evaluation, EvaluationMode, Span};
pub use components::index_of;
pub use context::Tick;
pub use differential_equations::{Reach, WorldFlow};
pub use failure::{Failure, FailureKind};
pub(crate) use finite_start::{refuse_far_anchors, refuse_least_inertia, refuse_not_finite};
pub(crate) use flight_permission::{add_observer, look_at_ticks};
pub use guard::Created;
pub use ledger::{Ledger, Rates, Totals};
pub(crate) use looks::{add_inner_looker, look_inside, read_forces_at_ends};
pub use method::{Integrator, Method};
pub use model::{
    Bend, Departure, Dependence, Energies, Events, ForceOn, ForcePart, Indicator, Loss, Model, Objection, Rhythm,
    Turning,
};
pub use notes::Notes;
pub use ode::Flow;
pub use progress::{LocatedEvents, StepCount};
pub(crate) use registered::systems_of_users;
use registered::{SystemKind, register};
pub use stabilisation::{FromOutside, JointDrift, Noted};
pub use stability::{Briefest, FEWEST_TICKS_OF_CONTACT, Fastest, Foreseen, Holder, Stability, TimeScales};
pub use state::State;
pub use steady::{SteadySpring, SteadySprings};
pub use step::{energy_seen, set_method};
pub use travel::{FarTravel, STANDS, far_travel, largest_travel, stands};
pub use undo::Undo;
pub use work::work_of_an_evaluation;

/// The schedule of one tick.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SimTick;

/// The schedule that turns a state into forces. The integrator runs it.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Evaluate;

/// The schedule in which models choose the modes (on or off, loading or unloading) that stay frozen during the step. A force that
/// is switched there corrects the sums of forces.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Modes;

/// The stages of [`SimTick`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Plugins look at the state and change it.
    Begin,
    /// The state is advanced by `dt`.
    Integrate,
    /// Expectations and guards look at the new state.
    Observe,
}

/// The stages of [`Evaluate`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EvaluateStage {
    /// Checks bounding boxes against the current positions of bodies, and finds candidate pairs.
    Bounds,
    /// Systems of users add to components.
    Systems,
    /// Models add their forces, contact laws last.
    Forces,
    /// Solves the constraints of models, all rows at once.
    Constraints,
    /// Work that depends on all forces.
    Settle,
}

/// How plugins take part in the tick.
pub trait TickAppExt {
    /// Adds the schedules and the state. Adding it twice does nothing.
    fn add_tick(&mut self) -> &mut Self;

    /// Adds a model: a force, a spring, a contact law. It acts after those that were added before; contact laws act last.
    fn add_model(&mut self, model: impl Model) -> &mut Self;

    /// Adds a force as a system: it reads `Position`, `Velocity` ... and adds to `Force` and `Torque`.
    ///
    /// Systems of forces act one after the other, in the order in which they were added, before all models. They may
    /// depend on velocities, and the ledger books their work as work.
    fn add_force<M>(&mut self, system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>) -> &mut Self;

    /// Adds systems that work on [`State`] only. They may not spawn or despawn.
    fn add_packed_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self;
}

/// Place of a system of forces in the order of sums.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ForceSlot(usize);

impl TickAppExt for App {
    fn add_tick(&mut self) -> &mut Self {
        if self.world().contains_resource::<State>() {
            return self;
        }
        let mut tick = single_threaded(SimTick);
        tick.configure_sets((Stage::Begin, Stage::Integrate, Stage::Observe).chain());
        let mut evaluate = single_threaded(Evaluate);
        use EvaluateStage::{Bounds, Constraints, Forces, Settle, Systems};
        evaluate.configure_sets((Bounds, Systems, Forces, Constraints, Settle).chain());
        self.add_schedule(tick).add_schedule(evaluate).add_schedule(single_threaded(Modes));
        self.init_resource::<State>().insert_resource(crate::world::Roster { changed: true, pushed: false });
        register(self.world_mut(), SimTick, SystemKind::Flies, |schedule| {
            schedule.add_systems(step::integrate.in_set(Stage::Integrate));
        });
        self
    }

    fn add_model(&mut self, model: impl Model) -> &mut Self {
        self.world_mut().get_resource_or_init::<State>().add_model(model);
        self
    }

    fn add_force<M>(&mut self, system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>) -> &mut Self {
        let mut state = self.world_mut().get_resource_or_init::<State>();
        let slot = ForceSlot(state.force_systems);
        state.force_systems += 1;
        self.configure_sets(Evaluate, slot.in_set(EvaluateStage::Systems));
        if let Some(before) = slot.0.checked_sub(1) {
            self.configure_sets(Evaluate, slot.after(ForceSlot(before)));
        }
        self.add_systems(Evaluate, system.in_set(slot))
    }

    fn add_packed_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self {
        add_packed_systems(self.world_mut(), schedule, systems);
        self
    }
}

/// Adds systems that work on [`State`] only, while a scene is read.
pub fn add_packed_systems<M>(
    world: &mut World,
    schedule: impl ScheduleLabel,
    systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
) {
    register(world, schedule, SystemKind::Packed, |schedule| {
        schedule.add_systems(systems);
    });
}

/// Adds one system to [`Stage::Observe`] that looks at the state and changes nothing of it.
pub(crate) fn add_looker<M>(world: &mut World, system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>) {
    register(world, SimTick, SystemKind::Looks, |schedule| {
        schedule.add_systems(system.in_set(Stage::Observe));
    });
}

/// Adds one system to [`Stage::Observe`] that works on [`State`] only, while a scene is read.
pub fn add_packed_observer<M>(
    world: &mut World,
    system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
) {
    add_packed_systems(world, SimTick, system.in_set(Stage::Observe));
}

/// Parallelism is inside a system, never between systems. With a dozen short systems a thread pool costs a hundred
/// times the work.
fn single_threaded(label: impl ScheduleLabel) -> Schedule {
    let mut schedule = Schedule::new(label);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule
}
