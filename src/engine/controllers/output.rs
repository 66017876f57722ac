//! The action of a controller in the last evaluation, for its channels.

use crate::scene::{NameKind, Outline};

/// Names of controllers.
pub const CONTROLLER: NameKind = NameKind::new("controller");

/// The output of a controller.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name, or its path in the scene, such as `controllers[0]`.
    pub name: String,
    /// Its path in the scene.
    pub path: String,
    /// Torque in N m or force in N, and power in W.
    pub values: (f64, f64),
}

impl Output {
    pub(super) fn named(name: Option<String>, path: String) -> Self {
        Self { name: name.unwrap_or_else(|| path.clone()), path, values: (0.0, 0.0) }
    }

    pub(super) fn note(&mut self, torque: f64, power: f64) {
        self.values = (torque, power);
    }
}

/// Declares the name of a controller.
pub(super) fn declare(name: Option<&str>, outline: &mut Outline) {
    if let Some(name) = name {
        outline.declare(CONTROLLER, name, "name");
    }
}

/// The places in the scene of all controllers of a kind, in the order of the file.
pub(super) fn paths(kind: &str, outline: &Outline) -> Vec<String> {
    outline.entries("controllers").iter().filter(|entry| entry.name == kind).map(|entry| entry.path.clone()).collect()
}
