//! Lists of candidate pairs where most bodies are asleep.
//!
//! Sleeping bodies keep their positions. So if another body has left its margin, renewed lists can differ only in the
//! pairs of awake bodies. These are searched in the cells of the last search. If they are unchanged, the lists stay,
//! and so do all data made from them. Renewed lists would be the same, so the motion does not depend on the choice.

use super::cells::Sorted;
use super::{AtomPair, SurfacePair, each_wall_pair, group_of, most_pairs};
use crate::tick::bounds::Bounds;
use crate::world::Bodies;
use jostle_simd::BLOCK;
use serde::{Deserialize, Serialize};

/// Bodies for each one that may move, at least: with fewer the search spares too little.
const MOST: usize = 8;

/// The state when lists were made.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Still {
    generation: u64,
    rousings: u64,
    margin: f64,
    /// All atoms. Those of awake bodies have moved since.
    sorted: Sorted,
    /// The bodies that may move, in order.
    moving: Vec<u32>,
    /// A bit each for all bodies, a byte for eight of them: whether it may move.
    moves: Vec<u8>,
    pairs: Pairs,
}

/// Pairs of bodies that may move.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
struct Pairs {
    /// Sorted, each with its group.
    atoms: Vec<(AtomPair, usize)>,
    walls: Vec<SurfacePair>,
}

fn has(bits: &[u8], body: usize) -> bool {
    bits[body / BLOCK] >> (body % BLOCK) & 1 != 0
}

impl Still {
    /// Whether all indices are those of these bodies.
    pub fn fits(&self, bodies: &Bodies) -> bool {
        let atoms = bodies.atom_count() as u32;
        let Self { sorted, moving, moves, pairs, .. } = self;
        sorted.fits(bodies)
            && moving.iter().all(|body| (*body as usize) < bodies.len())
            && moves.len() == bodies.len().div_ceil(8)
            && pairs.atoms.iter().all(|(pair, group)| pair.a < atoms && pair.b < atoms && *group < 3)
            && pairs.walls.iter().all(|pair| pair.is_among(bodies))
    }

    /// The result of the last search, if most bodies sleep.
    pub fn of(
        bodies: &Bodies,
        bounds: &Bounds,
        sorted: Sorted,
        (atoms, walls): (&[AtomPair], &[SurfacePair]),
    ) -> Option<Self> {
        if bodies.asleep.is_empty() || !bodies.hulls.is_empty() {
            return None;
        }
        let may_move = |body: &usize| bodies.moves[*body] && !bodies.is_asleep(*body);
        let moving: Vec<u32> = (0..bodies.len()).filter(may_move).map(|body| body as u32).collect();
        if MOST * moving.len() > bodies.len() {
            return None;
        }
        let mut moves = vec![0; bodies.len().div_ceil(BLOCK)];
        for &body in &moving {
            moves[body as usize / BLOCK] |= 1 << (body as usize % BLOCK);
        }
        let of_moving = |atom: u32| has(&moves, bodies.atom_body(atom as usize));
        let own = atoms.iter().copied().filter(|pair| of_moving(pair.a) || of_moving(pair.b));
        let mut own: Vec<_> = own.map(|pair| (pair, group_of(pair, bodies, bounds.margin))).collect();
        own.sort_unstable();
        let walls = walls.iter().copied().filter(|pair| of_moving(pair.probe)).collect();
        let pairs = Pairs { atoms: own, walls };
        let (generation, rousings, margin) = (bodies.generation, bodies.rousings, bounds.margin);
        Some(Self { generation, rousings, margin, sorted: sorted.without_list(), moving, moves, pairs })
    }

    /// Whether renewed lists would be the same.
    pub fn holds(&self, bodies: &Bodies, bounds: &Bounds) -> bool {
        let told = (self.generation, self.rousings, self.margin);
        told == (bodies.generation, bodies.rousings, bounds.margin) && self.pairs_now(bodies) == self.pairs
    }

    fn pairs_now(&self, bodies: &Bodies) -> Pairs {
        let moving = self.moving.iter().map(|&body| body as usize);
        let mut found = Pairs::default();
        let own = Sorted::among(bodies, self.margin, moving.clone().flat_map(|body| bodies.atoms_of(body)));
        let stands = |body: u32| !has(&self.moves, body as usize);
        own.each_pair(bodies, most_pairs(bodies), (&self.sorted, stands), |pair| {
            found.atoms.push((pair, group_of(pair, bodies, self.margin)));
        });
        found.atoms.sort_unstable();
        each_wall_pair(bodies, self.margin, moving, |pair| found.walls.push(pair));
        found
    }
}

#[cfg(test)]
mod tests {
    use bevy_ecs::prelude::Entity;
    use glam::DVec2;

    use super::super::{PairSearch, cells};
    use super::*;
    use crate::tick::pairs::CandidatePairs;
    use crate::world::{MaterialIndex, PackedWall};

    /// Law: lists hold if and only if renewed lists would be the same.
    #[test]
    fn lists_hold_where_new_ones_would_be_the_same() {
        let (mut held, mut changed, mut walls_alone) = (0, 0, 0);
        for seed in 1..=40 {
            let (mut bodies, mut bounds) = cells::tests::strewn(seed, 400, 30.0);
            bodies.moves.clone_from(&bodies.dynamic);
            for index in 0..20 {
                let (entity, point) = (Entity::PLACEHOLDER, DVec2::splat(1.5 * f64::from(index)));
                let normal = if index % 2 == 0 { DVec2::Y } else { -DVec2::X };
                let material = MaterialIndex::default();
                bodies.walls.push(PackedWall { entity, point, normal, ends: None, line: None, material });
            }
            bodies.extent = vec![30.0; bodies.len()];
            bodies.position = (0..bodies.len()).map(|body| bodies.atom_position[bodies.atoms_of(body).start]).collect();
            // One in a dozen is awake.
            let asleep = (0..bodies.len().div_ceil(BLOCK)).map(|block| if block % 3 == 0 { 0xdf } else { 0xff });
            bodies.lay_asleep(&asleep.collect::<Vec<_>>());
            let (mut search, mut pairs) = (PairSearch::default(), CandidatePairs::default());
            search.renew(&mut pairs, &bodies, &mut bounds);
            let still = search.still.take().expect("most are asleep");
            assert!(still.holds(&bodies, &bounds));
            for (number, &body) in still.moving.clone().iter().enumerate() {
                let way = DVec2::splat(0.001 * seed as f64) * if number % 2 == 0 { 1.0 } else { -0.5 };
                for atom in bodies.atoms_of(body as usize) {
                    bodies.atom_position[atom] += way;
                }
            }
            let before = (pairs.atoms.clone(), pairs.group_ends, pairs.surfaces.clone());
            search.renew(&mut pairs, &bodies, &mut bounds);
            walls_alone += u32::from(before.0 == pairs.atoms && before.2 != pairs.surfaces);
            let same = before == (pairs.atoms, pairs.group_ends, pairs.surfaces);
            assert_eq!(still.holds(&bodies, &bounds), same, "seed {seed}");
            *if same { &mut held } else { &mut changed } += 1;
            bodies.wake_all();
            assert!(!still.holds(&bodies, &bounds), "somebody woke");
        }
        assert!(held > 2 && changed > 2, "{held} held, {changed} changed");
        assert!(walls_alone > 0, "pairs with walls never changed alone");
    }
}
