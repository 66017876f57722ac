//! Candidate pairs: pairs that may touch. The search fills the lists, and contact laws use them.

use glam::DVec2;
use jostle_shapes::Feature;

use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Marks a pair that was not in the list before.
pub const NEW: u32 = u32::MAX;

/// A pair of atoms of different bodies that are nearer than the margin. In canonical order `a` precedes `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AtomPair {
    /// Place of the first atom.
    pub a: u32,
    /// Place of the second atom.
    pub b: u32,
}

impl AtomPair {
    /// Unit vector from the centre of the first atom to that of the second; upwards if the centres coincide.
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

/// A probe that is nearer to a surface of something else than the margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct SurfacePair {
    /// Index of a wall, or of the piece of a line at which the search found the probe. Indices behind all walls are
    /// those of hulls.
    pub surface: u32,
    /// Place of an atom: a corner, or a disc; or, behind all atoms, of an end of a wall.
    pub probe: u32,
    /// See [`SurfacePair::kept`].
    kept: u32,
}

/// The surface near a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Place of a wall.
    Wall(usize),
    /// Place of a hull.
    Hull(usize),
}

/// The probe near a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probe {
    /// Place of an atom.
    Atom(usize),
    /// An end of a wall: place of the wall, and whether it is the one to the right.
    End(usize, bool),
}

impl SurfacePair {
    /// A pair of which the nearest feature counts.
    #[inline]
    pub fn new(surface: u32, probe: u32) -> Self {
        Self { surface, probe, kept: 0 }
    }

    /// Whether there are such a surface, such a probe and such a feature.
    pub(crate) fn is_among(self, bodies: &Bodies) -> bool {
        let (probe, atoms, walls) = (self.probe as usize, bodies.atom_count(), bodies.walls.len());
        match self.surface(bodies) {
            Surface::Wall(_) => probe < atoms && self.kept == 0,
            Surface::Hull(hull) => {
                let corners = bodies.hulls.get(hull).map_or(0, |packed| packed.hull.corners().len());
                let known = self.kept.checked_sub(1).is_none_or(|kept| (kept as usize) / 2 < corners);
                corners > 0 && known && probe < atoms + 2 * walls
            }
        }
    }

    /// The feature of the hull that counts in a step with stages. Default: none, and the nearest counts.
    #[inline]
    pub fn kept(&self) -> Option<Feature> {
        let index = self.kept.checked_sub(1)? as usize;
        Some(if index.is_multiple_of(2) { Feature::Corner(index / 2) } else { Feature::Side(index / 2) })
    }

    /// Sets the corner or side that counts; `None` for the nearest.
    pub fn keep(&mut self, feature: Option<Feature>) {
        self.kept = match feature {
            Some(Feature::Corner(corner)) => 1 + 2 * corner as u32,
            Some(Feature::Side(side)) => 2 + 2 * side as u32,
            _ => 0,
        };
    }

    /// Surface and probe, by which pairs are in order.
    #[inline]
    pub fn names(&self) -> (u32, u32) {
        (self.surface, self.probe)
    }

    /// The surface.
    #[inline(always)]
    pub fn surface(self, bodies: &Bodies) -> Surface {
        let index = self.surface as usize;
        match index.checked_sub(bodies.walls.len()) {
            None => Surface::Wall(index),
            Some(hull) => Surface::Hull(hull),
        }
    }

    /// The probe.
    #[inline(always)]
    pub fn probe(self, bodies: &Bodies) -> Probe {
        let index = self.probe as usize;
        match index.checked_sub(bodies.atom_count()) {
            None => Probe::Atom(index),
            Some(end) => Probe::End(end / 2, end % 2 == 1),
        }
    }

    /// Half the width in metres of the thinner side; walls do not count.
    #[inline]
    pub fn size(self, bodies: &Bodies) -> f64 {
        let hull = |hull: usize| bodies.hulls[hull].half_width;
        match (self.surface(bodies), self.probe(bodies)) {
            (Surface::Wall(_), _) => bodies.size_of_atom(self.probe as usize),
            (Surface::Hull(index), Probe::Atom(atom)) => hull(index).min(bodies.size_of_atom(atom)),
            (Surface::Hull(index), Probe::End(..)) => hull(index),
        }
    }

    /// The index of the wall, if one side is a wall; for a line that of its first piece.
    #[inline]
    pub fn wall(self, bodies: &Bodies) -> Option<usize> {
        match (self.surface(bodies), self.probe(bodies)) {
            (Surface::Wall(wall), _) | (_, Probe::End(wall, _)) => Some(bodies.whole_wall(wall)),
            _ => None,
        }
    }

    /// The bodies of both sides. A wall has no body, and then the first is absent.
    #[inline]
    pub fn bodies(self, bodies: &Bodies) -> (Option<usize>, usize) {
        let of_hull = |hull: usize| bodies.hulls[hull].body as usize;
        match (self.surface(bodies), self.probe(bodies)) {
            (Surface::Hull(hull), Probe::Atom(atom)) => (Some(of_hull(hull)), bodies.atom_body(atom)),
            (Surface::Hull(hull), Probe::End(..)) => (None, of_hull(hull)),
            (Surface::Wall(_), _) => (None, bodies.atom_body(self.probe as usize)),
        }
    }
}

/// Pairs that may touch, in canonical order.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct CandidatePairs {
    /// The number of renewals of the lists.
    pub version: u64,
    /// Pairs of atoms.
    pub atoms: Vec<AtomPair>,
    /// The ends of two groups: pairs that touched when the list was made, and pairs that nearly did. Each group is in
    /// order.
    pub group_ends: [usize; 2],
    /// Atoms near walls and hulls, and ends of walls near hulls.
    pub surfaces: Vec<SurfacePair>,
    /// Whether some of them keep a feature.
    pub keeps: bool,
    /// For each item of `atoms` its index in the list before, or [`NEW`].
    pub atoms_before: Vec<u32>,
    /// For each item of `surfaces` its index in the list before, or [`NEW`].
    pub surfaces_before: Vec<u32>,
    /// The search that found the pairs of atoms.
    pub search: Search,
}

impl CandidatePairs {
    /// Whether all of them are pairs of these bodies, and the lists belong together.
    pub(crate) fn fits(&self, bodies: &Bodies) -> bool {
        let atoms = bodies.atom_count() as u32;
        self.atoms.iter().all(|pair| pair.a < atoms && pair.b < atoms && pair.a != pair.b)
            && self.surfaces.iter().all(|pair| pair.is_among(bodies))
            && self.group_ends[0] <= self.group_ends[1]
            && self.group_ends[1] <= self.atoms.len()
            && self.atoms_before.len() == self.atoms.len()
            && self.surfaces_before.len() == self.surfaces.len()
    }

    /// Places of walls, or of pieces of lines, and of the atoms near them.
    pub fn near_walls(&self, bodies: &Bodies) -> impl Iterator<Item = (usize, usize)> {
        self.surfaces.iter().filter_map(|pair| match pair.surface(bodies) {
            Surface::Wall(wall) => Some((wall, pair.probe as usize)),
            Surface::Hull(_) => None,
        })
    }

    /// The number of pairs, and of those that touch.
    pub fn count(&self, bodies: &Bodies) -> (usize, usize) {
        let between = |pair: &AtomPair| bodies.atom_place(pair.a as usize).distance(bodies.atom_place(pair.b as usize));
        let atoms = self.atoms.iter().filter(|pair| between(pair) < pair.reach(bodies)).count();
        let surfaces = self.surfaces.iter().filter(|pair| pair.overlap(bodies) > 0.0).count();
        (self.atoms.len() + self.surfaces.len(), atoms + surfaces)
    }
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
