//! Ballistic flight in closed form: position and velocity after many ticks of velocity Verlet, for several bodies side
//! by side.

use glam::DVec2;

use super::flight::BOUND;
use super::packed::Bodies;
use jostle_simd::{BLOCK, Kernel, Lanes, Record};
use serde::{Deserialize, Serialize};

/// The beginning of a flight: position and its rounding remainder, velocity, angle and its rounding remainder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub position: DVec2,
    pub position_residual: DVec2,
    pub velocity: DVec2,
    pub angle: f64,
    pub angle_residual: f64,
}

impl Start {
    pub fn record(self) -> Record {
        let Self { position, position_residual, velocity, angle, angle_residual } = self;
        let (place, rest) = (position.to_array(), position_residual.to_array());
        Record([place[0], place[1], rest[0], rest[1], velocity.x, velocity.y, angle, angle_residual])
    }
}

/// The common parameters of all flights.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Air {
    /// Acceleration in m/s2.
    pub field: DVec2,
    /// Length of a tick in s.
    pub dt: f64,
}

/// Bodies that fly, at the end of some tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aloft<V> {
    pub position: (V, V),
    pub position_residual: (V, V),
    pub angle: V,
    pub angle_residual: V,
    /// Velocity half a tick earlier: that of the last drift.
    pub drifted: (V, V),
    pub velocity: (V, V),
}

/// A number so much later, and what rounding leaves of that (Kahan 1965).
#[inline(always)]
fn later<V: Lanes>(before: V, rest: V, step: V) -> (V, V) {
    let step = rest + step;
    let after = before + step;
    (after, step - (after - before))
}

impl Air {
    /// Flights `time` seconds after they began.
    #[inline(always)]
    pub fn after<V: Lanes>(&self, start: [V; BLOCK], time: V, spin: V) -> Aloft<V> {
        let [x, y, rest_x, rest_y, u, v, angle, angle_residual] = start;
        let field = (V::splat(self.field.x), V::splat(self.field.y));
        let fallen = V::splat(0.5) * time * time;
        let (x, rest_x) = later(x, rest_x, u * time + field.0 * fallen);
        let (y, rest_y) = later(y, rest_y, v * time + field.1 * fallen);
        let (angle, angle_residual) = later(angle, angle_residual, spin * time);
        let middle = time - V::splat(0.5 * self.dt);
        Aloft {
            position: (x, y),
            position_residual: (rest_x, rest_y),
            angle,
            angle_residual,
            drifted: (u + field.0 * middle, v + field.1 * middle),
            velocity: (u + field.0 * time, v + field.1 * time),
        }
    }
}

/// Fills in where bodies are that fly.
pub(super) struct Land<'a> {
    pub bodies: &'a mut Bodies,
    pub starts: &'a [Record],
    /// The tick in which each took off; the largest number: it does not fly.
    pub since: &'a [u32],
    /// The present tick.
    pub ticks: u32,
    pub air: Air,
    /// The last kick of the tick was given.
    pub kicked: bool,
}

/// Numbers of bodies that fly take the place of those in a list.
#[inline(always)]
fn put<V: Lanes>(flies: V::Mask, new: V, list: &mut [f64]) {
    V::select(flies, new, V::load(list)).store(list);
}

/// Likewise pairs of numbers.
#[inline(always)]
fn put_pairs<V: Lanes>(flies: V::Mask, new: (V, V), list: &mut [DVec2]) {
    let old = V::load_pairs(list);
    V::store_pairs(V::select(flies, new.0, old.0), V::select(flies, new.1, old.1), list);
}

impl Land<'_> {
    /// Lands bodies from index `first` on, one for each lane. Returns the longest way in metres that a point of these
    /// made in the tick.
    #[inline(always)]
    pub fn some<V: Lanes>(&mut self, first: usize) -> f64 {
        let (mut time, mut indices) = ([0.0; BLOCK], [0_u32; BLOCK]);
        for (lane, &since) in self.since[first..first + V::COUNT].iter().enumerate() {
            let flown = if since == BOUND { -1.0 } else { f64::from(self.ticks - since) };
            (time[lane], indices[lane]) = (flown * self.air.dt, (first + lane) as u32);
        }
        let time = V::load(&time);
        let flies = !time.lt(V::splat(0.0));
        if V::bits(flies) == 0 {
            return 0.0;
        }
        let bodies = &mut *self.bodies;
        let spin = V::load(&bodies.spin[first..]);
        let aloft = self.air.after(V::records(self.starts, &indices), time, spin);
        put_pairs(flies, aloft.position, &mut bodies.position[first..]);
        put_pairs(flies, aloft.position_residual, &mut bodies.position_residual[first..]);
        put(flies, aloft.angle, &mut bodies.angle[first..]);
        put(flies, aloft.angle_residual, &mut bodies.angle_residual[first..]);
        let drifted = if self.kicked { aloft.velocity } else { aloft.drifted };
        // While an evaluation sees estimates these have taken the place of velocities.
        let (own, estimated) = if bodies.estimating { (aloft.velocity, drifted) } else { (drifted, aloft.velocity) };
        put_pairs(flies, own, &mut bodies.velocity[first..]);
        if !bodies.estimated_velocity.is_empty() {
            put_pairs(flies, estimated, &mut bodies.estimated_velocity[first..]);
        }
        let (u, v) = aloft.drifted;
        let around = spin.abs() * V::load(&bodies.atom_radius[first..]);
        let way = ((u * u + v * v).sqrt() + around) * V::splat(self.air.dt);
        let mut ways = [0.0; BLOCK];
        way.only(flies).store(&mut ways);
        ways.into_iter().fold(0.0, f64::max)
    }
}

impl Kernel for Land<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Lanes>(mut self) -> f64 {
        let (mut first, mut longest) = (0, 0.0_f64);
        while first + V::COUNT <= self.starts.len() {
            longest = longest.max(self.some::<V>(first));
            first += V::COUNT;
        }
        while first < self.starts.len() {
            longest = longest.max(self.some::<f64>(first));
            first += 1;
        }
        longest
    }
}

impl Land<'_> {
    /// All bodies that fly.
    pub fn all(self) -> f64 {
        let level = self.bodies.level;
        jostle_simd::run(level, self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If the tick is a power of two and all numbers are short, neither way rounds.
    #[test]
    fn many_ticks_at_once_are_as_many_one_by_one() {
        let air = Air { field: DVec2::new(0.5, -2.0), dt: 0.125 };
        let start = Start {
            position: DVec2::new(3.0, -1.0),
            position_residual: DVec2::ZERO,
            velocity: DVec2::new(-4.0, 0.25),
            angle: 1.0,
            angle_residual: 0.0,
        };
        let (mut position, mut velocity, mut angle, spin) = (start.position, start.velocity, start.angle, 0.75);
        for tick in 1..50 {
            let drifted = velocity + air.field * (air.dt / 2.0);
            position += drifted * air.dt;
            velocity = drifted + air.field * (air.dt / 2.0);
            angle += spin * air.dt;
            let aloft = air.after::<f64>(start.record().0, f64::from(tick) * air.dt, spin);
            assert_eq!((DVec2::from(aloft.position), DVec2::from(aloft.velocity)), (position, velocity));
            assert_eq!((aloft.angle, DVec2::from(aloft.drifted)), (angle, drifted));
        }
    }
}
