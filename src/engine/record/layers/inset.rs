//! `Inset(center: (0, 0.5), height: 0.2)`: a part of the picture, enlarged in one of its corners.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Corner, Mark, MarkShape, add_own_layer};
use crate::record::sections::look::LAYERS;
use crate::scene::units::{Length, LengthPair, Scalar};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A square part of the world, enlarged in a corner of the picture. It may stand more than once.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Inset {
    /// The place in its middle, in m.
    center: LengthPair,
    /// The height and width of the part, in m. Above zero.
    height: Length,
    /// The corner of the picture: `TopLeft`, `TopRight`, `BottomLeft` or `BottomRight`. Default: `BottomRight`.
    #[serde(default)]
    corner: Place,
    /// Its height in the picture, as a share of the shorter side, from 0.05 to 1. Default: 0.4.
    #[serde(default = "share")]
    share: Scalar,
}

fn share() -> Scalar {
    Scalar::new(0.4)
}

/// A corner of the picture.
#[derive(Clone, Copy, Default, Deserialize, JsonSchema)]
enum Place {
    TopLeft,
    TopRight,
    BottomLeft,
    #[default]
    BottomRight,
}

impl Entry for Inset {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = "Inset";
    const EXAMPLE: &'static str = "Inset(center: (0, 0.5), height: 0.2, corner: TopRight, share: 0.4)";

    fn check(&self, _: &Outline, report: &mut Diagnostics) {
        report.finite_pair("center", self.center.si());
        report.positive("height", self.height);
        report.between("share", self.share, 0.05, 1.0);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        for WrittenEntry { value: Self { center, height, corner, share }, .. } in entries {
            let (right, bottom) = match corner {
                Place::TopLeft => (false, false),
                Place::TopRight => (true, false),
                Place::BottomLeft => (false, true),
                Place::BottomRight => (true, true),
            };
            let (center, height, share) = (center.si(), height.si(), share.si());
            let shape = MarkShape::Inset { center, height, corner: Corner { right, bottom }, share };
            add_own_layer(app, move |_: &World, marks: &mut Vec<Mark>| marks.push(Mark::new(shape.clone(), "quiet")));
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Inset>();
}
