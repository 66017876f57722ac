//! Sentences for the card.

use bevy_ecs::prelude::*;

/// Notes on every choice the engine made and every limit it applied.
#[derive(Resource, Clone, Debug, Default)]
pub struct Notes(pub Vec<String>);
