//! Bounding boxes with a margin: as long as no body has moved by half the margin, whoever is farther apart than the
//! margin cannot touch, and the list of candidate pairs stays as it is (Verlet 1967).
//!
//! The boxes are checked before each evaluation and not only at the end of a tick, because a stage of an integrator
//! may stand anywhere.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::tick::{Evaluate, EvaluateStage, TickAppExt};
use crate::world::Bodies;

/// Margin as a share of the smallest radius. Larger: fewer searches, more candidates.
const MARGIN_SHARE: f64 = 0.7;

/// Axis-aligned bounding boxes of all bodies, each grown by half the margin.
#[derive(Resource, Debug, Default)]
pub struct Bounds {
    /// Counts how often the boxes were made anew: whoever made a list from them compares it.
    pub version: u64,
    /// Distance in metres below which two atoms are candidates.
    pub margin: f64,
    /// Lower left corner of each body's box in metres.
    pub low: Vec<DVec2>,
    /// Upper right corner of each body's box in metres.
    pub high: Vec<DVec2>,
    generation: u64,
    position: Vec<DVec2>,
    angle: Vec<f64>,
}

/// Registers the system of [`EvaluateStage::Bounds`]. Adding it twice does nothing.
pub fn plugin(app: &mut App) {
    if !app.world().contains_resource::<Bounds>() {
        app.init_resource::<Bounds>();
        app.add_packed_systems(Evaluate, 1, update_bounding_boxes.in_set(EvaluateStage::Bounds));
    }
}

/// Makes the boxes anew when a body has moved by half the margin since they were made.
pub fn update_bounding_boxes(bodies: Res<Bodies>, mut bounds: ResMut<Bounds>) {
    if bounds.generation == bodies.generation && !bounds.left_behind(&bodies) {
        return;
    }
    if bounds.generation != bodies.generation {
        let smallest = bodies.smallest_radius;
        bounds.margin = if smallest.is_finite() { MARGIN_SHARE * smallest } else { 0.0 };
    }
    bounds.generation = bodies.generation;
    bounds.version += 1;
    let bounds = &mut *bounds;
    bounds.position.clone_from(&bodies.position);
    bounds.angle.clone_from(&bodies.angle);
    bounds.low.clear();
    bounds.high.clear();
    for body in 0..bodies.len() {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for atom in bodies.atoms_of(body) {
            let reach = DVec2::splat(bodies.atom_radius[atom] + bounds.margin / 2.0);
            low = low.min(bodies.atom_position[atom] - reach);
            high = high.max(bodies.atom_position[atom] + reach);
        }
        bounds.low.push(low);
        bounds.high.push(high);
    }
}

impl Bounds {
    fn left_behind(&self, bodies: &Bodies) -> bool {
        let allowed = self.margin / 2.0;
        // Written so that a position that is not finite counts as moved.
        let stayed = |body: usize| {
            let turned = (bodies.angle[body] - self.angle[body]).abs() * bodies.extent[body];
            let left = allowed - turned;
            left >= 0.0 && (bodies.position[body] - self.position[body]).length_squared() <= left * left
        };
        (0..bodies.len()).any(|body| bodies.moves[body] && !stayed(body))
    }
}
