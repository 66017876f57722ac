//! Bodies in free flight: nothing touches them, so their motion is known until something does.
//!
//! Velocity Verlet moves a body on which nothing but its weight acts along the parabola itself: `k` ticks of `dt` seconds after
//! `(x, v)` its place is `x + v k dt + g (k dt)²/2` and its velocity `v + g k dt`, with no error but rounding (the method is exact
//! where the acceleration does not change). So such a body is not moved tick by tick: it is where that says, and who needs
//! to know works it out. Candidate pairs tell when somebody may have come near; a body that touches something is *bound*, moved
//! tick by tick, until it flies again.
//!
//! Where somebody looks at all bodies ([`Bodies::land`]) their places are filled in, and flights go on from where they began:
//! what is looked at does not change by that. Bodies are lone discs, all of them dynamic; the models of a scene say whether they
//! can do with that (`Census::of_flights`).

use glam::DVec2;

use super::aloft::{Air, Aloft, Land, Start};
use super::motion::Travel;
use super::packed::Bodies;
use super::part::PerBody;
use jostle_simd::Record;
use serde::{Deserialize, Serialize};

/// For bodies that are bound, in place of the tick in which they took off.
pub(super) const BOUND: u32 = u32::MAX;

/// Who flies, and since when.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Flights {
    /// Whether the method and the models of the run know that bodies may fly.
    allowed: bool,
    /// Bodies have landed since it was last tried whether many can fly.
    worth_trying: bool,
    /// For each body its flight; empty while none flies.
    starts: Vec<Record>,
    /// For each body the tick in which it took off, or [`BOUND`].
    since: Vec<u32>,
    /// The bodies that do not fly, in order.
    bound: Vec<u32>,
    /// Those that were bound since somebody asked.
    newly_bound: Vec<u32>,
    /// Ticks since the list was made.
    ticks: u32,
    air: Air,
    /// The last kick of the tick was given.
    kicked: bool,
    /// Ticks of the run in which some flew.
    flown: u64,
    /// No point of a body that flies goes farther in a tick, in metres.
    fastest: f64,
    /// The longest way in a tick that was seen where flights begin and end: none in between is longer. In metres.
    longest: f64,
    /// Mass of all that fly in kg, and mass times place as a polynomial of the time since the list was made.
    weighed: (f64, [DVec2; 3]),
}

impl Flights {
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

    /// What is left when all have landed.
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

    /// The bodies that were bound since somebody asked.
    pub fn take_bound(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.newly_bound)
    }

    fn at(&self, body: usize, spin: f64) -> Aloft<f64> {
        self.air.after(self.starts[body].0, self.elapsed(body), spin)
    }

    /// What a body adds to mass times place, as a polynomial of time.
    fn moment(&self, body: usize, mass: f64) -> [DVec2; 3] {
        let [x, y, _, _, u, v, ..] = self.starts[body].0;
        let (place, velocity) = (DVec2::new(x, y), DVec2::new(u, v));
        let (begun, half) = (f64::from(self.since[body]) * self.air.dt, self.air.field * 0.5);
        let place = place - velocity * begun + half * (begun * begun);
        [place * mass, (velocity - self.air.field * begun) * mass, half * mass]
    }
}

/// What a contact needs to know of a body that flies; see [`Bodies::displacement`].
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
    /// How many bodies are in free flight and need no work for that, see `flight.rs`.
    pub fn flying(&self) -> usize {
        self.flights.starts.len() - self.flights.bound.len()
    }

    /// Says whether bodies may fly from now on. Where they may not, all land.
    pub(crate) fn allow_flights(&mut self, allowed: bool) {
        if !allowed {
            self.end_flights();
        } else if !self.flights.allowed {
            self.flights.worth_trying = true;
        }
        self.flights.allowed = allowed;
    }

    /// A body that flies, as contacts of an evaluation see it. `None`: it is bound.
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

    /// Fills in where all bodies are, for somebody who looks at them. Those that fly go on as if nobody had looked. Returns the
    /// longest way of one of these in a tick, in metres.
    pub(crate) fn land(&mut self) -> f64 {
        if self.flights.some() {
            self.fill_in(None);
        }
        self.flights.longest
    }

    /// All bodies are bound from now on, where others have put them after they had landed.
    pub(crate) fn forget_flights(&mut self) {
        if self.flights.some() {
            self.flights = self.flights.ended();
        }
    }

    /// All bodies are bound from now on.
    pub(crate) fn end_flights(&mut self) {
        if self.flights.some() {
            self.land();
            self.flights = self.flights.ended();
        }
    }

    /// Nobody flies for the present; afterwards it is tried at once.
    pub(crate) fn put_off_flights(&mut self) {
        self.end_flights();
        self.flights.worth_trying = self.flights.allowed;
    }

    /// A body is moved tick by tick from this evaluation on. Its forces are its weight so far, as those of all bodies that fly.
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
        let place = flights.bound.partition_point(|&bound| (bound as usize) < body);
        flights.bound.insert(place, body as u32);
        flights.newly_bound.push(body as u32);
    }

    /// With new lists it is tried again whether many can fly, unless so many pairs touch that they cannot: a disc touches six others
    /// of its size at most.
    pub(crate) fn try_flights(&mut self, touching: usize) {
        self.flights.worth_trying = self.flights.allowed && MOST_BOUND * touching / 3 < self.len();
    }

    /// Whether some bodies fly or may take off.
    #[inline]
    pub(crate) fn may_fly(&self) -> bool {
        let Flights { allowed, worth_trying, .. } = self.flights;
        self.flights.some() || allowed && worth_trying && self.lone_discs && self.all_dynamic && self.len() > FEWEST
    }

    /// After all forces of an evaluation at the end of a tick of `dt` seconds: bodies on which nothing but their weight acts take
    /// off, but for those that touch something, which are given in order.
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
            position_rest: self.position_rest[body],
            // With the kick that ends the tick.
            velocity: drifted + field * (0.5 * dt),
            angle: self.angle[body],
            angle_rest: self.angle_rest[body],
        }
        .record();
        let moment = flights.moment(body, self.mass[body]);
        flights.weighed.0 += self.mass[body];
        flights.weighed.1.iter_mut().zip(moment).for_each(|(sum, moment)| *sum += moment);
        let next = (drifted + field * dt).length() + self.spin[body].abs() * self.atom_radius[body];
        flights.longest = flights.longest.max(next * dt);
        flights.fastest = flights.fastest.max(next * dt);
    }

    /// Before a drift of `dt` seconds: one more tick for all that fly, as long as it is one of those that they know.
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

    /// Adds how far those went that fly, and what they weigh.
    pub(super) fn add_flights(&mut self, travel: &mut Travel, weighed: &mut (f64, DVec2)) {
        travel.greatest = travel.greatest.max(std::mem::take(&mut self.flights.longest));
        if self.flights.some() {
            let (mass, [place, velocity, acceleration]) = self.flights.weighed;
            let time = f64::from(self.flights.ticks) * self.flights.air.dt;
            weighed.0 += mass;
            weighed.1 += place + velocity * time + acceleration * (time * time);
        }
    }

    /// How far bodies can have gone in a tick in which those that are bound went so far at most.
    pub(super) fn farthest_way(&self, bound: f64) -> f64 {
        bound.max(self.flights.fastest)
    }

    /// Does `work` for the bodies that are bound, if some are not. Says whether it did.
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
/// A part of the bodies that may be bound, as its inverse: with more it costs less to move all, many side by side.
const MOST_BOUND: usize = 4;
/// Bodies with fewer of which nothing is gained.
const FEWEST: usize = 64;
