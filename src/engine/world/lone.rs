//! Atoms of packed bodies. If each body is one disc about its centre of mass, derived data of atoms is not listed. Then
//! atoms have the indices, positions and extents of their bodies.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::DVec2;

use super::atom::Atom;
use super::material::MaterialIndex;
use super::packed::Bodies;
use serde::{Deserialize, Serialize};

/// The data of an atom that contacts need beside its radius. Few atoms differ in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Surface {
    /// Stiffness in N/m.
    stiffness: f64,
    material: MaterialIndex,
}

/// All surfaces that there are, each once, while they are listed.
#[derive(Default)]
pub(super) struct Surfaces {
    list: Vec<Surface>,
    /// Places in the list, by the bits of the stiffness and the place of the material.
    indices: BTreeMap<(u64, usize), u32>,
}

impl Surfaces {
    /// The place of the surface of an atom in the list.
    pub fn index(&mut self, Atom { stiffness, material, .. }: Atom) -> u32 {
        *self.indices.entry((stiffness.to_bits(), material.index())).or_insert_with(|| {
            self.list.push(Surface { stiffness, material });
            self.list.len() as u32 - 1
        })
    }

    /// The list, and the index of each atom in it. The indices are empty if all atoms have the same surface.
    pub fn listed(self, indices: Vec<u32>) -> (Vec<Surface>, Vec<u32>) {
        let indices = if self.list.len() == 1 { Vec::new() } else { indices };
        (self.list, indices)
    }
}

impl Bodies {
    /// Number of atoms.
    pub fn atom_count(&self) -> usize {
        self.atom_radius.len()
    }

    /// Atoms of body `body`.
    #[inline(always)]
    pub fn atoms_of(&self, body: usize) -> Range<usize> {
        if self.lone_discs {
            return body..body + 1;
        }
        self.first_atom[body] as usize..self.first_atom[body + 1] as usize
    }

    /// Body of an atom.
    #[inline(always)]
    pub fn atom_body(&self, atom: usize) -> usize {
        if self.lone_discs { atom } else { self.atom_body[atom] as usize }
    }

    /// The centre of an atom, in metres.
    #[inline(always)]
    pub fn atom_place(&self, atom: usize) -> DVec2 {
        if self.lone_discs { self.position[atom] } else { self.atom_position[atom] }
    }

    /// Centre of an atom from its body's centre of mass, in the body's frame, in metres.
    #[inline]
    pub fn atom_offset(&self, atom: usize) -> DVec2 {
        if self.lone_discs { DVec2::ZERO } else { self.atom_offset[atom] }
    }

    fn surface(&self, atom: usize) -> &Surface {
        &self.surfaces[self.atom_surface.get(atom).map_or(0, |&index| index as usize)]
    }

    /// Stiffness of an atom in N/m.
    #[inline]
    pub fn atom_stiffness(&self, atom: usize) -> f64 {
        self.surface(atom).stiffness
    }

    /// Material of an atom.
    #[inline]
    pub fn atom_material(&self, atom: usize) -> MaterialIndex {
        self.surface(atom).material
    }

    /// Greatest distance of a point of a body from its centre of mass, in metres.
    #[inline(always)]
    pub fn extent(&self, body: usize) -> f64 {
        self.extents()[body]
    }

    /// The same of all bodies.
    #[inline(always)]
    pub fn extents(&self) -> &[f64] {
        if self.lone_discs { &self.atom_radius } else { &self.extent }
    }
}
