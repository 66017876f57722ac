//! The two ends of a spring: points of two bodies, or of a body and the world.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer};
use std::borrow::Cow;

use crate::scene::{Diagnostics, NameKind, Outline, SceneAppExt};
use crate::tick::energy::CHANNELS;
use crate::tick::{Rates, State};
use crate::world::{Bodies, anchor};

/// The account of what dampers take.
pub const DAMPING: &str = "damping";

/// Registers the channel of this account.
pub fn plugin(app: &mut App) {
    app.register_word(CHANNELS, "energy.damping");
}

/// The holder of an end: the body of a name, or the word `World`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The body of this name.
    Body(String),
    /// The world: the end does not move.
    World,
}

const EXPECTED: &str = "expected the name of a body such as \"ball\", or the word `World`";

impl<'de> Deserialize<'de> for Partner {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        // A word and a text in quotes at one place: only the written text distinguishes them.
        let written = Box::<ron::value::RawValue>::deserialize(reader)?;
        let written = written.trim().get_ron();
        if written == "World" {
            return Ok(Self::World);
        }
        ron::from_str(written).map(Self::Body).map_err(|_| de::Error::custom(format!("{EXPECTED}, found {written}")))
    }
}

/// Reads the name of the body at end `a`, which is never the world.
///
/// # Errors
/// If the scene gives anything but a name.
pub(super) fn body_at_a<'de, R: Deserializer<'de>>(reader: R) -> Result<String, R::Error> {
    match Partner::deserialize(reader)? {
        Partner::Body(name) => Ok(name),
        Partner::World => Err(de::Error::custom(
            "expected the name of a body such as \"ball\". Only `b` may be `World`: exchange the two ends",
        )),
    }
}

impl JsonSchema for Partner {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "partner".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-value": "name of a body, or the word World" })
    }
}

/// Reports a stiffness and a damping that cannot be, or hold nothing.
pub(super) fn check_holds(stiffness: impl Into<f64>, damping: impl Into<f64>, report: &mut Diagnostics) {
    let (stiffness, damping) = (stiffness.into(), damping.into());
    report.not_negative("stiffness", stiffness);
    report.not_negative("damping", damping);
    if stiffness == 0.0 && damping == 0.0 {
        report.error("", "this spring holds nothing").help("give `stiffness` or `damping` a value above zero");
    }
}

/// Reports ends without a body, and two ends on one body.
pub(super) fn check_ends(a: &str, b: &Partner, outline: &Outline, report: &mut Diagnostics) {
    outline.require(NameKind::BODY, a, "a", report);
    if let Partner::Body(b) = b {
        outline.require(NameKind::BODY, b, "b", report);
        if a == b {
            let help = "name two bodies, or hold one to the world with `b: World`";
            report.error("b", format!("both ends are on \"{a}\": the force would move no body")).help(help);
        }
    }
}

/// Two ends, found again when bodies come or go.
#[derive(Clone, Debug)]
pub struct ForceLink {
    keys: (u64, Option<u64>),
    anchors: (DVec2, DVec2),
    generation: u64,
    indices: Option<(usize, Option<usize>)>,
}

/// An end in the present state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkEnd {
    /// Place of its body; `None`: the world.
    pub body: Option<usize>,
    /// From the body's centre of mass, in metres.
    pub arm: DVec2,
    /// Its position, in metres.
    pub position: DVec2,
    /// Its velocity, in m/s.
    pub velocity: DVec2,
}

impl LinkEnd {
    fn of(body: usize, anchor: DVec2, bodies: &Bodies) -> Self {
        let mut arm = anchor;
        // The centre of mass needs no angle.
        if anchor != DVec2::ZERO {
            let (sin, cos) = libm::sincos(bodies.angle[body]);
            arm = DVec2::new(cos, sin).rotate(anchor);
        }
        let (position, velocity) = (bodies.position[body] + arm, bodies.velocity_at(body, arm));
        Self { body: Some(body), arm, position, velocity }
    }

    /// Whether forces move it.
    fn dynamic(&self, bodies: &Bodies) -> bool {
        self.body.is_some_and(|body| bodies.dynamic[body])
    }

    /// Angle in rad and spin in rad/s of its body; the world does not turn.
    pub fn turn(&self, bodies: &Bodies) -> (f64, f64) {
        self.body.map_or((0.0, 0.0), |body| (bodies.angle[body], bodies.spin[body]))
    }
}

impl ForceLink {
    /// A spring between bodies of these keys, `None` for the world. Anchors are in the frames of the bodies, from their
    /// centres of mass, or in the world, in metres.
    pub fn new(a: u64, b: Option<u64>, anchors: (DVec2, DVec2)) -> Self {
        Self { keys: (a, b), anchors, generation: 0, indices: None }
    }

    /// Between the centres of mass of those that a scene names. The keys of a scene's bodies are their places in the outline.
    pub(super) fn named(a: &str, b: &Partner, outline: &Outline) -> Self {
        let key = |name: &str| outline.position(NameKind::BODY, name).unwrap_or_default() as u64;
        let b = match b {
            Partner::Body(name) => Some(key(name)),
            Partner::World => None,
        };
        Self::new(key(a), b, (DVec2::ZERO, DVec2::ZERO))
    }

    /// Takes the anchors that the entry at `path` gives, from the datum of each body.
    pub(super) fn place_anchors(&mut self, given: [Option<DVec2>; 2], path: &str, world: &mut World) {
        let keys = [Some(self.keys.0), self.keys.1];
        let ends = [(&mut self.anchors.0, "anchor_a"), (&mut self.anchors.1, "anchor_b")];
        for (((anchor, field), key), given) in ends.into_iter().zip(keys).zip(given) {
            let bodies = &world.resource::<State>().bodies;
            let body = key.and_then(|key| bodies.key.find(key)).map(|index| bodies.entity[index]);
            let path = format!("{path}.{field}");
            match given {
                Some(given) => *anchor = body.map_or(given, |body| anchor::from_center(world, body, path, given)),
                None => anchor::note_default(world, body, path, *anchor),
            }
        }
    }

    /// Looks the bodies up again if some have come or gone.
    pub fn refresh(&mut self, bodies: &Bodies) {
        if self.generation != bodies.generation {
            self.generation = bodies.generation;
            self.indices = self.look_up(bodies);
        }
    }

    fn look_up(&self, bodies: &Bodies) -> Option<(usize, Option<usize>)> {
        let index = |key: u64| bodies.key.find(key);
        let b = match self.keys.1 {
            Some(key) => Some(index(key)?),
            None => None,
        };
        Some((index(self.keys.0)?, b))
    }

    /// Both ends in the present state; `None` if one of the bodies is gone.
    pub fn ends(&self, bodies: &Bodies) -> Option<(LinkEnd, LinkEnd)> {
        let (a, b) = if self.generation == bodies.generation { self.indices } else { self.look_up(bodies) }?;
        let world = LinkEnd { body: None, arm: DVec2::ZERO, position: self.anchors.1, velocity: DVec2::ZERO };
        Some((LinkEnd::of(a, self.anchors.0, bodies), b.map_or(world, |b| LinkEnd::of(b, self.anchors.1, bodies))))
    }
}

/// The sides of a spring for the measure of its response: a body and an arm each. The first is absent if the world
/// holds it. `None`: neither end has a body.
pub(super) fn sides(a: &LinkEnd, b: &LinkEnd) -> Option<(Option<Side>, Side)> {
    let side = |end: &LinkEnd| end.body.map(|body| (body, end.arm));
    match (side(a), side(b)) {
        (first, Some(second)) => Some((first, second)),
        (Some(second), None) => Some((None, second)),
        (None, None) => None,
    }
}

/// A body and an arm from its centre of mass in metres.
type Side = (usize, DVec2);

/// Adds `force` newtons to end A, and the opposite force to the other end. An end that forces do not move takes its force from
/// outside, and its motion does work.
pub(super) fn pull(a: &LinkEnd, b: &LinkEnd, force: DVec2, bodies: &mut Bodies, rates: &mut Rates) {
    for (end, other, force) in [(a, b, force), (b, a, -force)] {
        if let Some(body) = end.body.filter(|&body| bodies.dynamic[body]) {
            bodies.push(body, end.arm, force);
            if !other.dynamic(bodies) {
                rates.outside(end.position, force, 0.0);
                rates.work += force.dot(other.velocity);
            }
        }
    }
}

/// Adds `torque` N m to end B and its opposite to end A, likewise.
pub(super) fn twist(a: &LinkEnd, b: &LinkEnd, torque: f64, bodies: &mut Bodies, rates: &mut Rates) {
    for (end, other, torque) in [(a, b, -torque), (b, a, torque)] {
        if let Some(body) = end.body.filter(|&body| bodies.dynamic[body]) {
            bodies.torque[body] += torque;
            if !other.dynamic(bodies) {
                rates.torque += torque;
                rates.work += torque * other.turn(bodies).1;
            }
        }
    }
}
