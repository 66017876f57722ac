//! Discs that cover a silhouette, and the quality of the cover.

use std::collections::BinaryHeap;

use super::Mask;

/// Positions of the lattice that are tried, along each side of its cell.
const POSITIONS: usize = 6;

/// How fine the discs are to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fineness {
    /// At most so many discs of different sizes.
    Count(usize),
    /// Equal discs, with their radius as a share of the silhouette's height.
    Radius(f64),
}

/// A disc; everything is a share of the silhouette's height, the origin the middle of its lowest edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disc {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) radius: f64,
}

/// Discs and how well they cover a silhouette.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Covering {
    pub(crate) discs: Vec<Disc>,
    /// The area of the silhouette that no disc covers, as a share of the silhouette's.
    pub(crate) uncovered: f64,
    /// The area of the discs that lies outside, as a share of the silhouette's.
    pub(crate) outside: f64,
    /// The greatest distance of a point of the silhouette from the nearest disc, or the reverse. It is a share of the
    /// height.
    pub(crate) distance: f64,
}

/// A disc in pixels: the middle of the lower left one is (0, 0).
#[derive(Clone, Copy)]
struct Spot {
    x: f64,
    y: f64,
    radius: f64,
}

/// A mask with the number of counted pixels to the left of each. So a disc is counted row by row.
struct Counted<'a> {
    mask: &'a Mask,
    before: Vec<u32>,
}

impl<'a> Counted<'a> {
    fn new(mask: &'a Mask) -> Self {
        let mut counted = Self { mask, before: vec![0; (mask.columns + 1) * mask.rows] };
        for row in 0..mask.rows {
            counted.sum_row(row, &mask.inside[row * mask.columns..(row + 1) * mask.columns]);
        }
        counted
    }

    fn sum_row(&mut self, row: usize, counts: &[bool]) {
        let start = row * (self.mask.columns + 1);
        for (column, &counts) in counts.iter().enumerate() {
            self.before[start + column + 1] = self.before[start + column] + u32::from(counts);
        }
    }

    /// The pixels whose middles lie in a disc, and how many of them count.
    fn count(&self, spot: Spot) -> (u32, u32) {
        let (mut all, mut counting) = (0, 0);
        for (row, columns) in rows_of(spot, self.mask) {
            let start = row * (self.mask.columns + 1);
            all += columns.len() as u32;
            counting += self.before[start + columns.end] - self.before[start + columns.start];
        }
        (all, counting)
    }
}

/// The pixels whose middles lie in a disc, row by row.
fn rows_of(spot: Spot, mask: &Mask) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> {
    let bounds = |middle: f64, half: f64, most: usize| {
        let first = ((middle - half).ceil().max(0.0) as usize).min(most);
        let end = ((middle + half).floor() + 1.0).clamp(0.0, most as f64) as usize;
        first..end.max(first)
    };
    let columns = mask.columns;
    bounds(spot.y, spot.radius, mask.rows).map(move |row| {
        let along = row as f64 - spot.y;
        let half = (spot.radius * spot.radius - along * along).max(0.0).sqrt();
        (row, bounds(spot.x, half, columns))
    })
}

impl Mask {
    /// The height in pixels of a disc of a share of the height.
    fn pixels(&self, share: f64) -> f64 {
        share * self.rows as f64
    }

    /// About how many equal discs cover the silhouette.
    pub(crate) fn estimate(&self, radius: f64) -> f64 {
        let radius = self.pixels(radius);
        self.area() as f64 / (2.0 * 3.0_f64.sqrt() * radius * radius)
    }

    /// The height of a pixel of the grid, as a share of the height.
    pub(crate) fn resolution(&self) -> f64 {
        1.0 / self.rows as f64
    }

    /// Covers the silhouette. `None`: no disc of that radius has half of its area inside.
    pub(crate) fn cover(&self, fineness: Fineness) -> Option<Covering> {
        let margin = match fineness {
            Fineness::Count(_) => 1,
            Fineness::Radius(radius) => {
                let pixels = self.pixels(radius);
                // Less than half of such a disc could be inside.
                if std::f64::consts::PI * pixels * pixels > 2.5 * self.area() as f64 {
                    return None;
                }
                pixels.ceil() as usize + 1
            }
        };
        let grid = self.with_margin(margin);
        let spots = match fineness {
            Fineness::Count(count) => inscribed(&grid, count),
            Fineness::Radius(radius) => lattice(&grid, self.pixels(radius)),
        };
        if spots.is_empty() {
            return None;
        }
        let (uncovered, outside, distance) = errors(&grid, &spots);
        let height = self.rows as f64;
        let area = self.area() as f64;
        let disc = |spot: &Spot| Disc {
            x: (spot.x + 0.5 - grid.columns as f64 / 2.0) / height,
            y: (spot.y + 0.5 - margin as f64) / height,
            radius: spot.radius / height,
        };
        Some(Covering {
            discs: spots.iter().map(disc).collect(),
            uncovered: uncovered as f64 / area,
            outside: outside as f64 / area,
            distance: distance / height,
        })
    }
}

/// The largest discs that fit, each at the point at which it covers most of the rest (greedy).
fn inscribed(grid: &Mask, count: usize) -> Vec<Spot> {
    let squares = grid.squared_distances(false);
    let radius = |at: usize| (squares[at] as f64).sqrt() - 0.5;
    let spot = |at: usize| Spot { x: (at % grid.columns) as f64, y: (at / grid.columns) as f64, radius: radius(at) };
    // A disc inside that of a neighbour covers no more. The margin makes all neighbours exist.
    let (width, diagonal) = (grid.columns, std::f64::consts::SQRT_2);
    let neighbours = |at: usize| {
        let straight = [at - 1, at + 1, at - width, at + width].map(|near| (near, 1.0));
        let across = [at - width - 1, at - width + 1, at + width - 1, at + width + 1].map(|near| (near, diagonal));
        straight.into_iter().chain(across)
    };
    let is_largest =
        |at: &usize| neighbours(*at).all(|(near, away)| !grid.inside[near] || radius(near) + 0.1 < radius(*at) + away);
    let candidates = (0..grid.inside.len()).filter(|&at| grid.inside[at]).filter(is_largest);
    let mut counted = Counted::new(grid);
    let mut left = grid.inside.clone();
    // The gain of a disc only falls as others are placed, so an earlier count is an upper bound.
    let mut heap: BinaryHeap<(u32, std::cmp::Reverse<usize>)> =
        candidates.map(|at| (counted.count(spot(at)).1, std::cmp::Reverse(at))).collect();
    let mut spots = Vec::new();
    while let Some((_, std::cmp::Reverse(at))) = heap.pop() {
        if spots.len() == count {
            break;
        }
        let gain = counted.count(spot(at)).1;
        if gain == 0 {
            continue;
        }
        let now = (gain, std::cmp::Reverse(at));
        if heap.peek().is_some_and(|next| *next > now) {
            heap.push(now);
            continue;
        }
        spots.push(spot(at));
        for (row, columns) in rows_of(spot(at), grid) {
            left[row * width..][columns].fill(false);
            counted.sum_row(row, &left[row * width..(row + 1) * width]);
        }
    }
    spots
}

/// Equal discs side by side, rows from below.
fn lattice(grid: &Mask, radius: f64) -> Vec<Spot> {
    let counted = Counted::new(grid);
    let (across, up) = (2.0 * radius, 3.0_f64.sqrt() * radius);
    let mut best: Option<(i64, Vec<Spot>)> = None;
    for position in 0..POSITIONS * POSITIONS {
        let share = |step: usize| step as f64 / POSITIONS as f64;
        let (right, above) = (across * share(position % POSITIONS), up * share(position / POSITIONS));
        let mut spots = Vec::new();
        let mut gain = 0;
        for row in 0..=(grid.rows as f64 / up) as usize {
            let shift = if row % 2 == 0 { 0.0 } else { radius };
            for column in 0..=(grid.columns as f64 / across) as usize {
                let spot = Spot { x: right + shift + column as f64 * across, y: above + row as f64 * up, radius };
                let (all, inside) = counted.count(spot);
                if 2 * inside >= all && inside > 0 {
                    gain += 2 * i64::from(inside) - i64::from(all);
                    spots.push(spot);
                }
            }
        }
        if best.as_ref().is_none_or(|(most, _)| gain > *most) {
            best = Some((gain, spots));
        }
    }
    best.map_or_else(Vec::new, |(_, spots)| spots)
}

/// Pixels that are not covered, pixels that are covered outside, and the largest distance in pixels.
fn errors(grid: &Mask, spots: &[Spot]) -> (usize, usize, f64) {
    let mut covered = vec![false; grid.inside.len()];
    for &spot in spots {
        for (row, columns) in rows_of(spot, grid) {
            covered[row * grid.columns..][columns].fill(true);
        }
    }
    let body = Mask { inside: covered, ..*grid };
    let farthest = |from: &Mask, to: &Mask| {
        let squares = to.squared_distances(true);
        let away = (0..squares.len()).filter(|&at| from.inside[at] && !to.inside[at]).map(|at| squares[at]);
        let pixels = away.clone().count();
        // Outlines run along the edges of pixels, half a pixel from their middles.
        (pixels, away.max().map_or(0.0, |square| (square as f64).sqrt() - 0.5))
    };
    let ((uncovered, near), (outside, far)) = (farthest(grid, &body), farthest(&body, grid));
    (uncovered, outside, near.max(far))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(columns: usize, rows: usize, inside: impl Fn(f64, f64) -> bool) -> Mask {
        let at = |at: usize| inside((at % columns) as f64 + 0.5, (at / columns) as f64 + 0.5);
        Mask { columns, rows, inside: (0..columns * rows).map(at).collect() }
    }

    /// One disc covers a disc, except for a ring. Its middle is that of a pixel, with an error of up to sqrt(1/2). It
    /// also keeps half a pixel away from the outer pixels, whose edge is rough by another half.
    #[test]
    fn a_disc_is_one_atom() {
        let (side, r) = (300, 150.0);
        let mask = drawn(side, side, |x, y| (x - r) * (x - r) + (y - r) * (y - r) <= r * r);
        let found = mask.cover(Fineness::Count(1)).unwrap();
        let [Disc { x, y, radius }] = found.discs[..] else { panic!("{found:?}") };
        let pixel = mask.resolution();
        assert!(x.abs() <= pixel && (y - 0.5).abs() <= pixel && (radius - 0.5).abs() <= 2.0 * pixel, "{found:?}");
        let ring = 0.5_f64.sqrt() + 0.5 + 0.5;
        assert!(
            found.uncovered <= 2.0 * ring / r && found.outside == 0.0 && found.distance <= 2.0 * ring * pixel,
            "{found:?}"
        );
    }

    /// A strip five times as long as high holds five discs that do not overlap. They cover pi/4 of it, and no other
    /// five cover more.
    #[test]
    fn five_discs_cover_a_strip_as_far_as_discs_can() {
        let mask = drawn(500, 100, |_, _| true);
        let found = mask.cover(Fineness::Count(5)).unwrap();
        assert_eq!(found.discs.len(), 5);
        // The greedy choice need not be the best; it is not worse than half of one disc less.
        let best = 1.0 - std::f64::consts::FRAC_PI_4;
        assert!((best - 0.02..best + 0.08).contains(&found.uncovered), "{found:?}");
        assert_eq!(found.outside, 0.0);
    }

    /// Inside, a hexagonal lattice of touching discs leaves 1 - pi/sqrt(12) open. The outline of 4 sides of 64 radii
    /// each adds at most half a disc's height along it.
    #[test]
    fn a_lattice_covers_its_share() {
        let mask = drawn(384, 384, |_, _| true);
        let found = mask.cover(Fineness::Radius(1.0 / 64.0)).unwrap();
        let open = 1.0 - std::f64::consts::PI / 12.0_f64.sqrt();
        let border = 4.0 * 64.0 / (64.0 * 64.0);
        assert!((found.uncovered - open).abs() < border && found.outside < border, "{found:?}");
        assert!(found.discs.iter().all(|disc| disc.radius == 1.0 / 64.0));
        assert_eq!(mask.cover(Fineness::Radius(3.0)), None);
        assert!((mask.estimate(1.0 / 64.0) / found.discs.len() as f64 - 1.0).abs() < 0.1);
    }

    /// More discs cover more, and discs of different sizes more than equal ones.
    #[test]
    fn the_cow_is_covered() {
        let cow = Mask::read(include_bytes!("../../../../assets/silhouettes/cow.png")).unwrap();
        let errors: Vec<f64> =
            [10, 30, 100, 300].map(|count| cow.cover(Fineness::Count(count)).unwrap().uncovered).to_vec();
        assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
        let equal = cow.cover(Fineness::Radius(0.03)).unwrap();
        let greedy = cow.cover(Fineness::Count(equal.discs.len())).unwrap();
        assert!(greedy.uncovered + greedy.outside < (equal.uncovered + equal.outside) / 2.0, "{equal:?}");
    }
}
