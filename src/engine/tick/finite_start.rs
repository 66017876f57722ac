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
    if world.get_resource::<LoadErrors>().is_some_and(|errors| !errors.0.is_empty()) {
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

fn holds_finite_energy(model: &dyn Model, state: &State) -> bool {
    let energies = model.energies(state);
    (energies.potential + energies.elastic).is_finite()
}

/// The section of the scene from which a model comes: the folder of its type has the same name.
fn section_of(type_name: &str) -> &str {
    type_name.split("::").nth(1).filter(|folder| ["forces", "joints", "contacts"].contains(folder)).unwrap_or("bodies")
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
