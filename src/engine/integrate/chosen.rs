//! The choice of the integration method of a run.

use bevy_ecs::prelude::*;

use crate::tick::EvaluationMode;

/// The method of the run.
#[derive(Resource, Clone, Copy, Debug)]
pub struct ChosenMethod {
    /// Its name.
    pub name: &'static str,
    /// Whether events are located inside ticks.
    pub located: bool,
    /// The style in which it evaluates models with a history.
    pub mode: EvaluationMode,
}

impl ChosenMethod {
    /// Whether events are located inside ticks: then nothing passes through others unseen.
    pub fn locates(world: &World) -> bool {
        world.get_resource::<Self>().is_some_and(|method| method.located)
    }
}
