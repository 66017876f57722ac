//! The outcome for a contact: it follows from the forces found and the velocities that they leave.

use jostle_simd::BLOCK;

use super::ROUNDING;
use super::blocks::{Blocks, Rows, Springs};
use super::contact_direction::{Mover, Row, Sides};
use super::rest_contact::{ContactOutcome, CoulombSpring, FrictionOutcome, RestContact, SpringPhase};

/// A contact with the forces found for it.
pub(super) struct Found<'a> {
    pub blocks: &'a Blocks,
    pub contact: &'a RestContact,
    /// Its index in the blocks.
    pub index: usize,
    /// All movers at the beginning of the tick, and at its end.
    pub movers: [&'a [Mover]; 2],
    pub dt: f64,
}

impl Found<'_> {
    /// The outcome for the tick to come.
    #[inline]
    pub fn outcome(&self) -> ContactOutcome {
        let (block, lane) = (self.index / BLOCK, self.index % BLOCK);
        let (normals, tangential, contact) =
            (&self.blocks.normals[block], &self.blocks.tangential[block], self.contact);
        let normal = normals.force[lane];
        let at_limit = (normals.at_limit >> lane) & 1 != 0;
        if !at_limit && tangential.is_free(lane) && !contact.rolling.acts() {
            let tangential = FrictionOutcome::Holds(tangential.force[lane]);
            return ContactOutcome::Rests { normal, tangential, rolling: FrictionOutcome::Follows, entirely: true };
        }
        self.looked_at(at_limit)
    }

    /// The same for a contact with a force at its limit, or with rolling resistance.
    fn looked_at(&self, at_limit: bool) -> ContactOutcome {
        let (block, lane) = (self.index / BLOCK, self.index % BLOCK);
        let (normals, tangential, contact) =
            (&self.blocks.normals[block], &self.blocks.tangential[block], self.contact);
        let [begin, end] = self.movers.map(|movers| Sides::of(movers, contact.ends));
        let (rows, sides) = (Rows::of(contact, &end), [begin, end]);
        let normal = normals.force[lane];
        let none = Springs::default();
        let rolling = self.blocks.rolling.get(block).unwrap_or(&none);
        if at_limit && !self.stands(&rows.normal, &sides[1]) {
            let tangential = self.beside_motion(&rows.tangent, &sides[1], (tangential, lane), &contact.tangential);
            let rolling = self.beside_motion(&rows.turn, &sides[1], (rolling, lane), &contact.rolling);
            return ContactOutcome::Moves { approaches: normal > contact.band.0, tangential, rolling };
        }
        let (tangential, slips) = self.friction(&rows.tangent, &sides, (tangential, lane), &contact.tangential);
        let (rolling, rolls) = self.friction(&rows.turn, &sides, (rolling, lane), &contact.rolling);
        ContactOutcome::Rests { normal, tangential, rolling, entirely: !slips && !rolls }
    }

    /// Whether the normal force has one value at rest. It follows each load then, and springs that hold are drawn along with it.
    fn is_single_valued(&self) -> bool {
        self.contact.band.0 == self.contact.band.1
    }

    /// Friction along a row of a contact that moves along its normal. Without its spring it goes on as it would at rest.
    fn beside_motion(
        &self,
        row: &Row,
        end: &Sides,
        (springs, lane): (&Springs, usize),
        drawn: &CoulombSpring,
    ) -> FrictionOutcome {
        if !drawn.phase.is_rigid() || drawn.phase == SpringPhase::Holds && self.is_single_valued() {
            return FrictionOutcome::Follows;
        }
        match self.holds(row, end, (springs, lane)) {
            true => FrictionOutcome::Holds(springs.force[lane]),
            false => FrictionOutcome::Slides(-row.velocity(end)),
        }
    }

    /// Whether friction along a row is below its limit, or at its limit and without motion.
    fn holds(&self, row: &Row, end: &Sides, (springs, lane): (&Springs, usize)) -> bool {
        springs.is_engaged(lane) && (springs.is_free(lane) || self.stands(row, end))
    }

    /// Whether a row has no velocity beyond rounding.
    fn stands(&self, row: &Row, end: &Sides) -> bool {
        row.velocity(end).abs() <= self.noise() * row.mobility * self.dt
    }

    /// Force in newtons too small to be told from none.
    fn noise(&self) -> f64 {
        self.contact.noise.max(1e3 * ROUNDING * self.contact.band.1)
    }

    /// Friction along a row, and whether it could hold there and does not.
    fn friction(
        &self,
        row: &Row,
        [begin, end]: &[Sides; 2],
        (springs, lane): (&Springs, usize),
        drawn: &CoulombSpring,
    ) -> (FrictionOutcome, bool) {
        let (force, engaged) = (springs.force[lane], springs.is_engaged(lane));
        if self.holds(row, end, (springs, lane)) {
            return (FrictionOutcome::Holds(force), false);
        }
        let (before, velocity) = (row.velocity(begin), row.velocity(end));
        let against = engaged && force * velocity < 0.0;
        let stood = before.abs() <= self.noise() * row.mobility * self.dt;
        // At rest along the normal friction is dry.
        let dry = self.contact.engaged && drawn.phase == SpringPhase::Slips && !self.is_single_valued();
        // A force along the motion has not converged.
        let yields = drawn.phase == SpringPhase::Holds && (against || !engaged);
        let slides = drawn.phase == SpringPhase::Slides;
        let friction = if slides || against && stood {
            FrictionOutcome::Slides(-velocity)
        } else if against && velocity.abs() < before.abs() {
            // It brakes without stopping. So friction that could hold a body catches a sudden motion within some ticks.
            FrictionOutcome::Holds(force)
        } else if yields || dry {
            FrictionOutcome::Slides(-velocity)
        } else if self.contact.parts {
            FrictionOutcome::Lands
        } else {
            FrictionOutcome::Follows
        };
        (friction, drawn.limit > 0.0)
    }
}
