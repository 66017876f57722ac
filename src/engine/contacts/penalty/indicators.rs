//! Event indicators: each is positive while a mode of a contact lasts. Its rate bounds its roots between two
//! evaluations.

use super::contact::Contact;
use super::coulomb::{self, Grip, Slider, SliderLaw};
use super::normal::{Change, Mode, NormalForce};
use super::pair_law::PairLaw;
use super::rolling_stages;
use super::switching::{View, What};
use crate::constraints::DEPENDENT;
use crate::contacts::geometry::{PairGeometry, Shares};
use crate::tick::{Bend, Indicator};
use crate::world::Bodies;

/// The weight of a turn of the line of centres against a swing. A body that passes another one turns it by half a turn.
const TURNS: f64 = 4.0;

/// A rate that is not known.
const UNKNOWN: f64 = f64::NAN;

/// The normal force of a contact: its value in N, and its first two rates per second. The second neglects changes of
/// other forces on both sides.
#[derive(Clone, Copy)]
pub(super) struct Pressure {
    pub force: f64,
    /// The error in N that rounding of places makes.
    noise: f64,
    pub rate: f64,
    pub second_rate: f64,
    /// The square of the angular frequency with which it swings, in 1/s2.
    pub swings: f64,
    /// The acceleration in m/s2 by the force alone.
    acceleration: f64,
    /// That by a force which is all rounding. Zero for a force beyond it.
    unknown_acceleration: f64,
}

impl Pressure {
    /// Of a contact that touches. A force that is held follows from all others, and its rates are not known.
    fn of<N: NormalForce>(
        contact: &Contact,
        law: &PairLaw,
        geometry: &PairGeometry,
        bodies: &Bodies,
        change: Change,
    ) -> Self {
        let force = contact.normal_force;
        if contact.mode == Mode::Hold {
            let (rate, second_rate) = (UNKNOWN, UNKNOWN);
            let (noise, acceleration, unknown_acceleration) = (0.0, 0.0, 0.0);
            return Self { force, noise, rate, second_rate, swings: 0.0, acceleration, unknown_acceleration };
        }
        let approach = geometry.approach(bodies);
        let (stiffness, damping) = N::response(law, approach.mobility);
        let damped = damping * approach.mobility;
        let noise = geometry.pair.noise(law, bodies);
        Self {
            force,
            noise,
            rate: N::force_rate(law, contact.mode, approach, change),
            second_rate: N::force_second_rate(law, contact.mode, approach, change),
            swings: stiffness * approach.mobility + damped * damped,
            acceleration: approach.mobility * force.abs(),
            unknown_acceleration: geometry.unknown_acceleration(law, approach.mobility, bodies),
        }
    }

    /// Whether the sides neither part nor approach by the forces on them. Rows that hold other contacts of a body hold this one
    /// still at an end of its band. Joints hold sides that just meet. The sign of the velocity that rounding leaves ends no
    /// mode.
    fn rests(&self, change: Change) -> bool {
        change.parting.abs() <= (DEPENDENT * self.acceleration).max(self.unknown_acceleration)
    }
}

impl View<'_> {
    /// Indicators of the present modes.
    pub fn tell<N: NormalForce>(&mut self, told: &mut Vec<Indicator>) {
        let mut what = std::mem::take(&mut self.contacts.told);
        what.clear();
        for index in 0..self.len() {
            let geometry = self.look(index);
            let bodies = self.bodies;
            let (contact, law, roller) = self.whole(index, &geometry);
            if contact.mode == Mode::Open {
                what.push((index as u32, What::Touch));
                let bend = geometry.bend(bodies);
                // Sides that a joint leads along each other meet by rounding alone.
                let rounding = geometry.pair.rounding(bodies);
                told.push(Indicator { rounding, ..Indicator::new(-geometry.overlap, geometry.parting(), bend) });
                continue;
            }
            let change = geometry.change(law, bodies);
            let pressure = Pressure::of::<N>(&contact, law, &geometry, bodies, change);
            let mut say = |event: What, indicator: Indicator| {
                what.push((index as u32, event));
                told.push(indicator);
            };
            // For fast bodies the line of centres turns faster than springs swing.
            let turns = if contact.mode == Mode::Hold { 0.0 } else { TURNS * geometry.turns() };
            let known = |value: f64, slope: f64| {
                let swings = pressure.swings.sqrt().max(turns);
                Indicator { swings, ..Indicator::new(value, slope, Bend::Fitted) }
            };
            if contact.mode == Mode::Hold {
                let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
                // A contact that gives its bound stays held: others hold it, and they tell when that ends.
                let bound = |value: f64| {
                    let gives = value == 0.0 && contact.normal_force > 0.0;
                    if gives { Indicator::lasting(contact.normal_force) } else { known(value, UNKNOWN) }
                };
                say(What::Lower, bound(contact.normal_force - least));
                say(What::Upper, bound(greatest - contact.normal_force));
            } else {
                let (value, is_overlap) = N::remaining(contact.mode, contact.overlap, contact.normal_force);
                let (slope, rounding) = if is_overlap {
                    (-geometry.parting(), geometry.pair.rounding(bodies))
                } else {
                    (pressure.rate, 0.0)
                };
                say(What::Part, Indicator { rounding, ..known(value, slope) });
                let loading = N::smooth_force(law, Mode::Loading, geometry.overlap, geometry.approach(bodies));
                if let Some((value, slope)) = N::stays(law, contact.mode, (geometry.parting(), change.parting), loading)
                {
                    let rounding = if N::SET_VALUED && pressure.rests(change) {
                        let overlap = contact.overlap.max(geometry.pair.rounding(bodies));
                        ROUNDING * (geometry.speeds(bodies) + pressure.swings.sqrt() * overlap)
                    } else {
                        0.0
                    };
                    say(What::Turn, Indicator { rounding, ..known(value, slope) });
                }
            }
            if law.tangential().acts() {
                tell_friction(&contact, law, pressure, &geometry, bodies, &mut say);
            }
            if let Some(roller) = roller {
                rolling_stages::tell(&roller, &contact, pressure, &geometry, bodies, say);
            }
            drop(contact);
            self.tell_borders(index, &mut what, told);
        }
        self.contacts.told = what;
    }
}

/// The end of the current mode of friction, and its indicators.
fn tell_friction(
    contact: &Contact,
    law: &PairLaw,
    pressure: Pressure,
    geometry: &PairGeometry,
    bodies: &Bodies,
    say: &mut impl FnMut(What, Indicator),
) {
    let slider = &contact.tangential;
    let motion = SliderMotion::along(geometry, law.shares(), bodies);
    tell_slider((slider, &law.tangential()), contact.mode, pressure, motion, |event, indicator| {
        say(
            match event {
                PhaseEnd::Gives(positive) => What::Give(positive),
                PhaseEnd::Stops => What::Stop,
            },
            indicator,
        );
    });
}

/// The relative motion of the ends of a spring with a Coulomb limit. It has a velocity, its rate, the speeds whose
/// difference it is, and the rate per unit of force.
#[derive(Clone, Copy)]
pub(super) struct SliderMotion {
    pub velocity: f64,
    pub rate: f64,
    pub speed: f64,
    pub mobility: f64,
}

impl SliderMotion {
    /// Along the surfaces of two sides.
    pub fn along(geometry: &PairGeometry, shares: Shares, bodies: &Bodies) -> Self {
        Self {
            velocity: geometry.sliding(shares),
            rate: geometry.sliding_rate(shares, bodies),
            speed: geometry.speed(shares),
            mobility: geometry.mobility_along(shares, bodies),
        }
    }

    /// The turn of one side on the other.
    pub fn of_turning(geometry: &PairGeometry, bodies: &Bodies) -> Self {
        Self {
            velocity: geometry.turning(),
            rate: geometry.turning_rate(bodies),
            speed: geometry.turning_speed(),
            mobility: geometry.mobility_of_turning(bodies),
        }
    }

    /// Whether the velocity is rounding of the speeds whose difference it is. An event is located less exactly than to their last
    /// digit.
    pub fn is_still(&self) -> bool {
        self.velocity.abs() <= coulomb::ROUNDING * self.speed
    }
}

/// How a spring with a Coulomb limit ends its phase.
#[derive(Clone, Copy)]
pub(super) enum PhaseEnd {
    /// It gives way with a force of this sign.
    Gives(bool),
    Stops,
}

/// A share of a velocity or force that counts as rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The end of the current phase of a spring with a Coulomb limit, and its indicators.
pub(super) fn tell_slider(
    (slider, law): (&Slider, &SliderLaw),
    mode: Mode,
    pressure: Pressure,
    motion: SliderMotion,
    mut say: impl FnMut(PhaseEnd, Indicator),
) {
    let (sign, rounding) = (slider.held.signum(), ROUNDING * motion.speed);
    // The amplitude of the second rate in a swing with this angular frequency.
    let stiffness = if slider.grip == Grip::Stick { law.stiffness } else { 0.0 };
    let squared = pressure.swings + stiffness * motion.mobility;
    // The rates of a force that rows hold are unknown.
    let bend = |slope: f64, second_rate: f64| {
        let bend = (second_rate * second_rate + squared * slope * slope).sqrt();
        if bend.is_finite() { Bend::AtMost(bend) } else { Bend::Fitted }
    };
    match slider.grip {
        // A slack contact has no friction that could begin to hold. The number of indicators of a mode does not change.
        Grip::Slip | Grip::Slide if mode != Mode::Hold && pressure.force == 0.0 && pressure.rate == 0.0 => {
            say(PhaseEnd::Stops, Indicator::new(1.0, 0.0, Bend::AtMost(0.0)));
        }
        Grip::Slip | Grip::Slide => {
            // Only a spring that slips follows the limit.
            let held = slider.grip == Grip::Slide;
            let follows = if held { 0.0 } else { law.friction_dynamic.copysign(sign) / law.stiffness };
            let (rate, second) = if held { (0.0, 0.0) } else { (pressure.rate, pressure.second_rate) };
            let (slip, slope) = (motion.velocity - follows * rate, motion.rate - follows * second);
            let (value, bend) = (sign * slip, bend(slope, squared * slip));
            say(PhaseEnd::Stops, Indicator { rounding, ..Indicator::new(value, sign * slope, bend) });
        }
        grip => {
            // At rest along the normal friction too may be any force within its cone once the sides stop.
            if grip == Grip::Stick && mode == Mode::Hold {
                let value = sign * motion.velocity;
                say(PhaseEnd::Stops, Indicator { rounding, ..Indicator::of_value(value, Bend::Fitted) });
            }
            let (known, swings) = if grip == Grip::Hold { (UNKNOWN, 0.0) } else { (law.stiffness, squared.sqrt()) };
            // A spring stretches below the last digit of places, where an overlap grows in jumps.
            let noise = if grip == Grip::Stick { law.friction_static * pressure.noise } else { 0.0 };
            let force = [slider.force(law), known * motion.velocity, known * motion.rate];
            let limit = [pressure.force, pressure.rate, pressure.second_rate].map(|rate| law.friction_static * rate);
            for (positive, sign) in [(true, -1.0), (false, 1.0)] {
                let [value, slope, second_rate] = [0, 1, 2].map(|rate| limit[rate] + sign * force[rate]);
                let bend = bend(slope, second_rate);
                // A contact that gives its bound does not slip: others hold it, and they tell when that ends.
                if grip == Grip::Hold && value == 0.0 {
                    say(PhaseEnd::Gives(positive), Indicator::lasting(limit[0]));
                    continue;
                }
                // A spring that stopped has the force of the cone, and at first the same rate.
                let rounding = ROUNDING * (force[0].abs() + limit[0].abs()) + noise;
                say(PhaseEnd::Gives(positive), Indicator { rounding, swings, ..Indicator::new(value, slope, bend) });
            }
        }
    }
}
