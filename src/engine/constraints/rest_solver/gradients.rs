//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952) over the rows of an island whose bounds are not active.

use glam::DVec2;

use jostle_simd::BLOCK;

use super::ROUNDING;
use super::blocks::{Blocks, Rows};
use super::contact_direction::{Mover, Row, Sides};
use super::joint_row::JointRow;
use super::rest_contact::RestContact;

/// Conjugate gradients reduce the velocities of an island to this share in one tick. A few ticks reach rounding.
const GAIN: f64 = 1e-4;
/// Greatest number of rows times steps, and the least number of steps. An island of a thousand rows is solved within that. In one of
/// a hundred thousand, which would take minutes, each search goes on where the last one ended.
const WORK: usize = 4_000_000;
const FEWEST_STEPS: usize = 32;

/// Conjugate gradients over the forces whose bounds are not active. A force that would leave its bounds stops there, and the
/// sweeps that follow take up the rest.
#[derive(Debug, Default)]
pub(super) struct Gradients {
    rows: Vec<(Row, (usize, usize))>,
    /// The movers without their velocities.
    still: Vec<Mover>,
    moved: Vec<Mover>,
    impulses: Vec<f64>,
    residual: Vec<f64>,
    scaled: Vec<f64>,
    search: Vec<f64>,
    response: Vec<f64>,
}

impl Gradients {
    pub fn finish(
        &mut self,
        (blocks, contact, joint_rows): (&mut Blocks, &[RestContact], &mut [JointRow]),
        movers: &mut [Mover],
        dt: f64,
    ) {
        let Self { rows, still, moved, impulses, residual, scaled, search, response } = self;
        rows.clear();
        for (contact, &index) in contact.iter().zip(&blocks.indices) {
            let all = Rows::of(contact, &Sides::of(movers, contact.ends));
            let free = [all.normal, all.tangent, all.turn].into_iter().zip(free(blocks, index));
            rows.extend(free.filter(|(_, is)| *is).map(|(row, _)| (row, contact.ends)));
        }
        still.clear();
        still.extend(movers.iter().map(|m| Mover { velocity: DVec2::ZERO, spin: 0.0, ..*m }));
        let count = rows.len() + joint_rows.len();
        for list in [&mut *impulses, &mut *response, &mut *scaled] {
            list.clear();
            list.resize(count, 0.0);
        }
        residual.clear();
        residual.extend(rows.iter().map(|(row, ends)| -row.velocity(&Sides::of(movers, *ends))));
        residual.extend(joint_rows.iter().map(|row| row.missing(movers)));
        let mobilities = || rows.iter().map(|(row, _)| row.mobility).chain(joint_rows.iter().map(|row| row.mobility));
        let scale = |scaled: &mut [f64], residual: &[f64]| {
            for ((scaled, residual), mobility) in scaled.iter_mut().zip(residual).zip(mobilities()) {
                *scaled = residual / mobility;
            }
        };
        scale(scaled, residual);
        search.clone_from(scaled);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b);
        let mut size = dot(residual, search);
        let goal = size * GAIN * GAIN;
        let affordable = (WORK / count.max(1)).max(FEWEST_STEPS);
        for _ in 0..affordable.min(4 * count + 10) {
            if size <= goal || size == 0.0 {
                break;
            }
            moved.clone_from(still);
            for ((row, ends), &impulse) in rows.iter().zip(&*search) {
                let mut sides = Sides::of(moved, *ends);
                row.push(&mut sides, impulse);
                sides.put_back(moved, *ends);
            }
            for (row, &impulse) in joint_rows.iter().zip(&search[rows.len()..]) {
                row.push(moved, impulse);
            }
            let (of_rows, of_joints) = response.split_at_mut(rows.len());
            for (response, (row, ends)) in of_rows.iter_mut().zip(&*rows) {
                *response = row.velocity(&Sides::of(moved, *ends));
            }
            for (response, row) in of_joints.iter_mut().zip(&*joint_rows) {
                *response = row.velocity(moved);
            }
            // Rows that say the same leave directions in which nothing moves: to rounding, the search has come to their end.
            let curvature = dot(search, response);
            let natural =
                search.iter().zip(mobilities()).fold(0.0, |sum, (search, mobility)| sum + search * search * mobility);
            if curvature <= ROUNDING * natural {
                break;
            }
            let step = size / curvature;
            for i in 0..count {
                impulses[i] += step * search[i];
                residual[i] -= step * response[i];
            }
            scale(scaled, residual);
            let before = std::mem::replace(&mut size, dot(residual, scaled));
            for i in 0..count {
                search[i] = scaled[i] + size / before * search[i];
            }
        }
        let (of_rows, of_joints) = impulses.split_at(rows.len());
        take_over((blocks, contact), movers, of_rows, dt);
        for (row, &impulse) in joint_rows.iter_mut().zip(of_joints) {
            row.take_over(movers, impulse, dt);
        }
    }
}

/// The rows of a contact, of three, that are free of their bounds.
fn free(blocks: &Blocks, index: usize) -> [bool; 3] {
    let (block, lane) = (index / BLOCK, index % BLOCK);
    let rolls = blocks.rolling.get(block).is_some_and(|rolling| rolling.is_free(lane));
    [(blocks.normals[block].at_limit >> lane) & 1 == 0, blocks.tangential[block].is_free(lane), rolls]
}

/// A force within its bounds. A NaN stays one, so that the run ends with it.
fn within(force: f64, least: f64, greatest: f64) -> f64 {
    let above = if force < least { least } else { force };
    if above > greatest { greatest } else { above }
}

/// Takes over the impulses of the free rows, each as far as its bounds allow.
fn take_over((blocks, contact): (&mut Blocks, &[RestContact]), movers: &mut [Mover], impulses: &[f64], dt: f64) {
    let mut impulses = impulses.iter();
    let mut next = || impulses.next().map_or(0.0, |impulse| impulse / dt);
    for (number, contact) in contact.iter().enumerate() {
        let index = blocks.indices[number];
        let (block, lane) = (index / BLOCK, index % BLOCK);
        let mut sides = Sides::of(movers, contact.ends);
        let (rows, free) = (Rows::of(contact, &sides), free(blocks, index));
        let normals = &mut blocks.normals[block];
        if free[0] {
            let wanted = normals.force[lane] + next();
            let force = within(wanted, normals.band[0][lane], normals.band[1][lane]);
            normals.at_limit |= u8::from(force != wanted) << lane;
            rows.normal.push(&mut sides, (force - normals.force[lane]) * dt);
            normals.force[lane] = force;
        }
        let normal_force = normals.force[lane];
        for (row, (free, springs)) in [rows.tangent, rows.turn].iter().zip(free[1..].iter().zip(blocks.springs())) {
            let Some(springs) = springs.get_mut(block).filter(|springs| springs.is_engaged(lane)) else { continue };
            let (before, limit) = (springs.force[lane], springs.gives[lane] * normal_force);
            // The limit of a spring that stands there has moved with the normal force.
            let wanted = if *free { before + next() } else { limit.copysign(before) };
            let force = within(wanted, -limit, limit);
            springs.note_limit(lane, !free || force != wanted);
            row.push(&mut sides, (force - before) * dt);
            springs.force[lane] = force;
        }
        sides.put_back(movers, contact.ends);
    }
}
