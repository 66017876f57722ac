//! Joints, one per file. A joint emits rows and solves none: [`crate::constraints`] solves those of all joints and held
//! contacts together.

mod assembly;
pub mod bounded;
mod coupling;
mod distance;
pub mod ends;
mod gear_pair;
mod joint_model;
pub mod law;
pub mod limit;
mod modes;
pub mod parts;
mod prismatic;
mod rack;
mod revolute;
mod rope;
pub mod soft;
mod weld;

use std::collections::BTreeMap;
use std::sync::Arc;

use bevy_app::App;
use bevy_ecs::prelude::*;

pub use coupling::Coupling;
pub use distance::Rod;
use ends::JointEnds;
pub use joint_model::Joint;
use law::JointLaw;
pub use prismatic::Slide;
pub use revolute::Hinge;
pub use rope::Cord;
pub use weld::Fixed;

use crate::scene::{Arity, SceneAppExt};
use crate::tick::AfterLoad;
use crate::world::IgnoredPairs;

/// Closes joints after the whole scene is built.
fn close_at_start(app: &mut App) {
    if !app.world().contains_resource::<Closing>() {
        app.insert_resource(Closing);
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(assembly::assemble);
    }
}

/// Set when joints are to be closed at the start.
#[derive(Resource)]
struct Closing;

/// The joints of a scene by their names, once they have begun: controllers find theirs here.
#[derive(Resource, Default)]
pub struct KnownJoints(BTreeMap<String, KnownJoint>);

/// A joint as controllers see it.
#[derive(Clone)]
pub struct KnownJoint {
    /// Its ends.
    pub ends: JointEnds,
    /// Its law.
    pub law: Arc<dyn JointLaw>,
    /// Whether it has limits.
    pub limited: bool,
}

impl KnownJoints {
    /// The joint of this name.
    pub fn named(&self, name: &str) -> Option<&KnownJoint> {
        self.0.get(name)
    }
}

/// Two bodies do not touch each other.
fn keep_apart(app: &mut App, a: u64, b: u64) {
    app.world_mut().get_resource_or_init::<IgnoredPairs>().insert(a, b);
}

/// Registers the joints of this folder. The order here is the order of the rows.
pub fn plugin(app: &mut App) {
    app.register_entry_section("joints", Arity::List, "joints: [Revolute(a: World, b: \"bar\", anchor_b: (-0.5, 0))]");
    app.describe_section("joints", "Constraints that hold bodies to each other exactly, without stretching.");
    app.add_plugins(revolute::plugin)
        .add_plugins(prismatic::plugin)
        .add_plugins(weld::plugin)
        .add_plugins(distance::plugin)
        .add_plugins(rope::plugin)
        .add_plugins(gear_pair::plugin)
        .add_plugins(rack::plugin);
    for name in ["Wheel", "Ratchet", "Pulley", "Slot"] {
        app.reserve_entry("joints", name);
    }
}
