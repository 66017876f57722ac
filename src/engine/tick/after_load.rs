//! Work and checks after the whole scene is built.

use bevy_ecs::prelude::*;

use crate::scene::SceneError;

/// Functions to be called once after the whole scene is built. Plugins add functions that need bodies and contacts.
#[derive(Resource, Default)]
pub struct AfterLoad(pub Vec<fn(&mut World)>);

/// Mistakes of the scene that show only after the whole scene is built. The functions of [`AfterLoad`] report them with
/// their paths, and the scene is refused.
#[derive(Resource, Default)]
pub struct LoadErrors(pub Vec<SceneError>);
