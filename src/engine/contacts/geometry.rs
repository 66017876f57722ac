//! The geometry of a candidate pair: overlap, normal, arms, velocities and their rates. Contact laws compute forces
//! from it.
//!
//! Side B is an atom, or the side of a hull near an end of a wall. Side A is another atom, the side of a hull, or a
//! wall. The normal points from A to B. The overlap is positive for touching sides. The kernel for many discs
//! ([`crate::contacts::penalty`]) computes the same for eight pairs at a time.

use bevy_ecs::entity::Entity;
use glam::DVec2;
use jostle_shapes::{Feature, Hull};

use super::{AtomPair, Probe, Surface, SurfacePair};
use crate::constraints::islands::IslandLink;
use crate::tick::{Bend, Turning};
use crate::world::{Bodies, NearestOnHull, NearestPoint};
use serde::{Deserialize, Serialize};

impl SurfacePair {
    /// The overlap of both sides in metres; negative: the gap.
    pub fn overlap(self, bodies: &Bodies) -> f64 {
        PairGeometry::surface(bodies, 0, self).overlap
    }
}

/// How two sides share their overlap: each gives way by its share, the softer one more. Both shares sum up to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shares {
    pub a: f64,
    pub b: f64,
}

/// One side of a contact: an atom, or the nearest point of a hull's core to the other side.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) struct ContactEnd {
    pub body: usize,
    /// Centre of the atom, or the place on the core, from the centre of mass of its body, in metres.
    pub arm: DVec2,
    /// Radius of the atom or of the hull in metres.
    pub radius: f64,
}

impl ContactEnd {
    /// The place of a hull that is nearest to the other side.
    #[inline(always)]
    fn on_hull(bodies: &Bodies, hull: usize, shape: &Hull, found: &NearestOnHull) -> Self {
        Self { body: bodies.hulls[hull].body as usize, arm: found.foot, radius: shape.radius() }
    }

    /// An atom as a wall sees it, and its centre in metres.
    #[inline]
    pub fn at_wall(bodies: &Bodies, wall: usize, atom: u32) -> (Self, DVec2) {
        let body = bodies.atom_body(atom as usize);
        let (place, radius) = bodies.meeting_wall(&bodies.walls[wall], atom as usize);
        (Self { body, arm: place - bodies.position[body], radius }, place)
    }

    #[inline(always)]
    pub fn of(bodies: &Bodies, atom: u32) -> Self {
        let atom = atom as usize;
        let body = bodies.atom_body(atom);
        Self { body, arm: bodies.atom_place(atom) - bodies.position[body], radius: bodies.atom_radius[atom] }
    }

    /// Relative velocity along `normal` that an impulse of one newton second makes on this side, in 1/kg.
    #[inline]
    pub fn mobility(&self, bodies: &Bodies, normal: DVec2) -> f64 {
        let lever = self.arm.perp_dot(normal);
        bodies.inverse_mass(self.body) + lever * lever * bodies.inverse_inertia(self.body)
    }

    /// Displacement of the atom's centre since the last accepted state, and its body's turn. The displacement is the
    /// chord of its arc, to second order.
    #[inline(always)]
    pub fn displacement(&self, bodies: &Bodies) -> (DVec2, f64) {
        let (moved, turn) = bodies.displacement(self.body);
        (moved + self.arm.perp() * turn + self.arm * (0.5 * turn * turn), turn)
    }

    #[inline]
    pub fn velocity(&self, bodies: &Bodies) -> DVec2 {
        bodies.velocity_at(self.body, self.arm)
    }
}

/// Side A of a pair.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) enum SideA {
    Atom(ContactEnd),
    Hull(ContactEnd),
    /// The index of a wall.
    Wall(u32),
}

/// The list that holds a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Listed {
    Atoms,
    Surfaces,
}

/// The two sides of a candidate pair.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) struct ContactSides {
    /// The index of the pair among those of its kind.
    pub index: u32,
    /// Unit normal from A to B.
    pub normal: DVec2,
    pub a: SideA,
    pub b: ContactEnd,
}

impl IslandLink for ContactSides {
    fn other_body(&self) -> Option<usize> {
        self.other_end().map(|end| end.body)
    }

    fn own_body(&self) -> usize {
        self.b.body
    }
}

impl ContactSides {
    /// The list that holds it.
    pub fn listed(&self) -> Listed {
        if matches!(self.a, SideA::Atom(_)) { Listed::Atoms } else { Listed::Surfaces }
    }

    /// Side A unless it is a wall.
    pub fn other_end(&self) -> Option<&ContactEnd> {
        match &self.a {
            SideA::Atom(end) | SideA::Hull(end) => Some(end),
            SideA::Wall(_) => None,
        }
    }

    /// The entities of both sides.
    pub fn entities(&self, bodies: &Bodies) -> (Entity, Entity) {
        let a = match &self.a {
            SideA::Atom(a) | SideA::Hull(a) => bodies.entity[a.body],
            SideA::Wall(wall) => bodies.walls[*wall as usize].entity,
        };
        (a, bodies.entity[self.b.body])
    }

    /// Arms of both sides to the contact point, in metres.
    pub fn arms(&self, shares: Shares, overlap: f64) -> (DVec2, DVec2) {
        match &self.a {
            SideA::Atom(other) | SideA::Hull(other) => arms((other, &self.b), self.normal, overlap, shares),
            SideA::Wall(_) => (DVec2::ZERO, self.b.arm - self.normal * (self.b.radius - overlap)),
        }
    }

    /// Velocity in m/s of the surface of side A, if that is a moving wall.
    pub fn surface(&self, bodies: &Bodies) -> Option<DVec2> {
        let SideA::Wall(wall) = self.a else { return None };
        bodies.belts.get(wall as usize).copied()
    }
}

/// Arms of both sides to the contact point. It lies between the centres, nearer to the undeformed surface of the harder
/// side.
#[inline]
pub(crate) fn arms((a, b): (&ContactEnd, &ContactEnd), normal: DVec2, overlap: f64, shares: Shares) -> (DVec2, DVec2) {
    (a.arm + normal * (a.radius - shares.a * overlap), b.arm - normal * (b.radius - shares.b * overlap))
}

/// The positions and motions of the two sides of a candidate pair.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) struct PairGeometry {
    /// The sides.
    pub pair: ContactSides,
    /// Overlap in metres; negative: the gap.
    pub overlap: f64,
    /// Distance of the centres in metres; infinite for the flat side of a wall or hull; see [`NearestPoint::distance`].
    pub distance: f64,
    /// For a nearest point on a flat side: the spin of the hull's body and the cores' distance in metres.
    flat: Option<(f64, f64)>,
    /// Velocity in m/s of the centre of side B relative to that of side A, or to the wall's surface.
    pub velocity: DVec2,
    /// Spins of side A and side B times their radii given way, for the velocity along the surface; see [`PairGeometry::sliding`].
    spins: (f64, f64),
}

impl PairGeometry {
    pub fn atoms(bodies: &Bodies, index: usize, pair: AtomPair) -> Self {
        let (AtomPair { a, b }, reach) = (pair, pair.reach(bodies));
        let distance = (bodies.atom_place(b as usize) - bodies.atom_place(a as usize)).length();
        let normal = pair.normal(bodies);
        let (a, b) = (ContactEnd::of(bodies, a), ContactEnd::of(bodies, b));
        Self {
            overlap: reach - distance,
            distance,
            flat: None,
            velocity: b.velocity(bodies) - a.velocity(bodies),
            spins: (bodies.spin[a.body], bodies.spin[b.body]),
            pair: ContactSides { index: index as u32, normal, a: SideA::Atom(a), b },
        }
    }

    pub fn surface(bodies: &Bodies, index: usize, pair: SurfacePair) -> Self {
        Self::near(bodies, index, pair).0
    }

    /// The same, with the distance in metres of the probe from the surface. It is given even if no contact belongs to
    /// that part of its body.
    #[inline(always)]
    pub fn near(bodies: &Bodies, index: usize, pair: SurfacePair) -> (Self, f64) {
        match (pair.surface(bodies), pair.probe(bodies)) {
            (Surface::Wall(wall), _) => {
                let geometry = Self::wall(bodies, index, wall, pair.probe);
                (geometry, -geometry.overlap)
            }
            (Surface::Hull(hull), Probe::Atom(atom)) => Self::hull(bodies, index, (hull, pair.kept()), atom as u32),
            (Surface::Hull(hull), Probe::End(wall, right)) => {
                Self::end(bodies, index, (hull, pair.kept()), (wall, right))
            }
        }
    }

    fn wall(bodies: &Bodies, index: usize, wall: usize, atom: u32) -> Self {
        let (end, place) = ContactEnd::at_wall(bodies, wall, atom);
        let NearestPoint { height, normal, distance } = bodies.nearest_on_wall(wall, atom as usize, place);
        let wall = bodies.whole_wall(wall);
        let belt = bodies.belts.get(wall).copied().unwrap_or(DVec2::ZERO);
        Self {
            overlap: end.radius - height,
            distance,
            flat: None,
            velocity: end.velocity(bodies) - belt,
            spins: (0.0, bodies.spin[end.body]),
            pair: ContactSides { index: index as u32, normal, a: SideA::Wall(wall as u32), b: end },
        }
    }

    #[inline(always)]
    fn hull(bodies: &Bodies, index: usize, (hull, kept): (usize, Option<Feature>), atom: u32) -> (Self, f64) {
        let (shape, place, radius) = bodies.meeting(hull, atom as usize);
        let (found, distance) = bodies.touched_on((hull, kept), shape, place);
        let a = ContactEnd::on_hull(bodies, hull, shape, &found);
        let body = bodies.atom_body(atom as usize);
        let b = ContactEnd { body, arm: place - bodies.position[body], radius };
        let spins = (bodies.spin[a.body], bodies.spin[b.body]);
        let geometry = Self {
            overlap: a.radius + b.radius - found.distance,
            distance: if found.flat { f64::INFINITY } else { found.distance },
            flat: found.flat.then_some((spins.0, found.distance)),
            velocity: b.velocity(bodies) - a.velocity(bodies),
            spins,
            pair: ContactSides { index: index as u32, normal: found.normal, a: SideA::Hull(a), b },
        };
        (geometry, distance - shape.radius() - radius)
    }

    /// An end of a wall near a hull: the hull is side B.
    fn end(
        bodies: &Bodies,
        index: usize,
        (hull, kept): (usize, Option<Feature>),
        (wall, right): (usize, bool),
    ) -> (Self, f64) {
        let (center, radius) = bodies.walls[wall].end(right);
        let shape = &bodies.hulls[hull].hull;
        let (found, distance) = bodies.touched_on((hull, kept), shape, center);
        let b = ContactEnd::on_hull(bodies, hull, shape, &found);
        let spin = bodies.spin[b.body];
        let geometry = Self {
            overlap: radius + b.radius - found.distance,
            distance: if found.flat { f64::INFINITY } else { found.distance },
            flat: found.flat.then_some((spin, found.distance)),
            velocity: b.velocity(bodies),
            spins: (0.0, spin),
            pair: ContactSides {
                index: index as u32,
                normal: -found.normal,
                a: SideA::Wall(bodies.whole_wall(wall) as u32),
                b,
            },
        };
        (geometry, distance - radius - shape.radius())
    }

    /// Whether the nearest place is on a flat side of a hull.
    pub fn is_flat(&self) -> bool {
        self.flat.is_some()
    }

    /// Velocity in m/s with which the sides part.
    pub fn parting(&self) -> f64 {
        self.velocity.dot(self.pair.normal)
    }

    /// The speeds in m/s of which the velocities of the sides at the contact are differences.
    pub fn speeds(&self, bodies: &Bodies) -> f64 {
        let velocity = self.pair.b.velocity(bodies);
        velocity.length() + (velocity - self.velocity).length()
    }

    /// Velocity in m/s of side B along the surface of side A.
    pub fn sliding(&self, shares: Shares) -> f64 {
        let (radius_a, radius_b) = self.radii(shares);
        self.velocity.dot(self.pair.normal.perp()) - self.spins.0 * radius_a - self.spins.1 * radius_b
    }

    /// The speeds in m/s of which [`PairGeometry::sliding`] is a difference.
    pub fn speed(&self, shares: Shares) -> f64 {
        let (radius_a, radius_b) = self.radii(shares);
        self.velocity.length() + (self.spins.0 * radius_a).abs() + (self.spins.1 * radius_b).abs()
    }

    /// Spin of side B seen from side A, in rad/s.
    pub fn turning(&self) -> f64 {
        self.spins.1 - self.spins.0
    }

    /// The spins in rad/s of which [`PairGeometry::turning`] is a difference.
    pub fn turning_speed(&self) -> f64 {
        self.spins.1.abs() + self.spins.0.abs()
    }

    /// Distances of the centres from the contact point, in metres.
    fn radii(&self, shares: Shares) -> (f64, f64) {
        let radius_a = self.pair.other_end().map_or(0.0, |a| a.radius - shares.a * self.overlap);
        (radius_a, self.pair.b.radius - shares.b * self.overlap)
    }

    /// The turn in rad of the normal since the last accepted state, for this relative displacement of side B.
    #[inline]
    pub fn turned(&self, bodies: &Bodies, displacement: DVec2) -> f64 {
        let flat = match (self.flat, &self.pair.a) {
            // In the corner of a line it turns within the overlap, whatever the displacement.
            (None, _) if self.distance < 0.0 => return 0.0,
            (None, _) => return self.pair.normal.perp_dot(displacement) / self.distance,
            (_, SideA::Hull(a)) => a,
            _ => &self.pair.b,
        };
        bodies.displacement(flat.body).1
    }

    /// The rate in rad/s at which the normal turns at most, whatever the direction of the velocity.
    pub fn turns(&self) -> f64 {
        self.velocity.length() / self.distance.abs() + self.flat.map_or(0.0, |(spin, _)| spin.abs())
    }

    /// The rate in rad/s at which the normal turns.
    fn swing(&self) -> f64 {
        self.velocity.dot(self.pair.normal.perp()) / self.distance + self.flat.map_or(0.0, |(spin, _)| spin)
    }

    /// The acceleration in m/s2 along the normal due to the motion of the nearest point along a flat side.
    fn gliding(&self) -> f64 {
        self.flat.map_or(0.0, |(spin, height)| spin * (self.velocity.dot(self.pair.normal.perp()) - spin * height))
    }

    /// The relative accelerations along normal and tangent without any force. They come from the rotation of the
    /// contact's frame and the change of its lever arms.
    pub fn inertial(&self, shares: Shares, bodies: &Bodies) -> (f64, f64) {
        let own = |end: &ContactEnd| {
            let (acceleration, turning) = bodies.prescribed.acceleration(end.body);
            end.arm * -(bodies.spin[end.body] * bodies.spin[end.body]) + acceleration + end.arm.perp() * turning
        };
        let spinning = |end: Option<&ContactEnd>| end.map_or(0.0, |end| bodies.prescribed.acceleration(end.body).1);
        let free = own(&self.pair.b) - self.pair.other_end().map_or(DVec2::ZERO, own);
        let (radius_a, radius_b) = self.radii(shares);
        let rolling = spinning(self.pair.other_end()) * radius_a + spinning(Some(&self.pair.b)) * radius_b;
        let tangent = self.pair.normal.perp();
        let (along, parting) = (self.velocity.dot(tangent), self.parting());
        let turning = self.swing();
        let giving_way = shares.a * self.spins.0 + shares.b * self.spins.1;
        (
            free.dot(self.pair.normal) + along * turning + self.gliding(),
            free.dot(tangent) - parting * turning - giving_way * parting - rolling,
        )
    }

    /// Arms of both sides to the contact point.
    pub fn contact_arms(&self, shares: Shares) -> (DVec2, DVec2) {
        self.pair.arms(shares, self.overlap)
    }

    /// The rate of what [`ContactEnd::mobility`] of both sides sums up to, in 1/(kg s).
    pub fn mobility_rate(&self, bodies: &Bodies) -> f64 {
        let normal = self.pair.normal;
        let swing = normal.perp() * self.swing();
        let (of_a, of_b) = self.glides();
        let mobility = |end: &ContactEnd, glides: f64| {
            let (lever, spin) = (end.arm.perp_dot(normal), bodies.spin[end.body]);
            let rate = spin * end.arm.perp().perp_dot(normal) + end.arm.perp_dot(swing) - glides;
            2.0 * lever * rate * bodies.inverse_inertia(end.body)
        };
        mobility(&self.pair.b, of_b) + self.pair.other_end().map_or(0.0, |a| mobility(a, of_a))
    }

    /// The speeds in m/s of the nearest points on sides A and B along their flat sides.
    fn glides(&self) -> (f64, f64) {
        let Some((spin, height)) = self.flat else { return (0.0, 0.0) };
        let along = self.velocity.dot(self.pair.normal.perp()) - spin * height;
        if matches!(self.pair.a, SideA::Hull(_)) { (along, 0.0) } else { (0.0, -along) }
    }

    /// The rate of [`PairGeometry::parting`] under the present forces, in m/s2.
    pub fn parting_rate(&self, shares: Shares, bodies: &Bodies) -> f64 {
        let acceleration = |end: &ContactEnd| {
            bodies.force[end.body] * bodies.inverse_mass(end.body)
                + end.arm.perp() * (bodies.torque[end.body] * bodies.inverse_inertia(end.body))
        };
        let other = self.pair.other_end().map_or(DVec2::ZERO, acceleration);
        (acceleration(&self.pair.b) - other).dot(self.pair.normal) + self.inertial(shares, bodies).0
    }

    /// The rate of [`PairGeometry::sliding`] under the present forces, in m/s2.
    pub fn sliding_rate(&self, shares: Shares, bodies: &Bodies) -> f64 {
        let (arm_a, arm_b) = self.contact_arms(shares);
        let acceleration = |body: usize, arm: DVec2| {
            bodies.force[body] * bodies.inverse_mass(body)
                + arm.perp() * (bodies.torque[body] * bodies.inverse_inertia(body))
        };
        let other = self.pair.other_body().map_or(DVec2::ZERO, |body| acceleration(body, arm_a));
        let apart = acceleration(self.pair.b.body, arm_b) - other;
        apart.dot(self.pair.normal.perp()) + self.inertial(shares, bodies).1
    }

    /// The acceleration along the surface that one newton along it makes, in 1/kg.
    pub fn mobility_along(&self, shares: Shares, bodies: &Bodies) -> f64 {
        let (arm_a, arm_b) = self.contact_arms(shares);
        let tangent = self.pair.normal.perp();
        let own = |body: usize, arm: DVec2| {
            let lever = arm.perp_dot(tangent);
            bodies.inverse_mass(body) + lever * lever * bodies.inverse_inertia(body)
        };
        own(self.pair.b.body, arm_b) + self.pair.other_body().map_or(0.0, |body| own(body, arm_a))
    }

    /// The relative angular acceleration of both sides by one newton metre between them, in 1/(kg m2).
    pub fn mobility_of_turning(&self, bodies: &Bodies) -> f64 {
        let other = self.pair.other_body().map_or(0.0, |body| bodies.inverse_inertia(body));
        bodies.inverse_inertia(self.pair.b.body) + other
    }

    /// The rate of [`PairGeometry::turning`] under the present forces, in rad/s2.
    pub fn turning_rate(&self, bodies: &Bodies) -> f64 {
        let own =
            |body: usize| bodies.torque[body] * bodies.inverse_inertia(body) + bodies.prescribed.acceleration(body).1;
        own(self.pair.b.body) - self.pair.other_body().map_or(0.0, own)
    }

    /// The greatest possible relative acceleration of both sides. The distance of two centres bends downwards by no more
    /// than that, because all other terms bend it upwards. That from a straight side bends by what lies along the normal,
    /// which turns with the side. Straight are sides of hulls, and walls away from their ends.
    pub fn bend(&self, bodies: &Bodies) -> Bend {
        let turning = |end: &ContactEnd| {
            let free = bodies.torque[end.body] * bodies.inverse_inertia(end.body);
            free + bodies.prescribed.acceleration(end.body).1
        };
        let acceleration = |end: &ContactEnd| {
            let body = end.body;
            bodies.force[body] * bodies.inverse_mass(body)
                + bodies.prescribed.acceleration(body).0
                + end.arm.perp() * turning(end)
                - end.arm * (bodies.spin[body] * bodies.spin[body])
        };
        let (b, a) = (&self.pair.b, self.pair.other_end());
        let apart = acceleration(b) - a.map_or(DVec2::ZERO, acceleration);
        let swings = self.flat.map_or(0.0, |(spin, _)| (spin * self.velocity.dot(self.pair.normal.perp())).abs());
        let turned = swings + self.gliding().abs();
        if self.flat.is_none() && self.distance.is_finite() {
            return Bend::AtMost(apart.length() + turned);
        }
        let sum = |of: &dyn Fn(&ContactEnd) -> f64| of(b).abs() + a.map_or(0.0, |a| of(a).abs());
        Bend::Turning(Turning {
            along: apart.dot(self.pair.normal).abs() + turned,
            across: apart.dot(self.pair.normal.perp()).abs(),
            spin: sum(&|end| bodies.spin[end.body]),
            acceleration: sum(&turning),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;
    use crate::Simulation;
    use crate::contacts::penalty::PenaltyState;
    use crate::scene::Source;

    /// Law: the kernel for eight pairs at a time and this geometry agree to the last bit. That holds for overlaps, and
    /// for normals as the force on each disc shows them. Pairs of discs of many sizes lie in all directions, also far
    /// from the origin, and move. Tolerance: none.
    #[test]
    fn the_kernel_knows_the_same_geometry_to_the_last_bit() {
        let mut bodies = String::new();
        for number in 0..203_i32 {
            let (angle, radius) = (f64::from(number) * 0.7, 0.05 + 0.001 * f64::from(number % 17));
            let (x, y) = (3.7 * f64::from(number % 20), 1e3 * f64::from(number / 100) + 2.9 * f64::from(number / 20));
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let apart = (radius + 0.06) * (0.93 + 0.05 * libm::sin(1.3 * angle));
            for (name, x, y, radius) in [("a", x, y, radius), ("b", x + apart * cos, y + apart * sin, 0.06)] {
                let spin = 0.1 * f64::from(number % 7);
                writeln!(
                    bodies,
                    "(name: \"{name}{number}\", at: ({x}, {y}), velocity: ({sin}, {angle}e-3), spin: {spin}, atoms: Disc(radius: {radius})),"
                )
                .unwrap();
            }
        }
        let text = format!(
            r#"Scene(
                format: 1,
                clock: (duration: 0.01, tick: "10 us", method: VelocityVerlet),
                contacts: Penalty(tangential: None),
                materials: {{"default": (stiffness: 2e4, restitution: 0.6)}},
                bodies: [{bodies}],
            )"#
        );
        let mut simulation =
            Simulation::load(&Source::new("pairs.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut compared = 0;
        for round in 1..=20 {
            simulation.run_to_tick(7 * round).unwrap();
            let state = simulation.state();
            let (contacts, pairs) = (&state.model::<PenaltyState>().unwrap().contacts, state.pairs.as_ref().unwrap());
            let bodies = state.bodies();
            for index in contacts.atoms.touching() {
                let geometry = PairGeometry::atoms(bodies, index, pairs.atoms[index]);
                let contact = contacts.atoms.get(index);
                assert_eq!(contact.overlap.to_bits(), geometry.overlap.to_bits(), "overlap of pair {index}");
                let force = geometry.pair.normal * contact.normal_force;
                assert_eq!(bodies.force[geometry.pair.b.body], force, "force of pair {index}");
                compared += 1;
            }
        }
        assert!(compared > 2000, "only {compared} contacts were compared");
    }
}
