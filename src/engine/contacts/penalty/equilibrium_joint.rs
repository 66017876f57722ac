//! The row of a joint in the search for equilibrium ([`super::equilibrium_search`]). It is a stiff spring with a force of its own. After
//! each round that force takes over what the spring bears. So the gap of the joint vanishes, and the force remains (method of
//! multipliers: Hestenes 1969, Powell 1969).

use super::equilibrium_part::{NOISE, OF_BOUND};
use crate::constraints::islands::IslandLink;
use crate::constraints::spring_network::{NetworkEnd, NetworkSpring, Twist};
use crate::constraints::{Row, RowKind, RowSide};
use crate::world::Bodies;

/// The spring of a row is stiffer than the contacts of its bodies by this factor. Each round reduces gaps by about as much: rounding is
/// reached in twenty. A greater one leaves more rounding in the forces.
const STIFFER: f64 = 8.0;

/// A row of a joint.
pub(super) struct JointRow {
    /// The index among all rows of joints.
    index: usize,
    row: Row,
    stiffness: f64,
    /// The force in N or torque in N m against its gap.
    pull: f64,
    /// The way of a row that holds no place, in metres or rad.
    way: f64,
}

impl IslandLink for JointRow {
    fn other_body(&self) -> Option<usize> {
        self.row.sides[1].and(self.row.sides[0]).map(|side| side.body)
    }

    fn own_body(&self) -> usize {
        self.row.sides[1].or(self.row.sides[0]).map_or(0, |side| side.body)
    }
}

impl JointRow {
    /// The rows of all joints that hold a body.
    pub fn all(rows: &[Row]) -> Vec<Self> {
        let held = rows.iter().enumerate().filter(|(_, row)| row.sides.iter().any(Option::is_some));
        held.map(|(index, row)| Self { index, row: *row, stiffness: 0.0, pull: 0.0, way: 0.0 }).collect()
    }

    /// The bodies that it holds.
    pub fn bodies(&self) -> impl Iterator<Item = usize> {
        self.row.sides.into_iter().flatten().map(|side| side.body)
    }

    /// Whether it holds bodies that stand, by forces along its own directions.
    pub fn stands(&self, bodies: &Bodies) -> bool {
        let sides = || self.row.sides.iter().flatten();
        let still =
            sides().all(|side| bodies.velocity[side.body] == glam::DVec2::ZERO && bodies.spin[side.body] == 0.0);
        let along = sides().all(|side| side.force == side.direction && side.torque == side.lever);
        still && along && self.row.rate == 0.0 && !self.row.grounded
    }

    /// Takes its stiffness. `stiffest`: the greatest sum in N/m of the contacts of a body. They resist a turn at the size of the body.
    pub fn stiffen(&mut self, stiffest: f64, bodies: &Bodies) {
        let size = |side: &RowSide| {
            let extent = bodies.extent(side.body);
            side.direction.length_squared() + if extent > 0.0 { (side.lever / extent).powi(2) } else { 0.0 }
        };
        let greatest = self.row.sides.iter().flatten().map(size).fold(f64::MIN_POSITIVE, f64::max);
        self.stiffness = STIFFER * stiffest / greatest;
    }

    /// Takes up the present places, and the force of its spring there. `None`: the joints have other rows than at the start.
    pub fn look(&mut self, rows: &[Row]) -> Option<()> {
        self.row = *rows.get(self.index)?;
        self.pull += self.stiffness * self.gap();
        Some(())
    }

    fn gap(&self) -> f64 {
        if self.row.kind == RowKind::Position { self.row.gap } else { self.way }
    }

    /// Whether its gap is rounding.
    pub fn is_closed(&self) -> bool {
        self.row.kind != RowKind::Position || self.row.gap.abs() <= NOISE * self.row.size
    }

    /// Whether it can give its force: within its bound, and by a push if it only pushes.
    pub fn bears(&self) -> bool {
        self.pull.abs() <= OF_BOUND * self.row.bound && self.row.pushes * self.pull <= 0.0
    }

    /// Its spring among the members of an island.
    pub fn spring(&self, index: impl Fn(usize) -> Option<usize>) -> NetworkSpring {
        let ends = self.row.sides.map(|side| {
            let side = side?;
            let row = Twist { linear: side.direction, angular: side.lever };
            Some(NetworkEnd { body: index(side.body)?, row })
        });
        NetworkSpring { ends, stiffness: self.stiffness }
    }

    /// Adds its force to those on the members.
    pub fn push(&self, spring: &NetworkSpring, forces: &mut [Twist]) {
        add(spring, -self.pull, forces);
    }

    /// Adds the force by which the next round closes its gap.
    pub fn close(&self, spring: &NetworkSpring, forces: &mut [Twist]) {
        add(spring, -self.stiffness * self.gap(), forces);
    }

    /// The force on a body of so many metres and its rounding, in newtons.
    pub fn size(&self, end: &NetworkEnd, extent: f64) -> (f64, f64) {
        let factor = end.row.linear.length() + end.row.angular.abs() / extent;
        (factor * self.pull.abs(), factor * self.stiffness * NOISE * self.row.size)
    }

    /// Takes up displacements of the bodies.
    pub fn stretch(&mut self, spring: &NetworkSpring, by: &[Twist]) {
        self.way += spring.elongation(by);
    }
}

fn add(spring: &NetworkSpring, force: f64, forces: &mut [Twist]) {
    for end in spring.ends.iter().flatten() {
        forces[end.body] = forces[end.body].plus(end.row, force);
    }
}
