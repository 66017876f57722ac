//! Scenes that begin with NaN or infinity, or with anchors beyond all digits. They are refused before the first tick, with the part
//! of the scene that is to blame.

use bevy_ecs::prelude::*;

use super::{LoadErrors, Model, State};
use crate::scene::SceneError;
use crate::world::anchor::{Anchor, Anchors};
use crate::world::{Name, finite};
use jostle_language::numbers::number;

const HELP: &str =
    "numbers beyond 1e308 overflow. Look for enormous distances, sizes, speeds, masses, stiffnesses or fields";

/// Reports the first body, or else the first model, whose state or energy is NaN or infinite. Mistakes found before may be the
/// cause, so it adds nothing to them.
pub(crate) fn refuse_not_finite(world: &mut World) {
    if has_errors(world) {
        return;
    }
    let state = world.resource::<State>();
    let (path, message) = if let Some((body, quantity)) = finite::first_not_finite(state.bodies()) {
        let name = world.get::<Name>(state.bodies().entity[body]).map(Name::to_string).unwrap_or_default();
        ("bodies", format!("the {quantity} of `{name}` is infinite or NaN at the start"))
    } else if let Some(model) = state.models().find(|model| !holds_finite_energy(*model, state)) {
        let name = model.name().rsplit("::").next().unwrap_or_default();
        (section_of(model.name()), format!("the energy of `{name}` is infinite or NaN at the start"))
    } else {
        return;
    };
    world.get_resource_or_init::<LoadErrors>().0.push(SceneError::new(path, message).with_help(HELP));
}

fn has_errors(world: &World) -> bool {
    world.get_resource::<LoadErrors>().is_some_and(|errors| !errors.0.is_empty())
}

fn holds_finite_energy(model: &dyn Model, state: &State) -> bool {
    let energies = model.energies(state);
    (energies.potential + energies.elastic).is_finite()
}

/// The section of the scene from which a model comes: the folder of its type has the same name.
fn section_of(type_name: &str) -> &str {
    type_name.split("::").nth(1).filter(|folder| ["forces", "joints", "contacts"].contains(folder)).unwrap_or("bodies")
}

/// The least moment of inertia as a share of `m r^2`, with the arm `r` of the farthest force. Rounding of a force `F` moves that point by
/// the share `eps m r^2/I` of `F/m`, which is less than 1e-3 then.
const LEAST_INERTIA: f64 = 1e-12;

/// Reports the first body whose moment of inertia is so small that rounding of forces turns it. No step would be short enough for it.
/// A far anchor may be the cause, so it adds nothing to that.
pub(crate) fn refuse_least_inertia(world: &mut World) {
    if has_errors(world) {
        return;
    }
    let bodies = world.resource::<State>().bodies();
    let mut arms: Vec<f64> = (0..bodies.len()).map(|body| bodies.extent(body)).collect();
    for anchor in world.get_resource::<Anchors>().map_or(&[][..], |anchors| &anchors.0) {
        if let Some(body) = anchor.body.and_then(|body| bodies.index(body)) {
            arms[body] = arms[body].max(anchor.at.length());
        }
    }
    let least = |body: usize| LEAST_INERTIA * bodies.mass[body] * arms[body] * arms[body];
    let turns = |body: usize| bodies.dynamic[body] && bodies.inverse_inertia(body) > 0.0;
    let too_small = (0..bodies.len()).find(|&body| turns(body) && bodies.inertia[body] < least(body));
    let Some(body) = too_small else { return };
    let name = world.get::<Name>(bodies.entity[body]).map(Name::to_string).unwrap_or_default();
    let message = format!(
        "the moment of inertia of `{name}` is {} kg m2. Below {} kg m2 the rounding of forces would turn it",
        number(bodies.inertia[body]),
        number(least(body))
    );
    let help = "leave `inertia` out, give a greater one in kg m2, or move its anchors nearer";
    world.get_resource_or_init::<LoadErrors>().0.push(SceneError::new("bodies", message).with_help(help));
}

/// Reports the first anchor that one rounding of an angle moves by more than the size of its body. The place of the body has no
/// part in that.
pub(crate) fn refuse_far_anchors(world: &mut World) {
    let bodies = world.resource::<State>().bodies();
    // Its length would overflow.
    let farthest = |anchor: &Anchor| anchor.at.abs().max_element();
    let is_far = |anchor: &&Anchor| {
        let size = anchor.body.and_then(|body| bodies.index(body)).map_or(f64::INFINITY, |body| bodies.extent(body));
        size > 0.0 && f64::EPSILON * farthest(anchor) > size
    };
    let Some(anchors) = world.get_resource::<Anchors>() else { return };
    let Some(far) = anchors.0.iter().find(is_far) else { return };
    let message = format!(
        "the anchor is {} m away. Numbers of 16 digits hold places so far only to {} m",
        number(farthest(far)),
        number(f64::EPSILON * farthest(far))
    );
    let error = SceneError::new(far.path.clone(), message).with_help("move it nearer to its body");
    world.get_resource_or_init::<LoadErrors>().0.push(error);
}
