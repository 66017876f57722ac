//! Motors and controllers of joints, one per file.

mod actuator;
mod driven;
mod motor;
pub(crate) mod output;
mod servo;
mod target;

use bevy_app::App;

pub use output::Output;

use crate::scene::{Arity, SceneAppExt};

/// Registers the controllers of this folder.
pub fn plugin(app: &mut App) {
    app.register_entry_section(
        "controllers",
        Arity::List,
        "controllers: [Servo(of: \"hip\", target: \"40 deg\", kp: 20, kd: 5)]",
    );
    app.describe_section("controllers", "Motors and controllers that drive joints.");
    app.add_plugins(motor::plugin).add_plugins(servo::plugin).add_plugins(actuator::plugin);
}
