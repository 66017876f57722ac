//! The critical tick of contacts, measured at some ticks of a run. All ticks would cost as much as the contacts
//! themselves.
//!
//! A tick is measured when the number of touching pairs has changed, after as many ticks as there are pairs. It is also
//! measured every [`PATIENCE`] ticks. A bound of the frequency is cheap. If it lies above the earlier result, the
//! eigenvalue itself is computed, which costs some ten times as much. So that is done less often unless the bound has
//! risen clearly.

use super::apply::PenaltyContacts;
use super::normal::NormalForce;
use super::pair_law::PairLaw;
use super::rolling;
use crate::contacts::geometry::{ContactEnd, PairGeometry, arms};
use crate::contacts::{AtomPair, CandidatePairs};
use crate::tick::critical_step::{Spring, Springs};
use crate::tick::steady::SteadySprings;
use crate::tick::{Briefest, Clock, Fastest, Holder, Rates, Stability, TimeScales};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Ticks after which an unchanged number of pairs is looked at again.
const PATIENCE: u64 = 512;
/// A bound that has risen by this factor is followed up at once.
const RISEN: f64 = 1.05;
/// Ticks per pair between two solutions otherwise.
const TICKS_PER_PAIR: u64 = 32;

/// Looks in which the tick is sought where forces depend on velocities, at most.
const ROUNDS: usize = 12;

/// The allowed error, as a share: a hundredth of that of [`Springs::largest`].
const ENOUGH: f64 = 1e-4;

/// Product of tick and angular frequency above which energy is watched at each tick; methods bear 2 and more.
const ALERT: f64 = 1.5;

/// When the contacts were looked at, and working memory.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Watch {
    next: u64,
    earliest: u64,
    pairs: usize,
    solved: u64,
    /// The greatest bound whose eigenvalue was worked out.
    bound: f64,
    springs: Springs,
    pub found: TimeScales,
}

impl PenaltyContacts {
    /// Looks at the touching pairs if it is time to.
    #[inline]
    pub(super) fn watch<N: NormalForce>(
        &mut self,
        bodies: &Bodies,
        pairs: &CandidatePairs,
        clock: &Clock,
        stability: &Stability,
        rates: &mut Rates,
        steady: &SteadySprings,
    ) {
        let touching = self.atoms.touching_count() + self.surfaces.touching_count();
        if touching == 0 {
            // The next touching pair counts as new.
            self.watch.pairs = 0;
            return;
        }
        let watch = &mut self.watch;
        watch.found.some_began |= touching > watch.pairs && clock.ticks > 0;
        let changed = touching != watch.pairs && clock.ticks >= watch.earliest;
        if changed || clock.ticks >= watch.next {
            self.measure::<N>(bodies, pairs, clock, stability, steady);
            let fastest = self.watch.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency);
            rates.alert |= clock.dt * fastest > ALERT;
        }
    }

    #[cold]
    fn measure<N: NormalForce>(
        &mut self,
        bodies: &Bodies,
        pairs: &CandidatePairs,
        clock: &Clock,
        stability: &Stability,
        steady: &SteadySprings,
    ) {
        let mut watch = std::mem::take(&mut self.watch);
        let weight = |angular_frequency: f64| angular_frequency * stability.weight_of_damping();
        // Springs of the scene hold the same bodies, and so count with the contacts.
        let gather = |springs: &mut Springs, weight: f64| {
            let others = steady.rows(weight);
            springs.gather(self.springs::<N>(bodies, pairs, weight), others, bodies);
        };
        watch.pairs = self.atoms.touching_count() + self.surfaces.touching_count();
        watch.springs.make_room(watch.pairs);
        gather(&mut watch.springs, weight(stability.limit / clock.dt));
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
                let number = bound.pair - self.atoms.touching_count();
                let index = self.surfaces.touching().nth(number).expect("the pair is one of those that were gathered");
                let wall =
                    pairs.surfaces[index].wall(bodies).expect("a contact without another body is one with a wall");
                bodies.walls[wall].entity
            };
            let between = (a.map_or_else(wall, entity), entity(b));
            found.briefest = Some(Briefest { angular_frequency: bound.pair_squared.sqrt(), between, time });
        }
        let due =
            bound.squared > RISEN * watch.bound || clock.ticks >= watch.solved + TICKS_PER_PAIR * watch.pairs as u64;
        if due && bound.squared > fastest * fastest {
            watch.solved = clock.ticks;
            watch.bound = watch.bound.max(bound.squared);
            let mut squared = watch.springs.largest();
            if N::DEPENDS_ON_VELOCITY || steady.damped() {
                // Damping counts by the tick that is sought.
                squared = frequency_squared((stability.limit / clock.dt, squared), |angular_frequency| {
                    gather(&mut watch.springs, weight(angular_frequency));
                    watch.springs.largest()
                });
            }
            if squared > fastest * fastest {
                let body = bodies.entity[bound.body];
                found.fastest =
                    Some(Fastest { angular_frequency: squared.sqrt(), body, holder: Holder::Contacts, time });
            }
        }
        watch.springs.put_away();
        self.watch = watch;
    }

    /// The springs of all touching pairs: those between bodies, then those at walls. Damping counts as stiffness, as
    /// `weight` newtons per metre for each N s/m.
    fn springs<N: NormalForce>(
        &self,
        bodies: &Bodies,
        pairs: &CandidatePairs,
        weight: f64,
    ) -> impl Iterator<Item = Spring> {
        let ratio = self.settings.rolling.ratio().unwrap_or(0.0);
        let stiffness = move |law: &PairLaw, mobility: f64| {
            let (stiffness, damping) = N::response(law, mobility);
            (stiffness, law.held_across(), damping * weight)
        };
        let atoms = self.atoms.touching().map(move |index| {
            let AtomPair { a, b } = pairs.atoms[index];
            let normal = pairs.atoms[index].normal(bodies);
            let (a, b) = (ContactEnd::of(bodies, a), ContactEnd::of(bodies, b));
            let contact = self.atoms.get(index);
            let law = self.laws.get(contact.law);
            let (arm_a, arm_b) = arms((&a, &b), normal, contact.overlap, law.shares());
            let mobility = a.mobility(bodies, normal) + b.mobility(bodies, normal);
            let (stiffness, across, damped) = stiffness(law, mobility);
            let radius = rolling::rolling_radius(Some(&a), &b);
            let (a, b) = (Some((a.body, arm_a)), (b.body, arm_b));
            let turning = rolling::stiffness(ratio, law.stiffness, radius);
            Spring { a, b, normal, stiffness: (stiffness, across), damped, turning }
        });
        let surfaces = self.surfaces.touching().map(move |index| {
            let pair = PairGeometry::surface(bodies, index, pairs.surfaces[index]).pair;
            let (normal, end) = (pair.normal, pair.b);
            let contact = self.surfaces.get(index);
            let law = self.laws.get(contact.law);
            let (arm_a, arm_b) = pair.arms(law.shares(), contact.overlap);
            let mobility = pair.other_end().map_or(0.0, |a| a.mobility(bodies, normal)) + end.mobility(bodies, normal);
            let (stiffness, across, damped) = stiffness(law, mobility);
            let turning = rolling::stiffness(ratio, law.stiffness, rolling::rolling_radius(pair.other_end(), &end));
            let a = pair.other_end().map(|a| (a.body, arm_a));
            Spring { a, b: (end.body, arm_b), normal, stiffness: (stiffness, across), damped, turning }
        });
        atoms.chain(surfaces)
    }
}

/// The square of the angular frequency at which springs respond. Damping stiffens them in proportion to the frequency.
/// `looked` is a frequency in rad/s for which damping was counted, with the resulting square. `look` computes the
/// square for another frequency.
///
/// For a single spring the square is `k + c omega`, and for many it is nearly so. The line through two results gives
/// the next frequency (secant method).
fn frequency_squared(looked: (f64, f64), mut look: impl FnMut(f64) -> f64) -> f64 {
    let (mut before, mut squared_before) = looked;
    let (mut now, mut squared) = (squared_before.sqrt(), squared_before);
    for _ in 0..ROUNDS {
        squared = look(now);
        if (squared - now * now).abs() <= ENOUGH * squared {
            break;
        }
        let damping = (squared - squared_before) / (now - before);
        let stiffness = squared - damping * now;
        let is_line = damping >= 0.0 && stiffness >= 0.0;
        (before, squared_before) = (now, squared);
        now = if is_line { 0.5 * (damping + (damping * damping + 4.0 * stiffness).sqrt()) } else { squared.sqrt() };
    }
    squared
}

impl PairLaw {
    /// Stiffness of the tangential spring in N/m, if friction stretches it.
    fn held_across(&self) -> f64 {
        if self.friction_static > 0.0 || self.friction_dynamic > 0.0 { self.tangential_stiffness } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_damping_counts_is_found_in_few_looks() {
        // One spring and a dashpot: omega^2 = k + c omega.
        for (stiffness, damping) in [(1.0, 0.0), (1.0, 0.1), (4e6, 1e3), (1.0, 1.0), (1.0, 30.0)] {
            let exact = 0.5 * (damping + f64::sqrt(damping * damping + 4.0 * stiffness));
            for begin in [0.01 * exact, 3.0 * exact, 100.0 * exact] {
                let mut looks = 0;
                let found = frequency_squared((begin, stiffness + damping * begin), |angular_frequency| {
                    looks += 1;
                    stiffness + damping * angular_frequency
                });
                // The error is below the difference of the last two results.
                assert!((found - exact * exact).abs() <= ENOUGH * found, "{stiffness} {damping}: {found}");
                assert!(looks <= 2, "{looks} looks");
            }
        }
        // The greatest of several such lines.
        let several = |omega: f64| [(9.0, 0.5), (5.0, 2.0), (1.0, 4.0)].map(|(k, c)| k + c * omega);
        for begin in [0.1, 3.0, 40.0] {
            let mut looks = 0;
            let mut look = |omega| {
                looks += 1;
                several(omega).into_iter().fold(0.0, f64::max)
            };
            let found = frequency_squared((begin, look(begin)), &mut look);
            // omega^2 = 1 + 4 omega.
            let exact = 2.0 + f64::sqrt(5.0);
            assert!((found - exact * exact).abs() <= ENOUGH * found, "{found}");
            // Two on each of the lines lead to the next, or to the end.
            assert!(looks <= 6, "{looks} looks");
        }
    }
}
