//! The outcome for a contact: it follows from the forces found and the velocities that they leave.

use jostle_simd::BLOCK;

use super::ROUNDING;
use super::blocks::{Blocks, Rows, Springs};
use super::contact_direction::{Mover, Row, Sides};
use super::rest_contact::{ContactOutcome, CoulombSpring, FrictionOutcome, RestContact, SpringPhase};

/// A hold that brakes a slide has the greatest force of a slip. It may miss this share of it, by rounding of the normal force.
const BRAKES: f64 = 1e-9;

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
            let turns = |springs: &Springs, drawn: &CoulombSpring| {
                let braked = drawn.phase == SpringPhase::Holds
                    && drawn.force.abs() >= (1.0 - BRAKES) * drawn.slips * contact.normal_force;
                match springs.is_engaged(lane) && !springs.is_free(lane) {
                    true => FrictionOutcome::TurnsRound { force: springs.force[lane], braked },
                    false => FrictionOutcome::Follows,
                }
            };
            let (tangential, rolling) = (turns(tangential, &contact.tangential), turns(rolling, &contact.rolling));
            return ContactOutcome::Moves { approaches: normal > contact.band.0, tangential, rolling };
        }
        let (tangential, slips) = self.friction(&rows.tangent, &sides, (tangential, lane), &contact.tangential);
        let (rolling, rolls) = self.friction(&rows.turn, &sides, (rolling, lane), &contact.rolling);
        ContactOutcome::Rests { normal, tangential, rolling, entirely: !slips && !rolls }
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
        if engaged && (springs.is_free(lane) || self.stands(row, end)) {
            return (FrictionOutcome::Holds(force), false);
        }
        let (before, velocity) = (row.velocity(begin), row.velocity(end));
        let against = engaged && force * velocity < 0.0;
        let stood = before.abs() <= self.noise() * row.mobility * self.dt;
        // At rest along the normal friction is dry. A spring that slipped would swing back if the sliding turns round.
        let turns = self.contact.engaged && drawn.phase == SpringPhase::Slips && drawn.force * velocity > 0.0;
        // A force along the motion has not converged.
        let yields = drawn.phase == SpringPhase::Holds && (against || !engaged);
        let friction = if drawn.phase == SpringPhase::Slides || against && stood {
            FrictionOutcome::Slides(-velocity)
        } else if against && velocity.abs() < before.abs() {
            // It brakes without stopping. So friction that could hold a body catches a sudden motion within some ticks.
            FrictionOutcome::Holds(force)
        } else if yields || turns {
            FrictionOutcome::Slides(-velocity)
        } else if self.contact.engaged {
            FrictionOutcome::Stays
        } else if self.contact.parts {
            FrictionOutcome::Lands
        } else {
            FrictionOutcome::Turns
        };
        (friction, drawn.limit > 0.0)
    }
}
