//! A weld of two bodies: the anchors coincide, and the angle between the bodies keeps its initial value. It has three
//! rows.

use std::sync::Arc;

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ends::EndPair;
use super::joint_model::{self, Absent, Setup};
use super::law::{Held, JointLaw};
use super::parts::Asked;
use super::revolute::hold_point;
use super::soft::Softness;
use crate::forces::link::Partner;
use crate::scene::units::{Force, LengthPair};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A weld, which holds two bodies in their relative pose at the start.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Weld {
    /// Its name, for channels and controllers. Default: none.
    name: Option<String>,
    /// One body, or `World`.
    a: Partner,
    /// The other body, or `World`.
    b: Partner,
    /// The anchor on `a` in its frame, in metres, from its centre of mass, or from the origin with `datum: Origin`.
    /// With `World` it is a point in the world. Default: the place of the other anchor at the start.
    anchor_a: Option<LengthPair>,
    /// The anchor on `b`, likewise. If both anchors are absent, it is the centre of mass of `b`. Default: the place of the
    /// other anchor at the start.
    anchor_b: Option<LengthPair>,
    /// The force in N at which it breaks forever. Above zero. A blow at a limit or a taut rope counts as an even force over a
    /// millisecond. Default: none.
    break_force: Option<Force>,
    /// The frequency in Hz and the damping ratio with which it swings as a spring. The frequency is that of the mean of
    /// both directions. Default: none.
    softness: Option<Softness>,
    /// Whether both bodies touch each other. Default: false.
    #[serde(default)]
    collide: bool,
    /// Whether the engine moves bodies to close a joint that is open at the start. The card gives the distance. If not, an
    /// open joint is an error. Default: false.
    #[serde(default)]
    assemble: bool,
}

impl Entry for Weld {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Weld";
    const EXAMPLE: &'static str = "Weld(a: \"box\", b: \"bar\")";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        joint_model::check_ends(&self.a, &self.b, outline, report);
        report.positive_if_given("break_force", self.break_force);
        Softness::check(self.softness, report);
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
                absent: Absent::Stands,
                asked: Asked {
                    break_force: value.break_force.map(Force::si),
                    softness: value.softness.map(Softness::si),
                    ..Asked::default()
                },
                law: Arc::new(Fixed { angle: None }),
            }),
        );
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Weld>();
}

/// The law of a weld.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    /// Angle of B relative to A in rad; `None`: that at the start.
    pub angle: Option<f64>,
}

/// Holds the angle of B relative to A.
pub(super) fn hold_angle(pair: &EndPair, angle: f64, held: &mut dyn FnMut(Held)) {
    let size = pair.a.angle.abs() + pair.b.angle.abs() + 1.0;
    held(Held { along: pair.turn(), gap: pair.b.angle - pair.a.angle - angle, size });
}

impl JointLaw for Fixed {
    fn begun(&self, pair: &EndPair) -> Arc<dyn JointLaw> {
        Arc::new(Self { angle: Some(self.angle.unwrap_or(pair.b.angle - pair.a.angle)) })
    }

    fn hold(&self, pair: &EndPair, held: &mut dyn FnMut(Held)) {
        hold_point(pair, held);
        hold_angle(pair, self.angle.unwrap_or_default(), held);
    }
}
