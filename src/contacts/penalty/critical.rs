//! Measures how fast the contacts of a run respond, at some of its ticks: all ticks would cost as much as the contacts
//! themselves.
//!
//! A tick is looked at when the number of touching pairs has changed and as many ticks have passed as there are pairs,
//! and every [`PATIENCE`] ticks. A bound of the frequency is cheap; where it lies above what was found before, the
//! eigenvalue itself is worked out, which costs some ten times as much, and so is done less often unless the bound has
//! risen clearly.

use super::apply::{End, PenaltyContacts, arms};
use super::law::PairLaw;
use crate::contacts::response::{Spring, Springs};
use crate::contacts::{AtomPair, CandidatePairs, WallPair};
use crate::tick::{Balance, Briefest, Clock, Fastest, Responses};
use crate::world::Bodies;

/// Ticks after which an unchanged number of pairs is looked at again.
const PATIENCE: u64 = 512;
/// A bound that has risen by this factor is followed up at once.
const RISEN: f64 = 1.05;
/// Ticks per pair between two solutions otherwise.
const TICKS_PER_PAIR: u64 = 32;

/// Product of tick and angular frequency above which energy is watched at each tick; methods bear 2 and more.
const ALERT: f64 = 1.5;

/// When the contacts were looked at, and working memory.
#[derive(Debug, Default)]
pub(super) struct Watch {
    next: u64,
    earliest: u64,
    pairs: usize,
    solved: u64,
    /// The greatest bound whose eigenvalue was worked out.
    bound: f64,
    springs: Springs,
    pub found: Responses,
}

impl PenaltyContacts {
    /// Looks at the touching pairs if it is time to.
    #[inline]
    pub(super) fn watch(&mut self, bodies: &Bodies, pairs: &CandidatePairs, clock: &Clock, balance: &mut Balance) {
        let touching = self.touching_atoms.len() + self.touching_walls.len();
        if touching == 0 {
            // Whoever touches next is new.
            self.watch.pairs = 0;
            return;
        }
        let watch = &self.watch;
        let changed = touching != watch.pairs && clock.ticks >= watch.earliest;
        if changed || clock.ticks >= watch.next {
            self.measure(bodies, pairs, clock);
            let fastest = self.watch.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency);
            balance.alert |= clock.dt * fastest > ALERT;
        }
    }

    #[cold]
    fn measure(&mut self, bodies: &Bodies, pairs: &CandidatePairs, clock: &Clock) {
        let mut watch = std::mem::take(&mut self.watch);
        watch.springs.gather(self.springs(bodies, pairs), bodies);
        watch.pairs = self.touching_atoms.len() + self.touching_walls.len();
        watch.earliest = clock.ticks + watch.pairs as u64;
        watch.next = clock.ticks + PATIENCE;
        let found = &mut watch.found;
        let bound = watch.springs.bound();
        let time = clock.time();
        let (fastest, briefest) =
            (found.fastest.map_or(0.0, |f| f.angular_frequency), found.briefest.map_or(0.0, |b| b.angular_frequency));
        if bound.pair_squared > briefest * briefest {
            let entity = |body: usize| bodies.entity[body];
            let (a, b) = watch.springs.pair(bound.pair);
            let wall = || {
                let touching = self.touching_walls[bound.pair - self.touching_atoms.len()];
                bodies.walls[pairs.walls[touching.place as usize].wall as usize].entity
            };
            let between = (a.map_or_else(wall, entity), entity(b));
            found.briefest = Some(Briefest { angular_frequency: bound.pair_squared.sqrt(), between, time });
        }
        let due =
            bound.squared > RISEN * watch.bound || clock.ticks >= watch.solved + TICKS_PER_PAIR * watch.pairs as u64;
        if due && bound.squared > fastest * fastest {
            watch.solved = clock.ticks;
            watch.bound = watch.bound.max(bound.squared);
            let squared = watch.springs.largest();
            if squared > fastest * fastest {
                let body = bodies.entity[bound.body];
                found.fastest = Some(Fastest { angular_frequency: squared.sqrt(), body, time });
            }
        }
        self.watch = watch;
    }

    /// The springs of all touching pairs: those between bodies, then those at walls.
    fn springs(&self, bodies: &Bodies, pairs: &CandidatePairs) -> impl Iterator<Item = Spring> {
        let stiffness = |law: &PairLaw| (law.stiffness * (1.0 + law.inelasticity), law.held_across());
        let atoms = self.touching_atoms.iter().map(move |touching| {
            let AtomPair { a, b } = pairs.atoms[touching.place as usize];
            let (a, b) = (End::of(bodies, a), End::of(bodies, b));
            let contact = &self.atoms[touching.place as usize];
            let law = self.laws.get(contact.law);
            let (arm_a, arm_b) = arms((&a, &b), touching.normal, contact.overlap, law);
            let (a, b) = (Some((a.body, arm_a)), (b.body, arm_b));
            Spring { a, b, normal: touching.normal, stiffness: stiffness(law) }
        });
        let walls = self.touching_walls.iter().map(move |touching| {
            let WallPair { atom, .. } = pairs.walls[touching.place as usize];
            let end = End::of(bodies, atom);
            let contact = &self.walls[touching.place as usize];
            let arm = end.arm - touching.normal * (end.radius - contact.overlap);
            let law = self.laws.get(contact.law);
            Spring { a: None, b: (end.body, arm), normal: touching.normal, stiffness: stiffness(law) }
        });
        atoms.chain(walls)
    }
}

impl PairLaw {
    /// Stiffness of the tangential spring in N/m, if there is friction that stretches it.
    fn held_across(&self) -> f64 {
        if self.friction_static > 0.0 || self.friction_dynamic > 0.0 { self.tangential_stiffness } else { 0.0 }
    }
}
