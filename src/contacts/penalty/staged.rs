//! Contacts as one stage of a step: forces as a function of the state, in modes that stay as they are.
//!
//! What follows a contact from state to state elsewhere (the elongation of its springs) is part of the state here, and
//! its losses are powers that the method integrates. Normal forces go on smoothly where the mode would end (a contact
//! pulls beyond its end), because a trial step may overshoot an event before it is located.

use glam::DVec2;

use super::apply::{End, PenaltyContacts, Sink, approach, arms};
use super::case::{Case, Other};
use super::contact::Contact;
use super::coulomb::Grip;
use super::held::{Held, Kind};
use super::law::PairLaw;
use super::normal::{Approach, Change, Mode, NormalForce};
use super::rolling::RollingContacts;
use super::rolling_stages::{self, Roller};
use crate::constraints::Rows;
use crate::contacts::{AtomPair, CandidatePairs, WallPair};
use crate::tick::Style;
use crate::world::Bodies;

/// Where and how the two sides of a candidate pair stand and move.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub case: Case,
    /// Overlap in metres; negative: the gap.
    pub overlap: f64,
    /// Distance of the centres in metres; infinite for a wall.
    pub distance: f64,
    /// Velocity of the centre of side B seen from that of side A, or from the surface of the wall, in m/s.
    pub velocity: DVec2,
    /// Spins of side A and side B times their radii given way, for the velocity along the surface; see [`Look::sliding`].
    spins: (f64, f64),
}

impl Look {
    pub fn atoms(bodies: &Bodies, place: usize, pair: AtomPair) -> Self {
        let (AtomPair { a, b }, reach) = (pair, pair.reach(bodies));
        let between = bodies.atom_place(b as usize) - bodies.atom_place(a as usize);
        let distance = between.length();
        let normal = if distance > 0.0 { between / distance } else { DVec2::Y };
        let (a, b) = (End::of(bodies, a), End::of(bodies, b));
        Self {
            overlap: reach - distance,
            distance,
            velocity: b.velocity(bodies) - a.velocity(bodies),
            spins: (bodies.spin[a.body], bodies.spin[b.body]),
            case: Case { place: place as u32, normal, other: Other::Atom(a), end: b },
        }
    }

    pub fn wall(bodies: &Bodies, place: usize, WallPair { wall, atom }: WallPair) -> Self {
        let (packed, end) = (bodies.walls[wall as usize], End::of(bodies, atom));
        let height = (bodies.atom_place(atom as usize) - packed.point).dot(packed.normal);
        let belt = bodies.belts.get(wall as usize).copied().unwrap_or(DVec2::ZERO);
        Self {
            overlap: end.radius - height,
            distance: f64::INFINITY,
            velocity: end.velocity(bodies) - belt,
            spins: (0.0, bodies.spin[end.body]),
            case: Case { place: place as u32, normal: packed.normal, other: Other::Wall(wall), end },
        }
    }

    /// Velocity in m/s with which the sides part.
    pub fn parting(&self) -> f64 {
        self.velocity.dot(self.case.normal)
    }

    /// Velocity in m/s of side B along the surface of side A.
    pub fn sliding(&self, law: &PairLaw) -> f64 {
        let (radius_a, radius_b) = self.radii(law);
        self.velocity.dot(self.case.normal.perp()) - self.spins.0 * radius_a - self.spins.1 * radius_b
    }

    /// The speeds in m/s of which [`Look::sliding`] is a difference.
    pub fn speed(&self, law: &PairLaw) -> f64 {
        let (radius_a, radius_b) = self.radii(law);
        self.velocity.length() + (self.spins.0 * radius_a).abs() + (self.spins.1 * radius_b).abs()
    }

    /// Spin of side B seen from side A, in rad/s.
    pub fn turning(&self) -> f64 {
        self.spins.1 - self.spins.0
    }

    /// The spins in rad/s of which [`Look::turning`] is a difference.
    pub fn turning_speed(&self) -> f64 {
        self.spins.1.abs() + self.spins.0.abs()
    }

    /// Distances of the centres from where the sides touch, in metres.
    fn radii(&self, law: &PairLaw) -> (f64, f64) {
        let radius_a = self.case.other_end().map_or(0.0, |a| a.radius - law.share_a * self.overlap);
        (radius_a, self.case.end.radius - law.share_b * self.overlap)
    }

    /// What the relative accelerations along normal and tangent would be if no force acted: the frame of the contact turns
    /// and its lever arms change.
    pub fn inertial(&self, law: &PairLaw, bodies: &Bodies) -> (f64, f64) {
        let own = |end: &End| {
            let (acceleration, turning) = bodies.prescribed.acceleration(end.body);
            end.arm * -(bodies.spin[end.body] * bodies.spin[end.body]) + acceleration + end.arm.perp() * turning
        };
        let spinning = |end: Option<&End>| end.map_or(0.0, |end| bodies.prescribed.acceleration(end.body).1);
        let free = own(&self.case.end) - self.case.other_end().map_or(DVec2::ZERO, own);
        let (radius_a, radius_b) = self.radii(law);
        let rolling = spinning(self.case.other_end()) * radius_a + spinning(Some(&self.case.end)) * radius_b;
        let tangent = self.case.normal.perp();
        let (along, parting) = (self.velocity.dot(tangent), self.parting());
        let turning = along / self.distance;
        let giving_way = law.share_a * self.spins.0 + law.share_b * self.spins.1;
        (
            free.dot(self.case.normal) + along * turning,
            free.dot(tangent) - parting * turning - giving_way * parting - rolling,
        )
    }

    /// Arms of both sides to where they touch.
    pub fn contact_arms(&self, law: &PairLaw) -> (DVec2, DVec2) {
        match &self.case.other {
            Other::Atom(a) => arms((a, &self.case.end), self.case.normal, self.overlap, law),
            Other::Wall(_) => {
                (DVec2::ZERO, self.case.end.arm - self.case.normal * (self.case.end.radius - self.overlap))
            }
        }
    }

    /// How [`Look::approach`] changes under the present forces.
    pub fn change(&self, law: &PairLaw, bodies: &Bodies) -> Change {
        let normal = self.case.normal;
        let swing = normal.perp() * (self.velocity.dot(normal.perp()) / self.distance);
        let mobility = |end: &End| {
            let (lever, spin) = (end.arm.perp_dot(normal), bodies.spin[end.body]);
            let rate = spin * end.arm.perp().perp_dot(normal) + end.arm.perp_dot(swing);
            2.0 * lever * rate * bodies.inverse_inertia(end.body)
        };
        Change {
            parting: self.parting_rate(law, bodies),
            mobility: mobility(&self.case.end) + self.case.other_end().map_or(0.0, mobility),
        }
    }

    /// The rate of [`Look::parting`] under the present forces, in m/s2.
    pub fn parting_rate(&self, law: &PairLaw, bodies: &Bodies) -> f64 {
        let acceleration = |end: &End| {
            bodies.force[end.body] * bodies.inverse_mass(end.body)
                + end.arm.perp() * (bodies.torque[end.body] * bodies.inverse_inertia(end.body))
        };
        let other = self.case.other_end().map_or(DVec2::ZERO, acceleration);
        (acceleration(&self.case.end) - other).dot(self.case.normal) + self.inertial(law, bodies).0
    }

    /// The rate of [`Look::sliding`] under the present forces, in m/s2.
    pub fn sliding_rate(&self, law: &PairLaw, bodies: &Bodies) -> f64 {
        let (arm_a, arm_b) = self.contact_arms(law);
        let acceleration = |body: usize, arm: DVec2| {
            bodies.force[body] * bodies.inverse_mass(body)
                + arm.perp() * (bodies.torque[body] * bodies.inverse_inertia(body))
        };
        let other = self.case.other_body().map_or(DVec2::ZERO, |body| acceleration(body, arm_a));
        let apart = acceleration(self.case.end.body, arm_b) - other;
        apart.dot(self.case.normal.perp()) + self.inertial(law, bodies).1
    }

    /// The acceleration along the surface that one newton along it makes, in 1/kg.
    pub fn mobility_along(&self, law: &PairLaw, bodies: &Bodies) -> f64 {
        let (arm_a, arm_b) = self.contact_arms(law);
        let tangent = self.case.normal.perp();
        let own = |body: usize, arm: DVec2| {
            let lever = arm.perp_dot(tangent);
            bodies.inverse_mass(body) + lever * lever * bodies.inverse_inertia(body)
        };
        own(self.case.end.body, arm_b) + self.case.other_body().map_or(0.0, |body| own(body, arm_a))
    }

    /// The angular acceleration of one side seen from the other that one newton metre between them makes, in 1/(kg m2).
    pub fn mobility_of_turning(&self, bodies: &Bodies) -> f64 {
        let other = self.case.other_body().map_or(0.0, |body| bodies.inverse_inertia(body));
        bodies.inverse_inertia(self.case.end.body) + other
    }

    /// The rate of [`Look::turning`] under the present forces, in rad/s2.
    pub fn turning_rate(&self, bodies: &Bodies) -> f64 {
        let own =
            |body: usize| bodies.torque[body] * bodies.inverse_inertia(body) + bodies.prescribed.acceleration(body).1;
        own(self.case.end.body) - self.case.other_body().map_or(0.0, own)
    }

    /// The greatest acceleration in m/s2 that one side may have seen from the other: the distance of two centres bends no more
    /// than that, as all else lets it bend outwards.
    pub fn bend(&self, bodies: &Bodies) -> f64 {
        let acceleration = |end: &End| {
            let body = end.body;
            let (led, turned) = bodies.prescribed.acceleration(body);
            let turning = bodies.torque[body] * bodies.inverse_inertia(body) + turned;
            bodies.force[body] * bodies.inverse_mass(body) + led + end.arm.perp() * turning
                - end.arm * (bodies.spin[body] * bodies.spin[body])
        };
        (acceleration(&self.case.end) - self.case.other_end().map_or(DVec2::ZERO, acceleration)).length()
    }

    pub fn approach(&self, bodies: &Bodies) -> Approach {
        approach(bodies, self.case.other_end(), &self.case.end, self.case.normal)
    }
}

/// Evaluates all contacts of a state. Those that are held give rows.
pub(super) fn evaluate<N: NormalForce>(
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
    pairs: &CandidatePairs,
    style: Style,
    (sink, rows): (&mut Sink, &mut Rows),
) {
    let PenaltyContacts { laws, atoms, walls, held, .. } = contacts;
    held.begin(rows);
    for (place, &pair) in pairs.atoms.iter().enumerate() {
        if style == Style::Instant || atoms.is_touching(place) {
            let look = Look::atoms(sink.bodies, place, pair);
            let mut contact = atoms.edit(place);
            let law = laws.get(contact.law);
            let roller = rolling.as_deref_mut().map(|rolling| rolling.of(&look, law));
            stage::<N>((&mut contact, law, roller), &look, style, sink, (held, rows));
        }
    }
    for (place, &pair) in pairs.walls.iter().enumerate() {
        if style == Style::Instant || walls.is_touching(place) {
            let look = Look::wall(sink.bodies, place, pair);
            let mut contact = walls.edit(place);
            let law = laws.get(contact.law);
            let roller = rolling.as_deref_mut().map(|rolling| rolling.of(&look, law));
            stage::<N>((&mut contact, law, roller), &look, style, sink, (held, rows));
        }
    }
}

/// Held contacts take the forces that were found for them.
pub(super) fn take_rows(
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
    rows: &Rows,
    sink: &mut Sink,
) {
    let PenaltyContacts { laws, atoms, walls, held, .. } = contacts;
    for (look, kind, force) in held.answers(rows) {
        let list = if look.case.other_end().is_some() { &mut *atoms } else { &mut *walls };
        let mut contact = list.edit(look.case.place as usize);
        let law = laws.get(contact.law);
        let roller = rolling.as_deref_mut().map(|rolling| rolling.of(look, law));
        let (normal, tangent_force) = match (kind, roller) {
            (Kind::Rolling, roller) => {
                if let Some((slider, rolling_law)) = roller {
                    slider.held = -force;
                    rolling_stages::push(slider, &rolling_law, look, sink);
                }
                continue;
            }
            (Kind::Tangent, _) => {
                contact.tangential.held = -force;
                (None, -force)
            }
            (Kind::Normal, roller) => {
                contact.normal_force = force;
                if let Some((slider, rolling_law)) = roller
                    && slider.grip == Grip::Slide
                {
                    rolling_stages::slip(slider, &rolling_law, force);
                    rolling_stages::push(slider, &rolling_law, look, sink);
                }
                let sliding = contact.tangential.grip == Grip::Slide;
                if sliding {
                    contact.slide(law, force);
                }
                (Some(force), if sliding { contact.tangential.held } else { 0.0 })
            }
        };
        let push = look.case.normal * normal.unwrap_or(0.0) - look.case.normal.perp() * tangent_force;
        look.case.push(sink, law, look.overlap, push);
        book(&contact, law, look, sink, normal, tangent_force);
    }
}

/// Evaluates one contact.
fn stage<N: NormalForce>(
    (contact, law, roller): (&mut Contact, &PairLaw, Option<Roller>),
    look: &Look,
    style: Style,
    sink: &mut Sink,
    (held, rows): (&mut Held, &mut Rows),
) {
    let approach = look.approach(sink.bodies);
    if style == Style::Instant {
        contact.adapt::<N>(law, look, approach);
        if contact.mode == Mode::Open {
            return;
        }
    }
    contact.overlap = look.overlap;
    let normal_held = contact.mode == Mode::Hold;
    if !normal_held {
        contact.normal_force = N::smooth_force(law, contact.mode, look.overlap, approach);
    }
    if contact.tangential.grip == Grip::Slide && !normal_held {
        contact.slide(law, contact.normal_force);
    }
    let acts = law.tangential().acts();
    let tangent_held = acts && contact.tangential.grip == Grip::Hold;
    let tangent_waits = !acts || tangent_held || (normal_held && contact.tangential.grip == Grip::Slide);
    let normal = (!normal_held).then_some(contact.normal_force);
    let tangential = if tangent_waits { 0.0 } else { contact.tangential_force(law) };
    if normal_held {
        let slope = if contact.tangential.grip == Grip::Slide {
            law.friction_dynamic.copysign(contact.tangential.held)
        } else {
            0.0
        };
        let twist = roller.as_ref().map_or(0.0, |roller| rolling_stages::slope(roller, contact));
        held.add_normal(rows, look, law, (slope, twist), sink.bodies);
    }
    if tangent_held {
        held.add_tangent(rows, look, law, contact, sink.bodies);
    }
    if normal.is_some() || tangential != 0.0 {
        let push = look.case.normal * normal.unwrap_or(0.0) - look.case.normal.perp() * tangential;
        look.case.push(sink, law, look.overlap, push);
        book(contact, law, look, sink, normal, tangential);
    }
    if let Some(roller) = roller {
        rolling_stages::stage(roller, (contact, law), look, sink, (held, rows));
    }
}

/// Books the powers of a contact force, in two parts if need be: what the force takes from the bodies and the springs do not
/// take up is lost. The spring of the elastic part takes up `k d` whatever the force is, booked with the normal force. A
/// spring that slips takes up or gives what its energy says at the end of a step ([`super::switching`]).
fn book(contact: &Contact, law: &PairLaw, look: &Look, sink: &mut Sink, normal: Option<f64>, tangential: f64) {
    // Without a force too, where a contact has gone slack: the spring gives up what it has.
    if let Some(normal) = normal {
        sink.balance.inelasticity -= look.parting() * (normal - law.stiffness * look.overlap);
    }
    if tangential != 0.0 && contact.tangential.grip == Grip::Slide {
        sink.balance.friction += tangential * look.sliding(law);
    }
}
