//! The exchange between components, which systems of users see and change, and the packed state.

use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut, Tick};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemChangeTick;
use glam::DVec2;

use super::State;
use crate::world::{Body, Force, Position, Roster, Rotation, Spin, Torque, Velocity};

type Pose = (Entity, Ref<'static, Position>, Ref<'static, Rotation>, Ref<'static, Velocity>, Ref<'static, Spin>);
type PoseMut = (Entity, &'static mut Position, &'static mut Rotation, &'static mut Velocity, &'static mut Spin);

/// Which components were written since the state was last shown in them. Others may hold an older state than a system that takes
/// [`State`] has made of it.
#[derive(Clone, Copy)]
struct Written {
    shown: Option<Tick>,
    now: Tick,
}

impl Written {
    fn since(state: &State, ticks: &SystemChangeTick) -> Self {
        Self { shown: state.progress.published_at, now: ticks.this_run() }
    }

    fn has<T>(self, component: &Ref<T>) -> bool {
        self.shown.is_none_or(|shown| component.last_changed().is_newer_than(shown, self.now))
    }
}

/// Whether some component was given another value than the packed state has.
pub(super) fn components_differ(state: Res<State>, poses: Query<Pose, With<Body>>, ticks: SystemChangeTick) -> bool {
    let (bodies, written) = (&state.bodies, Written::since(&state, &ticks));
    poses.iter().any(|(entity, position, rotation, velocity, spin)| {
        let Some(body) = bodies.index(entity) else { return false };
        bodies.position[body] != position.0 && written.has(&position)
            || bodies.angle[body] != rotation.0 && written.has(&rotation)
            || bodies.velocity[body] != velocity.0 && written.has(&velocity)
            || bodies.spin[body] != spin.0 && written.has(&spin)
    })
}

/// From components to the packed state. The rounding remainder is kept if a component was not touched.
pub(super) fn load_state(mut state: ResMut<State>, poses: Query<Pose, With<Body>>, ticks: SystemChangeTick) {
    let written = Written::since(&state, &ticks);
    let bodies = &mut state.bodies;
    for (entity, position, rotation, velocity, spin) in &poses {
        let Some(body) = bodies.index(entity) else { continue };
        if bodies.position[body] != position.0 && written.has(&position) {
            bodies.position[body] = position.0;
            bodies.position_residual[body] = DVec2::ZERO;
        }
        if bodies.angle[body] != rotation.0 && written.has(&rotation) {
            bodies.angle[body] = rotation.0;
            bodies.angle_residual[body] = 0.0;
        }
        let moved = bodies.velocity[body] != velocity.0 && written.has(&velocity);
        let turned = bodies.spin[body] != spin.0 && written.has(&spin);
        if moved {
            bodies.velocity[body] = velocity.0;
        }
        if turned {
            bodies.spin[body] = spin.0;
        }
        if (moved || turned) && !bodies.estimated_velocity.is_empty() {
            bodies.estimated_velocity[body] = bodies.velocity[body];
            bodies.estimated_spin[body] = bodies.spin[body];
        }
    }
}

/// Packed state -> components.
pub(super) fn publish_components(
    mut state: ResMut<State>,
    mut poses: Query<PoseMut, With<Body>>,
    ticks: SystemChangeTick,
) {
    let state = state.bypass_change_detection();
    // Lists that were made to fit hold nothing that is worth showing.
    if state.heal() || state.progress.is_torn() {
        return;
    }
    state.progress.published_at = Some(ticks.this_run());
    let bodies = &state.bodies;
    for (entity, mut position, mut rotation, mut velocity, mut spin) in &mut poses {
        // Spawned since the last rebuild: its components are the truth.
        let Some(body) = bodies.index(entity) else { continue };
        position.0 = bodies.position[body];
        rotation.0 = bodies.angle[body];
        velocity.0 = bodies.velocity[body];
        spin.0 = bodies.spin[body];
    }
}

/// Gives a [`Force`] and a [`Torque`] to bodies without them, also to later ones.
pub(super) fn make_pushable(world: &mut World) {
    world.get_resource_or_init::<Roster>().pushed = true;
    let mut without = world.query_filtered::<Entity, (With<Body>, Without<Force>)>();
    for body in without.iter(world).collect::<Vec<_>>() {
        world.entity_mut(body).insert((Force::default(), Torque::default()));
    }
}

/// Clears the components that force systems add to.
pub(super) fn clear_forces(mut forces: Query<(&mut Force, &mut Torque)>) {
    for (mut force, mut torque) in &mut forces {
        force.0 = DVec2::ZERO;
        torque.0 = 0.0;
    }
}

/// Adds what force systems wrote into `Force` and `Torque`, and books it as coming from outside.
pub(super) fn collect_forces(
    mut state: ResMut<State>,
    forces: Query<(Entity, &Force, &Torque)>,
    mut found: Local<Vec<(u32, DVec2, f64)>>,
) {
    let State { bodies, rates, .. } = &mut *state;
    found.clear();
    let index = |entity| bodies.index(entity).map(|index| index as u32);
    found.extend(forces.iter().filter_map(|(entity, force, torque)| Some((index(entity)?, force.0, torque.0))));
    // Query order depends on archetypes; the order of sums must not.
    found.sort_unstable_by_key(|(index, ..)| *index);
    for &(index, force, torque) in &*found {
        let body = index as usize;
        if bodies.dynamic[body] && (force != DVec2::ZERO || torque != 0.0) {
            bodies.force[body] += force;
            bodies.torque[body] += torque;
            rates.outside(bodies.position[body], force, torque);
            rates.work += force.dot(bodies.velocity[body]) + torque * bodies.spin[body];
        }
    }
}

/// Index of the body of an entity, if it still exists.
pub fn index_of(world: &World, entity: Entity) -> Option<usize> {
    world.get::<Body>(entity).and_then(|_| world.get_resource::<State>()?.bodies.index(entity))
}
