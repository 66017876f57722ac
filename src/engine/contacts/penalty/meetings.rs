//! Prediction of the next possible touch of pairs while bodies fly.
//!
//! In a uniform field the relative motion of two flying discs is a straight line. So a quadratic equation decides
//! whether and when they touch. For a pair with a bound disc the distance is known, and [`Bodies::path`] bounds the
//! ways of bodies. So each pair has its next meeting, and is not evaluated before. When a body is bound, the meetings
//! of its pairs become invalid.

use super::contact_list::ContactList;
use super::records::record;
use crate::contacts::AtomPair;
use crate::world::{Bodies, Passing};
use jostle_simd::{BLOCK, Record};
use serde::{Deserialize, Serialize};

/// When a pair has to be looked at: as soon as one of both has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Meeting {
    /// Tick of the flights.
    tick: u32,
    /// [`Bodies::path`] in metres.
    path: f64,
}

/// The meetings of all pairs, while bodies fly.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Meetings {
    pairs: Vec<Meeting>,
    /// The soonest of each block of pairs.
    blocks: Vec<Meeting>,
    /// Places of the pairs in which bodies are, body by body, and where those of each body begin.
    indices: Vec<u32>,
    first: Vec<u32>,
}

/// Discs that pass each other within this share of the touching distance are evaluated all the same. It is far more
/// than rounding, for which `NOISE` is counted as well.
const NEAR_MISS: f64 = 1e-6;
/// Rounding of positions, as a share of them.
const NOISE: f64 = 16.0 * f64::EPSILON;

impl Meetings {
    /// Whether they are those of so many pairs and bodies.
    pub fn fits(&self, pairs: usize, bodies: usize) -> bool {
        let Self { pairs: own, blocks, indices, first } = self;
        if blocks.is_empty() {
            return own.is_empty() && indices.is_empty();
        }
        own.len() == pairs
            && blocks.len() == pairs.div_ceil(BLOCK)
            && indices.iter().all(|index| (*index as usize) < pairs)
            && first.len() == bodies + 2
            && first.is_sorted()
            && first.last().is_none_or(|end| *end as usize <= indices.len())
    }

    /// Finds the pairs that an evaluation has to include, and fills in the records of their atoms. The others are
    /// postponed in the list. `bound` are the bodies that were bound since the last call. If no body flies, it does
    /// nothing and returns false.
    pub fn keep(
        &mut self,
        (bodies, bound): (&Bodies, &[u32]),
        pairs: &[AtomPair],
        list: &mut ContactList,
        records: &mut [Record],
    ) -> bool {
        if !bodies.flights.some() {
            if !self.blocks.is_empty() {
                *self = Self::default();
                list.look_at_all();
            }
            return false;
        }
        list.look_at_none();
        if self.blocks.is_empty() {
            self.begin(bodies.len(), pairs);
        } else {
            for &body in bound {
                let indices = self.first[body as usize] as usize..self.first[body as usize + 1] as usize;
                for &index in &self.indices[indices] {
                    (self.pairs[index as usize], self.blocks[index as usize / BLOCK]) = (Meeting::NOW, Meeting::NOW);
                }
            }
        }
        let now = Meeting { tick: bodies.flights.ticks(), path: bodies.path };
        for block in 0..self.blocks.len() {
            if list.phases[block].touching() != 0 || self.blocks[block].has_come(now) {
                self.look_again(bodies, pairs, (list, records), (block, now));
            }
        }
        true
    }

    /// Finds anew when the pairs of a block may touch. Not inlined: the loop over blocks that wait stays short.
    #[inline(never)]
    fn look_again(
        &mut self,
        bodies: &Bodies,
        pairs: &[AtomPair],
        (list, records): (&mut ContactList, &mut [Record]),
        (block, now): (usize, Meeting),
    ) {
        let touching = list.phases[block].touching();
        let (mut soonest, mut looked_at) = (Meeting::NEVER, 0);
        let first = BLOCK * block;
        let last = pairs.len().min(first + BLOCK);
        for (lane, (pair, meeting)) in pairs[first..last].iter().zip(&mut self.pairs[first..last]).enumerate() {
            let touches = touching >> lane & 1 != 0;
            if touches || meeting.has_come(now) {
                let sides = [side(bodies, pair.a), side(bodies, pair.b)];
                let indices = list.pairs.side(block).get(lane);
                (records[indices.0 as usize], records[indices.1 as usize]) = (sides[0].0, sides[1].0);
                let next = next_meeting(bodies, sides);
                *meeting = next.filter(|_| !touches).unwrap_or(Meeting::NOW);
                looked_at |= u8::from(*meeting == Meeting::NOW) << lane;
            }
            soonest = soonest.or(*meeting);
        }
        self.blocks[block] = soonest;
        list.look_at(block, looked_at);
    }

    fn begin(&mut self, bodies: usize, pairs: &[AtomPair]) {
        self.pairs.resize(pairs.len(), Meeting::NOW);
        self.blocks.resize(pairs.len().div_ceil(BLOCK), Meeting::NOW);
        self.first.resize(bodies + 2, 0);
        // Two places ahead, so that filling in leaves each where its body begins.
        pairs.iter().flat_map(|pair| [pair.a, pair.b]).for_each(|body| self.first[body as usize + 2] += 1);
        for body in 2..self.first.len() {
            self.first[body] += self.first[body - 1];
        }
        self.indices.resize(2 * pairs.len(), 0);
        for (index, pair) in pairs.iter().enumerate() {
            for body in [pair.a, pair.b] {
                let next = &mut self.first[body as usize + 1];
                self.indices[*next as usize] = index as u32;
                *next += 1;
            }
        }
    }
}

/// For the card: the number of ticks in which bodies flew.
pub(super) fn remark(bodies: &Bodies, ticks: u64) -> Option<String> {
    let flown = bodies.flights.flown();
    (flown > 0).then(|| {
        format!(
            "flight: in {flown} of {ticks} ticks some discs bore only their weight. The engine moved them along their \
             parabolas, not tick by tick"
        )
    })
}

impl Meeting {
    const NOW: Self = Self { tick: 0, path: f64::NEG_INFINITY };
    const NEVER: Self = Self { tick: u32::MAX, path: f64::INFINITY };

    #[inline]
    fn has_come(self, now: Self) -> bool {
        now.tick >= self.tick || now.path >= self.path
    }

    fn or(self, other: Self) -> Self {
        Self { tick: self.tick.min(other.tick), path: self.path.min(other.path) }
    }
}

/// The time at which a pair may begin to touch; `None` if it is near enough now. Each side comes with its flag for
/// flying.
fn next_meeting(bodies: &Bodies, [a, b]: [(Record, bool); 2]) -> Option<Meeting> {
    let (Record([ax, ay, amx, amy, .., a_radius]), Record([bx, by, bmx, bmy, .., b_radius])) = (a.0, b.0);
    let (x, y, reach) = (bx - ax, by - ay, a_radius + b_radius);
    let square = x * x + y * y;
    if square < reach * reach || square.is_nan() {
        return None;
    }
    if !(a.1 && b.1) {
        return Some(Meeting { path: bodies.path + 0.5 * (square.sqrt() - reach), ..Meeting::NEVER });
    }
    let noise = NOISE * ax.abs().max(ay.abs()).max(bx.abs()).max(by.abs());
    let ticks = ticks_until((x, y), (bmx - amx, bmy - amy), reach * (1.0 + NEAR_MISS) + noise);
    let tick = bodies.flights.ticks().saturating_add((ticks.floor() as u32).max(1));
    Some(Meeting { tick, ..Meeting::NEVER })
}

/// An atom as contacts see it, and whether its body flies.
fn side(bodies: &Bodies, atom: u32) -> (Record, bool) {
    let Some(Passing { position, moved, turn, velocity }) = bodies.passing(atom as usize) else {
        return (record(bodies, atom as usize), false);
    };
    let radius = bodies.atom_radius[atom as usize];
    (Record([position.x, position.y, moved.x, moved.y, velocity.x, velocity.y, turn, radius]), true)
}

/// Ticks until the distance of two discs is `reach`. They are `(x, y)` apart and move past each other by `(dx, dy)` in
/// each tick. Infinite if they never come so near.
fn ticks_until((x, y): (f64, f64), (dx, dy): (f64, f64), reach: f64) -> f64 {
    let left = x * x + y * y - reach * reach;
    let (closing, way) = (-(x * dx + y * dy), dx * dx + dy * dy);
    // `closing² - way left`, written so that nothing cancels where discs are far apart: by how much less than `reach` they pass.
    let beside = x * dy - y * dx;
    let discriminant = way * reach * reach - beside * beside;
    if left <= 0.0 {
        0.0
    } else if closing <= 0.0 || discriminant < 0.0 {
        f64::INFINITY
    } else {
        left / (closing + discriminant.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_that_pass_each_other_touch_when_the_line_says_so() {
        // Head on, 3 m apart of which 1 m is reach, a quarter of a metre each tick.
        assert_eq!(ticks_until((3.0, 0.0), (-0.25, 0.0), 1.0), 8.0);
        // Along the legs of a right triangle: 4 m to go beside 0.6 m with a reach of 1 m. So it ends 0.8 m before the
        // other's centre.
        assert!((ticks_until((4.0, 0.6), (-0.1, 0.0), 1.0) - 32.0).abs() < 1e-12);
        assert_eq!(ticks_until((4.0, 1.01), (-0.1, 0.0), 1.0), f64::INFINITY);
        assert_eq!(ticks_until((4.0, 0.0), (0.1, 0.0), 1.0), f64::INFINITY);
        assert_eq!(ticks_until((4.0, 0.0), (0.0, 0.0), 1.0), f64::INFINITY);
        assert_eq!(ticks_until((0.9, 0.0), (1.0, 0.0), 1.0), 0.0);
    }
}
