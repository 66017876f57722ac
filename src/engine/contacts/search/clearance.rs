//! The ways that atoms may go before a wall with ends can be in their way. Until then no look at walls is needed.

use glam::DVec2;

use crate::world::Bodies;

/// Pieces of lines count up to this distance, in sizes of the atom. An atom that touches one is nearer than one size.
const REACH: f64 = 2.0;

/// Distances of atoms from walls with ends, as sums of the greatest ways of all bodies.
#[derive(Debug, Default)]
pub(super) struct Clearances {
    /// The generation of the bodies for which they hold.
    generation: u64,
    /// For each atom the sum of ways in m up to which it stays on its side of all walls.
    until: Vec<f64>,
}

impl Clearances {
    /// Forgets those of bodies that have come, gone or taken other names.
    pub fn keep_of(&mut self, bodies: &Bodies) {
        if self.generation != bodies.generation || self.until.len() != bodies.atom_count() {
            self.generation = bodies.generation;
            self.until.clear();
            self.until.resize(bodies.atom_count(), f64::NEG_INFINITY);
        }
    }

    /// Whether an atom stays on its side of all walls up to a sum of ways.
    pub fn hold(&self, atom: usize, path: f64) -> bool {
        path < self.until[atom]
    }

    /// Looks where an atom is, at the sum of ways `path`. Half of the distance leaves room for rounding of the sum.
    pub fn look(&mut self, bodies: &Bodies, atom: usize, path: f64) {
        self.until[atom] = path + 0.5 * clearance(bodies, atom);
    }
}

/// The distance in m of an atom from the middle line of the nearest wall with ends, or less.
fn clearance(bodies: &Bodies, atom: usize) -> f64 {
    let distance = |wall: usize, at: DVec2| bodies.walls[wall].distance_to_middle(at);
    let single = bodies.single_walls().map(|wall| distance(wall, bodies.meeting_wall(&bodies.walls[wall], atom).0));
    let (at, reach) = (bodies.atom_place(atom), REACH * bodies.size_of_atom(atom));
    let mut nearest = single.fold(f64::INFINITY, f64::min);
    for line in &bodies.lines {
        nearest = nearest.min(reach);
        line.each_near(at, reach, &mut |piece| nearest = nearest.min(distance(line.first as usize + piece, at)));
    }
    nearest
}
