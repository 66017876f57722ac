//! The stages of a step as systems, and their schedules.
//!
//! Each system calls one function of [`State`]. If the schedules of a run hold exactly these systems, the integrator
//! calls the functions directly in the same order. The reason is that a schedule and its systems take more instructions
//! than a small world. Systems first check the lists of bodies, because others may have written to them.

use bevy_ecs::prelude::*;

use super::registered::{SystemKind, register};
use super::state::Stages;
use super::{Evaluate, EvaluateStage, Modes, State};

/// Stages Bounds and Pairs.
pub fn update_bounding_boxes(mut state: ResMut<State>) {
    state.heal();
    state.update_bounding_boxes();
}

/// Stage Forces: the models of the scene in order, contacts last.
pub fn apply_forces(mut state: ResMut<State>) {
    state.heal();
    state.apply_forces();
}

/// Stage Constraints: the rows of all models together.
pub fn solve_constraints(mut state: ResMut<State>) {
    state.heal();
    state.solve_constraints();
}

/// Stage Settle.
pub fn settle(mut state: ResMut<State>) {
    state.heal();
    state.settle();
}

/// The models that have modes choose them.
pub fn begin_step(mut state: ResMut<State>) {
    state.heal();
    state.begin_step();
}

/// The stages in the schedules so far.
#[derive(Resource, Clone, Copy, Default)]
struct Scheduled(Stages);

/// Puts the stages that the scene needs into the schedules, and no others.
pub(super) fn schedule_stages(world: &mut World) {
    let needed = world.resource::<State>().stages();
    let Scheduled(present) = *world.get_resource_or_init::<Scheduled>();
    if needed == present {
        return;
    }
    let mut add = |wanted: bool, there: bool, schedule: fn(&mut World)| {
        if wanted && !there {
            schedule(world);
        }
    };
    add(needed.bounds, present.bounds, |world| {
        register(world, Evaluate, SystemKind::Flies, |evaluate| {
            evaluate.add_systems(update_bounding_boxes.in_set(EvaluateStage::Bounds));
        });
    });
    add(needed.forces, present.forces, |world| {
        register(world, Evaluate, SystemKind::Flies, |evaluate| {
            evaluate.add_systems(apply_forces.in_set(EvaluateStage::Forces));
        });
    });
    add(needed.constraints, present.constraints, |world| {
        register(world, Evaluate, SystemKind::Flies, |evaluate| {
            evaluate.add_systems(solve_constraints.in_set(EvaluateStage::Constraints));
        });
    });
    add(needed.settle, present.settle, |world| {
        register(world, Evaluate, SystemKind::Flies, |evaluate| {
            evaluate.add_systems(settle.in_set(EvaluateStage::Settle));
        });
    });
    add(needed.modes, present.modes, |world| {
        register(world, Modes, SystemKind::Flies, |modes| {
            modes.add_systems(begin_step);
        });
    });
    world.insert_resource(Scheduled(Stages {
        bounds: needed.bounds || present.bounds,
        forces: needed.forces || present.forces,
        constraints: needed.constraints || present.constraints,
        settle: needed.settle || present.settle,
        modes: needed.modes || present.modes,
    }));
}
