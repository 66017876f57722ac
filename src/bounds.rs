//! Bounding boxes with a margin: as long as no body has moved by half the margin, whoever is farther apart than the
//! margin cannot touch, and the list of candidate pairs stays as it is (Verlet 1967).
//!
//! The boxes are checked before each evaluation and not only at the end of a tick, because a stage of an integrator
//! may stand anywhere.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::tick::{Evaluate, EvaluateStage, Evaluation, TickAppExt};
use crate::world::Bodies;

/// Margin as a share of the smallest radius. Larger: fewer searches, more candidates.
const MARGIN_SHARE: f64 = 0.7;

/// A margin so many times as wide as is needed is given up: a long step needed it, and lists are long ever since.
const WASTEFUL: f64 = 16.0;

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
    /// Somebody moved farther than the boxes allow in a stage of a step.
    pub outgrown: bool,
    /// Stages of steps renew them as states that follow one another do.
    pub renewed_in_steps: bool,
    /// The boxes are to be made anew at the next evaluation.
    stale: bool,
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
pub fn update_bounding_boxes(bodies: Res<Bodies>, mut bounds: ResMut<Bounds>, evaluation: Res<Evaluation>) {
    let known = bounds.generation == bodies.generation && !bounds.stale;
    if known && !bounds.left_behind(&bodies) {
        return;
    }
    // Inside a step lists stay as they are: the step is made again with a wider margin.
    if known && evaluation.style.is_staged() && !bounds.renewed_in_steps {
        bounds.outgrown = true;
        return;
    }
    (bounds.stale, bounds.outgrown) = (false, false);
    if bounds.generation != bodies.generation {
        bounds.margin = least_margin(&bodies);
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

/// The margin in metres that suits bodies of these sizes.
fn least_margin(bodies: &Bodies) -> f64 {
    let smallest = bodies.smallest_radius;
    if smallest.is_finite() { MARGIN_SHARE * smallest } else { 0.0 }
}

impl Bounds {
    /// Makes sure that the boxes hold while no point of a body moves farther than `travel` metres from where it stands now.
    /// Says whether they have to be made anew for that.
    pub fn reserve(&mut self, bodies: &Bodies, travel: f64) -> bool {
        let left = |body: usize| {
            let turned = (bodies.angle[body] - self.angle[body]).abs() * bodies.extent[body];
            self.margin / 2.0 - turned - (bodies.position[body] - self.position[body]).length()
        };
        let enough = (0..bodies.len()).filter(|&body| bodies.moves[body]).all(|body| left(body) >= travel);
        let wanted = least_margin(bodies).max(4.0 * travel);
        let renew = !enough || self.margin > WASTEFUL * wanted;
        if renew {
            self.margin = wanted;
            self.stale = true;
        }
        renew
    }

    /// The boxes are to be made anew at the next evaluation.
    pub fn outdate(&mut self) {
        self.stale = true;
    }

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
