//! What is done, and what is found wrong, when the whole scene stands.

use bevy_ecs::prelude::*;

use crate::scene::SceneError;

/// Work to be done once when the whole scene stands: plugins add functions that need bodies and contacts.
#[derive(Resource, Default)]
pub struct AfterLoad(pub Vec<fn(&mut World)>);

/// Mistakes of the scene that show only when the whole scene stands: [`AfterLoad`] write them down, with their paths, and
/// the scene is refused.
#[derive(Resource, Default)]
pub struct LoadErrors(pub Vec<SceneError>);
