//! Held contacts as rows of [`crate::constraints`]: along the normal, along the surface, and against rolling.

use glam::DVec2;

use super::contact::Contact;
use super::pair_law::PairLaw;
use crate::constraints::islands::IslandLink;
use crate::constraints::{Cone, ConePressure, LostTo, Row, RowSide, Rows, Share};
use crate::contacts::geometry::PairGeometry;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The part of a contact that a row holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum HeldPart {
    Normal,
    Tangent,
    Rolling,
}

/// Two contacts of the same bodies hold one line if one lies nearly in the surface of the other. Their distance across it is less than
/// this share of that along it.
///
/// Their sides turn against each other by that angle, which is the difference of overlaps over their distance. Both slide by half its
/// square then. Forces that keep this from being would be as much greater than loads as the angle is small.
const ONE_LINE: f64 = 1e-2;

/// The contacts of the rows of an evaluation, in the same order.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Held {
    /// The index of the first row.
    first: usize,
    contacts: Vec<(PairGeometry, HeldPart)>,
}

impl std::fmt::Debug for Held {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Held({})", self.contacts.len())
    }
}

impl Held {
    /// Whether each has its row, and all contacts and bodies are among so many.
    pub fn fits(&self, rows: usize, contacts: usize, bodies: usize) -> bool {
        let one = |geometry: &PairGeometry| (geometry.pair.index as usize) < contacts && geometry.pair.b.body < bodies;
        (self.contacts.is_empty() || self.first.checked_add(self.contacts.len()).is_some_and(|end| end <= rows))
            && self
                .contacts
                .iter()
                .all(|(geometry, _)| one(geometry) && geometry.pair.other_body().is_none_or(|body| body < bodies))
    }

    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    pub fn clear(&mut self) {
        self.contacts.clear();
    }

    /// The contacts of an evaluation follow.
    pub fn begin(&mut self, rows: &Rows) {
        self.first = rows.len();
        self.contacts.clear();
    }

    /// The contact of each row, the held part, and the force in newtons or torque in N m. Both act on side B of the contact.
    pub fn answers<'a>(&'a self, rows: &'a Rows) -> impl Iterator<Item = (&'a PairGeometry, HeldPart, f64)> + 'a {
        let indices = self.first..;
        self.contacts.iter().zip(indices).map(|((geometry, kind), index)| (geometry, *kind, rows.force(index)))
    }

    /// Holds the normal of a contact, with a force within `band`. While the contact slips, its tangential force is `slope` times the
    /// normal one. While its rolling spring slips, its torque is `twist` times the normal force.
    pub fn add_normal(
        &mut self,
        rows: &mut Rows,
        geometry: &PairGeometry,
        law: &PairLaw,
        (slope, twist, band): (f64, f64, Option<(f64, f64)>),
        bodies: &Bodies,
    ) {
        let normal = geometry.pair.normal;
        let force = normal - normal.perp() * slope;
        let natural = law.stiffness * geometry.overlap;
        let share = Share { natural, measure: natural.max(f64::MIN_POSITIVE) };
        let mut row = row(
            geometry,
            law,
            (normal, force),
            geometry.inertial(law.shares(), bodies).0,
            share,
            LostTo::Inelasticity,
            bodies,
        );
        row.pushes = 1.0;
        row.band = band;
        let [a, b] = &mut row.sides;
        for (side, sign) in [(a, 1.0), (b, -1.0)] {
            side.iter_mut().for_each(|side| side.torque += sign * twist);
        }
        rows.add(row);
        self.contacts.push((*geometry, HeldPart::Normal));
    }

    /// Holds the tangent of a contact.
    pub fn add_tangent(
        &mut self,
        rows: &mut Rows,
        geometry: &PairGeometry,
        law: &PairLaw,
        contact: &Contact,
        bodies: &Bodies,
    ) {
        let tangent = geometry.pair.normal.perp();
        let measure = (law.friction_static * law.stiffness * geometry.overlap).max(f64::MIN_POSITIVE);
        let share = Share { natural: -law.tangential_stiffness * contact.tangential.elongation, measure };
        let inertial = geometry.inertial(law.shares(), bodies).1;
        let mut row = row(geometry, law, (tangent, tangent), inertial, share, LostTo::Friction, bodies);
        let normal = self.contacts.last().filter(|(before, part)| {
            let same = before.pair.index == geometry.pair.index && before.pair.listed() == geometry.pair.listed();
            same && *part == HeldPart::Normal
        });
        let pressure = match normal {
            Some(_) => ConePressure::Row(rows.len() - 1),
            None => ConePressure::Force(contact.normal_force),
        };
        row.cone = Some(Cone { coefficient: law.friction_static, pressure });
        self.join_line(rows, &mut row, (geometry, law));
        rows.add(row);
        self.contacts.push((*geometry, HeldPart::Tangent));
    }

    /// Lets a tangent hold the line of one before it that all but coincides with its own. Its force acts where it is.
    fn join_line(&self, rows: &Rows, row: &mut Row, (geometry, law): (&PairGeometry, &PairLaw)) {
        let (ends, tangent) = ((geometry.pair.other_body(), Some(geometry.pair.b.body)), geometry.pair.normal.perp());
        let own = geometry.contact_arms(law.shares()).1;
        let one_line = |other: &PairGeometry| {
            let arms = other.contact_arms(law.shares());
            let (arm, along) = match (other.pair.other_body(), Some(other.pair.b.body)) {
                same if same == ends => (arms.1, other.pair.normal.perp()),
                // Its sides are the other way round.
                (b, a) if (a, b) == ends => (arms.0, -other.pair.normal.perp()),
                _ => return false,
            };
            let (way, angle) = (arm - own, tangent.perp_dot(along).abs());
            let across = way.dot(geometry.pair.normal).abs().max(angle * way.length());
            tangent.dot(along) > 0.0 && across <= ONE_LINE * way.length()
        };
        let mut before = self.contacts.iter().zip(self.first..).filter(|((_, part), _)| *part == HeldPart::Tangent);
        let Some((_, index)) = before.find(|((other, _), _)| one_line(other)) else { return };
        let first = rows.row(index);
        for side in row.sides.iter_mut().flatten() {
            if let Some(of_first) = first.sides.iter().flatten().find(|of_first| of_first.body == side.body) {
                (side.direction, side.lever) = (of_first.direction, of_first.lever);
            }
        }
        (row.inertial, row.surface) = (first.inertial, first.surface);
    }

    /// Holds the turn of a contact.
    pub fn add_rolling(&mut self, rows: &mut Rows, geometry: &PairGeometry, share: Share, bodies: &Bodies) {
        let side = |body: usize, sign: f64| RowSide { body, lever: sign, torque: sign, ..RowSide::default() };
        let sides = [geometry.pair.other_body().map(|body| side(body, -1.0)), Some(side(geometry.pair.b.body, 1.0))];
        let turning = |side: &RowSide| side.lever * bodies.prescribed.acceleration(side.body).1;
        let inertial = sides.iter().flatten().map(turning).fold(0.0, |sum, term| sum + term);
        rows.add(Row { sides, inertial, share, ..Row::default() });
        self.contacts.push((*geometry, HeldPart::Rolling));
    }
}

fn row(
    geometry: &PairGeometry,
    law: &PairLaw,
    (direction, force): (DVec2, DVec2),
    inertial: f64,
    share: Share,
    lost_to: LostTo,
    bodies: &Bodies,
) -> Row {
    let (arm_a, arm_b) = geometry.contact_arms(law.shares());
    let side = |body: usize, arm: DVec2, sign: f64| RowSide {
        body,
        direction: sign * direction,
        lever: sign * arm.perp_dot(direction),
        force: sign * force,
        torque: sign * arm.perp_dot(force),
    };
    let other = geometry.pair.other_body().map(|body| side(body, arm_a, -1.0));
    let sides = [other, Some(side(geometry.pair.b.body, arm_b, 1.0))];
    let surface = geometry.pair.surface(bodies).unwrap_or_default();
    Row { sides, inertial, surface, share, lost_to, ..Row::default() }
}
