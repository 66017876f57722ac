//! The broad phase: the search for pairs that may touch. Few atoms are found by their bodies' boxes (`sweep.rs`), many
//! by cells (`cells.rs`). Both find the same pairs.
//!
//! Each candidate pair has an index in a list sorted by atoms. The list is a function of keys and positions only. For
//! many atoms it begins with the pairs that touch as it is made. Then follow those that nearly touch, and then the
//! others. Each group is sorted. So vectorised work is on touching pairs, and distant pairs are skipped together. When
//! the list is renewed, every old pair gets its old index. So history beside the list can be carried over. If most
//! bodies sleep, the list stays until awake bodies come near to others (`still.rs`).

mod at_start;
mod behind;
mod cells;
mod clearance;
mod crossing;
mod hulls;
mod identity;
mod lines;
mod slept;
mod sort_and_sweep;
mod still;
mod sunk;

pub use at_start::OverlapAtStart;
pub use behind::TurnedWalls;

use bevy_app::App;
use bevy_ecs::world::World;

use self::cells::Sorted;
use self::identity::Identities;
use self::still::Still;
use crate::tick::bounds::{self, Bounds};
use crate::tick::pairs::{AtomPair, CandidatePairs, NEW, Search, SurfacePair};
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::{
    AfterLoad, Dependence, Energies, Evaluation, EvaluationMode, FailureKind, Model, State, SteadySpring, TickAppExt,
};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Renews the lists of candidate pairs after the bounding boxes.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct PairSearch {
    bounds_version: u64,
    generation: u64,
    /// The identities that stay the same when indices change.
    identities: Identities,
    wall_count: usize,
    /// The first corner of each hull, and how many atoms there were.
    first_atoms: Vec<u32>,
    atom_count: u32,
    /// The part of the lists that stays while most bodies sleep.
    still: Option<Still>,
}

/// Adds the search for pairs. Contact laws do so before they add themselves. Adding it twice does nothing.
pub fn plugin(app: &mut App) {
    app.add_tick();
    let mut state = app.world_mut().resource_mut::<State>();
    if state.pairs.is_some() {
        return;
    }
    state.bounds = Some(Bounds::default());
    state.pairs = Some(CandidatePairs::default());
    app.add_model(PairSearch::default());
    app.world_mut().get_resource_or_init::<AfterLoad>().0.extend([
        at_start::note_overlaps as fn(&mut World),
        crossing::watch,
        lines::watch,
        behind::note_behind,
        sunk::refuse_sunk,
        hulls::note_sharp,
        hulls::refuse_pointed,
    ]);
}

/// The candidate pairs of the present state, for a look before the first tick. The length in metres is how far each body may then
/// move without missing a pair. `None` if there are too many pairs.
pub(super) fn look(bodies: &mut Bodies) -> Option<(CandidatePairs, f64)> {
    let (mut pairs, mut bounds) = (CandidatePairs::default(), Bounds::default());
    bounds.update(bodies, &Evaluation { mode: EvaluationMode::Frozen, ..Evaluation::default() });
    let too_many = PairSearch::default().update(&mut pairs, bodies, &mut bounds);
    too_many.is_none().then_some((pairs, bounds.margin / 2.0))
}

/// Moves nothing by itself.
impl Model for PairSearch {
    fn save(&self) -> Memory {
        Memory::of(self)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        *self = recall(bytes)?;
        Ok(())
    }

    /// Lists of the present bodies are those of these bodies. The others are of no use.
    fn fits(&self, state: &State) -> Result<(), UnfitSnapshot> {
        let bodies = state.bodies();
        if state.bounds.as_ref().is_none_or(|bounds| bounds.version == 0) {
            return Ok(());
        }
        let hulls = bodies.hulls.iter().map(|hull| hull.first_atom);
        let same = self.generation == bodies.generation && self.identities == Identities::of(bodies);
        let counted = self.wall_count == bodies.walls.len() && self.atom_count as usize == bodies.atom_count();
        demand(same && counted && hulls.eq(self.first_atoms.iter().copied()), "the lists of the search for pairs")?;
        demand(self.still.as_ref().is_none_or(|still| still.fits(bodies)), "the lists of pairs of bodies at rest")
    }

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn flies(&self) -> bool {
        true
    }

    fn finds_pairs(&self) -> bool {
        true
    }

    fn find_pairs(&mut self, state: &mut State) {
        if let State { bounds: Some(bounds), pairs: Some(pairs), bodies, .. } = state
            && let Some(body) = self.update(pairs, bodies, bounds)
        {
            let most = most_pairs(bodies);
            state.end_run(body, FailureKind::Pairs(most));
        }
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}
}

impl PairSearch {
    /// Renews the lists if the bounding boxes were renewed. If there are too many pairs, the lists are empty, and it
    /// returns the body with most of them.
    #[inline]
    fn update(&mut self, pairs: &mut CandidatePairs, bodies: &Bodies, bounds: &mut Bounds) -> Option<usize> {
        if self.bounds_version == bounds.version {
            return None;
        }
        self.bounds_version = bounds.version;
        if self.still.as_ref().is_some_and(|still| still.holds(bodies, bounds)) {
            return None;
        }
        self.renew(pairs, bodies, bounds)
    }

    fn renew(&mut self, pairs: &mut CandidatePairs, bodies: &Bodies, bounds: &mut Bounds) -> Option<usize> {
        let most = most_pairs(bodies);
        pairs.version += 1;
        let old_atoms = std::mem::take(&mut pairs.atoms);
        let [touching, close] = std::mem::take(&mut pairs.group_ends);
        let old_surfaces = std::mem::take(&mut pairs.surfaces);
        pairs.search = suiting(bodies);
        let sorted = (pairs.search == Search::Cells).then(|| match bodies.hulls[..] {
            [] => Sorted::of(bodies, bounds.margin),
            // Corners touch hulls, not discs.
            _ => Sorted::among(bodies, bounds.margin, (0..bodies.atom_count()).filter(|atom| !bodies.is_corner(*atom))),
        });
        pairs.atoms =
            sorted.as_ref().map_or_else(|| sort_and_sweep::pairs(bodies, bounds), |sorted| sorted.pairs(bodies, most));
        let apart = indices_apart(bodies);
        if !apart.is_empty() {
            let body = |atom: u32| bodies.atom_body(atom as usize);
            pairs.atoms.retain(|pair| apart.binary_search(&ordered(body(pair.a), body(pair.b))).is_err());
        }
        if !bodies.hulls.is_empty() && sorted.is_none() {
            let corner = |atom: u32| bodies.is_corner(atom as usize);
            pairs.atoms.retain(|pair| !corner(pair.a) && !corner(pair.b));
        }
        let same = self.generation == bodies.generation;
        let renamed = if same { None } else { Some(self.identities.indices_in(&Identities::of(bodies))) };
        let index = |old: u32| {
            renamed
                .as_ref()
                .map_or(Some(old), |indices: &Vec<u32>| Some(indices[old as usize]).filter(|&index| index != NEW))
        };
        // Walls do not come and go one by one. If their number changes, the history of surfaces starts again.
        let old_wall_count = std::mem::replace(&mut self.wall_count, bodies.walls.len());
        let same_walls = same || old_wall_count == bodies.walls.len();
        let first_atoms = bodies.hulls.iter().map(|hull| hull.first_atom).collect();
        let old_first_atoms = std::mem::replace(&mut self.first_atoms, first_atoms);
        let old_atoms_count = std::mem::replace(&mut self.atom_count, bodies.atom_count() as u32);
        // Hulls are known by their first corners.
        let walls = old_wall_count as u32;
        let surface = |old: u32| match old.checked_sub(walls) {
            None => Some(old),
            Some(hull) => Some(
                bodies.walls.len() as u32 + bodies.hull_of(index(old_first_atoms[hull as usize])? as usize)? as u32,
            ),
        };
        let probe = |old: u32| match old.checked_sub(old_atoms_count) {
            None => index(old),
            Some(end) => Some(bodies.atom_count() as u32 + end),
        };
        let old_surface =
            |old: SurfacePair| same_walls.then(|| Some(SurfacePair::new(surface(old.surface)?, probe(old.probe)?)))?;
        let known = lines::known(bodies, &old_surfaces, old_surface);
        pairs.surfaces.clear();
        each_wall_pair(bodies, bounds.margin, 0..bodies.len(), |pair| {
            if pairs.surfaces.len() <= most {
                pairs.surfaces.push(pair);
            }
        });
        lines::each_pair(bodies, (bounds.margin, !same), &known, |pair| {
            if pairs.surfaces.len() <= most {
                pairs.surfaces.push(pair);
            }
        });
        let complete = hulls::each_pair(bodies, bounds.margin, (&apart, most), |pair| {
            if pairs.surfaces.len() <= most {
                pairs.surfaces.push(pair);
            }
        });
        if !bodies.lines.is_empty() {
            pairs.surfaces.sort_unstable();
        }
        let too_many = !complete || pairs.atoms.len() + pairs.surfaces.len() > most;
        let most_of = too_many.then(|| body_with_most(pairs, bodies));
        if most_of.is_some() {
            (pairs.atoms, pairs.surfaces) = (Vec::new(), Vec::new());
        }
        bounds.candidates = pairs.atoms.len() + pairs.surfaces.len();
        let groups = [&old_atoms[..touching], &old_atoms[touching..close], &old_atoms[close..]];
        pairs.atoms_before = carry(&pairs.atoms, groups, |old| Some(AtomPair { a: index(old.a)?, b: index(old.b)? }));
        pairs.surfaces_before = if bodies.lines.is_empty() {
            carry(&pairs.surfaces, [&old_surfaces], old_surface)
        } else {
            pairs.surfaces.iter().map(|pair| lines::index(&known, *pair)).collect()
        };
        if pairs.keeps {
            for (pair, before) in pairs.surfaces.iter_mut().zip(&pairs.surfaces_before) {
                pair.keep(old_surfaces.get(*before as usize).and_then(SurfacePair::kept));
            }
        }
        if pairs.search == Search::Cells {
            group(pairs, bodies, bounds.margin);
        }
        self.still = sorted.and_then(|sorted| Still::of(bodies, bounds, sorted, (&pairs.atoms, &pairs.surfaces)));
        if !same {
            self.generation = bodies.generation;
            self.identities = Identities::of(bodies);
        }
        most_of
    }
}

/// Pairs take 200 to 700 bytes each. So many of a run, and of another one that is compared with it, take less than a gigabyte.
const MOST_PAIRS: usize = 1 << 19;
/// A sufficient number of pairs for each atom. In the densest packing of discs the widest margin of `bounds` gives 55.
const PAIRS_PER_ATOM: usize = 64;

/// The greatest number of candidate pairs, beyond which a run ends.
fn most_pairs(bodies: &Bodies) -> usize {
    MOST_PAIRS.max(PAIRS_PER_ATOM * bodies.atom_count())
}

/// The first of the bodies that have most pairs.
fn body_with_most(pairs: &CandidatePairs, bodies: &Bodies) -> usize {
    let mut counts = vec![0_u32; bodies.len()];
    let atoms = pairs.atoms.iter().flat_map(|pair| [pair.a, pair.b]);
    let of_surfaces = pairs.surfaces.iter().flat_map(|pair| {
        let (a, b) = pair.bodies(bodies);
        [a, Some(b)].into_iter().flatten()
    });
    atoms.map(|atom| bodies.atom_body(atom as usize)).chain(of_surfaces).for_each(|body| counts[body] += 1);
    (0..counts.len()).rev().max_by_key(|&body| counts[body]).unwrap_or_default()
}

/// The places of bodies that do not touch each other, the lower one first, in order.
fn indices_apart(bodies: &Bodies) -> Vec<(usize, usize)> {
    let index = |(a, b): &(u64, u64)| Some(ordered(bodies.key.find(*a)?, bodies.key.find(*b)?));
    let mut apart: Vec<_> = bodies.apart.iter().filter_map(index).collect();
    apart.sort_unstable();
    apart
}

fn ordered(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// Share of the margin that pairs are apart at the most that nearly touch.
const CLOSE: f64 = 1.0 / 8.0;

/// For each new pair the index of the same pair in the old list. The new list is sorted, and so is each group of the
/// old one. They stay sorted when old pairs get new indices, because indices keep the order of identities.
fn carry<P: Ord + Copy, const GROUPS: usize>(
    new: &[P],
    old: [&[P]; GROUPS],
    renamed: impl Fn(P) -> Option<P>,
) -> Vec<u32> {
    let mut first = 0;
    let mut groups = old.map(|group| {
        let begin = first;
        first += group.len() as u32;
        (begin..).zip(group).filter_map(|(index, &pair)| Some((index, renamed(pair)?))).peekable()
    });
    let find = |pair: &P| {
        let mut found = NEW;
        for rest in &mut groups {
            // The compiler does not always inline `next_if`, whose calls cost more than these looks.
            while rest.peek().is_some_and(|(_, old)| old < pair) {
                rest.next();
            }
            if let Some((index, _)) = rest.peek().filter(|(_, old)| old == pair) {
                found = *index;
            }
        }
        found
    };
    new.iter().map(find).collect()
}

/// The group to which a pair belongs: 0 if it touches, 1 if it nearly does, 2 otherwise.
fn group_of(pair: AtomPair, bodies: &Bodies, margin: f64) -> usize {
    let between = bodies.atom_place(pair.b as usize) - bodies.atom_place(pair.a as usize);
    let (squared, reach) = (between.length_squared(), pair.reach(bodies));
    let apart = |gap: f64| usize::from(squared > (reach + gap) * (reach + gap));
    apart(0.0) + apart(CLOSE * margin)
}

/// Puts those first that touch, then those that nearly do.
fn group(pairs: &mut CandidatePairs, bodies: &Bodies, margin: f64) {
    let mut groups = [const { Vec::new() }; 3];
    for (&pair, &before) in pairs.atoms.iter().zip(&pairs.atoms_before) {
        groups[group_of(pair, bodies, margin)].push((pair, before));
    }
    pairs.group_ends = [groups[0].len(), groups[0].len() + groups[1].len()];
    (pairs.atoms, pairs.atoms_before) = groups.into_iter().flatten().unzip();
}

/// The search that suits so many atoms: from some two hundred on cells are faster.
fn suiting(bodies: &Bodies) -> Search {
    if bodies.atom_count() <= bounds::MOST_ATOMS { Search::Sweep } else { Search::Cells }
}

/// Gives the atoms of some bodies that are near walls: wall by wall, each in the order of the bodies.
fn each_wall_pair(
    bodies: &Bodies,
    margin: f64,
    among: impl Iterator<Item = usize> + Clone,
    mut see: impl FnMut(SurfacePair),
) {
    for index in bodies.single_walls() {
        let wall = &bodies.walls[index];
        for body in among.clone().filter(|&body| bodies.dynamic[body] && bodies.collides[body]) {
            if wall.nearest(bodies.position[body]).height > bodies.extent(body) + margin {
                continue;
            }
            for atom in bodies.atoms_of(body).filter(|&atom| bodies.probes(atom)) {
                let (at, radius) = bodies.meeting_wall(wall, atom);
                if wall.nearest(at).height < radius + margin {
                    see(SurfacePair::new(index as u32, atom as u32));
                }
            }
        }
    }
}
