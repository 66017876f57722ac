//! `Overlap()`: the deepest overlap so far. `overlap.deepest` is in metres, and `overlap.share` is a share of the smaller radius.
//! Each is the greatest over all pairs.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found};
use crate::contacts::DeepestOverlap;
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;

const CHANNELS: &[&str] = &["overlap.deepest", "overlap.share"];

/// The deepest overlap so far: `overlap.deepest` in m, `overlap.share` of the smaller radius. Each has its own pair. A small body
/// may overlap by a larger share of its radius, and a large one by more metres.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Overlap {}

impl Entry for Overlap {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Overlap";
    const EXAMPLE: &'static str = "Overlap()";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_found(app.world_mut(), CHANNELS.iter().map(|&name| name.to_owned()));
    }
}

fn find(_: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let (part, unit): (fn(&DeepestOverlap) -> f64, _) = match (owner, quantity) {
        ("overlap", "deepest") => (|deepest| deepest.in_meters.overlap, "m"),
        ("overlap", "share") => (|deepest| deepest.in_share.share, ""),
        _ => return None,
    };
    let value = move |state: &State| part(state.deepest_overlap());
    Some(Channel::of_state(format!("overlap.{quantity}"), unit, value))
}

pub(super) fn plugin(app: &mut App) {
    app.add_channels(CHANNELS, find);
    app.register_entry::<Overlap>();
}
