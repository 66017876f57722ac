//! Rows that do not hold what they ought to, because others contradict them. Two wheels whose motors hold one rate each cannot both
//! roll without slip on a bent line. The equations have no solution then, and the forces satisfy some of them only.

use super::cones::{DEPENDENT, HOLDS};
use super::rows::Rows;
use super::structure::islands;
use crate::world::Bodies;

impl Rows {
    /// The indices of bodies that rows link with a row that accelerates all the same, in increasing order. It follows
    /// [`Rows::solve`], and the bodies have the forces of all rows. Loads cancel whose accelerations are as large as `cancelled`, in
    /// m/s2 or rad/s2.
    pub fn contradicted(&self, bodies: &Bodies, cancelled: f64) -> Vec<usize> {
        let own = |index: usize| (self.row(index).response(self.row(index), bodies) * self.force(index)).abs();
        // An acceleration far below those of all forces and loads is rounding, also where its own forces cancel.
        let least = DEPENDENT * (0..self.len()).map(own).fold(cancelled, f64::max);
        let moves = |index: &usize| {
            let row = self.row(*index);
            let acceleration = row.acceleration(bodies).abs();
            let far = acceleration > least && !self.gives_its_bound(*index);
            far && acceleration > HOLDS * (self.pulls(row, bodies) + row.inertial.abs())
        };
        let movable = |index: usize| {
            let sides = self.row(index).sides.iter().flatten().map(|side| side.body);
            sides.filter(|body| bodies.dynamic[*body])
        };
        let moving: Vec<usize> = (0..self.len()).filter(moves).collect();
        if moving.is_empty() {
            return Vec::new();
        }
        let islands = islands(self.all(), bodies);
        let moved = islands.iter().filter(|island| moving.iter().any(|row| island.binary_search(row).is_ok()));
        let mut reached: Vec<usize> = moved.flatten().flat_map(|row| movable(*row)).collect();
        reached.sort_unstable();
        reached.dedup();
        reached
    }
}
