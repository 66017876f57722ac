//! The common part of layers of bodies: an entry of `look.layers` with the field `of`.

use bevy_app::App;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::{Layer, Shown, add_own_layer};
use crate::record::sections::look::LAYERS;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, WrittenEntry};

/// A layer that shows the bodies of its field `of`, or all that move.
pub(super) trait OfBodies: DeserializeOwned + JsonSchema + Send + Sync + 'static {
    /// Its name in the scene.
    const NAME: &'static str;
    /// One correct use.
    const EXAMPLE: &'static str;

    /// The field `of`.
    fn of(&self) -> Option<&Names>;

    /// Reports mistakes in its other fields.
    fn check_others(&self, _report: &mut Diagnostics) {}

    /// Installs once what all layers of the kind need.
    fn prepare(_app: &mut App) {}

    /// Makes the layer.
    fn layer(self, shown: Shown, outline: &Outline) -> impl Layer;
}

impl<L: OfBodies> Entry for L {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = <L as OfBodies>::NAME;
    const EXAMPLE: &'static str = <L as OfBodies>::EXAMPLE;

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        Shown::check(self.of(), outline, report);
        self.check_others(report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        Self::prepare(app);
        for entry in entries {
            let shown = Shown::new(entry.value.of(), outline);
            add_own_layer(app, entry.value.layer(shown, outline));
        }
    }
}
