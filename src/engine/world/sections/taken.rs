//! The places that are taken at the start, in cells. An entry of `fill` looks only at discs near its region, and at all walls, strips and
//! large discs. The numbers here decide over time and memory, and over no place.

use glam::DVec2;

use crate::scene::Obstacle;

/// A disc over more cells is large. Every entry looks at it, for it would take more memory in cells than its own.
const MOST_CELLS: usize = 16;

/// Cells for each entry. Regions side by side then have cells of their own, and all cells take less memory than the entries.
const PER_ENTRY: usize = 4;

/// Places that are taken.
pub(super) struct TakenPlaces {
    obstacles: Vec<Obstacle>,
    /// The indices of large discs, walls and strips.
    everywhere: Vec<u32>,
    /// For each cell the indices of discs that reach into it.
    cells: Vec<Vec<u32>>,
    columns: usize,
    rows: usize,
    low: DVec2,
    /// The side of a cell in metres.
    side: f64,
}

impl TakenPlaces {
    /// None yet, for entries with these regions: two opposite corners each.
    pub fn new(regions: impl ExactSizeIterator<Item = (DVec2, DVec2)>) -> Self {
        let most = (PER_ENTRY * regions.len()).max(1);
        let (low, high) = regions.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let size = high - low;
        let side = (size.x * size.y / most as f64).sqrt().max(size.max_element() / most as f64);
        let good = side.is_finite() && side > 0.0;
        let count = |length: f64| if good { (length / side).ceil().clamp(1.0, most as f64) as usize } else { 1 };
        let (columns, rows) = (count(size.x), count(size.y));
        let (obstacles, everywhere) = Default::default();
        Self { obstacles, everywhere, cells: vec![Vec::new(); columns * rows], columns, rows, low, side }
    }

    /// Takes one more place.
    pub fn add(&mut self, obstacle: Obstacle) {
        let index = self.obstacles.len() as u32;
        self.obstacles.push(obstacle);
        let cells = match obstacle {
            Obstacle::Disc { center, radius } => self.cells_of((center - radius, center + radius)),
            Obstacle::Wall { .. } | Obstacle::Strip { .. } => return self.everywhere.push(index),
        };
        if cells.clone().take(MOST_CELLS + 1).count() > MOST_CELLS {
            return self.everywhere.push(index);
        }
        cells.for_each(|cell| self.cells[cell].push(index));
    }

    /// Those that come within `reach` metres of a region, and perhaps others, in the order in which they were taken.
    pub fn near(&self, region: (DVec2, DVec2), reach: f64) -> impl Iterator<Item = Obstacle> + '_ {
        let mut near = self.everywhere.clone();
        for cell in self.cells_of((region.0 - reach, region.1 + reach)) {
            near.extend(&self.cells[cell]);
        }
        near.sort_unstable();
        near.dedup();
        near.into_iter().map(|index| self.obstacles[index as usize])
    }

    /// The cells of a box. Those at the border reach to infinity.
    fn cells_of(&self, (low, high): (DVec2, DVec2)) -> impl Iterator<Item = usize> + Clone + use<> {
        let place = |at: DVec2| {
            let place = (at - self.low) / self.side;
            ((place.x.max(0.0) as usize).min(self.columns - 1), (place.y.max(0.0) as usize).min(self.rows - 1))
        };
        let ((first, lowest), (last, highest)) = (place(low), place(high));
        let columns = self.columns;
        (lowest..=highest).flat_map(move |row| (first..=last).map(move |column| row * columns + column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: f64, y: f64, radius: f64) -> Obstacle {
        Obstacle::Disc { center: DVec2::new(x, y), radius }
    }

    #[test]
    fn an_entry_looks_at_all_places_near_its_region_and_at_few_others() {
        let region = |index: usize| (DVec2::new(0.0, 0.3 * index as f64), DVec2::new(0.1, 0.3 * index as f64 + 0.2));
        let mut taken = TakenPlaces::new((0..1000).map(region));
        let discs: Vec<Obstacle> = (0..1000).map(|index| disc(0.05, 0.3 * f64::from(index) + 0.1, 0.05)).collect();
        discs.iter().for_each(|disc| taken.add(*disc));
        for (index, own) in discs.iter().enumerate() {
            let near: Vec<Obstacle> = taken.near(region(index), 0.06).collect();
            assert!(near.contains(own), "{index}");
            assert!(near.len() <= 3, "{index}: {}", near.len());
        }
    }

    #[test]
    fn large_and_far_places_are_not_lost() {
        let mut taken =
            TakenPlaces::new((0..100).map(|x| (DVec2::new(f64::from(x), 0.0), DVec2::new(f64::from(x) + 0.5, 1.0))));
        let wall = Obstacle::Wall { left: DVec2::X, right: DVec2::ZERO };
        let all = [disc(50.0, 0.0, 40.0), wall, disc(1e9, 0.0, 1.0), disc(99.2, 0.5, 0.01)];
        all.iter().for_each(|place| taken.add(*place));
        let near = |x: f64| taken.near((DVec2::new(x, 0.0), DVec2::new(x + 0.5, 1.0)), 0.1).collect::<Vec<_>>();
        assert_eq!(near(3.0), all[..2]);
        assert_eq!(near(99.0), all);
    }
}
