//! Data parallelism over independent parts: work on many bodies, several side by side and in several threads at once.

use std::ops::Range;

use glam::DVec2;

use super::packed::{Bodies, place_atoms};
use jostle_simd::{BLOCK, Kernel, Lanes, Record};

/// Atoms, or bodies without, of the smallest part: with fewer it costs more to hand them out than they do.
const FEWEST: usize = 16384;
/// Parts at most.
const MOST: usize = 16;

/// The distance in bodies of the prefetch ahead of the work. The processor prefetches by itself only if lists are few.
const FETCHED: usize = 6 * BLOCK;

/// Some consecutive bodies with their data. Lists begin at the first of them and have one item for each body.
pub(crate) struct Chunk<'a> {
    /// Place of the first body.
    pub first: usize,
    /// Blocks that need work among all bodies; `None`: all of them.
    awake: Option<&'a [u32]>,
    /// A bit for each sleeping body, a byte for each block from the first on. Empty if no body sleeps.
    pub asleep: &'a [u8],
    pub mass: &'a [f64],
    pub inertia: &'a [f64],
    /// Empty if all bodies move by forces.
    inverse_mass: &'a [f64],
    inverse_inertia: &'a [f64],
    pub extent: &'a [f64],
    pub position: &'a mut [DVec2],
    pub position_residual: &'a mut [DVec2],
    pub angle: &'a mut [f64],
    pub angle_residual: &'a mut [f64],
    pub velocity: &'a mut [DVec2],
    pub spin: &'a mut [f64],
    /// Empty without an estimate.
    pub estimated_velocity: &'a mut [DVec2],
    pub estimated_spin: &'a mut [f64],
    /// Empty where displacements are not listed.
    pub drift: &'a mut [DVec2],
    pub turn: &'a mut [f64],
    /// Empty if no contact law needs them.
    pub records: &'a mut [Record],
    pub force: &'a mut [DVec2],
    pub torque: &'a mut [f64],
    pub lone_discs: bool,
    moves: &'a [bool],
    /// One more than bodies; empty where bodies are lone discs, and so are the following.
    first_atom: &'a [u32],
    atom_offset: &'a [DVec2],
    pub atom_position: &'a mut [DVec2],
    /// Empty without hulls.
    turned: &'a mut [DVec2],
}

/// The first items of a list, which then begins behind them.
pub(crate) fn cut<'a, T>(list: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let whole = std::mem::take(list);
    let (front, rest) = whole.split_at_mut(count.min(whole.len()));
    *list = rest;
    front
}

impl<'a> Chunk<'a> {
    fn whole(bodies: &'a mut Bodies) -> Self {
        Self {
            first: 0,
            awake: (!bodies.asleep.is_empty()).then_some(&bodies.awake),
            asleep: &bodies.asleep,
            mass: &bodies.mass,
            inertia: &bodies.inertia,
            inverse_mass: &bodies.inverse_mass,
            inverse_inertia: &bodies.inverse_inertia,
            extent: if bodies.lone_discs { &bodies.atom_radius } else { &bodies.extent },
            position: &mut bodies.position,
            position_residual: &mut bodies.position_residual,
            angle: &mut bodies.angle,
            angle_residual: &mut bodies.angle_residual,
            velocity: &mut bodies.velocity,
            spin: &mut bodies.spin,
            estimated_velocity: &mut bodies.estimated_velocity,
            estimated_spin: &mut bodies.estimated_spin,
            drift: &mut bodies.drift,
            turn: &mut bodies.turn,
            records: &mut bodies.records,
            force: &mut bodies.force,
            torque: &mut bodies.torque,
            lone_discs: bodies.lone_discs,
            moves: &bodies.moves,
            first_atom: &bodies.first_atom,
            atom_offset: &bodies.atom_offset,
            atom_position: &mut bodies.atom_position,
            turned: &mut bodies.turned,
        }
    }

    /// Splits off the first `count` bodies, in whole blocks.
    fn take(&mut self, count: usize) -> Self {
        let blocks = |list: &[u32]| list.partition_point(|&block| (block as usize) < (self.first + count) / BLOCK);
        let (awake, rest) = self.awake.map(|list| list.split_at(blocks(list))).unzip();
        let atoms = if self.lone_discs { 0 } else { (self.first_atom[count] - self.first_atom[0]) as usize };
        let front = Self {
            first: self.first,
            awake,
            asleep: &self.asleep[..self.asleep.len().min(count / BLOCK)],
            mass: &self.mass[..count],
            inertia: &self.inertia[..count],
            inverse_mass: &self.inverse_mass[..count.min(self.inverse_mass.len())],
            inverse_inertia: &self.inverse_inertia[..count.min(self.inverse_inertia.len())],
            extent: &self.extent[..count],
            position: cut(&mut self.position, count),
            position_residual: cut(&mut self.position_residual, count),
            angle: cut(&mut self.angle, count),
            angle_residual: cut(&mut self.angle_residual, count),
            velocity: cut(&mut self.velocity, count),
            spin: cut(&mut self.spin, count),
            estimated_velocity: cut(&mut self.estimated_velocity, count),
            estimated_spin: cut(&mut self.estimated_spin, count),
            drift: cut(&mut self.drift, count),
            turn: cut(&mut self.turn, count),
            records: cut(&mut self.records, count),
            force: cut(&mut self.force, count),
            torque: cut(&mut self.torque, count),
            lone_discs: self.lone_discs,
            moves: &self.moves[..count],
            first_atom: if self.lone_discs { &[] } else { &self.first_atom[..=count] },
            atom_offset: &self.atom_offset[..atoms],
            atom_position: cut(&mut self.atom_position, atoms),
            turned: cut(&mut self.turned, count),
        };
        self.first += count;
        self.awake = rest;
        self.asleep = &self.asleep[front.asleep.len()..];
        self.mass = &self.mass[count..];
        self.inertia = &self.inertia[count..];
        self.inverse_mass = &self.inverse_mass[front.inverse_mass.len()..];
        self.inverse_inertia = &self.inverse_inertia[front.inverse_inertia.len()..];
        self.extent = &self.extent[count..];
        self.moves = &self.moves[count..];
        self.first_atom = if self.lone_discs { &[] } else { &self.first_atom[count..] };
        self.atom_offset = &self.atom_offset[atoms..];
        front
    }

    /// Cuts all lists to the number of bodies, and none is shorter. So one check of an index holds for all lists.
    #[inline(always)]
    fn cut_alike(&mut self) {
        let count = self.mass.len();
        self.inertia = &self.inertia[..count];
        self.extent = &self.extent[..count];
        self.moves = &self.moves[..count];
        self.position = &mut std::mem::take(&mut self.position)[..count];
        self.position_residual = &mut std::mem::take(&mut self.position_residual)[..count];
        self.angle = &mut std::mem::take(&mut self.angle)[..count];
        self.angle_residual = &mut std::mem::take(&mut self.angle_residual)[..count];
        self.velocity = &mut std::mem::take(&mut self.velocity)[..count];
        self.spin = &mut std::mem::take(&mut self.spin)[..count];
        self.force = &mut std::mem::take(&mut self.force)[..count];
        self.torque = &mut std::mem::take(&mut self.torque)[..count];
    }

    /// 1/mass and 1/inertia of some bodies from place `first` of the part on.
    #[inline(always)]
    pub fn inverses<V: Lanes>(&self, first: usize) -> (V, V) {
        if self.inverse_mass.is_empty() {
            let one = V::splat(1.0);
            return (one / V::load(&self.mass[first..]), one / V::load(&self.inertia[first..]));
        }
        (V::load(&self.inverse_mass[first..]), V::load(&self.inverse_inertia[first..]))
    }

    /// The bodies among them that move by forces.
    #[inline(always)]
    pub fn moving<V: Lanes>(&self, first: usize) -> V::Mask {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        if self.inverse_mass.is_empty() { one } else { V::load(&self.inverse_mass[first..]) }.gt(zero)
    }

    #[inline(always)]
    fn blocks(&self) -> usize {
        self.awake.map_or(self.mass.len().div_ceil(BLOCK), <[u32]>::len)
    }

    /// Places within the part of one of its blocks that need work.
    #[inline(always)]
    fn block(&self, number: usize) -> Range<usize> {
        let first = self.awake.map_or(number, |list| list[number] as usize - self.first / BLOCK) * BLOCK;
        first..self.mass.len().min(first + BLOCK)
    }

    /// Has the numbers of a block of bodies brought near; there need not be such bodies.
    #[inline(always)]
    pub fn fetch_numbers<const COUNT: usize>(lists: [&[f64]; COUNT], first: usize) {
        for list in lists {
            jostle_simd::fetch(list.as_ptr().wrapping_add(first));
        }
    }

    /// Likewise pairs of numbers, two lines of the cache.
    #[inline(always)]
    pub fn fetch_pairs<const COUNT: usize>(lists: [&[DVec2]; COUNT], first: usize) {
        for list in lists {
            jostle_simd::fetch(list.as_ptr().wrapping_add(first));
            jostle_simd::fetch(list.as_ptr().wrapping_add(first + BLOCK / 2));
        }
    }

    /// Moves the atoms of a body with it, unless it is at rest.
    #[inline(always)]
    pub fn place_atoms<V: Lanes>(&mut self, body: usize) {
        if self.moves[body] {
            let atoms = |index: usize| (self.first_atom[index] - self.first_atom[0]) as usize;
            let atoms = atoms(body)..atoms(body + 1);
            let offsets = &self.atom_offset[atoms.clone()];
            let pose = (self.position[body], self.angle[body]);
            let turned = place_atoms::<V>(pose, offsets, &mut self.atom_position[atoms]);
            if let (Some(turned), Some(slot)) = (turned, self.turned.get_mut(body)) {
                *slot = turned;
            }
        }
    }
}

/// Work on bodies, one for each lane side by side.
pub(crate) trait PerBody: Clone + Send {
    /// Does it for the bodies from place `first` of a part on.
    fn bodies<V: Lanes>(&mut self, part: &mut Chunk, first: usize);

    /// Processes the atoms of a body, several side by side, after [`PerBody::bodies`].
    #[inline(always)]
    fn atoms<V: Lanes>(&mut self, _: &mut Chunk, _: usize) {}

    /// Prefetches the data of a block of bodies, from index `first` of a part on. The index may be out of range.
    #[inline(always)]
    fn fetch(_: &Chunk, _: usize) {}
}

struct All<'a, W> {
    part: Chunk<'a>,
    /// Lent, because partial sums are too long to be moved.
    work: &'a mut W,
}

impl<W: PerBody> Kernel for All<'_, W> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let Self { mut part, work } = self;
        part.cut_alike();
        let mut number = 0;
        while number < part.blocks() {
            let bodies = part.block(number);
            let mut first = bodies.start;
            if first + FETCHED < part.mass.len() {
                W::fetch(&part, first + FETCHED);
            }
            while first + V::COUNT <= bodies.end {
                work.bodies::<V>(&mut part, first);
                first += V::COUNT;
            }
            // At the end of the list there may be no whole block.
            while first + V::Half::COUNT <= bodies.end {
                work.bodies::<V::Half>(&mut part, first);
                first += V::Half::COUNT;
            }
            while first < bodies.end {
                work.bodies::<f64>(&mut part, first);
                first += 1;
            }
            for body in bodies {
                work.atoms::<V>(&mut part, body);
            }
            number += 1;
        }
    }
}

/// The number of parts of a list that takes so much work. It depends on the work alone.
pub(crate) fn parts_of(work: usize, fewest: usize) -> usize {
    (work / fewest).clamp(1, MOST)
}

impl Bodies {
    /// Does `work` for some bodies, one by one.
    pub(super) fn each_of<W: PerBody>(&mut self, bodies: &[u32], work: &mut W) {
        let mut part = Chunk::whole(self);
        for (number, &body) in bodies.iter().enumerate() {
            if let Some(&body) = bodies.get(number + FETCHED / BLOCK) {
                W::fetch(&part, body as usize);
            }
            work.bodies::<f64>(&mut part, body as usize);
        }
    }

    /// Does `work` for all awake bodies. `found` receives the result, part by part in order.
    pub(crate) fn each<W: PerBody>(&mut self, mut work: W, mut found: impl FnMut(&W)) {
        let level = self.level;
        let count = parts_of(self.atom_count().max(self.len()), FEWEST);
        if count == 1 {
            jostle_simd::run(level, All { part: Chunk::whole(self), work: &mut work });
            return found(&work);
        }
        let each = self.len().div_ceil(count).next_multiple_of(BLOCK);
        let threads = self.threads.clone();
        let mut rest = Chunk::whole(self);
        let mut parts = Vec::with_capacity(count);
        while rest.mass.len() > each {
            parts.push(rest.take(each));
        }
        parts.push(rest);
        let mut works = vec![work; parts.len()];
        threads.each(parts.into_iter().zip(&mut works).collect(), |(part, work)| {
            jostle_simd::run(level, All { part, work });
        });
        works.iter().for_each(found);
    }
}
