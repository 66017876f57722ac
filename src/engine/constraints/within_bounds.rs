//! Forces within all bounds of contacts that hold bodies together, if there are any.
//!
//! Forces that balance the same loads differ by a combination of few directions. The nearest of them to the springs' within all bounds is
//! the answer of a small quadratic program. The dual method of active sets solves it, and tells if there is none. Source: Goldfarb and
//! Idnani 1983, "A numerically stable dual method for solving strictly convex quadratic programs".

use super::cones::{AtBound, Bound, Cone, ConePressure};
use super::row::RowKind;
use super::{Row, Rows, Share};
use crate::world::Bodies;

/// The directions of more rows take too long to find: each needs a solution of all rows.
const MOST_ROWS: usize = 24;

/// A direction of which less than this remains beside others is one of theirs. Dependent rows leave 1e-10.
const NOTHING_NEW: f64 = 1e-6;

/// A share of the measure of a bound that counts as rounding.
const ROUNDING: f64 = 1e-11;

/// A bound `normal . y <= room` on the shares `y` of the directions.
struct Limit {
    normal: Vec<f64>,
    room: f64,
    gives: AtBound,
}

impl Rows {
    /// Other forces may balance the same loads as `forces` do, within all bounds. These are the rows that give their bounds in the nearest
    /// of them. `None` if there are no such forces, or too many rows to tell.
    pub(super) fn bounds_of_nearest(&self, forces: &[f64], bodies: &Bodies) -> Option<Vec<AtBound>> {
        if self.len() > MOST_ROWS {
            return None;
        }
        let directions = self.directions(bodies);
        let along = |row: usize| directions.iter().map(|direction| direction[row]).collect::<Vec<f64>>();
        let mut limits = Vec::new();
        for (index, row) in self.all().iter().enumerate() {
            let measure = row.share.measure;
            let mut limit = |normal: Vec<f64>, room: f64, bound: Bound| {
                let normal = normal.iter().map(|part| part / measure).collect();
                limits.push(Limit { normal, room: room / measure, gives: AtBound { row: index, bound } });
            };
            if let Some((least, greatest)) = row.band {
                limit(along(index), greatest - forces[index], Bound::Band(greatest));
                let below = along(index).iter().map(|part| -part).collect();
                limit(below, forces[index] - least, Bound::Band(least));
            }
            if let Some(cone @ Cone { coefficient, pressure }) = row.cone {
                let (of_pressure, pressure) = match pressure {
                    ConePressure::Row(row) => (along(row), forces[row]),
                    ConePressure::Force(force) => (vec![0.0; directions.len()], force),
                };
                for sign in [1.0, -1.0] {
                    let own = along(index);
                    let normal = own.iter().zip(&of_pressure).map(|(own, of)| sign * own - coefficient * of).collect();
                    limit(normal, coefficient * pressure - sign * forces[index], Bound::Cone(sign, cone));
                }
            }
        }
        let active = nearest(&limits, directions.len())?;
        Some(active.into_iter().map(|(index, _)| limits[index].gives).collect())
    }

    /// The directions in which forces may change without any change of motion. They are of length one and at right angles, if each force
    /// is measured by its share.
    fn directions(&self, bodies: &Bodies) -> Vec<Vec<f64>> {
        let is_contact = |row: &Row| row.kind == RowKind::Acceleration;
        let product = |one: &[f64], other: &[f64]| -> f64 {
            let rows = self.all().iter().enumerate().filter(|(_, row)| is_contact(row));
            rows.map(|(index, row)| one[index] * other[index] / (row.share.measure * row.share.measure)).sum()
        };
        let mut directions: Vec<Vec<f64>> = Vec::new();
        for drawn in (0..self.len()).filter(|&index| is_contact(self.row(index))) {
            let mut rows = Self::default();
            for (index, row) in self.all().iter().enumerate() {
                let natural = if index == drawn { row.share.measure } else { 0.0 };
                rows.add(Row { share: Share { natural, ..row.share }, ..*row });
            }
            rows.solve_beside(bodies, |row| -row.acceleration(bodies));
            let mut direction: Vec<f64> = (0..self.len()).map(|index| rows.force(index)).collect();
            // Twice, for rounding.
            for other in directions.iter().chain(&directions) {
                let along = product(&direction, other);
                direction.iter_mut().zip(other).for_each(|(part, other)| *part -= along * other);
            }
            let length = product(&direction, &direction).sqrt();
            if length > NOTHING_NEW {
                direction.iter_mut().for_each(|part| *part /= length);
                directions.push(direction);
            }
        }
        directions
    }
}

/// The limits that bind the shortest vector within all limits, and the forces with which they do. `None` if there is none.
fn nearest(limits: &[Limit], size: usize) -> Option<Vec<(usize, f64)>> {
    let mut shares = vec![0.0; size];
    let mut active: Vec<(usize, f64)> = Vec::new();
    // Each turn adds a limit, or takes one away that a farther one has replaced.
    for _ in 0..8 * limits.len() {
        let room = |limit: &Limit| limit.room - dot(&limit.normal, &shares);
        let open = |index: &usize| active.iter().all(|(other, _)| other != index);
        let worst = (0..limits.len()).filter(open).min_by(|a, b| room(&limits[*a]).total_cmp(&room(&limits[*b])));
        let Some(next) = worst.filter(|&index| room(&limits[index]) < -ROUNDING) else {
            return Some(active);
        };
        let mut pressed = 0.0;
        loop {
            let (rest, parts) = apart(limits, &active, &limits[next].normal);
            let slope = dot(&rest, &limits[next].normal);
            let blocks = |(place, part): (usize, &f64)| (*part > 0.0).then(|| (place, active[place].1 / part));
            let first = parts.iter().enumerate().filter_map(blocks).min_by(|a, b| a.1.total_cmp(&b.1));
            let whole = (slope > NOTHING_NEW * NOTHING_NEW)
                .then(|| (dot(&limits[next].normal, &shares) - limits[next].room) / slope);
            let (step, dropped) = match (whole, first) {
                (None, None) => return None,
                (Some(whole), Some((place, part))) if part < whole => (part, Some(place)),
                (Some(whole), _) => (whole, None),
                (None, Some((place, part))) => (part, Some(place)),
            };
            if whole.is_some() {
                shares.iter_mut().zip(&rest).for_each(|(share, along)| *share -= step * along);
            }
            active.iter_mut().zip(&parts).for_each(|((_, force), part)| *force -= step * part);
            pressed += step;
            match dropped {
                Some(place) => active.remove(place),
                None => break,
            };
        }
        active.push((next, pressed));
    }
    None
}

/// The part of a normal at right angles to those of the active limits, and their shares in the rest.
fn apart(limits: &[Limit], active: &[(usize, f64)], normal: &[f64]) -> (Vec<f64>, Vec<f64>) {
    // Directions at right angles, and each one in terms of the active normals.
    let mut bases: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let reduced = |normal: &[f64], bases: &[(Vec<f64>, Vec<f64>)]| {
        let (mut rest, mut parts) = (normal.to_vec(), vec![0.0; active.len()]);
        for (base, of) in bases.iter().chain(bases) {
            let along = dot(&rest, base);
            rest.iter_mut().zip(base).for_each(|(rest, base)| *rest -= along * base);
            parts.iter_mut().zip(of).for_each(|(part, of)| *part += along * of);
        }
        (rest, parts)
    };
    for (place, (index, _)) in active.iter().enumerate() {
        let (mut rest, parts) = reduced(&limits[*index].normal, &bases);
        let length = dot(&rest, &rest).sqrt();
        let mut of: Vec<f64> = parts.iter().map(|part| -part / length).collect();
        of[place] += 1.0 / length;
        rest.iter_mut().for_each(|part| *part /= length);
        bases.push((rest, of));
    }
    reduced(normal, &bases)
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn limits(numbers: &[f64], size: usize, room: impl Fn(&[f64], usize) -> f64) -> Vec<Limit> {
        let gives = |row: usize| AtBound { row, bound: Bound::Band(0.0) };
        let normals = numbers.chunks_exact(size).map(<[f64]>::to_vec).enumerate();
        normals.map(|(row, normal)| Limit { room: room(&normal, row), normal, gives: gives(row) }).collect()
    }

    proptest! {
        /// Law: the nearest point of a convex set is in it. It is a sum of normals of limits that bind. All their forces have one sign
        /// (Karush, Kuhn and Tucker). The set holds a point here, so there is a nearest one.
        #[test]
        fn the_limits_that_bind_push_the_nearest_point(
            numbers in prop::collection::vec(-1.0..1.0f64, 3 * 12),
            inside in prop::collection::vec(-1.0..1.0f64, 3),
            rooms in prop::collection::vec(0.0..0.5f64, 12),
        ) {
            let limits = limits(&numbers, 3, |normal, row| dot(normal, &inside) + rooms[row]);
            let active = nearest(&limits, 3).expect("a set that is not empty");
            let pushed = |axis: usize| active.iter().map(|(row, force)| force * limits[*row].normal[axis]).sum::<f64>();
            let point: Vec<f64> = (0..3).map(|axis| -pushed(axis)).collect();
            for (row, force) in active {
                prop_assert!(force > -1e-9 && (dot(&limits[row].normal, &point) - limits[row].room).abs() < 1e-9);
            }
            for limit in &limits {
                prop_assert!(dot(&limit.normal, &point) <= limit.room + 1e-9);
            }
        }

        /// Law: limits whose normals cancel with positive forces, and whose rooms sum to less than nothing, exclude each other.
        #[test]
        fn limits_that_exclude_each_other_have_no_point(
            numbers in prop::collection::vec(-1.0..1.0f64, 3 * 3),
            lack in 0.01..1.0f64,
        ) {
            let mut numbers = numbers;
            let sum: Vec<f64> = (0..3).map(|axis| -(0..3).map(|row| numbers[3 * row + axis]).sum::<f64>()).collect();
            numbers.extend(sum);
            let limits = limits(&numbers, 3, |_, row| if row == 3 { -lack } else { 0.0 });
            prop_assert!(nearest(&limits, 3).is_none());
        }
    }
}
