//! The components of a body: position, velocity, mass, and the forces of the current evaluation.
//!
//! The components are the truth between ticks. Inside a tick the packed [`Bodies`](super::Bodies) hold the state. The
//! components are updated for their readers (see [`crate::tick`]).

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use glam::DVec2;

use super::roster::Roster;

/// How a body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// By forces.
    #[default]
    Dynamic,
    /// Never.
    Fixed,
    /// It moves as its [`Kinematic`](super::Kinematic) prescribes, and without one it is at rest.
    Kinematic,
}

/// A body. Its key is its identity: the order of keys is the order of every sum.
#[derive(Component, Clone, Debug, Default)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
#[require(Position, Rotation, Velocity, Spin, Mass)]
pub struct Body {
    /// Place in the canonical order: the order of the scene, later spawns after it. Two bodies never share a key.
    pub key: u64,
    /// Its motion.
    pub motion: Motion,
    /// Whether its atoms touch anything.
    pub collides: bool,
}

/// Position of the centre of mass in metres.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Position(pub DVec2);

/// Angle in radians, counter-clockwise, continuous: it is never wrapped.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Rotation(pub f64);

/// Velocity of the centre of mass in m/s.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity(pub DVec2);

/// Angular velocity in rad/s, counter-clockwise.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Spin(pub f64);

/// Force on the centre of mass in newtons, summed by the force systems of one evaluation. Cleared before each. Bodies have it as
/// soon as some system that works on components is in the schedules of the tick.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Force(pub DVec2);

/// Torque about the centre of mass in N m, summed by the force systems of one evaluation. Cleared before each. Bodies have it when
/// they have a [`Force`].
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Torque(pub f64);

/// Mass and moment of inertia about the centre of mass.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed)]
pub struct Mass {
    /// Mass in kg.
    pub mass: f64,
    /// Moment of inertia in kg m2.
    pub inertia: f64,
}

impl Default for Mass {
    fn default() -> Self {
        Self { mass: 1.0, inertia: 1.0 }
    }
}

/// The packed state is rebuilt before the next tick.
pub(super) fn mark_changed(mut world: DeferredWorld, _: HookContext) {
    if let Some(mut roster) = world.get_resource_mut::<Roster>() {
        roster.changed = true;
    }
}
