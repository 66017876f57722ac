//! A slide (prismatic joint). A line through the anchor on body A turns with that body. The anchor on body B stays on the line,
//! and both bodies turn alike. There are two rows: across the line, and the angle.

use std::sync::Arc;

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ends::EndPair;
use super::joint_model::{self, Absent, Setup};
use super::law::{Freedom, Held, JointLaw};
use super::parts::{self, Asked};
use super::soft::Softness;
use super::weld::hold_angle;
use crate::forces::link::Partner;
use crate::scene::units::{Force, Length, LengthPair, Scalar};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A slide: `anchor_b` of `b` moves along a line through `anchor_a` that belongs to `a`. Body `b` does not turn against
/// `a`. Its travel counts from `anchor_a` along the line.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Prismatic {
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
    /// Direction of the line in the frame of `a`. Its length is not zero.
    axis: LengthPair,
    /// Least and greatest travel of `b` along the line, in metres or with a unit. Default: none.
    limits: Option<(Length, Length)>,
    /// The share of its speed with which it comes back from a limit, 0 to 1. With 0 it stays there. Default: 0.
    #[serde(default)]
    restitution: Scalar,
    /// The greatest friction, in N: below it the joint sticks. Not negative. 0 is no friction. Default: none.
    friction: Option<Force>,
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

impl Entry for Prismatic {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Prismatic";
    const EXAMPLE: &'static str = "Prismatic(name: \"piston\", a: World, b: \"box\", axis: (1, 0))";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        joint_model::check_ends(&self.a, &self.b, outline, report);
        parts::check_limits(self.limits.as_ref(), report);
        parts::check_restitution(self.restitution, self.limits.is_some(), report);
        parts::check_friction(self.friction, report);
        report.positive_if_given("break_force", self.break_force);
        Softness::check(self.softness, report);
        if report.finite_pair("axis", self.axis.si()) && self.axis.si() == DVec2::ZERO {
            report
                .error("axis", "the line has no direction")
                .help("give `axis` two numbers that are not both zero, such as `(1, 0)`");
        }
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
                    limits: value.limits.map(|(low, high)| [low.si(), high.si()]),
                    restitution: value.restitution.si(),
                    friction: value.friction.map(Force::si),
                    break_force: value.break_force.map(Force::si),
                    softness: value.softness.map(Softness::si),
                },
                law: Arc::new(Slide { axis: value.axis.si().normalize_or(DVec2::X), angle: None }),
            }),
        );
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Prismatic>();
}

/// The law of a slide.
#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// Direction of the line in the frame of body A, of length one.
    pub axis: DVec2,
    /// Angle of B relative to A in rad; `None`: that at the start.
    pub angle: Option<f64>,
}

impl JointLaw for Slide {
    fn begun(&self, pair: &EndPair) -> Arc<dyn JointLaw> {
        Arc::new(Self { angle: Some(self.angle.unwrap_or(pair.b.angle - pair.a.angle)), ..*self })
    }

    fn hold(&self, pair: &EndPair, held: &mut dyn FnMut(Held)) {
        let across = pair.a.axis.rotate(self.axis).perp();
        held(Held { along: pair.across(across), gap: pair.between().dot(across), size: pair.size() });
        hold_angle(pair, self.angle.unwrap_or_default(), held);
    }

    fn freedom(&self, pair: &EndPair) -> Option<Freedom> {
        let axis = pair.a.axis.rotate(self.axis);
        Some(Freedom { along: pair.across(axis), value: pair.between().dot(axis) })
    }

    fn freedom_name(&self) -> (&'static str, &'static str) {
        ("travel", "m")
    }
}
