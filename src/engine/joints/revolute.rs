//! A hinge: both anchors coincide, and the bodies turn. Two rows: the anchors along both axes of the world.

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
use crate::forces::link::Partner;
use crate::scene::units::{Angle, Force, LengthPair, Scalar, Torque};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A hinge: `anchor_a` of `a` and `anchor_b` of `b` coincide, and the bodies turn about them. Its angle is that of `b`
/// minus that of `a`, counter-clockwise, over full turns.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Revolute {
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
    /// Least and greatest angle of `b` relative to `a`, in radians or with a unit such as "90 deg". Default: none.
    limits: Option<(Angle, Angle)>,
    /// The share of its speed with which it comes back from a limit, 0 to 1. With 0 it stays there. Default: 0.
    #[serde(default)]
    restitution: Scalar,
    /// The greatest friction, in N m: below it the joint sticks. Not negative. 0 is no friction. Default: none.
    friction: Option<Torque>,
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

impl Entry for Revolute {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Revolute";
    const EXAMPLE: &'static str =
        "Revolute(name: \"hip\", a: World, anchor_a: (0, 2), b: \"bar\", anchor_b: (-0.5, 0))";

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
                    limits: value.limits.map(|(low, high)| [low.si(), high.si()]),
                    restitution: value.restitution.si(),
                    friction: value.friction.map(Torque::si),
                    break_force: value.break_force.map(Force::si),
                    softness: value.softness.map(Softness::si),
                },
                law: Arc::new(Hinge),
            }),
        );
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Revolute>();
}

/// The law of a hinge.
#[derive(Clone, Copy, Debug)]
pub struct Hinge;

/// Holds both anchors in one place.
pub(super) fn hold_point(pair: &EndPair, held: &mut dyn FnMut(Held)) {
    let (between, size) = (pair.between(), pair.size());
    for direction in [DVec2::X, DVec2::Y] {
        held(Held { along: pair.point(direction), gap: between.dot(direction), size });
    }
}

impl JointLaw for Hinge {
    fn begun(&self, _: &EndPair) -> Arc<dyn JointLaw> {
        Arc::new(*self)
    }

    fn hold(&self, pair: &EndPair, held: &mut dyn FnMut(Held)) {
        hold_point(pair, held);
    }

    fn freedom(&self, pair: &EndPair) -> Option<Freedom> {
        Some(Freedom { along: pair.turn(), value: pair.b.angle - pair.a.angle })
    }
}
