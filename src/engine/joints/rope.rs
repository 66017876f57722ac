//! A massless rope: both anchors are at most its length apart. It pulls while it is taut and does nothing while it is
//! slack.

use std::sync::Arc;

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ends::EndPair;
use super::joint_model::{self, Absent, Setup};
use super::law::{Freedom, Held, JointLaw};
use super::parts::Asked;
use crate::forces::link::Partner;
use crate::scene::units::{Force, Length, LengthPair, Scalar};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A rope without mass: `anchor_a` of `a` and `anchor_b` of `b` are at most its length apart. A rope has no `softness`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Rope {
    /// Its name, for channels and controllers. Default: none.
    name: Option<String>,
    /// One body, or `World`.
    a: Partner,
    /// The other body, or `World`.
    b: Partner,
    /// The anchor on `a` in its frame, in metres, from its centre of mass, or from the origin with `datum: Origin`.
    /// With `World` it is a point in the world. Default: the centre of mass, and with `World` the place of the other
    /// anchor at the start.
    anchor_a: Option<LengthPair>,
    /// The anchor on `b`, likewise. Default: as that of `anchor_a`.
    anchor_b: Option<LengthPair>,
    /// Its length in metres. Above zero. Default: the distance at the start.
    length: Option<Length>,
    /// The share of the speed with which its ends come back when it becomes taut, 0 to 1. With 0 it stays taut. Default: 0.
    #[serde(default)]
    restitution: Scalar,
    /// The force in N at which it breaks forever. Above zero. A blow at a limit or a taut rope counts as an even force over a
    /// millisecond. Default: none.
    break_force: Option<Force>,
    /// Whether both bodies touch each other. Default: false.
    #[serde(default)]
    collide: bool,
}

impl Entry for Rope {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Rope";
    const EXAMPLE: &'static str = "Rope(a: \"bar\", b: \"bob\", length: 2)";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        joint_model::check_ends(&self.a, &self.b, outline, report);
        report.between("restitution", self.restitution, 0.0, 1.0);
        report.positive_if_given("break_force", self.break_force);
        report.positive_if_given("length", self.length);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        joint_model::install::<Self>(
            app,
            outline,
            entries.into_iter().map(|WrittenEntry { value, .. }| Setup {
                name: value.name,
                partners: [value.a, value.b],
                anchors: [value.anchor_a, value.anchor_b].map(|anchor| anchor.map(LengthPair::si)),
                collide: value.collide,
                assemble: false,
                absent: Absent::Center,
                asked: Asked {
                    restitution: value.restitution.si(),
                    break_force: value.break_force.map(Force::si),
                    ..Asked::default()
                },
                law: Arc::new(Cord { length: value.length.map(Length::si) }),
            }),
        );
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Rope>();
}

/// The law of a rope.
#[derive(Clone, Copy, Debug)]
pub struct Cord {
    /// Its length in metres; `None`: the distance at the start.
    pub length: Option<f64>,
}

impl JointLaw for Cord {
    fn begun(&self, pair: &EndPair) -> Arc<dyn JointLaw> {
        Arc::new(Self { length: Some(self.length.unwrap_or(pair.between().length())) })
    }

    fn hold(&self, _: &EndPair, _: &mut dyn FnMut(Held)) {}

    fn limits(&self) -> Option<[f64; 2]> {
        self.length.map(|length| [f64::NEG_INFINITY, length])
    }

    fn freedom(&self, pair: &EndPair) -> Option<Freedom> {
        let value = pair.between().length();
        Some(Freedom { along: if value > 0.0 { pair.stretch() } else { pair.point(DVec2::X) }, value })
    }

    fn freedom_name(&self) -> (&'static str, &'static str) {
        ("distance", "m")
    }
}
