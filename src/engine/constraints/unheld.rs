//! Rows that do not hold what they ought to, because others contradict them. Two wheels whose motors hold one rate each cannot both
//! roll without slip on a bent line. The equations have no solution then, and the forces satisfy some of them only.

use super::cones::{DEPENDENT, HOLDS};
use super::rows::Rows;
use crate::world::Bodies;

impl Rows {
    /// The indices of bodies that rows link with a row that accelerates all the same, in increasing order. It follows
    /// [`Rows::solve`], and the bodies have the forces of all rows.
    pub fn contradicted(&self, bodies: &Bodies) -> Vec<usize> {
        let own = |index: usize| (self.row(index).response(self.row(index), bodies) * self.force(index)).abs();
        // An acceleration far below those of all forces is rounding, also where its own forces cancel.
        let least = DEPENDENT * (0..self.len()).map(own).fold(0.0, f64::max);
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
        let mut reached: Vec<usize> = (0..self.len()).filter(moves).flat_map(movable).collect();
        let mut before = 0;
        while !reached.is_empty() && reached.len() > before {
            reached.sort_unstable();
            reached.dedup();
            before = reached.len();
            for index in 0..self.len() {
                if movable(index).any(|body| reached.contains(&body)) {
                    reached.extend(movable(index).filter(|body| !reached[..before].contains(body)).collect::<Vec<_>>());
                }
            }
        }
        reached
    }
}
