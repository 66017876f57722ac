//! A massless rod: both anchors keep their distance. One row, along the line through both.

use std::sync::Arc;

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ends::EndPair;
use super::joint_model::{self, Absent, Setup};
use super::law::{Freedom, Held, JointLaw};
use super::parts::Asked;
use super::soft::Softness;
use crate::forces::link::Partner;
use crate::scene::units::{Force, Length, LengthPair};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A rod without mass: `anchor_a` of `a` and `anchor_b` of `b` stay at one distance.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Distance {
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
    /// The distance in metres. Above zero. Default: that at the start.
    length: Option<Length>,
    /// The force in N at which it breaks forever. Above zero. A blow at a limit or a taut rope counts as an even force over a
    /// millisecond. Default: none.
    break_force: Option<Force>,
    /// The frequency in Hz and the damping ratio with which it swings as a spring. Default: none.
    softness: Option<Softness>,
    /// Whether both bodies touch each other. Default: false.
    #[serde(default)]
    collide: bool,
    /// Whether the engine moves bodies to close a joint that is open at the start. The card gives the distance. If not, an
    /// open joint is an error. Default: false.
    #[serde(default)]
    assemble: bool,
}

impl Entry for Distance {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Distance";
    const EXAMPLE: &'static str = "Distance(a: \"bar\", anchor_a: (0.5, 0), b: \"bob\", length: 0.5)";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        joint_model::check_ends(&self.a, &self.b, outline, report);
        report.positive_if_given("break_force", self.break_force);
        Softness::check(self.softness, report);
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
                assemble: value.assemble,
                absent: Absent::Center,
                asked: Asked {
                    break_force: value.break_force.map(Force::si),
                    softness: value.softness.map(Softness::si),
                    ..Asked::default()
                },
                law: Arc::new(Rod { length: value.length.map(Length::si) }),
            }),
        );
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Distance>();
}

/// The law of a rod.
#[derive(Clone, Copy, Debug)]
pub struct Rod {
    /// Distance in metres; `None`: that at the start.
    pub length: Option<f64>,
}

impl JointLaw for Rod {
    fn begun(&self, pair: &EndPair) -> Arc<dyn JointLaw> {
        Arc::new(Self { length: Some(self.length.unwrap_or(pair.between().length())) })
    }

    fn hold(&self, pair: &EndPair, held: &mut dyn FnMut(Held)) {
        let length = self.length.unwrap_or_default();
        held(Held { along: pair.stretch(), gap: pair.between().length() - length, size: pair.size() + length });
    }

    fn needs_distance(&self) -> bool {
        true
    }

    fn freedom(&self, pair: &EndPair) -> Option<Freedom> {
        Some(Freedom { along: pair.turn(), value: pair.b.angle - pair.a.angle })
    }
}
