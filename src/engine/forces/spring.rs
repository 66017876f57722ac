//! A spring and a damper between two points (Hooke 1678; Kelvin and Voigt). With the distance `l` of its ends, both are
//! pulled towards each other by `F = k (l - l0) + c dl/dt`, in newtons. Elastic energy `k (l - l0)^2/2`; the damper
//! takes `c (dl/dt)^2` watts, booked as `damping`.
//!
//! If the ends coincide, the force of the spring has no direction. A spring with a length then gives no force, and a
//! spring of zero length never pushes. The damper acts along the relative velocity of the ends, which is the limit of
//! ends that pass each other.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::link::{self, DAMPING, ForceLink, LinkEnd, Partner};
use crate::scene::units::{Damping, Length, LengthPair, Stiffness};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, SceneError, WrittenEntry, exact};
use crate::tick::critical_step;
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Dependence, Energies, ForceOn, ForcePart, LoadErrors, Loss, Model, State, SteadySpring, TickAppExt};

/// A spring, and a damper beside it, between points of two bodies or of a body and the world. It pulls its ends together by
/// `stiffness (distance - length) + damping d(distance)/dt`, and pushes if that is negative.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Spring {
    /// The body at one end.
    #[serde(deserialize_with = "link::body_at_a")]
    a: String,
    /// The body at the other end, or `World`.
    b: Partner,
    /// The anchor on `a` in its frame, in metres, from its centre of mass, or from the origin with `datum: Origin`. Default: the
    /// centre of mass.
    anchor_a: Option<LengthPair>,
    /// The anchor on `b` in its frame, in metres, from its centre of mass, or from the origin with `datum: Origin`. With `World`
    /// it is a place in the world. Default: the centre of mass, or the origin of the world.
    anchor_b: Option<LengthPair>,
    /// Force over lengthening in N/m. Not negative.
    stiffness: Stiffness,
    /// Force over speed of lengthening in N s/m. Not negative. `2 sqrt(k m)` lets a mass `m` on it come to rest without a
    /// swing. Default: 0.
    #[serde(default)]
    damping: Damping,
    /// Length without force in metres. Not negative. Default: the distance of its ends at the start.
    length: Option<Length>,
}

impl Entry for Spring {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Spring";
    const EXAMPLE: &'static str = "Spring(a: \"left\", b: \"right\", stiffness: 100, damping: 0.5)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        link::check_ends(&self.a, &self.b, outline, report);
        link::check_holds(self.stiffness, self.damping, report);
        if let Some(length) = self.length {
            report.not_negative("length", length);
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let paths = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        for (WrittenEntry { value, .. }, mention) in entries.into_iter().zip(paths) {
            app.add_model(SpringForce {
                link: ForceLink::named(&value.a, &value.b, outline),
                anchors: [value.anchor_a, value.anchor_b].map(|anchor| anchor.map(LengthPair::si)),
                stiffness: value.stiffness.si(),
                damping: value.damping.si(),
                power: 0.0,
                force: DVec2::ZERO,
                length: value.length.map(Length::si),
                path: mention.path.clone(),
            });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct SpringForce {
    /// Its ends.
    pub link: ForceLink,
    /// Its anchors as the scene gives them.
    anchors: [Option<DVec2>; 2],
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// Damping in N s/m.
    pub damping: f64,
    /// Power that the damper took in the last evaluation, in watts.
    power: f64,
    /// Its force on end A in the last evaluation, in newtons.
    force: DVec2,
    /// Length without force in metres; `None`: the distance of the ends at the start, which takes its place then.
    pub length: Option<f64>,
    /// Its path in the scene, such as `forces[0]`.
    pub path: String,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Spring>();
}

/// The state of a spring: direction from A to B, distance in m, and speed of lengthening in m/s.
fn stretch(a: &LinkEnd, b: &LinkEnd) -> (DVec2, f64, f64) {
    let (between, parting) = (b.position - a.position, b.velocity - a.velocity);
    let distance = between.length();
    let direction = if distance > 0.0 { between / distance } else { parting.normalize_or_zero() };
    (direction, distance, parting.dot(direction))
}

impl SpringForce {
    fn lengthening(&self, distance: f64) -> f64 {
        distance - self.length.unwrap_or(distance)
    }
}

impl Model for SpringForce {
    fn dependence(&self) -> Dependence {
        if self.damping > 0.0 { Dependence::Velocity } else { Dependence::Position }
    }

    /// Takes the distance at the start for a length that the scene does not give.
    fn start(&mut self, world: &mut World) {
        self.link.place_anchors(self.anchors, &self.path, world);
        let Some((a, b)) = self.link.ends(&world.resource::<State>().bodies) else { return };
        let distance = (b.position - a.position).length();
        let length = *self.length.get_or_insert(distance);
        if distance == 0.0 && length > 0.0 {
            let path = format!("{}.length", self.path);
            let message = format!("both ends are in one place: in which direction should {} m lie?", exact(length));
            let help = "move an end or an anchor, or give the spring no length: `length: 0`";
            let error = SceneError::new(path, message).with_help(help);
            world.get_resource_or_init::<LoadErrors>().0.push(error);
        }
    }

    fn loss(&self) -> Option<Loss> {
        (self.damping > 0.0).then_some(Loss { account: DAMPING, power: self.power })
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.power, self.force, self.length))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.power, self.force, self.length) = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, state: &State) -> Energies {
        let stretched =
            self.link.ends(&state.bodies).map(|(a, b)| self.lengthening((b.position - a.position).length()));
        Energies { potential: 0.0, elastic: 0.5 * self.stiffness * stretched.unwrap_or(0.0).powi(2) }
    }

    /// Along the spring the stiffness is its constant. Across it, a pulling spring has the stiffness `F/l` of its
    /// tension.
    fn stiffness(&self, state: &State, list: &mut Vec<SteadySpring>) {
        let Some((a, b)) = self.link.ends(&state.bodies) else { return };
        let (direction, distance, _) = stretch(&a, &b);
        let tension = if distance > 0.0 { self.lengthening(distance) / distance } else { 1.0 };
        let across = self.stiffness * tension.max(0.0);
        let normal = if direction == DVec2::ZERO { DVec2::X } else { direction };
        let Some((a, b)) = link::sides(&a, &b) else { return };
        let spring =
            critical_step::Spring { a, b, normal, stiffness: (self.stiffness, across), damped: 0.0, turning: 0.0 };
        list.push(SteadySpring { spring, damping: self.damping, turning_damping: 0.0 });
    }

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        let (a, b) = self.link.ends(&state.bodies)?;
        let ends = [(a.body, a.position, self.force), (b.body, b.position, -self.force)];
        ForceOn::of_ends(ForcePart::Spring, body, ends)
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        (self.power, self.force) = (0.0, DVec2::ZERO);
        self.link.refresh(bodies);
        let Some((a, b)) = self.link.ends(bodies) else { return };
        let (direction, distance, speed) = stretch(&a, &b);
        let elastic = if distance > 0.0 { self.stiffness * self.lengthening(distance) } else { 0.0 };
        self.power = self.damping * speed * speed;
        self.force = direction * (elastic + self.damping * speed);
        link::pull(&a, &b, self.force, bodies, rates);
    }
}
