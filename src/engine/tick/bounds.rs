//! Verlet lists (Verlet 1967): bounding boxes with a margin, which keep the list of candidate pairs valid. While no
//! body has moved by half the margin, two bodies farther apart than the margin cannot touch.
//!
//! The boxes are checked before each evaluation and not only at the end of a tick. The reason is that a stage of an
//! integrator may be at any state.

use glam::DVec2;

use super::Evaluation;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Margin as a share of the smallest radius: what steps that locate events begin with.
const MARGIN_SHARE: f64 = 0.7;
/// The same for states that follow one another: at first, at least and at most. Larger: fewer searches, more candidates.
const FIRST_SHARE: f64 = 0.3;
const LEAST_SHARE: f64 = 0.05;
const MOST_SHARE: f64 = 6.0;
/// The cost of a search for each atom and for each found pair, relative to a pair in each evaluation. These rough
/// figures only decide how often lists are made.
const SEARCH_PER_ATOM: f64 = 12.0;
const SEARCH_PER_PAIR: f64 = 3.0;
/// Searches may cost this share of the work on pairs. The margin shrinks if they cost less than a sixteenth of that.
const SEARCH_SHARE: f64 = 1.0;
/// The same for bodies with hulls. Pairs that do not touch are checked now and then. A check costs as much as a pair of
/// discs.
const SEARCH_SHARE_OF_HULLS: f64 = 7.0;
const FEW_SEARCHES: f64 = 16.0;
/// The same if most bodies fly: the cost of a search for each atom, with landing and taking off. It is relative to a
/// pair during the life of its list.
const FLIGHT_SEARCH: f64 = 0.5;
/// By how much the margin changes at once where most bodies fly.
const MOST_AT_ONCE: f64 = 4.0;
/// By how much the margin changes at once.
const CHANGE: f64 = 1.5;

/// A margin that is wider than needed by this factor is replaced. A long step needed it, and the lists have been long
/// since then.
const WASTEFUL: f64 = 16.0;

/// Scenes with more atoms have no boxes, and pairs are searched without them.
pub(crate) const MOST_ATOMS: usize = 191;

/// Axis-aligned bounding boxes of all bodies, each grown by half the margin.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Bounds {
    /// The number of renewals of the boxes, for the owners of lists that were made from them.
    pub version: u64,
    /// Distance in metres below which two atoms are candidates.
    pub margin: f64,
    /// Lower left corner of each body's box in metres; empty where many atoms are sorted into cells instead.
    pub low: Vec<DVec2>,
    /// Upper right corner of each body's box in metres; likewise.
    pub high: Vec<DVec2>,
    /// A body moved farther than the boxes allow in a stage of a step.
    pub outgrown: bool,
    /// Stages of steps renew them as states that follow one another do.
    pub renewed_in_steps: bool,
    /// The boxes are to be renewed at the next evaluation.
    stale: bool,
    generation: u64,
    position: Vec<DVec2>,
    /// Empty where bodies are lone discs, which reach as far however they are turned.
    angle: Vec<f64>,
    /// The value of [`Bodies::path`] below which no body can have left half the margin. NaN: unknown.
    path: f64,
    /// The number of candidate pairs that were found with the boxes.
    pub candidates: usize,
    /// Evaluations since the boxes were made.
    age: u64,
}

impl Bounds {
    /// Whether all lists are those of so many bodies.
    pub(crate) fn fits(&self, bodies: usize) -> bool {
        let Self { margin, low, high, position, angle, .. } = self;
        let whole = |len: usize| len == 0 || len == bodies;
        margin.is_finite()
            && *margin >= 0.0
            && low.len() == high.len()
            && [low.len(), position.len(), angle.len()].into_iter().all(whole)
    }

    /// Renews the boxes if a body has moved by half the margin since the last renewal.
    pub(crate) fn update(&mut self, bodies: &mut Bodies, evaluation: &Evaluation) {
        // Sleepers change nothing. Their waking does not count either, or else it would affect the times at which lists
        // are made.
        if evaluation.again {
            return;
        }
        let known = self.generation == bodies.generation && !self.stale;
        let follows = !evaluation.mode.is_staged();
        self.age += 1;
        // Between two checks no body can have moved farther than the sum of all ways.
        let moved_by_step = follows && evaluation.elapsed > 0.0;
        let flying = bodies.flights.some();
        if known && moved_by_step && bodies.path < self.path && (flying || !self.age.is_power_of_two()) {
            return;
        }
        bodies.end_flights();
        self.path = f64::NAN;
        let holds = known && !flying && !self.left_behind(bodies);
        if holds && !(follows && self.could_shrink(bodies)) {
            // A body nearer than a quarter of the margin has another quarter left.
            if follows && bodies.stayed_near(self.margin / 4.0, &self.position, &self.angle) {
                self.path = bodies.path + self.margin / 4.0;
            }
            return;
        }
        // Inside a step lists stay as they are: the step is made again with a wider margin.
        if known && !follows && !self.renewed_in_steps {
            self.outgrown = true;
            return;
        }
        (self.stale, self.outgrown) = (false, false);
        if self.generation != bodies.generation {
            self.margin = if follows { FIRST_SHARE / MARGIN_SHARE } else { 1.0 } * least_margin(bodies);
        } else if flying {
            self.adapt_to_flights(bodies);
        } else if follows {
            self.adapt(bodies);
        }
        self.age = 0;
        self.path = bodies.path + self.margin / 2.0;
        self.generation = bodies.generation;
        self.version += 1;
        self.position.clone_from(&bodies.position);
        if bodies.lone_discs {
            self.angle = Vec::new();
        } else {
            self.angle.clone_from(&bodies.angle);
        }
        self.low.clear();
        self.high.clear();
        if bodies.atom_count() > MOST_ATOMS {
            return;
        }
        for body in 0..bodies.len() {
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for atom in bodies.atoms_of(body) {
                let reach = DVec2::splat(bodies.atom_radius[atom] + self.margin / 2.0);
                low = low.min(bodies.atom_place(atom) - reach);
                high = high.max(bodies.atom_place(atom) + reach);
            }
            self.low.push(low);
            self.high.push(high);
        }
    }
}

/// The margin in metres that suits bodies of these sizes.
fn least_margin(bodies: &Bodies) -> f64 {
    let smallest = bodies.smallest_radius;
    if smallest.is_finite() { MARGIN_SHARE * smallest } else { 0.0 }
}

impl Bounds {
    /// Ensures that the boxes hold while no point of a body moves farther than `travel` metres from its current
    /// position. Returns whether they have to be renewed for that.
    pub fn reserve(&mut self, bodies: &Bodies, travel: f64) -> bool {
        let left = |body: usize| {
            let turned =
                self.angle.get(body).map_or(0.0, |angle| (bodies.angle[body] - angle).abs() * bodies.extent(body));
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

    /// Evaluations that lists should last.
    fn should_last(&self, bodies: &Bodies) -> f64 {
        let pairs = self.candidates.max(1) as f64;
        let share = if bodies.hulls.is_empty() { SEARCH_SHARE } else { SEARCH_SHARE_OF_HULLS };
        (SEARCH_PER_ATOM * bodies.atom_count() as f64 / pairs + SEARCH_PER_PAIR) / share
    }

    /// The margin that suits how long the last boxes held.
    fn adapt(&mut self, bodies: &Bodies) {
        let share = self.margin * MARGIN_SHARE / least_margin(bodies);
        let age = self.age as f64 / self.should_last(bodies);
        if age < 1.0 && share < MOST_SHARE {
            self.margin *= CHANGE;
        } else if age > FEW_SEARCHES && share > LEAST_SHARE {
            self.margin /= CHANGE;
        }
    }

    /// The best margin if most bodies fly. The life of lists grows with it, and the number of pairs grows with the
    /// square of diameter plus margin. The cost is least if the pairs of the square of the margin alone cost as much as
    /// the search.
    fn adapt_to_flights(&mut self, bodies: &Bodies) {
        let margin = self.margin / (2.0 * bodies.smallest_radius);
        let own = self.candidates as f64 * margin / (2.0 + margin);
        let wanted = FLIGHT_SEARCH * bodies.atom_count() as f64;
        let times = (wanted / own).sqrt();
        if !(1.0 / CHANGE..CHANGE).contains(&times) {
            self.margin *= times.clamp(1.0 / MOST_AT_ONCE, MOST_AT_ONCE);
        }
    }

    /// Whether boxes that have held for long would still hold with a smaller margin. It is checked now and then.
    fn could_shrink(&self, bodies: &Bodies) -> bool {
        let (least, small) = (least_margin(bodies) * LEAST_SHARE / MARGIN_SHARE, self.margin / 8.0);
        let due = self.age.is_power_of_two() && self.age as f64 > FEW_SEARCHES * self.should_last(bodies);
        due && self.margin > least && bodies.stayed_near(small, &self.position, &self.angle)
    }

    /// Demands that the boxes are renewed at the next evaluation.
    pub fn outdate(&mut self) {
        self.stale = true;
    }

    fn left_behind(&self, bodies: &Bodies) -> bool {
        !bodies.stayed_near(self.margin / 2.0, &self.position, &self.angle)
    }
}
