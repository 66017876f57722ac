//! Linked cells (Hockney and Eastwood 1981): atoms are sorted into squares as wide as the reach of most of them. Each
//! is compared with those of the nine squares around it, in one pass over lists in row order.
//!
//! Atoms much larger than most are kept beside the cells, and each is compared with all cells that it covers. So one
//! large disc under a thousand grains does not make all cells as large as itself. It costs no more than the cells under
//! it.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec2;

use super::AtomPair;
use crate::threads::Threads;
use crate::world::Bodies;
use crate::world::chunk::parts_of;
use serde::{Deserialize, Serialize};

/// Atoms of the smallest part of a search.
const FEWEST: usize = 4096;
/// An atom is large if its radius exceeds that of most by this factor.
const LARGE: f64 = 2.0;
/// The share of atoms that counts as most.
const MOST: f64 = 0.75;
/// The most fine cells along a side. With more, rounding could separate near atoms by two cells. Atoms farther from the
/// middle are in the first or in the last cell.
const LONGEST: f64 = 1e7;
/// Cells per atom, at most.
const CELLS_PER_ATOM: f64 = 4.0;
/// With this many times as many fine cells, empty ones are removed.
const WASTE: f64 = 16.0;

/// An atom or a hull as the search sees it: a circle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Entry {
    pub center: DVec2,
    /// Radius and half the margin.
    pub reach: f64,
    /// The atom, or the first corner of the hull.
    pub atom: u32,
    pub body: u32,
}

/// Atoms that touch something, sorted into cells; those much larger than most aside.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Sorted {
    all: Vec<Entry>,
    large: Vec<Entry>,
    cells: Cells,
}

impl Sorted {
    /// Whether all entries are of these bodies, and each cell has its entries. A file has no list of them
    /// ([`Sorted::without_list`]). Entries in the order of cells make the same cells.
    pub fn fits(&self, bodies: &Bodies) -> bool {
        let Self { all, large, cells } = self;
        let own = |entry: &Entry| {
            let (atom, body) = (entry.atom as usize, entry.body as usize);
            atom < bodies.atom_count() && body < bodies.len() && entry.center.is_finite() && entry.reach.is_finite()
        };
        all.is_empty() && large.iter().chain(&cells.entries).all(own) && *cells == Cells::of(&cells.entries)
    }

    /// All atoms, each with half of the margin around it.
    pub fn of(bodies: &Bodies, margin: f64) -> Self {
        Self::among(bodies, margin, 0..bodies.atom_count())
    }

    /// Some of them.
    pub fn among(bodies: &Bodies, margin: f64, atoms: impl Iterator<Item = usize>) -> Self {
        Self::entries(bodies, atoms.map(|atom| Entry::atom(bodies, margin, atom)))
    }

    /// Those that touch something.
    pub fn entries(bodies: &Bodies, entries: impl Iterator<Item = Entry>) -> Self {
        let touching = |entry: &Entry| bodies.collides[entry.body as usize] && entry.center.is_finite();
        let mut all: Vec<Entry> = entries.filter(touching).collect();
        let limit = LARGE * usual_reach(&all);
        let large: Vec<Entry> = all.iter().copied().filter(|entry| entry.reach > limit).collect();
        all.retain(|entry| entry.reach <= limit);
        let cells = Cells::of(&all);
        Self { all, large, cells }
    }

    /// The same for others to be looked for among it: without the list of all.
    pub fn without_list(self) -> Self {
        Self { all: Vec::new(), ..self }
    }

    /// All near pairs of atoms of different bodies that are not both at rest, in canonical order. Near means below the
    /// margin. If there are more than `most`, it returns only some of them, but more than `most`.
    pub fn pairs(&self, bodies: &Bodies, most: usize) -> Vec<AtomPair> {
        let among = self.cells.all_pairs(&bodies.threads, most, |a, b| moves(bodies, a, b));
        let mut pairs = in_order(among, bodies.atom_count());
        let sorted = pairs.len();
        self.each_of_large(bodies, |pair| {
            pairs.push(pair);
            pairs.len() <= most
        });
        if pairs.len() > sorted {
            // Two sorted runs and a little more: nearly linear.
            pairs.sort();
        }
        pairs
    }

    /// Shows pairs of which one at least is large, until `see` has seen enough.
    fn each_of_large(&self, bodies: &Bodies, mut see: impl FnMut(AtomPair) -> bool) {
        let mut more = true;
        for (index, entry) in self.large.iter().enumerate() {
            let mut look = |other: &Entry| {
                if more && moves(bodies, entry.body, other.body) {
                    more = see(entry.with(other));
                }
            };
            self.cells.near(entry, self.cells.reach, &mut look);
            self.large[index + 1..].iter().filter(|other| are_near(entry, other)).for_each(look);
            if !more {
                break;
            }
        }
    }

    /// Gives the same pairs as [`Sorted::pairs`], in any order, and those with one of `others`. `counts` selects the
    /// bodies. If there are more than `most`, it gives only some of them, but more than `most`.
    pub fn each_pair(
        &self,
        bodies: &Bodies,
        most: usize,
        (others, counts): (&Self, impl Fn(u32) -> bool),
        mut see: impl FnMut(AtomPair),
    ) {
        let mut count = 0;
        let mut see = |pair: AtomPair| {
            count += 1;
            see(pair);
            count <= most
        };
        let among = self.cells.all_pairs(&bodies.threads, most, |a, b| moves(bodies, a, b));
        if !among.into_iter().flatten().all(&mut see) {
            return;
        }
        self.each_of_large(bodies, &mut see);
        for entry in self.all.iter().chain(&self.large) {
            let mut more = true;
            let mut look = |other: &Entry| {
                if more && counts(other.body) && moves(bodies, entry.body, other.body) {
                    more = see(entry.with(other));
                }
            };
            others.cells.near(entry, others.cells.reach, &mut look);
            others.large.iter().filter(|other| are_near(entry, other)).for_each(look);
            if !more {
                break;
            }
        }
    }
}

fn moves(bodies: &Bodies, a: u32, b: u32) -> bool {
    bodies.dynamic[a as usize] || bodies.dynamic[b as usize]
}

impl Entry {
    /// An atom with half of the margin around it.
    pub fn atom(bodies: &Bodies, margin: f64, atom: usize) -> Self {
        Self {
            center: bodies.atom_place(atom),
            reach: bodies.atom_radius[atom] + margin / 2.0,
            atom: atom as u32,
            body: bodies.atom_body(atom) as u32,
        }
    }

    fn with(&self, other: &Self) -> AtomPair {
        AtomPair { a: self.atom.min(other.atom), b: self.atom.max(other.atom) }
    }
}

/// Sorts found pairs into canonical order, first by the first atom and then by the second.
fn in_order(found: Vec<Vec<AtomPair>>, atoms: usize) -> Vec<AtomPair> {
    let mut first = vec![0_u32; atoms + 1];
    for pair in found.iter().flatten() {
        first[pair.a as usize + 1] += 1;
    }
    for atom in 0..atoms {
        first[atom + 1] += first[atom];
    }
    let mut pairs = vec![AtomPair { a: 0, b: 0 }; first[atoms] as usize];
    let mut next = first.clone();
    for &pair in found.iter().flatten() {
        let slot = &mut next[pair.a as usize];
        pairs[*slot as usize] = pair;
        *slot += 1;
    }
    for own in first.windows(2) {
        pairs[own[0] as usize..own[1] as usize].sort_unstable();
    }
    pairs
}

/// Gives pairs of atoms of different bodies that overlap and are not both at rest. It ends when `see` returns false or
/// after `looks` pairs. Returns whether all were given.
pub(super) fn overlapping(bodies: &Bodies, mut looks: usize, mut see: impl FnMut(AtomPair) -> bool) -> bool {
    let Sorted { all, large, cells } = Sorted::of(bodies, 0.0);
    let mut go_on = true;
    let mut look = |entry: &Entry, others: &[Entry], twice: bool| {
        let others = &others[..others.len().min(looks)];
        looks -= others.len();
        for other in others.iter().filter(|other| are_near(entry, other) && moves(bodies, entry.body, other.body)) {
            if !twice || other.atom > entry.atom {
                go_on &= see(entry.with(other));
            }
        }
        go_on &= looks > 0;
        go_on
    };
    for entry in &all {
        let mut more = true;
        cells.around(entry, cells.reach, |others| more = look(entry, others, true));
        if !more {
            return false;
        }
    }
    for (index, entry) in large.iter().enumerate() {
        cells.around(entry, cells.reach, |others| _ = look(entry, others, false));
        if !look(entry, &large[index + 1..], false) {
            return false;
        }
    }
    true
}

/// The reach that most atoms do not exceed.
fn usual_reach(all: &[Entry]) -> f64 {
    let mut reaches: Vec<f64> = all.iter().map(|entry| entry.reach).collect();
    if reaches.is_empty() {
        return 0.0;
    }
    let most = ((reaches.len() - 1) as f64 * MOST) as usize;
    *reaches.select_nth_unstable_by(most, f64::total_cmp).1
}

/// The median position: that of most atoms, even if some are far away.
fn median(all: &[Entry], place: fn(&Entry) -> f64) -> f64 {
    let mut places: Vec<f64> = all.iter().map(place).collect();
    let middle = places.len() / 2;
    *places.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A cell of more entries than this is looked at body by body. The lists that this needs cost as much as some dozens of comparisons.
const CROWDED: usize = 64;

#[inline]
fn are_near(a: &Entry, b: &Entry) -> bool {
    let reach = a.reach + b.reach;
    a.body != b.body && a.center.distance_squared(b.center) < reach * reach
}

/// Cells along one axis.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Axis {
    low: f64,
    /// Fine cells per metre.
    per_meter: f64,
    /// The last fine cell: what lies beyond is in it.
    last: u64,
    /// Fine cells with contents, from low to high, each with its number among the kept ones. Of the empty cells between
    /// two of them one is kept. Empty list: all are kept.
    taken: Vec<(u64, u64)>,
    /// Cells that are kept and count as one.
    merged: u64,
    count: usize,
}

impl Axis {
    fn fine(&self, place: f64) -> u64 {
        // Below all is the first.
        (((place - self.low) * self.per_meter) as u64).min(self.last)
    }

    /// The cell of a place. Places nearer than the width of a fine cell are in one cell or in neighbours.
    fn cell(&self, place: f64) -> usize {
        let fine = self.fine(place);
        let kept = if self.taken.is_empty() {
            fine
        } else {
            let next = self.taken.partition_point(|(taken, _)| *taken <= fine);
            let (taken, number) = self.taken[next.saturating_sub(1)];
            number + u64::from(taken < fine)
        };
        let cell = if self.merged == 1 { kept } else { kept / self.merged };
        (cell as usize).min(self.count - 1)
    }

    /// Leaves out what lies empty.
    fn compress(&mut self, places: impl Iterator<Item = f64>) {
        let mut fine: Vec<u64> = places.map(|place| self.fine(place)).collect();
        fine.sort_unstable();
        fine.dedup();
        let mut number = 0;
        let mut before = None;
        self.taken = fine
            .into_iter()
            .map(|fine| {
                number += before.map_or(0, |before| 2.min(fine - before));
                before = Some(fine);
                (fine, number)
            })
            .collect();
        self.count = number as usize + 1;
    }

    fn merge(&mut self, cells: u64) {
        self.merged = cells;
        self.count = (self.count as u64).div_ceil(cells) as usize;
    }
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Cells {
    columns: Axis,
    rows: Axis,
    /// First entry of each cell, row by row, and the number of entries at the end.
    first: Vec<u32>,
    entries: Vec<Entry>,
    /// The greatest reach of any.
    reach: f64,
}

impl Cells {
    fn of(all: &[Entry]) -> Self {
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0_f64);
        let (low, high, reach) = all.iter().fold(none, |(low, high, reach), entry| {
            (low.min(entry.center), high.max(entry.center), reach.max(entry.reach))
        });
        // A little wider, so that rounding never separates near atoms by two cells.
        let width = (2.000_000_01 * reach).max(f64::MIN_POSITIVE);
        let axis = |low: f64, high: f64, place: fn(&Entry) -> f64| {
            let longest = LONGEST * width;
            let (low, length) = match all {
                [] => (0.0, 0.0),
                all if high - low > longest => (median(all, place) - 0.5 * longest, longest),
                _ => (low, high - low),
            };
            let (per_meter, last) = (1.0 / width, (length / width) as u64);
            Axis { low, per_meter, last, taken: Vec::new(), merged: 1, count: last as usize + 1 }
        };
        let mut columns = axis(low.x, high.x, |entry| entry.center.x);
        let mut rows = axis(low.y, high.y, |entry| entry.center.y);
        let most = CELLS_PER_ATOM * all.len().max(1) as f64;
        let cells = |columns: &Axis, rows: &Axis| columns.count as f64 * rows.count as f64;
        if cells(&columns, &rows) > WASTE * most {
            // A body lies far from the rest.
            columns.compress(all.iter().map(|entry| entry.center.x));
            rows.compress(all.iter().map(|entry| entry.center.y));
        }
        let merged = (cells(&columns, &rows) / most).sqrt().ceil().max(1.0) as u64;
        columns.merge(merged);
        rows.merge(merged);
        let first = vec![0; columns.count * rows.count + 1];
        let mut cells = Self { columns, rows, first, entries: Vec::new(), reach };
        let (columns, rows) = (cells.columns.count, cells.rows.count);
        let places: Vec<u32> = all.iter().map(|entry| cells.cell(entry.center) as u32).collect();
        for &place in &places {
            cells.first[place as usize + 1] += 1;
        }
        for cell in 0..columns * rows {
            cells.first[cell + 1] += cells.first[cell];
        }
        let mut next = cells.first.clone();
        cells.entries = vec![Entry::default(); all.len()];
        for (entry, &place) in all.iter().zip(&places) {
            let slot = &mut next[place as usize];
            cells.entries[*slot as usize] = *entry;
            *slot += 1;
        }
        cells
    }

    fn column_and_row(&self, place: DVec2) -> (usize, usize) {
        (self.columns.cell(place.x), self.rows.cell(place.y))
    }

    fn cell(&self, place: DVec2) -> usize {
        let (column, row) = self.column_and_row(place);
        row * self.columns.count + column
    }

    /// Pairs of near entries of different bodies, each once, if their bodies are wanted. The order is band by band of
    /// rows, then by cells. The search ends when it has found more than `most`.
    fn all_pairs(
        &self,
        threads: &Threads,
        most: usize,
        wanted: impl Fn(u32, u32) -> bool + Sync,
    ) -> Vec<Vec<AtomPair>> {
        let total = AtomicUsize::new(0);
        let bands = parts_of(self.entries.len(), FEWEST).min(self.rows.count);
        let mut found = vec![Vec::new(); bands];
        let each = self.rows.count.div_ceil(bands);
        threads.each(found.iter_mut().enumerate().collect(), |(band, found): (usize, &mut Vec<AtomPair>)| {
            let rows = band * each..self.rows.count.min((band + 1) * each);
            found.reserve(3 * self.entries.len() / bands);
            for row in rows {
                let before = found.len();
                self.pairs_of_row(row, &wanted, most, found);
                let new = found.len() - before;
                if total.fetch_add(new, Ordering::Relaxed) + new > most {
                    break;
                }
            }
        });
        found
    }

    /// The pairs of a row with later entries of the row, and with the next row.
    fn pairs_of_row(&self, row: usize, wanted: &impl Fn(u32, u32) -> bool, most: usize, found: &mut Vec<AtomPair>) {
        let columns = self.columns.count;
        let (begin, end) = (row * columns, (row + 1) * columns);
        for cell in begin..end {
            let own = self.first[cell] as usize..self.first[cell + 1] as usize;
            if own.is_empty() {
                continue;
            }
            let beside = self.first[end.min(cell + 2)] as usize;
            let above = if row + 1 < self.rows.count {
                let (left, right) = ((cell + columns).saturating_sub(1).max(end), cell + columns + 2);
                self.first[left] as usize..self.first[right.min(end + columns)] as usize
            } else {
                0..0
            };
            if own.len() > CROWDED {
                self.pairs_of_crowd(own, (beside, above), wanted, most, found);
                continue;
            }
            for index in own {
                if found.len() > most {
                    return;
                }
                let entry = &self.entries[index];
                for other in self.entries[index + 1..beside].iter().chain(&self.entries[above.clone()]) {
                    if are_near(entry, other) && wanted(entry.body, other.body) {
                        found.push(entry.with(other));
                    }
                }
            }
        }
    }

    /// The pairs of a cell of many entries: `own` with later ones up to `beside`, and with those `above`. Entries of one body follow
    /// each other in a cell, and are passed over together. So a body whose atoms all lie at one place costs no square of their number.
    fn pairs_of_crowd(
        &self,
        own: Range<usize>,
        (beside, above): (usize, Range<usize>),
        wanted: &impl Fn(u32, u32) -> bool,
        most: usize,
        found: &mut Vec<AtomPair>,
    ) {
        let runs = |entries: Range<usize>| {
            let mut from = entries.start;
            self.entries[entries].chunk_by(|a, b| a.body == b.body).map(move |run| {
                from += run.len();
                from - run.len()..from
            })
        };
        let all: Vec<Range<usize>> = runs(own.start..beside).chain(runs(above)).collect();
        for index in own {
            let entry = &self.entries[index];
            for run in all.iter().filter(|run| self.entries[run.start].body != entry.body) {
                if found.len() > most {
                    return;
                }
                // Those above lie in a later row, so all indices behind this one count.
                for other in &self.entries[run.start.max(index + 1)..run.end.max(index + 1)] {
                    if are_near(entry, other) && wanted(entry.body, other.body) {
                        found.push(entry.with(other));
                    }
                }
            }
        }
    }

    /// Shows all entries of other bodies near to one; `reach` is the greatest that they have.
    #[inline]
    fn near(&self, entry: &Entry, reach: f64, mut see: impl FnMut(&Entry)) {
        self.around(entry, reach, |others| {
            others.iter().filter(|other| are_near(entry, other)).for_each(&mut see);
        });
    }

    /// Shows all entries that may be near to one, and others; `reach` is the greatest that they have.
    #[inline]
    fn around(&self, entry: &Entry, reach: f64, mut see: impl FnMut(&[Entry])) {
        if self.entries.is_empty() {
            return;
        }
        let around = DVec2::splat(entry.reach + reach);
        let (first_column, first_row) = self.column_and_row(entry.center - around);
        let (last_column, last_row) = self.column_and_row(entry.center + around);
        for row in first_row..=last_row {
            let first = self.first[row * self.columns.count + first_column] as usize;
            let last = self.first[row * self.columns.count + last_column + 1] as usize;
            see(&self.entries[first..last]);
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use bevy_ecs::prelude::Entity;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::super::{Search, sort_and_sweep, suiting};
    use super::*;
    use crate::tick::bounds::Bounds;

    /// Discs scattered over a square; some are a hundred times as large, some do not collide, some are fixed.
    pub(in super::super) fn strewn(seed: u64, count: usize, side: f64) -> (Bodies, Bounds) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut chance = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let (mut bodies, mut bounds) = (Bodies::default(), Bounds::default());
        bounds.margin = 0.05;
        bodies.first_atom.push(0);
        for body in 0..count {
            let atoms = if body % 5 == 0 { 3 } else { 1 };
            let center = side * DVec2::new(chance(), chance());
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for _ in 0..atoms {
                let radius = if chance() < 0.02 { 0.3 * side * chance() } else { 0.1 + 0.1 * chance() };
                let place = center + 0.1 * DVec2::new(chance(), chance());
                bodies.atom_position.push(place);
                bodies.atom_radius.push(radius);
                bodies.atom_body.push(body as u32);
                let reach = DVec2::splat(radius + bounds.margin / 2.0);
                (low, high) = (low.min(place - reach), high.max(place + reach));
            }
            bodies.first_atom.push(bodies.atom_radius.len() as u32);
            bodies.entity.push(Entity::PLACEHOLDER);
            bodies.collides.push(chance() < 0.9);
            bodies.dynamic.push(chance() < 0.8);
            bounds.low.push(low);
            bounds.high.push(high);
        }
        (bodies, bounds)
    }

    /// Promise: one body far away, or two crowds far apart, do not put everybody into a few cells.
    #[test]
    fn what_lies_far_away_does_not_crowd_the_cells() {
        let crowd = |origin: DVec2| {
            (0..2500).map(move |index| Entry {
                center: origin + DVec2::new(f64::from(index % 50), f64::from(index / 50)),
                reach: 0.5,
                atom: index as u32,
                body: index as u32,
            })
        };
        let far = DVec2::new(-1e5, 3e4);
        for (what, all) in [
            ("one crowd", crowd(DVec2::ZERO).collect::<Vec<_>>()),
            ("and a body far away", crowd(DVec2::ZERO).chain(crowd(far).take(1)).collect()),
            ("two crowds", crowd(DVec2::ZERO).chain(crowd(far)).collect()),
            ("and a body beyond all", crowd(DVec2::ZERO).chain(crowd(1e12 * far).take(1)).collect()),
            ("and one as far as numbers go", crowd(DVec2::ZERO).chain(crowd(1e303 * far).take(1)).collect()),
        ] {
            let cells = Cells::of(&all);
            let most = cells.first.windows(2).map(|pair| pair[1] - pair[0]).max();
            // Squares of 1 m hold one disc, or a few if they are merged.
            assert!(most <= Some(36), "{what}: {most:?} in one cell");
            assert!(cells.first.len() <= 16 * all.len(), "{what}: {} cells", cells.first.len());
        }
    }

    #[test]
    fn cells_find_what_a_sweep_finds() {
        for (seed, count, side) in
            [(1, 300, 6.0), (2, 300, 60.0), (3, 2000, 12.0), (4, 7, 1.0), (5, 1, 1.0), (6, 1500, 1.2)]
        {
            let (mut bodies, mut bounds) = strewn(seed, count, side);
            if seed > 2 {
                // One of them far away.
                let far = DVec2::new(1e5, -3e6) - bodies.atom_position[0];
                for atom in bodies.atoms_of(0) {
                    bodies.atom_position[atom] += far;
                }
                (bounds.low[0], bounds.high[0]) = (bounds.low[0] + far, bounds.high[0] + far);
            }
            let found = Sorted::of(&bodies, bounds.margin).pairs(&bodies, usize::MAX);
            assert_eq!(found, sort_and_sweep::pairs(&bodies, &bounds), "seed {seed}");
            assert!(count < 10 || found.len() > 10, "{} pairs", found.len());
        }
        assert_eq!(suiting(&Bodies::default()), Search::Sweep);
    }
}
