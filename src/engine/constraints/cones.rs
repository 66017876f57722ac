//! Several contacts that hold one body together, within the bounds of all of them. Bounds are cones of friction and bands of normal forces.
//!
//! Rows of such contacts depend on each other, so only sums are determined. The forces nearest to the springs may be beyond the
//! bound of one contact and far within that of another. Such a contact gives its bound, and the others bear the rest. The motion
//! is the same. Only if the others cannot bear it does a contact let go. The bound of the last one tells when.

use super::rows::Rows;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The forces of rows that depend on each other are exact to a tenth of this share.
pub const DEPENDENT: f64 = 1e-9;

/// A row that the others hold accelerates by at most this share of all accelerations that cancel there. Dependent rows leave
/// 1e-10, and a row that is free leaves all of it.
pub const HOLDS: f64 = 1e-6;

/// The bound of friction along the surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// The static coefficient.
    pub coefficient: f64,
    /// The force that presses the sides together.
    pub pressure: ConePressure,
}

/// The normal force of a contact with friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum ConePressure {
    /// The force of the row with this index.
    Row(usize),
    /// A known force in newtons.
    Force(f64),
}

/// The bound that a row gives.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    /// That of its cone, with a sign.
    Cone(f64, Cone),
    /// An end of its band, in newtons.
    Band(f64),
}

/// A row that gives its bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtBound {
    pub row: usize,
    pub bound: Bound,
}

impl AtBound {
    /// The row without any force.
    fn without_force(self) -> Self {
        let bound = match self.bound {
            Bound::Cone(sign, cone) => Bound::Cone(sign, Cone { coefficient: 0.0, ..cone }),
            Bound::Band(_) => Bound::Band(0.0),
        };
        Self { bound, ..self }
    }

    /// The share of the force of row `normal` that this row gives, if it is the friction of that.
    fn share_of(&self, normal: usize) -> Option<f64> {
        match self.bound {
            Bound::Cone(sign, Cone { coefficient, pressure: ConePressure::Row(row) }) if row == normal => {
                Some(sign * coefficient)
            }
            _ => None,
        }
    }

    /// The force in newtons beside those of the other rows, as far as these are known.
    fn force(&self, force_of: impl Fn(usize) -> Option<f64>) -> Option<f64> {
        match self.bound {
            Bound::Band(force) => Some(force),
            Bound::Cone(sign, Cone { coefficient, pressure }) => {
                let pressure = match pressure {
                    ConePressure::Row(row) => force_of(row),
                    ConePressure::Force(force) => Some(force),
                };
                pressure.map(|pressure| sign * (coefficient * pressure))
            }
        }
    }
}

impl Rows {
    /// After [`Rows::solve`]: a contact beyond its bounds gives its bound if other rows hold it.
    pub fn stay_in_bounds(&mut self, bodies: &Bodies) {
        let (mut given, mut refused): (Vec<AtBound>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut nearest = Vec::new();
        while let Some(next) = self.farthest_beyond(&given, &refused) {
            if self.is_given_up() {
                return;
            }
            if nearest.is_empty() {
                nearest = (0..self.len()).map(|row| self.force(row)).collect();
            }
            // At its bound it is nearly held anyway. Without any force it tells whether others hold it.
            let probe: Vec<AtBound> = given.iter().copied().chain([next.without_force()]).collect();
            let (_, held) = self.solved_beside(&probe, bodies);
            if held {
                given.push(next);
                let (answer, _) = self.solved_beside(&given, bodies);
                self.set_answer(answer);
            } else {
                refused.push(next.row);
            }
        }
        // One bound after the other may miss the forces that are within all.
        if !refused.is_empty()
            && let Some(given) = self.bounds_of_nearest(&nearest, bodies)
            && let (answer, true) = self.solved_beside(&given, bodies)
        {
            self.set_answer(answer);
        }
    }

    /// The row that exceeds its bound by the greatest factor, among those not looked at yet.
    fn farthest_beyond(&self, given: &[AtBound], refused: &[usize]) -> Option<AtBound> {
        let open = |row: &usize| !refused.contains(row) && given.iter().all(|other| other.row != *row);
        let beyond = (0..self.len()).filter(open).filter_map(|row| {
            let (factor, bound) = self.beyond(row)?;
            Some((factor, AtBound { row, bound }))
        });
        beyond.reduce(|most, next| if next.0 > most.0 { next } else { most }).map(|(_, row)| row)
    }

    /// The factor by which a row exceeds its bound, if it does, and that bound.
    fn beyond(&self, index: usize) -> Option<(f64, Bound)> {
        let (row, force) = (self.row(index), self.force(index));
        if let Some((least, greatest)) = row.band.filter(|band| force < band.0 || force > band.1) {
            let bound = if force < least { least } else { greatest };
            return Some((1.0 + (force - bound).abs() / row.share.measure, Bound::Band(bound)));
        }
        let cone = row.cone?;
        let pressure = match cone.pressure {
            ConePressure::Row(row) => self.force(row),
            ConePressure::Force(force) => force,
        };
        // A stage of a step may lie behind the moment at which a contact is let go. Forces go on smoothly there, and pull.
        let beyond = pressure >= 0.0 && force.abs() > cone.coefficient * pressure;
        beyond.then_some((force.abs() / (cone.coefficient * pressure), Bound::Cone(force.signum(), cone)))
    }

    /// The forces of all rows, of which some give their bounds, and whether the others hold those.
    fn solved_beside(&mut self, given: &[AtBound], bodies: &Bodies) -> (Vec<f64>, bool) {
        let mut others = Self::default();
        let kept: Vec<usize> = (0..self.len()).filter(|row| given.iter().all(|other| other.row != *row)).collect();
        for &index in &kept {
            let mut row = *self.row(index);
            // Friction at its bound follows the normal force.
            for (other, share) in given.iter().filter_map(|other| Some((other, other.share_of(index)?))) {
                for (side, along) in row.sides.iter_mut().zip(&self.row(other.row).sides) {
                    if let (Some(side), Some(along)) = (side, along) {
                        side.force += along.force * share;
                        side.torque += along.torque * share;
                    }
                }
            }
            others.add(row);
        }
        let given_normal = |row: usize| given.iter().find(|other| other.row == row)?.force(|_| None);
        let known: Vec<(usize, f64)> =
            given.iter().filter_map(|other| Some((other.row, other.force(given_normal)?))).collect();
        let beside = |row: &super::Row| -> f64 {
            known.iter().map(|(other, force)| row.response(self.row(*other), bodies) * force).sum()
        };
        others.solve_beside(bodies, beside);
        let holds = |other: &AtBound| {
            let row = self.row(other.row);
            let own = row.acceleration(bodies) + beside(row);
            let terms =
                others.all().iter().enumerate().map(|(index, of)| row.response(of, bodies) * others.force(index));
            let (sum, size) = terms.fold((own, own.abs()), |(sum, size), term| (sum + term, size + term.abs()));
            sum.abs() <= HOLDS * size
        };
        let held = given.iter().all(holds);
        let mut answer = vec![0.0; self.len()];
        kept.iter().enumerate().for_each(|(index, row)| answer[*row] = others.force(index));
        known.iter().for_each(|(row, force)| answer[*row] = *force);
        for other in given {
            answer[other.row] = other.force(|row| Some(answer[row])).unwrap_or_default();
        }
        self.count(others.multiplications());
        (answer, held)
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::RowSide;
    use super::super::{Row, Share};
    use super::*;
    use bevy_ecs::entity::Entity;
    use glam::DVec2;

    /// A block of 1 kg on two corners at x = -1 and 1, its centre at a height of 0.5. It is pressed down with 10 N at `x`, and pulled
    /// with `pull` newtons at the height of the floor. Springs of friction would bear half of the pull each.
    fn block(x: f64, pull: f64) -> (Rows, Bodies) {
        let mut bodies = Bodies {
            entity: vec![Entity::PLACEHOLDER],
            dynamic: vec![true],
            mass: vec![1.0],
            inertia: vec![1.0],
            force: vec![DVec2::new(pull, -10.0)],
            torque: vec![-10.0 * x + 0.5 * pull],
            ..Bodies::default()
        };
        bodies.velocity.push(DVec2::ZERO);
        bodies.spin.push(0.0);
        let mut rows = Rows::default();
        for (index, corner) in [-1.0, 1.0].into_iter().enumerate() {
            let arm = DVec2::new(corner, -0.5);
            for direction in [DVec2::Y, DVec2::X] {
                let torque = arm.perp_dot(direction);
                let side = RowSide { body: 0, direction, lever: torque, force: direction, torque };
                let cone = Cone { coefficient: 0.5, pressure: ConePressure::Row(2 * index) };
                let cone = (direction == DVec2::X).then_some(cone);
                let share = Share { natural: 0.0, measure: 1.0 };
                rows.add(Row { sides: [None, Some(side)], share, cone, ..Row::default() });
            }
        }
        rows.solve(&bodies);
        (rows, bodies)
    }

    /// Law: friction holds as long as the sum of all cones suffices, however the weight lies. The sum of friction is the pull, and no
    /// contact exceeds its cone. Tolerance: rounding.
    #[test]
    fn friction_holds_up_to_the_sum_of_all_cones() {
        for x in [-0.9, -0.3, 0.0, 0.4, 0.8] {
            for pull in [0.5, 2.0, 4.0, 4.9, -4.9] {
                let (mut rows, bodies) = block(x, pull);
                rows.stay_in_bounds(&bodies);
                for corner in [0, 2] {
                    let (normal, friction) = (rows.force(corner), rows.force(corner + 1));
                    assert!(friction.abs() <= 0.5 * normal + 1e-12, "{x}, {pull}: {friction} under {normal}");
                }
                assert!((rows.force(1) + rows.force(3) + pull).abs() < 1e-12, "{x}, {pull}");
                assert!((rows.force(0) + rows.force(2) - 10.0).abs() < 1e-12, "{x}, {pull}");
            }
        }
    }

    /// Law: beyond the sum of all cones the last contact stays beyond its own, by which its event is found.
    #[test]
    fn beyond_the_sum_of_all_cones_one_contact_is_beyond_its_own() {
        for pull in [5.1, 6.0, -7.0] {
            let (mut rows, bodies) = block(0.4, pull);
            rows.stay_in_bounds(&bodies);
            let beyond = |corner: usize| rows.force(corner + 1).abs() > 0.5 * rows.force(corner);
            assert!(beyond(0) || beyond(2), "{pull}");
            assert!((rows.force(1) + rows.force(3) + pull).abs() < 1e-12, "{pull}");
        }
    }
}
