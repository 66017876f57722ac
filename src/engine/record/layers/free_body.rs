//! `FreeBody(of: ["block"], parts: [Weight, Normal, Friction])`: the free-body diagram. Each force on a body is an
//! arrow with its name.
//!
//! Weight acts at the centre of mass, `m g`. A contact's force is drawn in two parts: along its normal, and friction across it. Forces
//! of springs and joints act at their anchors. Neighbouring contacts in about one direction are one arrow, as in the layer
//! [`ContactForces`](super::contact_forces). Drag, thrust and the like are not drawn. Forces are those at the end of a tick.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::contact_forces::{TypicalForce, loads, note_start};
use super::of_bodies::OfBodies;
use super::scale::Scale;
use super::{Layer, Mark, MarkShape, PictureHeight, Shown};
use crate::contacts::{ContactPoint, Other};
use crate::scene::units::Force;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Outline, SceneAppExt};
use crate::tick::{AfterLoad, ForcePart, State};

/// Names are above a point. Names of arrows that point down are lower by this share of the picture's height.
const LINE: f64 = 0.042;

/// The forces on bodies one by one, as arrows with their names: a free-body diagram.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FreeBody {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
    /// The forces that the layer draws. Default: all five.
    #[serde(default = "all")]
    parts: Vec<Part>,
    /// The force whose arrow is a tenth of the picture's height long, in N. Default: as for `ContactForces`.
    #[serde(default)]
    scale: Option<Force>,
    /// Whether each arrow bears its name. Default: true.
    #[serde(default = "yes")]
    names: bool,
}

/// A kind of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
enum Part {
    /// `m g` at the centre of mass.
    Weight,
    /// Of contacts, along their normal.
    Normal,
    /// Of contacts, across their normal.
    Friction,
    /// Of springs and dampers, at their ends.
    Spring,
    /// Of joints and of motors on them, at their anchors.
    Joint,
}

impl Part {
    const ALL: [Self; 5] = [Self::Weight, Self::Normal, Self::Friction, Self::Spring, Self::Joint];

    /// Its name in the picture, and the colour of its arrow.
    fn look(self) -> (&'static str, &'static str) {
        match self {
            Self::Weight => ("weight", "blue"),
            Self::Normal => ("normal", "force"),
            Self::Friction => ("friction", "orange"),
            Self::Spring => ("spring", "green"),
            Self::Joint => ("joint", "purple"),
        }
    }
}

fn all() -> Vec<Part> {
    Part::ALL.to_vec()
}

fn yes() -> bool {
    true
}

impl OfBodies for FreeBody {
    const NAME: &'static str = "FreeBody";
    const EXAMPLE: &'static str = "FreeBody(of: [\"block\"], parts: [Weight, Normal, Friction])";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn check_others(&self, report: &mut Diagnostics) {
        report.positive_if_given("scale", self.scale);
        if self.parts.is_empty() {
            report.error("parts", "must name at least one force").help("for example: parts: [Weight, Normal]");
        }
    }

    fn prepare(app: &mut App) {
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(note_start);
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        let Self { parts, scale, names, .. } = self;
        let given = scale.map(Force::si);
        move |world: &World, marks: &mut Vec<Mark>| {
            let state = world.resource::<State>();
            let typical = world.get_resource::<TypicalForce>().map_or(1.0, |typical| typical.0);
            let height = PictureHeight::of(world);
            let scale = |color| Scale::new(given.unwrap_or(typical), height, "N", color);
            marks.push(scale("force").key());
            for body in shown.indices(state.bodies()) {
                for (part, point, force) in forces_on(state, body).into_iter().filter(|(part, ..)| parts.contains(part))
                {
                    let (name, color) = part.look();
                    let Some(arrow) = scale(color).arrow(point, force) else { continue };
                    let (MarkShape::Arrow(_, tip) | MarkShape::LongArrow(_, tip)) = arrow.shape else { continue };
                    marks.push(arrow);
                    if names {
                        let below = (tip - point).normalize_or_zero().y.min(0.0) * LINE * height;
                        let at = tip + DVec2::new(0.0, below);
                        marks.push(Mark::new(MarkShape::Label { at, clear: 0.0, text: name.to_owned() }, color));
                    }
                }
            }
        }
    }
}

/// Each force on a body: its kind, the point of action in metres, and the force in newtons.
fn forces_on(state: &State, body: usize) -> Vec<(Part, DVec2, DVec2)> {
    let bodies = state.bodies();
    let mut found = Vec::new();
    if bodies.dynamic[body] {
        found.push((Part::Weight, bodies.position[body], state.gravity() * bodies.mass[body]));
    }
    let contacts = state.contact_points().unwrap_or_default();
    let own: Vec<ContactPoint> = contacts.into_iter().filter_map(|contact| seen_by(body, contact)).collect();
    let normal = |contact: &ContactPoint| contact.normal * contact.force.dot(contact.normal);
    for (part, of) in [
        (Part::Normal, &normal as &dyn Fn(&ContactPoint) -> DVec2),
        (Part::Friction, &|contact: &ContactPoint| contact.force - normal(contact)),
    ] {
        let parts = own.iter().map(|contact| ContactPoint { force: of(contact), ..*contact });
        found.extend(loads(parts).into_iter().map(|load| (part, load.point, load.force)));
    }
    for told in state.models().filter_map(|model| model.force_on(state, body)) {
        let part = match told.part {
            ForcePart::Spring => Part::Spring,
            ForcePart::Joint => Part::Joint,
        };
        found.push((part, told.point, told.force));
    }
    found
}

/// A contact as the force on this body; `None`: the body is not in touch there.
fn seen_by(body: usize, contact: ContactPoint) -> Option<ContactPoint> {
    if contact.body == body {
        return Some(contact);
    }
    (contact.other == Other::Body(body)).then(|| ContactPoint {
        body,
        other: Other::Body(contact.body),
        force: -contact.force,
        normal: -contact.normal,
        ..contact
    })
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<FreeBody>();
}
