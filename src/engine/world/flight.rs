//! Bodies in free flight: no body touches them, so their motion is known until a contact begins.
//!
//! Velocity Verlet moves a body under its weight alone along the exact parabola. Its position `k` ticks of `dt` seconds
//! after `(x, v)` is `x + v k dt + g (k dt)²/2`, and its velocity is `v + g k dt`. The only error is rounding, because
//! the method is exact for constant accelerations. So the integrator does not move such a body tick by tick. These
//! formulas give its state on demand. Candidate pairs show the bodies that may have come near. A body that touches
//! another is *bound*: the integrator moves it tick by tick until it flies again.
//!
//! [`Bodies::land`] fills in all positions for a reader, and the flights continue from their beginnings. So reading
//! changes nothing. Bodies are lone discs, all of them dynamic. The models of a scene declare whether they support
//! flights (`Census::of_flights`).

use glam::DVec2;

use super::aloft::{Air, Aloft, Land, Start};
use super::chunk::PerBody;
use super::motion::Travel;
use super::packed::Bodies;
use jostle_simd::Record;
use serde::{Deserialize, Serialize};

/// The value for bound bodies, in place of the tick in which they took off.
pub(super) const BOUND: u32 = u32::MAX;

/// The flying bodies, and the beginnings of their flights.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Flights {
    /// Whether the method and the models of the run support flights.
    allowed: bool,
    /// Bodies have landed since it was last tried whether many can fly.
    worth_trying: bool,
    /// For each body its flight; empty if no body flies.
    starts: Vec<Record>,
    /// For each body the tick in which it took off, or [`BOUND`].
    since: Vec<u32>,
    /// The bodies that do not fly, in order.
    bound: Vec<u32>,
    /// The bodies that were bound since the last call of `take_bound`.
    newly_bound: Vec<u32>,
    /// Ticks since the list was made.
    ticks: u32,
    air: Air,
    /// The last kick of the tick was given.
    kicked: bool,
    /// Ticks of the run in which some flew.
    flown: u64,
    /// The upper bound of the way of any point of a flying body in a tick, in metres.
    fastest: f64,
    /// The longest way in a tick at the beginnings and ends of flights, in metres. No way in between is longer.
    longest: f64,
    /// Mass of all flying bodies in kg. Their mass times position, as a polynomial of the time since the list was made.
    weighed: (f64, [DVec2; 3]),
}

impl Flights {
    /// Whether all flights are those of so many bodies.
    pub(super) fn fits(&self, bodies: usize) -> bool {
        let Self { starts, since, bound, newly_bound, ticks, .. } = self;
        let listed = |list: &[u32]| list.iter().all(|body| (*body as usize) < bodies);
        let begun = since.iter().all(|since| *since == BOUND || since <= ticks);
        let bound_ones = since.iter().enumerate().filter(|(_, since)| **since == BOUND).map(|(body, _)| body as u32);
        (starts.is_empty() && since.is_empty() && bound.is_empty() || starts.len() == bodies && since.len() == bodies)
            && begun
            && bound_ones.eq(bound.iter().copied())
            && listed(newly_bound)
            && *ticks < BOUND - 1
    }

    /// Whether some bodies fly.
    #[inline]
    pub fn some(&self) -> bool {
        !self.starts.is_empty()
    }

    /// Whether this one does.
    #[inline]
    fn has(&self, body: usize) -> bool {
        self.since.get(body).is_some_and(|since| *since != BOUND)
    }

    /// Seconds of a flight so far.
    #[inline]
    fn elapsed(&self, body: usize) -> f64 {
        f64::from(self.ticks - self.since[body]) * self.air.dt
    }

    /// The settings that remain after all bodies have landed.
    pub fn ended(&self) -> Self {
        let Self { allowed, longest, kicked, flown, .. } = *self;
        Self { allowed, longest, kicked, flown, worth_trying: true, ..Self::default() }
    }

    /// Ticks since some began to fly.
    #[inline]
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Ticks of the run in which some flew.
    pub fn flown(&self) -> u64 {
        self.flown
    }

    /// The bodies that were bound since the last call.
    pub fn take_bound(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.newly_bound)
    }

    fn at(&self, body: usize, spin: f64) -> Aloft<f64> {
        self.air.after(self.starts[body].0, self.elapsed(body), spin)
    }

    /// The contribution of a body to mass times position, as a polynomial of time.
    fn moment(&self, body: usize, mass: f64) -> [DVec2; 3] {
        let [x, y, _, _, u, v, ..] = self.starts[body].0;
        let (place, velocity) = (DVec2::new(x, y), DVec2::new(u, v));
        let (begun, half) = (f64::from(self.since[body]) * self.air.dt, self.air.field * 0.5);
        let place = place - velocity * begun + half * (begun * begun);
        [place * mass, (velocity - self.air.field * begun) * mass, half * mass]
    }
}

/// The data of a flying body that a contact needs; see [`Bodies::displacement`].
pub(crate) struct Passing {
    pub position: DVec2,
    /// Displacement in the last tick.
    pub moved: DVec2,
    /// Turn in the last tick.
    pub turn: f64,
    /// As forces are to see it.
    pub velocity: DVec2,
}

impl Bodies {
    /// The number of bodies that are in free flight and need no work for that, see `flight.rs`.
    pub fn flying(&self) -> usize {
        self.flights.starts.len() - self.flights.bound.len()
    }

    /// Sets whether bodies may fly from here on. If they may not, all land.
    pub(crate) fn allow_flights(&mut self, allowed: bool) {
        if !allowed {
            self.end_flights();
        } else if !self.flights.allowed {
            self.flights.worth_trying = true;
        }
        self.flights.allowed = allowed;
    }

    /// A flying body, as contacts of an evaluation see it. `None` if it is bound.
    #[inline]
    pub(crate) fn passing(&self, body: usize) -> Option<Passing> {
        if !self.flights.has(body) {
            return None;
        }
        let (spin, dt) = (self.spin[body], self.flights.air.dt);
        let Aloft { position, drifted, velocity, .. } = self.flights.at(body, spin);
        let drifted = DVec2::from(drifted);
        let velocity = if self.estimating { velocity.into() } else { drifted };
        Some(Passing { position: position.into(), moved: drifted * dt, turn: spin * dt, velocity })
    }

    /// Fills in the present place and velocity of a body that flies, or of all. Returns the longest way that a point of them
    /// made in the last tick, in metres.
    fn fill_in(&mut self, body: Option<usize>) -> f64 {
        let starts = std::mem::take(&mut self.flights.starts);
        let since = std::mem::take(&mut self.flights.since);
        let Flights { ticks, air, kicked, .. } = self.flights;
        let mut land = Land { bodies: self, starts: &starts, since: &since, ticks, air, kicked };
        let longest = match body {
            Some(body) => land.some::<f64>(body),
            None => land.all(),
        };
        (self.flights.starts, self.flights.since) = (starts, since);
        self.flights.longest = self.flights.longest.max(longest);
        longest
    }

    /// Fills in the positions of all bodies for a reader. Flights continue independently of it. Returns the longest way
    /// of a flying body in a tick, in metres.
    pub(crate) fn land(&mut self) -> f64 {
        if self.flights.some() {
            self.fill_in(None);
        }
        self.flights.longest
    }

    /// Binds all bodies, after others have moved the landed bodies.
    pub(crate) fn forget_flights(&mut self) {
        if self.flights.some() {
            self.flights = self.flights.ended();
        }
    }

    /// Lands and binds all bodies.
    pub(crate) fn end_flights(&mut self) {
        if self.flights.some() {
            self.land();
            self.flights = self.flights.ended();
        }
    }

    /// Ends all flights for the moment; afterwards new ones are tried at once.
    pub(crate) fn put_off_flights(&mut self) {
        self.end_flights();
        self.flights.worth_trying = self.flights.allowed;
    }

    /// From this evaluation on a body is moved tick by tick. Its forces so far are its weight, like those of all flying
    /// bodies.
    pub(crate) fn bind(&mut self, body: usize) {
        if !self.flights.has(body) {
            return;
        }
        self.fill_in(Some(body));
        let moment = self.flights.moment(body, self.mass[body]);
        let flights = &mut self.flights;
        flights.weighed.0 -= self.mass[body];
        flights.weighed.1.iter_mut().zip(moment).for_each(|(sum, moment)| *sum -= moment);
        flights.since[body] = BOUND;
        let index = flights.bound.partition_point(|&bound| (bound as usize) < body);
        flights.bound.insert(index, body as u32);
        flights.newly_bound.push(body as u32);
    }

    /// After new lists, flights are tried again if enough bodies can fly. The number of touching pairs decides, because
    /// a disc touches at most six others of its size.
    pub(crate) fn try_flights(&mut self, touching: usize) {
        self.flights.worth_trying = self.flights.allowed && MOST_BOUND * touching / 3 < self.len();
    }

    /// Whether some bodies fly or may take off.
    #[inline]
    pub(crate) fn may_fly(&self) -> bool {
        let Flights { allowed, worth_trying, .. } = self.flights;
        self.flights.some() || allowed && worth_trying && self.lone_discs && self.all_dynamic && self.len() > FEWEST
    }

    /// At the end of a tick of `dt` seconds, after all forces: bodies under their weight alone take off. Those in
    /// `touching`, which is in order, stay bound.
    pub(crate) fn take_off(&mut self, touching: &[u32], dt: f64) {
        let flights = &self.flights;
        let field = self.field.unwrap_or(DVec2::ZERO);
        let mut touching = touching.iter().peekable();
        let mut is_free = |body: usize| {
            while touching.next_if(|other| (**other as usize) < body).is_some() {}
            let touches = touching.peek().is_some_and(|other| **other as usize == body);
            !touches && self.force[body] == DVec2::ZERO + field * self.mass[body] && self.torque[body] == 0.0
        };
        let mut free: Vec<u32> = Vec::new();
        if flights.some() {
            free.extend(flights.bound.iter().copied().filter(|&body| is_free(body as usize)));
        } else {
            free.extend((0..self.len()).filter(|&body| is_free(body)).map(|body| body as u32));
            self.flights.worth_trying = false;
            if free.len() < MOST_BOUND * (self.len() - free.len()) + FEWEST {
                return;
            }
            self.begin_flights(field, dt);
        }
        for &body in &free {
            self.begin_flight(body as usize);
        }
        let Flights { bound, since, .. } = &mut self.flights;
        bound.retain(|&body| since[body as usize] == BOUND);
        if bound.len() * MOST_BOUND > self.len() || self.flights.fastest > self.smallest_radius {
            self.end_flights();
            self.flights.worth_trying = false;
        }
    }

    fn begin_flights(&mut self, field: DVec2, dt: f64) {
        let bodies = self.len();
        let Flights { allowed, longest, flown, .. } = self.flights;
        self.flights = Flights {
            allowed,
            longest,
            flown,
            starts: vec![Record::default(); bodies],
            since: vec![BOUND; bodies],
            bound: (0..bodies as u32).collect(),
            air: Air { field, dt },
            ..Flights::default()
        };
    }

    fn begin_flight(&mut self, body: usize) {
        let drifted = if self.estimating { self.estimated_velocity[body] } else { self.velocity[body] };
        let flights = &mut self.flights;
        let Air { field, dt } = flights.air;
        flights.since[body] = flights.ticks;
        flights.starts[body] = Start {
            position: self.position[body],
            position_residual: self.position_residual[body],
            // Includes the kick that ends the tick.
            velocity: drifted + field * (0.5 * dt),
            angle: self.angle[body],
            angle_residual: self.angle_residual[body],
        }
        .record();
        let moment = flights.moment(body, self.mass[body]);
        flights.weighed.0 += self.mass[body];
        flights.weighed.1.iter_mut().zip(moment).for_each(|(sum, moment)| *sum += moment);
        let next = (drifted + field * dt).length() + self.spin[body].abs() * self.atom_radius[body];
        flights.longest = flights.longest.max(next * dt);
        flights.fastest = flights.fastest.max(next * dt);
    }

    /// Adds a tick to all flying bodies before a drift of `dt` seconds, if they assume this tick.
    pub(super) fn fly(&mut self, dt: f64) {
        if !self.flights.some() {
            return;
        }
        if dt != self.flights.air.dt || self.flights.ticks == MOST_TICKS {
            return self.end_flights();
        }
        let flights = &mut self.flights;
        flights.ticks += 1;
        flights.flown += 1;
        flights.kicked = false;
        // The field may make each faster by as much.
        flights.fastest += flights.air.field.length() * dt * dt;
    }

    /// Adds the ways of flying bodies, and their mass and moment.
    pub(super) fn add_flights(&mut self, travel: &mut Travel, weighed: &mut (f64, DVec2)) {
        travel.greatest = travel.greatest.max(std::mem::take(&mut self.flights.longest));
        if self.flights.some() {
            let (mass, [place, velocity, acceleration]) = self.flights.weighed;
            let time = f64::from(self.flights.ticks) * self.flights.air.dt;
            weighed.0 += mass;
            weighed.1 += place + velocity * time + acceleration * (time * time);
        }
    }

    /// The upper bound of the ways in a tick, if `bound` is that of bound bodies.
    pub(super) fn farthest_way(&self, bound: f64) -> f64 {
        bound.max(self.flights.fastest)
    }

    /// Does `work` for the bound bodies alone, if some bodies fly. Returns whether it did.
    pub(super) fn each_bound<W: PerBody>(&mut self, work: &mut W) -> bool {
        let some = self.flights.some();
        if some {
            let bound = std::mem::take(&mut self.flights.bound);
            self.each_of(&bound, work);
            self.flights.bound = bound;
        }
        some
    }

    /// The last kick of a tick is given.
    pub(super) fn note_kick(&mut self) {
        self.flights.kicked = true;
    }
}

/// Ticks of a flight at the most: they are counted in so many bits.
const MOST_TICKS: u32 = 1 << 30;
/// The inverse of the share of bodies that may be bound. With more it is faster to move all bodies, many side by side.
const MOST_BOUND: usize = 4;
/// Bodies with fewer of which nothing is gained.
const FEWEST: usize = 64;
