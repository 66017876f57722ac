//! Candidate pairs: who may touch whom. The search for them fills the lists, contact laws go by them.

use glam::DVec2;

use crate::world::{Bodies, NearestPoint};
use serde::{Deserialize, Serialize};

/// Marks a pair that was not in the list before.
pub const NEW: u32 = u32::MAX;

/// A pair of atoms of different bodies that are nearer than the margin. `a` stands before `b` in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AtomPair {
    /// Place of the first atom.
    pub a: u32,
    /// Place of the second atom.
    pub b: u32,
}

impl AtomPair {
    /// Unit vector from the centre of the first atom to that of the second; up if they are in one place.
    #[inline]
    pub fn normal(self, bodies: &Bodies) -> DVec2 {
        let between = bodies.atom_place(self.b as usize) - bodies.atom_place(self.a as usize);
        let distance = between.length();
        if distance > 0.0 { between * (1.0 / distance) } else { DVec2::Y }
    }

    /// Distance of the centres in metres below which the two touch.
    #[inline]
    pub fn reach(self, bodies: &Bodies) -> f64 {
        bodies.atom_radius[self.a as usize] + bodies.atom_radius[self.b as usize]
    }
}

/// An atom that is nearer to a wall than the margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct WallPair {
    /// Place of the wall.
    pub wall: u32,
    /// Place of the atom.
    pub atom: u32,
}

impl WallPair {
    /// The wall as the centre of the atom sees it.
    #[inline(always)]
    pub fn nearest(self, bodies: &Bodies) -> NearestPoint {
        bodies.walls[self.wall as usize].nearest(bodies.atom_place(self.atom as usize))
    }
}

/// Who may touch whom, in canonical order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct CandidatePairs {
    /// Counts how often the lists were made anew.
    pub version: u64,
    /// Pairs of atoms.
    pub atoms: Vec<AtomPair>,
    /// Where the group of those ends that touched when the list was made, and that of those that nearly did. Each group is in order.
    pub group_ends: [usize; 2],
    /// Atoms near walls.
    pub walls: Vec<WallPair>,
    /// For each item of `atoms` its place in the list before, or [`NEW`].
    pub atoms_before: Vec<u32>,
    /// For each item of `walls` its place in the list before, or [`NEW`].
    pub walls_before: Vec<u32>,
    /// How the pairs of atoms were found.
    pub search: Search,
}

/// How pairs of atoms are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Search {
    /// Boxes of bodies along an axis: for few atoms.
    #[default]
    Sweep,
    /// Square cells: for many.
    Cells,
}

impl Search {
    /// In words.
    pub fn told(self) -> &'static str {
        match self {
            Self::Sweep => "boxes swept along an axis",
            Self::Cells => "cells with a skin",
        }
    }
}
