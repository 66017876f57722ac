//! The broad phase: who may touch whom. Few atoms are found by their bodies' boxes (`sweep.rs`), many by cells (`cells.rs`);
//! both find the same pairs.
//!
//! Each candidate pair has a place in a list sorted by atoms, which is a function of keys and positions only. Of many atoms the
//! pairs that touch as the list is made stand first, then those that nearly do, then the others, each group sorted: so the
//! work on several pairs side by side is on pairs that touch, and those that are far are passed over together. When the list is made anew every pair that was in the old one is told
//! its old place, so that whoever keeps history beside the list can carry it over. Where most bodies sleep the list stays, unless
//! those that are awake have come near to others (`still.rs`).

mod at_start;
mod cells;
mod identity;
mod still;
mod sweep;

pub use at_start::OverlapAtStart;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use self::cells::Sorted;
use self::identity::Identities;
use self::still::Still;
pub use crate::tick::FindPairs;
use crate::tick::bounds::{self, Bounds};
use crate::tick::{AfterLoad, Evaluate, EvaluateStage, SearchPairs, TickAppExt};
use crate::world::Bodies;

/// Marks a pair that was not in the list before.
pub const NEW: u32 = u32::MAX;

/// A pair of atoms of different bodies that are nearer than the margin. `a` stands before `b` in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallPair {
    /// Place of the wall.
    pub wall: u32,
    /// Place of the atom.
    pub atom: u32,
}

/// Who may touch whom, in canonical order.
#[derive(Resource, Debug, Default)]
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
    bounds_version: u64,
    generation: u64,
    /// What stays the same when places change.
    identities: Identities,
    wall_count: usize,
    /// Where most bodies are asleep: what stays of the lists as long as those do.
    still: Option<Still>,
}

/// Registers the search. Contact laws add it and order themselves after [`FindPairs`]. Adding it twice does nothing.
pub fn plugin(app: &mut App) {
    bounds::plugin(app);
    if !app.world().contains_resource::<CandidatePairs>() {
        app.init_resource::<CandidatePairs>();
        let system = find_pairs.in_set(SearchPairs).in_set(FindPairs).in_set(EvaluateStage::Contacts);
        app.add_flight_systems(Evaluate, system);
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(at_start::note_overlaps);
    }
}

/// Makes the lists anew when the bounding boxes were.
pub fn find_pairs(bodies: Res<Bodies>, mut bounds: ResMut<Bounds>, mut pairs: ResMut<CandidatePairs>) {
    pairs.update(&bodies, &mut bounds);
}

impl CandidatePairs {
    /// Makes the lists anew when the bounding boxes were.
    #[inline]
    pub(super) fn update(&mut self, bodies: &Bodies, bounds: &mut Bounds) {
        if self.bounds_version != bounds.version {
            self.bounds_version = bounds.version;
            if !self.still.as_ref().is_some_and(|still| still.holds(bodies, bounds)) {
                self.renew(bodies, bounds);
            }
        }
    }

    fn renew(&mut self, bodies: &Bodies, bounds: &mut Bounds) {
        self.version += 1;
        let old_atoms = std::mem::take(&mut self.atoms);
        let [touching, close] = std::mem::take(&mut self.group_ends);
        let old_walls = std::mem::take(&mut self.walls);
        self.search = Search::suiting(bodies);
        let sorted = (self.search == Search::Cells).then(|| Sorted::of(bodies, bounds.margin));
        self.atoms = sorted.as_ref().map_or_else(|| sweep::pairs(bodies, bounds), |sorted| sorted.pairs(bodies));
        self.walls.clear();
        each_wall_pair(bodies, bounds.margin, 0..bodies.len(), |pair| self.walls.push(pair));
        bounds.candidates = self.atoms.len() + self.walls.len();
        let same = self.generation == bodies.generation;
        let places = if same { None } else { Some(self.identities.places_in(&Identities::of(bodies))) };
        let place = |old: u32| {
            places
                .as_ref()
                .map_or(Some(old), |places: &Vec<u32>| Some(places[old as usize]).filter(|&place| place != NEW))
        };
        // Walls do not come and go one by one: when their number changes their history starts anew.
        let same_walls = same || self.wall_count == bodies.walls.len();
        let groups = [&old_atoms[..touching], &old_atoms[touching..close], &old_atoms[close..]];
        self.atoms_before = carry(&self.atoms, groups, |old| Some(AtomPair { a: place(old.a)?, b: place(old.b)? }));
        self.walls_before = carry(&self.walls, [&old_walls], |old| {
            Some(WallPair { wall: old.wall, atom: place(old.atom)? }).filter(|_| same_walls)
        });
        if self.search == Search::Cells {
            self.group(bodies, bounds.margin);
        }
        self.still = sorted.and_then(|sorted| Still::of(bodies, bounds, sorted, (&self.atoms, &self.walls)));
        if !same {
            self.generation = bodies.generation;
            self.wall_count = bodies.walls.len();
            self.identities = Identities::of(bodies);
        }
    }
}

/// Share of the margin that pairs are apart at the most that nearly touch.
const CLOSE: f64 = 1.0 / 8.0;

/// For each new pair the place of the same pair in the old list. The new list is sorted, and so is each group of the old one; they
/// stay so when old pairs are told their new places, because places keep the order of identities.
fn carry<P: Ord + Copy, const GROUPS: usize>(
    new: &[P],
    old: [&[P]; GROUPS],
    renamed: impl Fn(P) -> Option<P>,
) -> Vec<u32> {
    let mut first = 0;
    let mut groups = old.map(|group| {
        let begin = first;
        first += group.len() as u32;
        (begin..).zip(group).filter_map(|(place, &pair)| Some((place, renamed(pair)?))).peekable()
    });
    let find = |pair: &P| {
        let mut found = NEW;
        for rest in &mut groups {
            while rest.next_if(|(_, old)| old < pair).is_some() {}
            found = rest.next_if(|(_, old)| old == pair).map_or(found, |(place, _)| place);
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

impl CandidatePairs {
    /// Puts those first that touch, then those that nearly do.
    fn group(&mut self, bodies: &Bodies, margin: f64) {
        let mut groups = [const { Vec::new() }; 3];
        for (&pair, &before) in self.atoms.iter().zip(&self.atoms_before) {
            groups[group_of(pair, bodies, margin)].push((pair, before));
        }
        self.group_ends = [groups[0].len(), groups[0].len() + groups[1].len()];
        (self.atoms, self.atoms_before) = groups.into_iter().flatten().unzip();
    }
}

/// How pairs of atoms are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// Boxes of bodies along an axis: for few atoms.
    #[default]
    Sweep,
    /// Square cells: for many.
    Cells,
}

impl Search {
    /// The one that suits so many atoms: from some two hundred on cells are faster.
    fn suiting(bodies: &Bodies) -> Self {
        if bodies.atom_count() <= bounds::MOST_ATOMS { Self::Sweep } else { Self::Cells }
    }

    /// In words.
    pub fn told(self) -> &'static str {
        match self {
            Self::Sweep => "boxes swept along an axis",
            Self::Cells => "cells with a skin",
        }
    }
}

/// Shows the atoms of some bodies that are near walls: wall by wall, for each in the order of the bodies.
fn each_wall_pair(
    bodies: &Bodies,
    margin: f64,
    among: impl Iterator<Item = usize> + Clone,
    mut see: impl FnMut(WallPair),
) {
    for (place, wall) in bodies.walls.iter().enumerate() {
        for body in among.clone().filter(|&body| bodies.dynamic[body] && bodies.collides[body]) {
            let height = (bodies.position[body] - wall.point).dot(wall.normal);
            if height > bodies.extent(body) + margin {
                continue;
            }
            for atom in bodies.atoms_of(body) {
                let height = (bodies.atom_place(atom) - wall.point).dot(wall.normal);
                if height < bodies.atom_radius[atom] + margin {
                    see(WallPair { wall: place as u32, atom: atom as u32 });
                }
            }
        }
    }
}
