//! What becomes of a contact, from the forces found for it and the velocities that they leave.

use jostle_simd::BLOCK;

use super::ROUNDING;
use super::blocks::{Blocks, Rows, Springs};
use super::row::{Mover, Row, Sides};
use super::seen::{Drawn, Friction, Seen, Verdict};

/// A contact with what was found for it.
pub(super) struct Judged<'a> {
    pub blocks: &'a Blocks,
    pub seen: &'a Seen,
    /// Where it stands in the blocks.
    pub place: usize,
    /// All movers at the beginning of the tick, and at its end.
    pub movers: [&'a [Mover]; 2],
    pub dt: f64,
}

impl Judged<'_> {
    /// What the contact does in the tick to come.
    #[inline]
    pub fn verdict(&self) -> Verdict {
        let (block, lane) = (self.place / BLOCK, self.place % BLOCK);
        let (normals, tangential, seen) = (&self.blocks.normals[block], &self.blocks.tangential[block], self.seen);
        let normal = normals.force[lane];
        let at_limit = (normals.at_limit >> lane) & 1 != 0;
        if !at_limit && tangential.is_free(lane) && !seen.rolling.acts() {
            let tangential = Friction::Holds(tangential.force[lane]);
            return Verdict::Rests { normal, tangential, rolling: Friction::Follows, entirely: true };
        }
        self.looked_at(at_limit)
    }

    /// The same for a contact with a force at its limit, or with rolling resistance.
    fn looked_at(&self, at_limit: bool) -> Verdict {
        let (block, lane) = (self.place / BLOCK, self.place % BLOCK);
        let (normals, tangential, seen) = (&self.blocks.normals[block], &self.blocks.tangential[block], self.seen);
        let [begin, end] = self.movers.map(|movers| Sides::of(movers, seen.ends));
        let (rows, sides) = (Rows::of(seen, &end), [begin, end]);
        let normal = normals.force[lane];
        if at_limit && !self.stands(&rows.normal, &sides[1]) {
            return Verdict::Moves { approaches: normal > seen.band.0 };
        }
        let none = Springs::default();
        let rolling = self.blocks.rolling.get(block).unwrap_or(&none);
        let (tangential, slips) =
            self.friction(&rows.tangent, &sides, (tangential, lane), &seen.tangential, seen.slides.0);
        let (rolling, rolls) = self.friction(&rows.turn, &sides, (rolling, lane), &seen.rolling, seen.slides.1);
        Verdict::Rests { normal, tangential, rolling, entirely: !slips && !rolls }
    }

    /// Whether a row has no velocity beyond rounding.
    fn stands(&self, row: &Row, end: &Sides) -> bool {
        row.velocity(end).abs() <= self.noise() * row.mobility * self.dt
    }

    /// Force in newtons too small to be told from none.
    fn noise(&self) -> f64 {
        self.seen.noise.max(1e3 * ROUNDING * self.seen.band.1)
    }

    /// What friction does along a row, and whether it could hold there and does not.
    fn friction(
        &self,
        row: &Row,
        [begin, end]: &[Sides; 2],
        (springs, lane): (&Springs, usize),
        drawn: &Drawn,
        slides: bool,
    ) -> (Friction, bool) {
        let (force, engaged) = (springs.force[lane], springs.is_engaged(lane));
        if engaged && (springs.is_free(lane) || self.stands(row, end)) {
            return (Friction::Holds(force), false);
        }
        let (before, velocity) = (row.velocity(begin), row.velocity(end));
        let against = engaged && force * velocity < 0.0;
        let stood = before.abs() <= self.noise() * row.mobility * self.dt;
        let friction = if slides || against && stood {
            Friction::Slides(-velocity)
        } else if against && velocity.abs() < before.abs() {
            // It brakes without stopping: so a body that is taken by surprise is caught within some ticks by what could hold it.
            Friction::Holds(force)
        } else if self.seen.engaged {
            Friction::Stays
        } else if self.seen.parts {
            Friction::Lands
        } else {
            Friction::Turns
        };
        (friction, drawn.limit > 0.0)
    }
}
