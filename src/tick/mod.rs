//! One tick, read aloud.
//!
//! | schedule | stage | what happens |
//! |---|---|---|
//! | [`SimTick`] | [`Stage::Begin`] | plugins look at the state and change it: spawn, despawn, steer |
//! | | [`Stage::Integrate`] | the integrator advances the state by `dt`; it runs [`Modes`] and [`Evaluate`] as often as its method needs |
//! | | [`Stage::Observe`] | sensors, expectations and guards look at the new state |
//! | [`Modes`] | [`EvaluateStage::Forces`] | schedules of forces switch on or off for the whole step |
//! | | [`EvaluateStage::Contacts`] | contacts choose the modes that stay frozen during the step |
//! | [`Evaluate`] | [`EvaluateStage::Bounds`] | bounding boxes are checked against where the bodies stand now |
//! | | [`EvaluateStage::Forces`] | one system per kind of force, in the order of registration |
//! | | [`EvaluateStage::Contacts`] | candidate pairs, then the contact law |
//! | | [`EvaluateStage::Joints`] | rows of joints |
//!
//! [`Evaluate`] is a pure function of the state: state in, forces out. The forces of the last evaluation stay in
//! place, so an integrator that ends where the next tick begins evaluates once per tick.
//!
//! **Packed systems and ordinary systems.** Built-in systems work on the packed [`Bodies`](crate::world::Bodies) and
//! are registered with [`TickAppExt::add_packed_systems`]. Any other system in these schedules is an ordinary one: the
//! engine notices it and keeps the components (`Position`, `Velocity` ...) up to date around it. A scene without
//! ordinary systems pays nothing for that. A system in [`Stage::Begin`] that changes components, spawns or despawns is
//! noticed too, and the forces are evaluated anew before the tick; one that changes anything else that forces depend on
//! says so with [`Bodies::touched`](crate::world::Bodies::touched).
//!
//! **Direct forms.** Where all systems are the engine's own and have one, ticks call them without these schedules: see
//! `direct.rs`.

pub mod after_load;
pub mod balance;
pub mod bounds;
pub mod clock;
pub(crate) mod direct;
pub(crate) mod direct_force;
mod drive;
pub mod energy;
mod failure;
mod flight;
pub mod flow;
mod following;
mod guard;
mod inside;
mod method;
pub mod models;
mod notes;
mod ode;
pub(crate) mod registered;
pub mod response;
pub mod stability;
mod stages;
pub mod steady;
pub mod stopwatch;
mod travel;
mod undo;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};

pub use after_load::{AfterLoad, LoadErrors};
pub use balance::{Balance, Ledger};
pub use clock::{Clock, Evaluation, Span, Style};
use direct::Direct;
pub(crate) use drive::foresee_components;
pub use drive::{energy_seen, set_method, step};
pub use failure::{Failure, Wrong};
pub(crate) use flight::{add_observer_of_ticks, look_at_ticks};
pub use flow::{Reach, WorldFlow};
pub use guard::Created;
pub use inside::Tick;
pub use method::{Integrator, Method};
pub use models::{Indicator, Models, Objection, Rhythm, StateBlock, Watch};
pub use notes::Notes;
pub use ode::Flow;
use registered::{Registered, register};
pub use stability::{Briefest, Fastest, Foreseen, Holder, Responses, Stability};
pub(crate) use stages::Stages;
pub use travel::{FarTravel, far_travel, largest_travel};
pub use undo::Undo;

/// The schedule of one tick.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SimTick;

/// The schedule that turns a state into forces. The integrator runs it.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Evaluate;

/// The schedule in which forces and contacts choose the modes (on or off, loading or unloading) that stay frozen during
/// the step. It has the stages [`EvaluateStage::Forces`] and [`EvaluateStage::Contacts`]. A force that is switched there corrects
/// the sums of forces, and sets [`Evaluation::stale`].
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Modes;

/// The stages of [`SimTick`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Plugins look at the state and change it.
    Begin,
    /// The state is advanced by `dt`.
    Integrate,
    /// Sensors, expectations and guards look at the new state.
    Observe,
}

/// Within [`EvaluateStage::Contacts`], before any contact law: where candidate pairs are found, with what looks on.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FindPairs;

/// Within [`FindPairs`]: the search itself.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SearchPairs;

/// The stages of [`Evaluate`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EvaluateStage {
    /// Bounding boxes are checked against where the bodies stand now.
    Bounds,
    /// Forces are summed.
    Forces,
    /// Candidate pairs are found and the contact law is applied.
    Contacts,
    /// Joints emit their rows.
    Joints,
}

/// What a force, or the power that it books, depends on. An integrator that keeps velocities at half steps provides whole-step velocities to
/// those who need them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// Nothing: the force is the same always. Bodies that are asleep ([`Bodies::asleep`](crate::world::Bodies::asleep)) are
    /// to be left out, and so is what they would bring to [`Balance`].
    Nothing,
    /// Time and positions only.
    Position,
    /// Velocities too.
    Velocity,
}

/// Place of a force in the order of sums.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ForceSlot(pub u32);

/// What the engine knows of its systems.
#[derive(Resource, Debug, Default)]
pub(crate) struct Census {
    pub ordinary_forces: usize,
    pub force_slots: u32,
    pub velocity_dependent: bool,
    /// Some force other than those of contacts depends on velocities.
    pub velocity_forces: bool,
    /// Some force is not the same always.
    pub changing_forces: bool,
}

impl Census {
    /// Whether some force may change with time in a state that does not.
    pub fn changing_forces(&self) -> bool {
        self.changing_forces || self.ordinary_forces > 0
    }
}

/// How plugins add systems to the tick.
pub trait TickAppExt {
    /// Adds the schedules and resources of the tick. Adding it twice does nothing.
    fn add_tick(&mut self) -> &mut Self;

    /// Adds systems that work on the packed state only. They may not spawn or despawn.
    fn add_packed_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self;

    /// Likewise systems that are right while bodies fly: they do not go by the places and velocities of bodies that touch
    /// nothing, nor by forces on them. No body flies where others make forces or choose modes; where others are in the
    /// tick, places and velocities are filled in for them.
    fn add_flight_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self;

    /// Says that forces depend on velocities: integrators that keep them at half steps then provide whole-step ones.
    /// For contact laws; forces say so themselves.
    fn need_velocities(&mut self) -> &mut Self;

    /// Adds a force as an ordinary system: it reads `Position`, `Velocity` ... and adds to `Force` and `Torque`.
    ///
    /// It gets its own slot after all forces registered before, so the order of the sum does not depend on chance.
    /// It may depend on velocities; the work it does stands in the ledger as work.
    fn add_force<M>(&mut self, system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>) -> &mut Self;

    /// Adds a force that works on the packed state. It keeps its own account in [`Balance`].
    fn add_packed_force<M>(
        &mut self,
        dependence: Dependence,
        system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self;
}

impl TickAppExt for App {
    fn add_tick(&mut self) -> &mut Self {
        if self.world().contains_resource::<Census>() {
            return self;
        }
        let mut tick = single_threaded(SimTick);
        tick.configure_sets((Stage::Begin, Stage::Integrate, Stage::Observe).chain());
        let mut evaluate = single_threaded(Evaluate);
        use EvaluateStage::{Bounds, Contacts, Forces, Joints};
        evaluate.configure_sets((Bounds, Forces, Contacts, Joints).chain());
        let mut modes = single_threaded(Modes);
        modes.configure_sets((Forces, Contacts).chain());
        self.add_schedule(tick).add_schedule(evaluate).add_schedule(modes);
        self.init_resource::<Census>()
            .init_resource::<Clock>()
            .init_resource::<Evaluation>()
            .init_resource::<Span>()
            .init_resource::<Models>()
            .init_resource::<Balance>()
            .init_resource::<Ledger>()
            .init_resource::<Stability>()
            .init_resource::<drive::Drive>()
            .insert_resource(crate::world::Bodies { changed: true, ..Default::default() });
        self.init_resource::<Direct>();
        let mark = Registered::mark(self.world());
        self.add_flight_systems(SimTick, drive::integrate.in_set(Stage::Integrate));
        Registered::cover(self.world_mut(), mark);
        self
    }

    fn add_packed_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self {
        register(self.world_mut(), schedule, false, |schedule| {
            schedule.add_systems(systems);
        });
        self
    }

    fn add_flight_systems<M>(
        &mut self,
        schedule: impl ScheduleLabel,
        systems: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self {
        register(self.world_mut(), schedule, true, |schedule| {
            schedule.add_systems(systems);
        });
        self
    }

    fn need_velocities(&mut self) -> &mut Self {
        self.world_mut().get_resource_or_init::<Census>().velocity_dependent = true;
        self
    }

    fn add_force<M>(&mut self, system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>) -> &mut Self {
        let slot = next_force_slot(self, Dependence::Velocity);
        self.world_mut().resource_mut::<Census>().ordinary_forces += 1;
        self.add_systems(Evaluate, system.in_set(slot))
    }

    fn add_packed_force<M>(
        &mut self,
        dependence: Dependence,
        system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
    ) -> &mut Self {
        let slot = next_force_slot(self, dependence);
        self.add_packed_systems(Evaluate, system.in_set(slot))
    }
}

/// Adds one system to [`Stage::Observe`] that works on the packed state only, while a scene is read.
pub fn add_packed_observer<M>(
    world: &mut World,
    system: impl IntoScheduleConfigs<bevy_ecs::system::ScheduleSystem, M>,
) {
    register(world, SimTick, false, |schedule| {
        schedule.add_systems(system.in_set(Stage::Observe));
    });
}

fn next_force_slot(app: &mut App, dependence: Dependence) -> ForceSlot {
    let mut census = app.world_mut().resource_mut::<Census>();
    census.velocity_dependent |= dependence == Dependence::Velocity;
    census.velocity_forces |= dependence == Dependence::Velocity;
    census.changing_forces |= dependence != Dependence::Nothing;
    let slot = ForceSlot(census.force_slots);
    census.force_slots += 1;
    app.configure_sets(Evaluate, slot.in_set(EvaluateStage::Forces));
    if let Some(before) = slot.0.checked_sub(1) {
        app.configure_sets(Evaluate, slot.after(ForceSlot(before)));
    }
    slot
}

/// Parallelism is inside a system, never between systems: with a dozen short systems a thread pool costs a hundred
/// times the work.
fn single_threaded(label: impl ScheduleLabel) -> Schedule {
    let mut schedule = Schedule::new(label);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule
}
