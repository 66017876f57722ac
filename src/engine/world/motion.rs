//! Kicks, drifts and estimates of each body in a step, several bodies at once.

use std::ops::{Add, Range, Sub};
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec2;

use super::begin_evaluation::BeginEvaluation;
use super::chunk::{Chunk, PerBody, parts_of};
use super::packed::{Bodies, Moved};
use jostle_simd::{BLOCK, Kernel, Lanes, Vectors};

/// The ways of bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// The greatest way of any point of a body, in metres.
    pub greatest: f64,
    /// A sum over all bodies that is finite as long as the squares of their ways are.
    pub sum: f64,
}

impl Bodies {
    /// Kinetic energy of one body in J, zero if it does not move by forces.
    #[inline]
    pub fn kinetic_energy(&self, body: usize) -> f64 {
        if !self.dynamic[body] {
            return 0.0;
        }
        let (velocity, spin) = (self.velocity[body], self.spin[body]);
        0.5 * (self.mass[body] * velocity.length_squared() + self.inertia[body] * spin.powi(2))
    }

    /// Velocities change by the present forces over `dt` seconds.
    pub fn kick(&mut self, dt: f64) {
        self.note_kick();
        if !self.each_bound(&mut Kick { dt }) {
            self.each(Kick { dt }, |_| ());
        }
    }

    /// The same, but the next step applies the kick if it moves all bodies, with numbers that are loaded once. Until
    /// then velocities lack the kick. Code that reads them, or changes forces, calls [`Bodies::catch_up`] first.
    pub(crate) fn kick_later(&mut self, dt: f64) {
        if self.records.is_empty() || self.flights.some() {
            return self.kick(dt);
        }
        self.note_kick();
        self.owed = Some(dt);
    }

    /// Applies the pending kick, if there is one.
    #[inline]
    pub(crate) fn catch_up(&mut self) {
        if let Some(dt) = self.owed.take() {
            self.each(Kick { dt }, |_| ());
        }
    }

    /// Velocities change by the current forces over `kick` seconds. Then positions and angles of dynamic bodies change
    /// by those velocities over `drift` seconds. Compensated summation adds the rounding remainder the next time. With
    /// `ahead` the velocities so many seconds later are estimated from the same forces. The forces then belong to a
    /// past state and must be evaluated next.
    pub fn advance(&mut self, kick: f64, drift: f64, ahead: Option<f64>) -> Travel {
        if ahead.is_some() {
            self.estimated_velocity.resize(self.len(), DVec2::ZERO);
            self.estimated_spin.resize(self.len(), 0.0);
        }
        if matches!(self.moved, Moved::For(_)) {
            self.moved = Moved::For(drift);
        }
        let mut travel = Travel::default();
        let mut weighed = (0.0, DVec2::ZERO);
        let pose = BeginEvaluation::new(self.field);
        let owed = self.owed.take();
        let mut advance = Advance { owed, kick, drift, ahead, greatest: [0.0; BLOCK], sum: [0.0; BLOCK], pose };
        let mut found = |part: &Advance| {
            travel.greatest = part.greatest.iter().copied().fold(travel.greatest, f64::max);
            travel.sum = part.sum.iter().fold(travel.sum, |sum, part| sum + part);
            part.pose.add_to(&mut weighed);
        };
        self.fly(drift);
        if self.each_bound(&mut advance) {
            found(&advance);
        } else {
            self.each(advance, found);
            self.recorded = !self.records.is_empty() && self.asleep.is_empty();
        }
        self.advanced = self.farthest_way(travel.greatest);
        self.path += self.advanced;
        self.add_flights(&mut travel, &mut weighed);
        self.weighed = weighed;
        // Done on the way; atoms beside the centre take turning.
        self.posed = self.lone_discs;
        travel
    }

    /// Resets forces to the weight of each body (zero without a field), and moves the atoms to their bodies. Cosine and
    /// sine are computed from the angle each time. So a body cannot grow or shrink however long it spins.
    pub fn pose(&mut self) {
        if !std::mem::take(&mut self.posed) {
            self.end_flights();
            let mut weighed = (0.0, DVec2::ZERO);
            self.each(BeginEvaluation::new(self.field), |part| part.add_to(&mut weighed));
            self.weighed = weighed;
        }
    }
}

#[derive(Clone)]
struct Kick {
    dt: f64,
}

impl PerBody for Kick {
    #[inline(always)]
    fn fetch(part: &Chunk, first: usize) {
        Chunk::fetch_pairs([part.velocity, part.force], first);
        Chunk::fetch_numbers([part.mass, part.inertia, part.spin, part.torque], first);
    }

    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Chunk, first: usize) {
        let dt = V::splat(self.dt);
        let (inverse_mass, inverse_inertia) = part.inverses::<V>(first);
        let kicked = Vectors::load(&part.velocity[first..]) + Vectors::load(&part.force[first..]) * (inverse_mass * dt);
        kicked.store(&mut part.velocity[first..]);
        let spin = V::load(&part.spin[first..]) + V::load(&part.torque[first..]) * (inverse_inertia * dt);
        spin.store(&mut part.spin[first..]);
    }
}

#[derive(Clone)]
struct Advance {
    /// See [`Bodies::owed`].
    owed: Option<f64>,
    kick: f64,
    drift: f64,
    ahead: Option<f64>,
    greatest: [f64; BLOCK],
    sum: [f64; BLOCK],
    pose: BeginEvaluation,
}

/// A number that changes by a step, and what rounding leaves of that (Kahan 1965).
#[inline(always)]
fn compensated<N: Copy + Add<Output = N> + Sub<Output = N>>(before: N, rest: N, step: N) -> (N, N) {
    let step = step + rest;
    let after = before + step;
    (after, step - (after - before))
}

impl PerBody for Advance {
    #[inline(always)]
    fn fetch(part: &Chunk, first: usize) {
        Chunk::fetch_pairs([part.velocity, part.force, part.position, part.position_residual], first);
        Chunk::fetch_pairs([part.estimated_velocity], first);
        Chunk::fetch_numbers([part.mass, part.inertia, part.spin, part.torque], first);
        Chunk::fetch_numbers([part.angle, part.angle_residual, part.extent, part.estimated_spin], first);
    }

    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Chunk, first: usize) {
        let force = Vectors::load(&part.force[first..]);
        let (torque, (inverse_mass, inverse_inertia)) = (V::load(&part.torque[first..]), part.inverses::<V>(first));
        let (mut velocity, mut spin) = (Vectors::load(&part.velocity[first..]), V::load(&part.spin[first..]));
        if let Some(owed) = self.owed {
            let owed = V::splat(owed);
            velocity = velocity + force * (inverse_mass * owed);
            spin = spin + torque * (inverse_inertia * owed);
        }
        let kick = V::splat(self.kick);
        velocity = velocity + force * (inverse_mass * kick);
        spin = spin + torque * (inverse_inertia * kick);
        velocity.store(&mut part.velocity[first..]);
        spin.store(&mut part.spin[first..]);
        let mut seen = velocity;
        if let Some(ahead) = self.ahead {
            let ahead = V::splat(ahead);
            seen = velocity + force * (inverse_mass * ahead);
            seen.store(&mut part.estimated_velocity[first..]);
            (spin + torque * (inverse_inertia * ahead)).store(&mut part.estimated_spin[first..]);
        }
        let moves = inverse_mass.gt(V::splat(0.0));
        let dt = V::splat(self.drift).only(moves);
        let (drift, turn) = (velocity * dt, spin * dt);
        if !part.drift.is_empty() {
            drift.store(&mut part.drift[first..]);
            turn.store(&mut part.turn[first..]);
        }
        let (position, rest) =
            (Vectors::load(&part.position[first..]), Vectors::load(&part.position_residual[first..]));
        let (position, rest) = compensated(position, rest, drift);
        position.store(&mut part.position[first..]);
        rest.store(&mut part.position_residual[first..]);
        let (angle, rest) = (V::load(&part.angle[first..]), V::load(&part.angle_residual[first..]));
        let (angle, rest) = compensated(angle, rest, turn);
        angle.store(&mut part.angle[first..]);
        rest.store(&mut part.angle_residual[first..]);
        if !part.records.is_empty() {
            let radius = V::load(&part.extent[first..]);
            V::store_records([position, drift, seen, Vectors::of(turn, radius)], &mut part.records[first..]);
        }
        if part.lone_discs {
            self.pose.forces(part, first, position, moves);
        }
        let (dx, dy) = drift.parted();
        let (lane, around) = (first % BLOCK, turn.abs() * V::load(&part.extent[first..]));
        // No way is longer than along both axes: roots only of those that may be the longest so far.
        let squared = dx * dx + dy * dy;
        let (bound, greatest) = (dx.abs() + dy.abs() + around, V::load(&self.greatest[lane..]));
        if V::bits(bound.gt(greatest)) != 0 {
            let travel = squared.sqrt() + around;
            V::select(travel.gt(greatest), travel, greatest).store(&mut self.greatest[lane..]);
        }
        (V::load(&self.sum[lane..]) + squared + around).store(&mut self.sum[lane..]);
    }
}

impl Bodies {
    /// Whether each moving body is nearer than `allowed` metres to its given position and angle, its turn included.
    /// Without angles turning does not count. NaN gives false.
    pub fn stayed_near(&self, allowed: f64, position: &[DVec2], angle: &[f64]) -> bool {
        let near = |blocks: Range<usize>| {
            jostle_simd::run(self.level, Near { bodies: self, allowed, position, angle, blocks })
        };
        let blocks = self.awake_blocks();
        let count = parts_of(BLOCK * blocks, FEWEST_NEAR);
        if count == 1 {
            return near(0..blocks);
        }
        let each = blocks.div_ceil(count);
        let parts = (0..count).map(|part| blocks.min(part * each)..blocks.min((part + 1) * each)).collect();
        let all = AtomicBool::new(true);
        self.threads.each(parts, |blocks| {
            // Relaxed: a part that has not seen another's result only does useless work.
            if all.load(Ordering::Relaxed) && !near(blocks) {
                all.store(false, Ordering::Relaxed);
            }
        });
        all.into_inner()
    }
}

/// Bodies of the smallest part of that.
const FEWEST_NEAR: usize = 32768;

struct Near<'a> {
    bodies: &'a Bodies,
    allowed: f64,
    position: &'a [DVec2],
    angle: &'a [f64],
    blocks: Range<usize>,
}

impl Near<'_> {
    #[inline(always)]
    fn near<V: Lanes>(&self, first: usize) -> bool {
        let bodies = self.bodies;
        let (x, y) = V::load_pairs(&bodies.position[first..]);
        let (from_x, from_y) = V::load_pairs(&self.position[first..]);
        let mut left = V::splat(self.allowed);
        if !self.angle.is_empty() {
            let turned = (V::load(&bodies.angle[first..]) - V::load(&self.angle[first..])).abs();
            left = left - turned * V::load(&bodies.extents()[first..]);
        }
        let (x, y, zero) = (x - from_x, y - from_y, V::splat(0.0));
        // Bodies at rest keep their position, whatever the sign of zero.
        let near =
            !(left * left).lt(x * x + y * y) & !left.lt(zero) & (x * x + y * y + left).lt(V::splat(f64::INFINITY));
        let all = ((1_u16 << V::COUNT) - 1) as u8;
        V::bits(near) & all == all
    }
}

impl Kernel for Near<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Lanes>(self) -> bool {
        let mut number = self.blocks.start;
        while number < self.blocks.end {
            let bodies = self.bodies.awake_block(number);
            let (mut first, whole) = (bodies.start, bodies.len() == BLOCK);
            while first < bodies.end {
                let near = if whole { self.near::<V>(first) } else { self.near::<f64>(first) };
                if !near {
                    return false;
                }
                first += if whole { V::COUNT } else { 1 };
            }
            number += 1;
        }
        true
    }
}
