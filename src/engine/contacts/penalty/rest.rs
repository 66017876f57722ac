//! Sleeping islands: bodies whose contacts hold every load are exactly at rest until something changes.
//!
//! A body is laid to rest only with its whole island. [`crate::constraints::rest_solver`] must have found forces within
//! the bounds of the contact law. They balance all loads and cancel the last velocity. The body stays at rest while no
//! bit of the sum of its forces changes. A touch, another load, or a changed velocity or position wakes it.

use glam::DVec2;

use super::apply::PenaltyContacts;
use crate::contacts::Other;
use crate::contacts::{CandidatePairs, ContactForces};
use crate::tick::Rates;
use crate::world::Bodies;
use jostle_simd::BLOCK;
use serde::{Deserialize, Serialize};

/// Largest imbalance of a body that is laid to rest, as a share of the forces on it. It allows for rounding.
const IMBALANCE: f64 = 1e-9;

/// Bodies that move by forces, of which at least one has to sleep. Only then are all bodies checked for sleep.
const FEWEST: usize = 16;

/// A body at rest.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Resting {
    body: usize,
    position: DVec2,
    angle: f64,
    /// Force against which its imbalance is judged, in newtons; see [`crate::constraints::rest_solver::loads`].
    load: f64,
    /// Sum of all forces and torques: what rounding leaves of zero. `None` before the first evaluation.
    left_over: Option<(DVec2, f64)>,
}

/// Which bodies are at rest.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Rest {
    generation: u64,
    resting: Vec<Resting>,
    /// For each body whether it is at rest.
    still: Vec<bool>,
    /// Whether bodies have been laid to rest or have woken since contacts were informed.
    changed: bool,
    /// Some woke since their neighbours were looked at.
    pub woke: bool,
    /// A bit for each body that falls asleep, and whether each block of bodies stays awake. Only their memory is kept.
    #[serde(skip)]
    blocks: (Vec<u8>, Vec<bool>),
}

impl Rest {
    /// Whether the bodies at rest are among so many.
    pub fn fits(&self, bodies: usize) -> bool {
        let Self { resting, still, .. } = self;
        resting.iter().all(|one| one.body < bodies && one.position.is_finite() && one.angle.is_finite())
            && (still.is_empty() || still.len() == bodies)
    }

    /// Whether `body` is at rest.
    #[inline]
    pub fn has(&self, body: usize) -> bool {
        self.still.get(body).copied().unwrap_or(false)
    }

    /// Whether any body is.
    pub fn is_empty(&self) -> bool {
        self.resting.is_empty()
    }

    /// Lays `body` to rest under contact forces of `load` newtons in all: velocities become zero.
    pub fn lay(&mut self, body: usize, load: f64, bodies: &mut Bodies) {
        self.generation = bodies.generation;
        self.still.resize(bodies.len(), false);
        self.still[body] = true;
        bodies.velocity[body] = DVec2::ZERO;
        bodies.spin[body] = 0.0;
        if !bodies.estimated_velocity.is_empty() {
            bodies.estimated_velocity[body] = DVec2::ZERO;
            bodies.estimated_spin[body] = 0.0;
        }
        bodies.force[body] = DVec2::ZERO;
        bodies.torque[body] = 0.0;
        bodies.stays(body);
        self.changed = true;
        let (position, angle) = (bodies.position[body], bodies.angle[body]);
        self.resting.push(Resting { body, position, angle, load, left_over: None });
    }

    /// Wakes all.
    pub fn clear(&mut self) {
        self.changed |= !self.resting.is_empty();
        self.resting.clear();
        self.still.clear();
    }

    /// Wakes `body`; returns whether it was at rest.
    pub fn wake(&mut self, body: usize) -> bool {
        let was = self.has(body);
        if was {
            self.still[body] = false;
            (self.changed, self.woke) = (true, true);
        }
        was
    }

    /// Forgets those that woke.
    pub fn forget_woken(&mut self) {
        let still = &self.still;
        self.resting.retain(|resting| still[resting.body]);
    }

    /// After an evaluation: bodies without a change stay at rest. The bodies that carry them supply the rounding
    /// remainder of their balance. The others wake. Sleeping bodies have received no force except that of new touches.
    pub fn settle(&mut self, bodies: &mut Bodies, rates: &mut Rates) {
        if self.resting.is_empty() {
            return;
        }
        if self.generation != bodies.generation {
            // Indices have changed. Bodies at rest are found again before the next step.
            self.clear();
            return;
        }
        if !bodies.asleep.is_empty() {
            bodies.disturbed = self.any_pushed_asleep(bodies);
            // If all bodies at rest sleep, there is no more to check. If an evaluation is repeated with all of them,
            // only the repetition counts. Bodies that were just laid to rest are checked in it.
            if bodies.disturbed || !self.changed {
                return;
            }
        }
        let still = &mut self.still;
        let (changed, woke) = (&mut self.changed, &mut self.woke);
        self.resting.retain_mut(|resting| {
            let body = resting.body;
            if bodies.is_asleep(body) {
                return still[body];
            }
            let stays = resting.unchanged(bodies);
            if stays {
                let (force, torque) = (bodies.force[body], bodies.torque[body]);
                rates.outside(bodies.position[body], -force, -torque);
                bodies.force[body] = DVec2::ZERO;
                bodies.torque[body] = 0.0;
            } else {
                still[body] = false;
                (*changed, *woke) = (true, true);
            }
            stays
        });
        // The list may hold a body twice, or one that has woken. So its length does not show whether all rest.
        let all = |still: &[bool]| (0..bodies.len()).all(|body| still[body] || !bodies.dynamic[body]);
        if self.resting.len() >= bodies.dynamic_count() && all(&self.still) {
            // No body moves. So the external forces cancel, and the rounding of their sum must not accumulate over the
            // ticks.
            (rates.force, rates.torque) = (DVec2::ZERO, 0.0);
        }
    }

    /// Whether one of those that are asleep was pushed. All others were given no force.
    fn any_pushed_asleep(&self, bodies: &Bodies) -> bool {
        let pushed = |body: usize| bodies.force[body] != DVec2::ZERO || bodies.torque[body] != 0.0;
        let mut awake = (0..bodies.awake_blocks()).flat_map(|number| bodies.awake_block(number));
        awake.any(|body| bodies.is_asleep(body) && self.has(body) && pushed(body))
    }
}

/// Whether bodies at rest need no work: forces are known not to change as long as nothing touches them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Sleep {
    Allowed,
    Never,
}

impl PenaltyContacts {
    /// Informs bodies and contacts about sleepers. They are the bodies at rest under forces that do not change and that
    /// only touch such bodies.
    pub(super) fn lay_asleep(
        &mut self,
        bodies: &mut Bodies,
        pairs: &CandidatePairs,
        forces: Option<&mut ContactForces>,
    ) {
        let Self { rest, atoms, surfaces, sleep, .. } = self;
        // Bodies that were laid to rest in this tick have yet to be checked. The lists may be renewed before that.
        rest.changed = rest.resting.iter().any(|resting| resting.left_over.is_none());
        let known = rest.generation == bodies.generation && *sleep == Sleep::Allowed;
        let still = |body: usize| rest.still.get(body).is_some_and(|still| *still);
        let sleepers = rest.resting.iter().filter(|resting| resting.left_over.is_some() && still(resting.body));
        let (asleep, awake) = &mut rest.blocks;
        asleep.clear();
        asleep.resize(bodies.len().div_ceil(BLOCK), 0);
        let mut count = 0;
        for resting in sleepers.filter(|_| known) {
            asleep[resting.body / BLOCK] |= 1 << (resting.body % BLOCK);
            count += 1;
        }
        if count == 0 || FEWEST * count < bodies.dynamic_count() {
            bodies.wake_all();
            atoms.wake_all();
            surfaces.wake_all();
            return;
        }
        bodies.lay_asleep(asleep);
        let stands = |atom: u32| {
            let body = bodies.atom_body(atom as usize);
            !bodies.moves[body] || bodies.is_asleep(body)
        };
        atoms.lay_asleep(|index| stands(pairs.atoms[index].a) && stands(pairs.atoms[index].b));
        let body_stands = |body: usize| !bodies.moves[body] || bodies.is_asleep(body);
        surfaces.lay_asleep(|index| {
            let (a, b) = pairs.surfaces[index].bodies(bodies);
            body_stands(b) && a.is_none_or(body_stands)
        });
        awake.clear();
        awake.resize(bodies.asleep.len(), false);
        let whole = |block: usize| {
            let there = bodies.len() - BLOCK * block;
            if there < BLOCK { (1_u8 << there) - 1 } else { u8::MAX }
        };
        for (block, awake) in awake.iter_mut().enumerate() {
            let fixed = (BLOCK * block..bodies.len().min(BLOCK * block + BLOCK)).rev();
            let fixed = fixed.fold(0, |bits, body| bits << 1 | u8::from(!bodies.moves[body]));
            *awake = (bodies.asleep[block] | fixed) & whole(block) != whole(block);
        }
        // Bodies that awake bodies may touch are evaluated.
        for number in 0..atoms.awake_blocks() {
            let first = BLOCK * atoms.awake_block(number);
            for pair in &pairs.atoms[first..pairs.atoms.len().min(first + BLOCK)] {
                for atom in [pair.a, pair.b] {
                    awake[bodies.atom_body(atom as usize) / BLOCK] = true;
                }
            }
        }
        for number in 0..if bodies.hulls.is_empty() { 0 } else { surfaces.awake_blocks() } {
            let first = BLOCK * surfaces.awake_block(number);
            for pair in &pairs.surfaces[first..pairs.surfaces.len().min(first + BLOCK)] {
                let (a, b) = pair.bodies(bodies);
                [a, Some(b)].into_iter().flatten().for_each(|body| awake[body / BLOCK] = true);
            }
        }
        bodies.awake.clear();
        bodies.awake.extend((0..awake.len()).filter(|&block| awake[block]).map(|block| block as u32));
        if let Some(forces) = forces {
            let mut asleep = forces.asleep.take().unwrap_or_default();
            for (list, count) in [(&mut asleep.0, bodies.len()), (&mut asleep.1, bodies.walls.len())] {
                list.clear();
                list.resize(count, DVec2::ZERO);
            }
            for (index, point) in self.atom_points(bodies, pairs) {
                if let Other::Body(other) = point.other
                    && self.atoms.is_asleep(index)
                {
                    asleep.0[other] -= point.force;
                    asleep.0[point.body] += point.force;
                }
            }
            for (index, point) in self.surface_points(bodies, pairs) {
                if self.surfaces.is_asleep(index) {
                    asleep.0[point.body] += point.force;
                    match point.other {
                        Other::Body(other) => asleep.0[other] -= point.force,
                        Other::Wall(wall) => asleep.1[wall] -= point.force,
                    }
                }
            }
            forces.asleep = Some(asleep);
        }
    }
}

impl PenaltyContacts {
    /// After all forces: see [`Rest::settle`]. Bodies at rest fall asleep unless forces are `changing`.
    #[inline]
    pub(super) fn settle(
        &mut self,
        (bodies, rates): (&mut Bodies, &mut Rates),
        pairs: &CandidatePairs,
        forces: Option<&mut ContactForces>,
        changing: bool,
    ) {
        if self.rest.is_empty() && !self.rest.changed {
            return;
        }
        let woken_by_others = bodies.asleep.is_empty() && self.sleep == Sleep::Allowed;
        let new = self.rest.changed || woken_by_others;
        self.rest.settle(bodies, rates);
        if !bodies.disturbed && (new || self.rest.changed) {
            // Joints find their forces from all forces on their bodies, so these have to be there.
            let jointed = |resting: &Resting| bodies.jointed.get(resting.body).is_some_and(|jointed| *jointed);
            let jointed = self.rest.resting.iter().any(jointed);
            let carried = jointed || !bodies.prescribed.motions.is_empty() || !bodies.belts.is_empty();
            let sleeps = !(changing || carried);
            self.sleep = if sleeps && self.may_sleep { Sleep::Allowed } else { Sleep::Never };
            self.lay_asleep(bodies, pairs, forces);
        }
    }
}

impl Resting {
    fn unchanged(&mut self, bodies: &Bodies) -> bool {
        let body = self.body;
        let (force, torque) = (bodies.force[body], bodies.torque[body]);
        let balanced = match self.left_over {
            Some(left_over) => left_over == (force, torque),
            None => {
                self.left_over = Some((force, torque));
                let limit = IMBALANCE * self.load;
                force.length() <= limit && torque.abs() <= limit * bodies.extent(body)
            }
        };
        let stands = bodies.position[body] == self.position && bodies.angle[body] == self.angle;
        balanced && stands && bodies.velocity[body] == DVec2::ZERO && bodies.spin[body] == 0.0
    }
}
