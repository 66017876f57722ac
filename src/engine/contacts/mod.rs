//! Contacts: the search for pairs that may touch ([`search`]), and one contact law per scene.

pub mod events;
pub(crate) mod geometry;
mod law;
pub mod penalty;
pub mod search;

use bevy_app::App;

use crate::scene::{Arity, Outline, SceneAppExt};
use crate::tick::kept::SnapshotAppExt;
use crate::world::{Body, Wall, atom};

pub use crate::tick::pairs::{AtomPair, CandidatePairs, Probe, Surface, SurfacePair};
pub use crate::tick::touch::{ContactForces, ContactPoint, DeepestOverlap, Other, Overlap, Touches};
pub use events::{ContactEvents, ContactEventsAppExt};
pub use law::{ContactLaw, LawSide, LawTouch, add_law};

const MEANING: &str = "\
The law by which touching bodies and walls push each other. Without this section it is `Penalty` with its defaults, if bodies \
can touch. With `contacts: None` bodies pass through each other and through walls.";

/// Registers the contact laws of this folder.
pub fn plugin(app: &mut App) {
    app.register_entry_section("contacts", Arity::OneOrNone, "contacts: Penalty(tangential: Spring(ratio: 0.8))");
    app.describe_section("contacts", MEANING);
    penalty::plugin(app);
    app.keep_resource::<ContactEvents>();
    app.reserve_entry("contacts", "Rigid");
}

/// A scene without the section gets penalty contacts with their defaults when there is something to touch.
pub fn install_default(outline: &Outline, app: &mut App) {
    if outline.has_section("contacts") {
        return;
    }
    let world = app.world_mut();
    let colliding = world.query::<&Body>().iter(world).filter(|body| body.collides).count();
    let walls = world.query::<&Wall>().iter(world).count();
    if atom::count_atoms(world) > 0 && (colliding > 1 || (colliding > 0 && walls > 0)) {
        penalty::install(penalty::Penalty::default(), app);
    }
}
