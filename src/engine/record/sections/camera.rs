//! `camera`: the part of the world that the film shows. Entries `Fit`, `Look` and `Follow`.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Length, LengthPair, Scalar, Time};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, WrittenEntry};

/// The name of the section that takes one camera.
pub const SECTION: &str = "camera";
/// The meaning of the section.
pub const MEANING: &str = "The part of the world that the film shows. Without this section the camera is `Fit`, with its \
default.";
/// One correct use of the section.
pub const EXAMPLE: &str = "camera: Fit(margin: 0.05)";

/// All bodies that move stay in the picture.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Fit")]
pub struct FitCamera {
    /// Empty border, as a share of the picture's smaller side, from 0 to 0.45. Default: 0.05.
    #[serde(default = "margin")]
    pub margin: Scalar,
}

fn margin() -> Scalar {
    Scalar::new(0.05)
}

impl Default for FitCamera {
    fn default() -> Self {
        Self { margin: margin() }
    }
}

impl Entry for FitCamera {
    const SECTION: &'static str = SECTION;
    const NAME: &'static str = "Fit";
    const EXAMPLE: &'static str = "Fit(margin: 0.05)";

    /// Reports a margin that leaves no picture.
    fn check(&self, _: &Outline, report: &mut Diagnostics) {
        report.between("margin", self.margin, 0.0, 0.45);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            app.insert_resource(CameraChoice::Fit(entry.value));
        }
    }
}

/// A fixed part of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Look")]
pub struct LookCamera {
    /// The place in the middle of the picture, in m.
    pub center: LengthPair,
    /// The height of the picture, in m. Above zero.
    pub height: Length,
}

impl Entry for LookCamera {
    const SECTION: &'static str = SECTION;
    const NAME: &'static str = "Look";
    const EXAMPLE: &'static str = "Look(center: (3, 3), height: 6)";

    /// Reports a height that is not above zero.
    fn check(&self, _: &Outline, report: &mut Diagnostics) {
        report.finite_pair("center", self.center.si());
        report.positive("height", self.height);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            app.insert_resource(CameraChoice::Look(entry.value));
        }
    }
}

/// A body stays in the picture: `d camera/dt = (body - camera)/smoothing`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Follow")]
pub struct FollowCamera {
    /// The name of the body.
    pub of: String,
    /// The height of the picture, in m. Above zero.
    pub height: Length,
    /// The delay of the camera, in s of film. With 0 the body is always in the middle. Default: 0.
    #[serde(default)]
    pub smoothing: Time,
}

impl Entry for FollowCamera {
    const SECTION: &'static str = SECTION;
    const NAME: &'static str = "Follow";
    const EXAMPLE: &'static str = "Follow(of: \"ball\", height: 3, smoothing: \"0.3 s\")";

    /// Reports a body that is not there, and what gives no picture.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require(NameKind::BODY, &self.of, "of", report);
        report.positive("height", self.height);
        report.not_negative("smoothing", self.smoothing);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            app.insert_resource(CameraChoice::Follow(entry.value));
        }
    }
}

/// The camera of the scene. Absent: everything fits, with the default margin.
#[derive(Resource, Clone, Debug)]
pub enum CameraChoice {
    /// All bodies that move stay in the picture.
    Fit(FitCamera),
    /// A fixed part of the world.
    Look(LookCamera),
    /// A body stays in the picture.
    Follow(FollowCamera),
}
