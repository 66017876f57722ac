//! Forces, one per file. A force adds to the sums of the bodies and keeps its account in
//! [`Rates`](crate::tick::Rates).

mod applied_at;
pub mod attraction;
pub mod ballistics;
mod between_ticks;
pub mod drag;
pub mod drive;
pub mod firing_solution;
pub mod gravity;
pub mod link;
pub mod spring;
mod targets;
pub mod thrust;
pub mod torque;
pub mod torsion_spring;
mod wind;

use bevy_app::App;

pub use applied_at::AppliedAt;
pub use targets::{Targets, check_targets};

use crate::scene::{Arity, SceneAppExt};
use crate::tick::State;

/// Registers the forces of this folder. The order here is the order of the sums.
pub fn plugin(app: &mut App) {
    app.register_entry_section("forces", Arity::List, "forces: [Drag(linear: 0.1)]");
    app.describe_section("forces", "Forces on bodies beside gravity and contacts.");
    app.add_plugins(gravity::plugin)
        .add_plugins(attraction::plugin)
        .add_plugins(thrust::plugin)
        .add_plugins(torque::plugin)
        .add_plugins(drag::plugin)
        .add_plugins(wind::plugin)
        .add_plugins(link::plugin)
        .add_plugins(spring::plugin)
        .add_plugins(torsion_spring::plugin)
        .add_plugins(drive::plugin)
        .add_plugins(firing_solution::plugin);
}

/// Whether a force of this folder slows bodies by the resistance of air, at rest or moving.
pub fn resists(state: &State) -> bool {
    let moving = state.models_of::<wind::Gust>().next().is_some();
    moving || state.models_of::<drag::DragForce>().next().is_some()
}
