//! What happens to each body in a step, several bodies at once: kicks, drifts, estimates.

use glam::DVec2;

use super::packed::Bodies;
use crate::simd::{self, BLOCK, Kernel, Lanes};

/// How far bodies went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// The greatest way of any point of a body, in metres.
    pub greatest: f64,
    /// The sum over all bodies, in metres: not finite as soon as one of them is.
    pub sum: f64,
}

impl Bodies {
    /// Velocities change by the present forces over `dt` seconds.
    pub fn kick(&mut self, dt: f64) {
        simd::run(self.level, Kick { bodies: self, dt });
    }

    /// Velocities change by the present forces over `kick` seconds, then positions and angles of dynamic bodies by those
    /// velocities over `drift` seconds (compensated summation: what rounding drops is added the next time). With `ahead` the
    /// velocities so many seconds later are estimated from the same forces.
    pub fn advance(&mut self, kick: f64, drift: f64, ahead: Option<f64>) -> Travel {
        if ahead.is_some() {
            self.estimated_velocity.resize(self.len(), DVec2::ZERO);
            self.estimated_spin.resize(self.len(), 0.0);
        }
        let travel = simd::run(self.level, Advance { bodies: self, kick, drift, ahead });
        self.path += travel.greatest;
        travel
    }
}

/// Work on bodies, as many side by side as there are lanes.
pub(crate) trait PerBody: Sized {
    /// Whose they are.
    fn whose(&self) -> &Bodies;

    /// Does it for the bodies from `first` on.
    fn bodies<V: Lanes>(&mut self, first: usize);

    /// Does it for all that are not asleep.
    #[inline(always)]
    fn all<V: Lanes>(&mut self) {
        let mut number = 0;
        while number < self.whose().awake_blocks() {
            let bodies = self.whose().awake_block(number);
            let mut first = bodies.start;
            if bodies.len() == BLOCK {
                while first < bodies.end {
                    self.bodies::<V>(first);
                    first += V::COUNT;
                }
            } else {
                while first < bodies.end {
                    self.bodies::<f64>(first);
                    first += 1;
                }
            }
            number += 1;
        }
    }
}

struct Kick<'a> {
    bodies: &'a mut Bodies,
    dt: f64,
}

impl Kernel for Kick<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(mut self) {
        self.all::<V>();
    }
}

impl PerBody for Kick<'_> {
    #[inline(always)]
    fn whose(&self) -> &Bodies {
        self.bodies
    }

    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, first: usize) {
        let (bodies, dt) = (&mut *self.bodies, V::splat(self.dt));
        let (x, y) = V::load_pairs(&bodies.velocity[first..]);
        let (force_x, force_y) = V::load_pairs(&bodies.force[first..]);
        let weight = V::load(&bodies.inverse_mass[first..]) * dt;
        V::store_pairs(x + force_x * weight, y + force_y * weight, &mut bodies.velocity[first..]);
        let weight = V::load(&bodies.inverse_inertia[first..]) * dt;
        let spin = V::load(&bodies.spin[first..]) + V::load(&bodies.torque[first..]) * weight;
        spin.store(&mut bodies.spin[first..]);
    }
}

struct Advance<'a> {
    bodies: &'a mut Bodies,
    kick: f64,
    drift: f64,
    ahead: Option<f64>,
}

impl Kernel for Advance<'_> {
    type Output = Travel;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Travel {
        let mut advancing = Advancing { step: self, greatest: [0.0; BLOCK], sum: [0.0; BLOCK] };
        advancing.all::<V>();
        Travel {
            greatest: advancing.greatest.into_iter().fold(0.0, f64::max),
            sum: advancing.sum.into_iter().fold(0.0, |sum, part| sum + part),
        }
    }
}

struct Advancing<'a> {
    step: Advance<'a>,
    greatest: [f64; BLOCK],
    sum: [f64; BLOCK],
}

/// A number that changes by a step, and what rounding leaves of that (Kahan 1965).
#[inline(always)]
fn compensated<V: Lanes>(before: V, rest: V, step: V) -> (V, V) {
    let step = step + rest;
    let after = before + step;
    (after, step - (after - before))
}

impl PerBody for Advancing<'_> {
    #[inline(always)]
    fn whose(&self) -> &Bodies {
        self.step.bodies
    }

    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, first: usize) {
        let Advance { bodies, kick, drift, ahead } = &mut self.step;
        let (force_x, force_y) = V::load_pairs(&bodies.force[first..]);
        let (torque, inverse_mass) = (V::load(&bodies.torque[first..]), V::load(&bodies.inverse_mass[first..]));
        let inverse_inertia = V::load(&bodies.inverse_inertia[first..]);
        let (u, v) = V::load_pairs(&bodies.velocity[first..]);
        let spin = V::load(&bodies.spin[first..]);
        let (weight, turning) = (inverse_mass * V::splat(*kick), inverse_inertia * V::splat(*kick));
        let (u, v, spin) = (u + force_x * weight, v + force_y * weight, spin + torque * turning);
        V::store_pairs(u, v, &mut bodies.velocity[first..]);
        spin.store(&mut bodies.spin[first..]);
        if let Some(ahead) = *ahead {
            let (weight, turning) = (inverse_mass * V::splat(ahead), inverse_inertia * V::splat(ahead));
            let (u, v) = (u + force_x * weight, v + force_y * weight);
            V::store_pairs(u, v, &mut bodies.estimated_velocity[first..]);
            (spin + torque * turning).store(&mut bodies.estimated_spin[first..]);
        }
        let moves = inverse_mass.gt(V::splat(0.0));
        let dt = V::splat(*drift).only(moves);
        let (dx, dy, turn) = (u * dt, v * dt, spin * dt);
        V::store_pairs(dx, dy, &mut bodies.drift[first..]);
        turn.store(&mut bodies.turn[first..]);
        let (x, y) = V::load_pairs(&bodies.position[first..]);
        let (rest_x, rest_y) = V::load_pairs(&bodies.position_rest[first..]);
        let ((x, rest_x), (y, rest_y)) = (compensated(x, rest_x, dx), compensated(y, rest_y, dy));
        V::store_pairs(x, y, &mut bodies.position[first..]);
        V::store_pairs(rest_x, rest_y, &mut bodies.position_rest[first..]);
        let (angle, rest) = (V::load(&bodies.angle[first..]), V::load(&bodies.angle_rest[first..]));
        let (angle, rest) = compensated(angle, rest, turn);
        angle.store(&mut bodies.angle[first..]);
        rest.store(&mut bodies.angle_rest[first..]);
        let travel = (dx * dx + dy * dy).sqrt() + turn.abs() * V::load(&bodies.extent[first..]);
        let lane = first % BLOCK;
        let greatest = V::load(&self.greatest[lane..]);
        V::select(travel.gt(greatest), travel, greatest).store(&mut self.greatest[lane..]);
        (V::load(&self.sum[lane..]) + travel).store(&mut self.sum[lane..]);
    }
}

impl Bodies {
    /// Whether each body that moves is nearer than `allowed` metres, its turn included, to where it stood: places and angles
    /// are given. What is no number is not.
    pub fn stayed_near(&self, allowed: f64, position: &[DVec2], angle: &[f64]) -> bool {
        simd::run(self.level, Near { bodies: self, allowed, position, angle })
    }
}

struct Near<'a> {
    bodies: &'a Bodies,
    allowed: f64,
    position: &'a [DVec2],
    angle: &'a [f64],
}

impl Near<'_> {
    #[inline(always)]
    fn near<V: Lanes>(&self, first: usize) -> bool {
        let bodies = self.bodies;
        let (x, y) = V::load_pairs(&bodies.position[first..]);
        let (from_x, from_y) = V::load_pairs(&self.position[first..]);
        let turned = (V::load(&bodies.angle[first..]) - V::load(&self.angle[first..])).abs();
        let left = V::splat(self.allowed) - turned * V::load(&bodies.extent[first..]);
        let (x, y, zero) = (x - from_x, y - from_y, V::splat(0.0));
        // Bodies that stand still are where they were, whatever the sign of zero.
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
        let mut number = 0;
        while number < self.bodies.awake_blocks() {
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
