//! The silhouette of a body: the union of its discs, drawn at once, so that no seam shows between neighbours.
//!
//! A straight strip joins discs of one size that touch, and the pinholes between four discs are closed. So a body looks
//! as massive as it is. The outline lies inside the edge, so the edge of the picture is the edge of the discs. Parts
//! with sides are drawn by their distance too, so that they join discs without a seam.

use glam::DVec2;

use super::canvas::{Canvas, Ink, blend, fill, span};
use jostle_frames::frame::{Disc, HullLook};

/// Discs count as touching up to this share of the sum of their radii beyond it.
const TOUCH: f64 = 1e-3;

/// A packing of equal discs in which each touches more than this many has no pinholes to close.
const NEIGHBORS_OF_A_LATTICE: usize = 6;

/// Discs that touch more others than this on average leave neither seams nor pinholes between them.
const MOST_BONDS: usize = 64;

/// Pairs that are looked at for bonds, at most: a second's work.
const MOST_LOOKS: usize = 1 << 28;

/// A strip with round ends, from `from` to `to`, in pixels from the body's centre with y up. A disc is a strip whose
/// ends agree.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Strip {
    from: DVec2,
    to: DVec2,
    radius: f64,
}

/// The shape of one body, in pixels.
#[derive(Clone, Debug)]
pub(super) struct Silhouette {
    strips: Vec<Strip>,
    polygons: Vec<Polygon>,
}

/// A convex polygon, counter-clockwise, grown by a radius, in pixels from the body's centre with y up.
#[derive(Clone, Debug, PartialEq)]
struct Polygon {
    corners: Vec<DVec2>,
    cuts: Vec<bool>,
    radius: f64,
}

/// The pose of a body in the picture: centre in pixels, and direction of its x axis with y up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) cosine: f64,
    pub(super) sine: f64,
}

impl Stand {
    /// A point of the body in the picture.
    pub(super) fn place(&self, offset: DVec2) -> (f32, f32) {
        let x = self.x + offset.x * self.cosine - offset.y * self.sine;
        let y = self.y - (offset.x * self.sine + offset.y * self.cosine);
        (x as f32, y as f32)
    }
}

/// The distances of the pixels of a box to a body. Kept from body to body to spare allocations.
#[derive(Debug, Default)]
pub(super) struct Field {
    distances: Vec<f32>,
}

impl Silhouette {
    /// The shape of the discs and hulls of a body at a scale.
    pub(super) fn new(discs: &[Disc], hulls: &[HullLook], pixels_per_meter: f64) -> Silhouette {
        let bonds = bonds(discs);
        let mut bonded = vec![false; discs.len()];
        for &(a, b) in &bonds {
            bonded[a] = true;
            bonded[b] = true;
        }
        // A strip holds the discs at its ends; only those without one are drawn by themselves.
        let alone = (0..discs.len()).filter(|&disc| !bonded[disc]).map(|disc| (disc, disc));
        let strip = |(a, b): (usize, usize)| Strip {
            from: discs[a].offset * pixels_per_meter,
            to: discs[b].offset * pixels_per_meter,
            radius: discs[a].radius * pixels_per_meter,
        };
        // As wide as the square's diagonal, a disc in its middle lies within the strips around it.
        let closure = |(a, b): (usize, usize)| {
            let middle = 0.5 * (discs[a].offset + discs[b].offset) * pixels_per_meter;
            let radius = 0.5 * discs[a].offset.distance(discs[b].offset) * pixels_per_meter;
            Strip { from: middle, to: middle, radius }
        };
        let closed = closures(discs, &bonds).into_iter().map(closure);
        let bars = hulls.iter().filter_map(|hull| match hull.corners[..] {
            [from, to] => {
                let [from, to] = [from, to].map(|end| end * pixels_per_meter);
                Some(Strip { from, to, radius: hull.radius * pixels_per_meter })
            }
            _ => None,
        });
        let polygons = hulls.iter().filter(|hull| hull.corners.len() > 2).map(|hull| Polygon {
            corners: hull.corners.iter().map(|corner| *corner * pixels_per_meter).collect(),
            cuts: hull.cuts.clone(),
            radius: hull.radius * pixels_per_meter,
        });
        Silhouette {
            strips: bonds.iter().copied().chain(alone).map(strip).chain(closed).chain(bars).collect(),
            polygons: polygons.collect(),
        }
    }

    /// Draws the body at its pose.
    pub(super) fn draw(&self, stand: &Stand, ink: &Ink, canvas: &mut Canvas, field: &mut Field) {
        match self.strips.as_slice() {
            [only] if only.from == only.to && self.polygons.is_empty() => {
                let (x, y) = stand.place(only.from);
                canvas.disc(x, y, only.radius as f32, ink);
            }
            strips => draw_union((strips, &self.polygons), stand, ink, canvas, field),
        }
    }
}

fn draw_union(
    (strips, polygons): (&[Strip], &[Polygon]),
    stand: &Stand,
    ink: &Ink,
    canvas: &mut Canvas,
    field: &mut Field,
) {
    let placed: Vec<Segment> = strips.iter().map(|strip| Segment::new(strip, stand)).collect();
    let outlines: Vec<Outline> = polygons.iter().map(|polygon| Outline::new(polygon, stand)).collect();
    let all = placed.iter().map(|segment| segment.reach(canvas)).chain(outlines.iter().map(|of| of.reach(canvas)));
    let seen = all.filter(|reach| !reach.is_empty());
    let Some(reach) = seen.reduce(Reach::union) else { return };
    let width = reach.columns.len();
    field.distances.clear();
    field.distances.resize(width * reach.rows.len(), f32::MAX);
    let mut lower = |own: Reach, lower: &dyn Fn(&mut [f32], f32, f32)| {
        if own.is_empty() {
            return;
        }
        for row in own.rows {
            let start = (row - reach.rows.start) * width + own.columns.start - reach.columns.start;
            let distances = &mut field.distances[start..start + own.columns.len()];
            lower(distances, own.columns.start as f32 + 0.5, row as f32 + 0.5);
        }
    };
    placed.iter().for_each(|of| lower(of.reach(canvas), &|distances, x, y| of.lower(distances, x, y)));
    outlines.iter().for_each(|of| lower(of.reach(canvas), &|distances, x, y| of.lower(distances, x, y)));
    let solid = -(ink.width + 0.5);
    for (row, distances) in reach.rows.clone().zip(field.distances.chunks_exact(width)) {
        let pixels = &mut canvas.row(row)[4 * reach.columns.start..4 * reach.columns.end];
        for (pixel, &distance) in pixels.chunks_exact_mut(4).zip(distances) {
            if distance <= solid {
                fill(pixel, ink.fill);
            } else if distance < 0.5 {
                let (color, coverage) = ink.at(distance);
                blend(pixel, color, coverage);
            }
        }
    }
}

/// A strip in the picture.
struct Segment {
    from: (f32, f32),
    along: (f32, f32),
    /// One over the squared length; 0 for a disc, whose nearest point is always its centre.
    inverse_square: f32,
    radius: f32,
}

impl Segment {
    fn new(strip: &Strip, stand: &Stand) -> Segment {
        let from = stand.place(strip.from);
        let to = stand.place(strip.to);
        let along = (to.0 - from.0, to.1 - from.1);
        let square = along.0 * along.0 + along.1 * along.1;
        let inverse_square = if square > 1e-6 { 1.0 / square } else { 0.0 };
        Segment { from, along, inverse_square, radius: (strip.radius as f32).max(0.75) }
    }

    /// The box of pixels it may touch.
    fn reach(&self, canvas: &Canvas) -> Reach {
        let half = |along: f32| 0.5 * along.abs() + self.radius + 0.5;
        Reach {
            columns: span(self.from.0 + 0.5 * self.along.0, half(self.along.0), canvas.width()),
            rows: span(self.from.1 + 0.5 * self.along.1, half(self.along.1), canvas.height()),
        }
    }

    /// Lowers the distances of a row of pixels, whose first centre is (`x`, `y`), to those of this strip.
    fn lower(&self, distances: &mut [f32], x: f32, y: f32) {
        let dy = y - self.from.1;
        let share_of_y = dy * self.along.1;
        // A 32-bit count turns into a float within vector registers; a 64-bit one would keep the loop from them.
        for (distance, column) in distances.iter_mut().zip(0_i32..) {
            let dx = x + column as f32 - self.from.0;
            let share = (dx * self.along.0 + share_of_y) * self.inverse_square;
            let share = if share > 0.0 { share } else { 0.0 };
            let share = if share < 1.0 { share } else { 1.0 };
            let to_x = dx - share * self.along.0;
            let to_y = dy - share * self.along.1;
            let own = (to_x * to_x + to_y * to_y).sqrt() - self.radius;
            *distance = if own < *distance { own } else { *distance };
        }
    }
}

/// A polygon in the picture.
struct Outline {
    sides: Vec<OutlineSide>,
    radius: f32,
}

/// A side of a polygon in the picture.
struct OutlineSide {
    from: (f32, f32),
    /// Unit direction.
    along: (f32, f32),
    length: f32,
    cut: bool,
}

impl Outline {
    fn new(polygon: &Polygon, stand: &Stand) -> Outline {
        let corners: Vec<(f32, f32)> = polygon.corners.iter().map(|corner| stand.place(*corner)).collect();
        let side = |index: usize| {
            let (from, to) = (corners[index], corners[(index + 1) % corners.len()]);
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            let length = (x * x + y * y).sqrt().max(f32::MIN_POSITIVE);
            OutlineSide { from, along: (x / length, y / length), length, cut: polygon.cuts[index] }
        };
        let sides = (0..corners.len()).map(side);
        Outline { sides: sides.collect(), radius: polygon.radius as f32 }
    }

    /// The box of pixels it may touch.
    fn reach(&self, canvas: &Canvas) -> Reach {
        let none = (f32::INFINITY, f32::NEG_INFINITY);
        let of = |number: fn(&OutlineSide) -> f32| {
            let (low, high) = self.sides.iter().map(number).fold(none, |(low, high), at| (low.min(at), high.max(at)));
            (0.5 * (low + high), 0.5 * (high - low) + self.radius + 0.5)
        };
        let (x, y) = (of(|side| side.from.0), of(|side| side.from.1));
        Reach { columns: span(x.0, x.1, canvas.width()), rows: span(y.0, y.1, canvas.height()) }
    }

    /// Lowers the distances of a row of pixels, whose first centre is (`x`, `y`), to those of this polygon.
    fn lower(&self, distances: &mut [f32], x: f32, y: f32) {
        for (distance, column) in distances.iter_mut().zip(0_i32..) {
            let own = self.distance(x + column as f32, y) - self.radius;
            *distance = if own < *distance { own } else { *distance };
        }
    }

    /// The distance of a point from the polygon without its radius: below zero inside, where cuts do not count. The highest side has
    /// the nearest place.
    fn distance(&self, x: f32, y: f32) -> f32 {
        let (mut highest, mut beyond, mut outer) = (f32::NEG_INFINITY, 0.0, f32::INFINITY);
        for OutlineSide { from, along, length, cut } in &self.sides {
            let (dx, dy) = (x - from.0, y - from.1);
            // With y down, this is the outer side of a counter-clockwise polygon.
            let height = dx * -along.1 + dy * along.0;
            let way = dx * along.0 + dy * along.1;
            let past = (way - length).max(-way).max(0.0);
            if height > highest {
                (highest, beyond) = (height, past);
            }
            if !cut {
                outer = outer.min(height * height + past * past);
            }
        }
        if highest > 0.0 { (highest * highest + beyond * beyond).sqrt() } else { -outer.sqrt() }
    }
}

/// A box of pixels.
struct Reach {
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
}

impl Reach {
    fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    fn union(self, other: Reach) -> Reach {
        Reach {
            columns: self.columns.start.min(other.columns.start)..self.columns.end.max(other.columns.end),
            rows: self.rows.start.min(other.rows.start)..self.rows.end.max(other.rows.end),
        }
    }
}

/// The pairs of discs of one size that touch, lower index first, in order. The list is empty if discs pile up by the
/// dozen. Such discs look the same without strips, whose number grows with the square of the pile.
fn bonds(discs: &[Disc]) -> Vec<(usize, usize)> {
    // A tall chain swept along x would be compared each with each.
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = discs.iter().fold(none, |(low, high), disc| (low.min(disc.offset), high.max(disc.offset)));
    let axis = usize::from((high - low).y > (high - low).x);
    let mut sorted: Vec<usize> = (0..discs.len()).collect();
    sorted.sort_by(|&a, &b| discs[a].offset[axis].total_cmp(&discs[b].offset[axis]));
    let largest = discs.iter().map(|disc| disc.radius).fold(0.0, f64::max);
    let (mut found, mut looks) = (Vec::new(), 0);
    for (rank, &a) in sorted.iter().enumerate() {
        for &b in &sorted[rank + 1..] {
            let apart = discs[b].offset - discs[a].offset;
            if apart[axis] > 2.0 * largest * (1.0 + TOUCH) {
                break;
            }
            looks += 1;
            let (ra, rb) = (discs[a].radius, discs[b].radius);
            let alike = (ra - rb).abs() <= TOUCH * ra;
            if alike && apart.length() <= (ra + rb) * (1.0 + TOUCH) {
                found.push((a.min(b), a.max(b)));
            }
        }
        if found.len() > MOST_BONDS * discs.len() || looks > MOST_LOOKS {
            return Vec::new();
        }
    }
    found.sort_unstable();
    found
}

/// One diagonal of each complete square of bonded discs that has a pinhole.
fn closures(discs: &[Disc], bonds: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let mut neighbors = vec![Vec::new(); discs.len()];
    for &(a, b) in bonds {
        neighbors[a].push(b);
        neighbors[b].push(a);
    }
    // Each diagonal with a corner that sees both its ends.
    let mut corners = Vec::new();
    for (corner, around) in neighbors.iter().enumerate().filter(|(_, around)| around.len() <= NEIGHBORS_OF_A_LATTICE) {
        for (index, &a) in around.iter().enumerate() {
            for &b in &around[index + 1..] {
                let longest = 2.0 * std::f64::consts::SQRT_2 * discs[a].radius * (1.0 + TOUCH);
                let near = discs[a].offset.distance(discs[b].offset) <= longest;
                if near && !neighbors[a].contains(&b) {
                    corners.push((a.min(b), a.max(b), corner));
                }
            }
        }
    }
    // A complete square is seen from two corners. If these two touch each other, there is no pinhole between them.
    corners.sort_unstable();
    let complete = corners
        .windows(2)
        .filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) && !neighbors[pair[0].2].contains(&pair[1].2));
    let mut squares: Vec<_> = complete
        .map(|pair| {
            let (a, b) = (pair[0].0, pair[0].1);
            let mut square = [a, b, pair[0].2, pair[1].2];
            square.sort_unstable();
            (square, (a, b))
        })
        .collect();
    squares.sort_unstable();
    squares.dedup_by_key(|(square, _)| *square);
    squares.into_iter().map(|(_, diagonal)| diagonal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use jostle_frames::frame::Rgb;
    use tiny_skia::Pixmap;

    fn grid(rows: &[&str]) -> Vec<Disc> {
        let row = |(y, line): (usize, &&str)| {
            let disc = move |(x, _)| Disc { offset: DVec2::new(x as f64, -(y as f64)), radius: 0.5 };
            line.chars().enumerate().filter(|(_, letter)| *letter == '#').map(disc).collect::<Vec<_>>()
        };
        rows.iter().enumerate().flat_map(row).collect()
    }

    #[test]
    fn neighbours_are_joined_and_complete_squares_closed() {
        let discs = grid(&["##.", "##.", "..#"]);
        assert_eq!(bonds(&discs), [(0, 1), (0, 2), (1, 3), (2, 3)]);
        assert_eq!(closures(&discs, &bonds(&discs)), [(0, 3)]);
        // Three of four: the inner corner stays open.
        let corner = grid(&["##", "#."]);
        assert_eq!(closures(&corner, &bonds(&corner)), []);
    }

    /// Along such a chain every disc sees two others far apart: nothing is open between them.
    #[test]
    fn a_chain_of_overlapping_discs_has_nothing_to_close() {
        let chain: Vec<Disc> =
            (0..6).map(|k| Disc { offset: DVec2::new(0.35 * f64::from(k), 0.0), radius: 0.5 }).collect();
        assert_eq!(closures(&chain, &bonds(&chain)), []);
    }

    /// A chain in which each disc overlaps many gets its strips. A heap of discs does not, because its strips would
    /// take gigabytes.
    #[test]
    fn discs_by_the_thousand_in_one_place_are_drawn_by_themselves() {
        let chain = |step: f64| -> Vec<Disc> {
            (0..3000).map(|k| Disc { offset: DVec2::new(step * f64::from(k), 0.0), radius: 0.5 }).collect()
        };
        assert!(bonds(&chain(0.02)).len() > 49 * 2900);
        let turned = |disc: Disc| Disc { offset: disc.offset.perp(), ..disc };
        assert_eq!(bonds(&chain(0.02)), bonds(&chain(0.02).into_iter().map(turned).collect::<Vec<_>>()));
        let column = (0..100_000).map(|k| Disc { offset: DVec2::new(0.0, 0.9 * f64::from(k)), radius: 0.5 });
        assert_eq!(bonds(&column.collect::<Vec<_>>()).len(), 99_999);
        let heap = chain(1e-9);
        assert_eq!(bonds(&heap), []);
        assert_eq!(Silhouette::new(&heap, &[], 10.0).strips.len(), heap.len());
    }

    #[test]
    fn discs_of_different_size_are_not_joined() {
        let small = Disc { offset: DVec2::ZERO, radius: 0.1 };
        let large = Disc { offset: DVec2::new(0.3, 0.0), radius: 0.2 };
        assert_eq!(bonds(&[small, large]), []);
    }

    #[test]
    fn a_body_turns_counter_clockwise() {
        let stand = Stand { x: 10.0, y: 20.0, cosine: 0.0, sine: 1.0 };
        // A quarter turn brings its right side to the top, and its top to the left. Up means a smaller y in the
        // picture.
        assert_eq!(stand.place(DVec2::new(3.0, 0.0)), (10.0, 17.0));
        assert_eq!(stand.place(DVec2::new(0.0, 3.0)), (7.0, 20.0));
    }

    #[test]
    fn a_block_is_one_flat_area_inside_its_outline() {
        let ink = Ink { fill: Rgb(200, 100, 50), outline: Rgb(10, 20, 30), width: 2.0 };
        let mut pixmap = Pixmap::new(80, 80).expect("small");
        let silhouette = Silhouette::new(&grid(&["####", "####", "####"]), &[], 16.0);
        let stand = Stand { x: 20.0, y: 20.0, cosine: 0.8, sine: -0.6 };
        silhouette.draw(&stand, &ink, &mut Canvas::new(&mut pixmap), &mut Field::default());
        // Along a line through the body in its own frame, all pixels well inside have the fill.
        for step in 0..=30 {
            let (x, y) = stand.place(DVec2::new(1.6 * f64::from(step), -8.0));
            let pixel = pixmap.pixel(x as u32, y as u32).expect("inside");
            assert_eq!((pixel.red(), pixel.green(), pixel.blue()), (200, 100, 50), "step {step}");
        }
    }
}
