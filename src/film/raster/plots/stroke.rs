//! Curves as the set of points near a line: the coverage of a pixel comes from the nearest segment.
//!
//! So a curve of many segments has no seams, and the picture depends on the segments alone. All arithmetic is addition,
//! multiplication, division and square root of `f32`: the same bytes on every machine.

use crate::raster::canvas::{self, Canvas, blend};
use jostle_frames::frame::Rgb;

/// A rectangle of a picture, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::raster) struct Area {
    pub(in crate::raster) left: f32,
    pub(in crate::raster) top: f32,
    pub(in crate::raster) right: f32,
    pub(in crate::raster) bottom: f32,
}

impl Area {
    pub(in crate::raster) fn width(&self) -> f32 {
        self.right - self.left
    }

    pub(in crate::raster) fn height(&self) -> f32 {
        self.bottom - self.top
    }

    /// Fills its pixels with a colour.
    pub(super) fn fill(&self, canvas: &mut Canvas, color: Rgb) {
        let (width, height) = (canvas.width(), canvas.height());
        let side = |from: f32, to: f32, end: usize| (from.max(0.0) as usize).min(end)..(to.max(0.0) as usize).min(end);
        let columns = side(self.left, self.right, width);
        for row in side(self.top, self.bottom, height) {
            canvas::fill(&mut canvas.row(row)[4 * columns.start..4 * columns.end.max(columns.start)], color);
        }
    }
}

/// A place in the picture, in pixels.
pub(super) type Point = (f32, f32);

/// Lines are drawn of lengths on and off, in pixels; empty: without gaps.
pub(super) type Dash = [f32];

/// Room to draw a curve in, kept from frame to frame to spare allocations.
#[derive(Clone, Debug, Default)]
pub(in crate::raster) struct Sheet {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    coverage: Vec<f32>,
    /// The rows with anything in them.
    rows: std::ops::Range<usize>,
}

impl Sheet {
    /// An empty sheet over the pixels that an area touches.
    pub(super) fn begin(&mut self, area: &Area) {
        (self.left, self.top) = (area.left.max(0.0) as usize, area.top.max(0.0) as usize);
        self.width = (area.right.max(0.0) as usize + 1).saturating_sub(self.left);
        self.height = (area.bottom.max(0.0) as usize + 1).saturating_sub(self.top);
        self.coverage.clear();
        self.coverage.resize(self.width * self.height, 0.0);
        self.rows = self.height..0;
    }

    /// Draws a line from point to point. `weights` are 0 to 1 for each segment; an empty list means 1.
    pub(super) fn line(&mut self, points: &[Point], width: f32, dash: &Dash, weights: &[f32]) {
        let (mut part, mut left) = (0, dash.first().copied().unwrap_or(f32::INFINITY));
        for (index, ends) in points.windows(2).enumerate() {
            let (from, to) = (ends[0], ends[1]);
            let weight = weights.get(index).copied().unwrap_or(1.0);
            let (dx, dy) = (to.0 - from.0, to.1 - from.1);
            let length = (dx * dx + dy * dy).sqrt();
            if !length.is_finite() {
                continue;
            }
            if dash.is_empty() {
                self.segment(from, to, 0.5 * width, weight);
                continue;
            }
            let mut done = 0.0;
            while done < length {
                let end = (done + left).min(length);
                let at = |way: f32| (from.0 + dx * (way / length), from.1 + dy * (way / length));
                if part % 2 == 0 {
                    self.segment(at(done), at(end), 0.5 * width, weight);
                }
                left -= end - done;
                // A gap ends with the segment or within it.
                if end < length || left <= 0.0 {
                    part = (part + 1) % dash.len();
                    left = dash[part].max(0.5);
                }
                done = end;
            }
        }
    }

    /// A segment with round ends.
    fn segment(&mut self, from: Point, to: Point, radius: f32, weight: f32) {
        let local = |(x, y): Point| (x - self.left as f32, y - self.top as f32);
        let (a, b) = (local(from), local(to));
        if ![a.0, a.1, b.0, b.1].iter().all(|side| side.is_finite()) {
            return;
        }
        let reach = radius + 0.5;
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let square = dx * dx + dy * dy;
        let rows = pixels(a.1.min(b.1) - reach, a.1.max(b.1) + reach, self.height);
        self.rows = self.rows.start.min(rows.start)..self.rows.end.max(rows.end);
        for row in rows {
            let y = row as f32 + 0.5;
            // The part of the segment that this row can reach.
            let share = |height: f32| ((height - a.1) / dy).clamp(0.0, 1.0);
            let (s, t) = if dy.abs() < 1e-3 { (0.0, 1.0) } else { (share(y - reach), share(y + reach)) };
            let (x0, x1) = (a.0 + dx * s, a.0 + dx * t);
            for column in pixels(x0.min(x1) - reach, x0.max(x1) + reach, self.width) {
                let (px, py) = (column as f32 + 0.5 - a.0, y - a.1);
                let along = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
                let (ox, oy) = (px - along * dx, py - along * dy);
                let covered = (reach - (ox * ox + oy * oy).sqrt()).clamp(0.0, 1.0) * weight;
                let place = &mut self.coverage[row * self.width + column];
                *place = place.max(covered);
            }
        }
    }

    /// Lays the drawn curves over a picture.
    pub(super) fn put(&self, canvas: &mut Canvas, color: Rgb) {
        for row in self.rows.clone() {
            let y = self.top + row;
            if y >= canvas.height() {
                break;
            }
            let pixels = canvas.row(y);
            let coverage = &self.coverage[row * self.width..(row + 1) * self.width];
            for (pixel, covered) in pixels.chunks_exact_mut(4).skip(self.left).zip(coverage) {
                if *covered > 0.0 {
                    blend(pixel, color, *covered);
                }
            }
        }
    }
}

/// The pixels between two places, within 0 to `end`.
fn pixels(from: f32, to: f32, end: usize) -> std::ops::Range<usize> {
    // Casts saturate and turn not-a-number into 0.
    let last = if to > 0.0 { (to as usize).saturating_add(1).min(end) } else { 0 };
    (from as usize).min(last)..last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(lines: &[&[Point]], dash: &Dash) -> Sheet {
        let mut sheet = Sheet::default();
        sheet.begin(&Area { left: 10.0, top: 20.0, right: 70.0, bottom: 60.0 });
        lines.iter().for_each(|points| sheet.line(points, 2.0, dash, &[]));
        sheet
    }

    /// Every pixel of a line has the coverage that its distance requires. The check visits all pixels, so skipped rows
    /// and columns have none. Tolerance: rounding, 1e-4 of a pixel at 100 pixels.
    #[test]
    fn a_line_is_all_points_near_it() {
        for (from, to) in [((12.0, 22.0), (60.3, 50.7)), ((40.0, 25.0), (40.0, 55.0)), ((0.0, 0.0), (90.0, 21.0))] {
            let sheet = drawn(&[&[from, to]], &[]);
            for (index, covered) in sheet.coverage.iter().enumerate() {
                let x = (10 + index % sheet.width) as f64 + 0.5;
                let y = (20 + index / sheet.width) as f64 + 0.5;
                let (ax, ay) = (f64::from(from.0), f64::from(from.1));
                let (dx, dy) = (f64::from(to.0) - ax, f64::from(to.1) - ay);
                let along = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
                let distance = ((x - ax - along * dx).powi(2) + (y - ay - along * dy).powi(2)).sqrt();
                assert!((f64::from(*covered) - (1.5 - distance).clamp(0.0, 1.0)).abs() < 1e-4, "{x}, {y}");
            }
        }
    }

    /// A line in pieces or whole, forwards or later, is the same.
    #[test]
    fn a_line_in_pieces_is_the_same_line() {
        let points: Vec<Point> = (0..40).map(|index| (12.0 + index as f32, 40.0 + (index * 7 % 11) as f32)).collect();
        let pieces: Vec<&[Point]> = points.windows(2).rev().collect();
        assert_eq!(drawn(&[&points], &[]).coverage, drawn(&pieces, &[]).coverage);
    }

    #[test]
    fn dashes_leave_gaps_and_go_on_round_corners() {
        let straight = drawn(&[&[(10.0, 40.0), (70.0, 40.0)]], &[8.0, 6.0]);
        let bent = drawn(&[&[(10.0, 40.0), (13.0, 40.0), (30.0, 40.0), (70.0, 40.0)]], &[8.0, 6.0]);
        let row = 20 * straight.width;
        for column in 0..60 {
            let (one, other) = (straight.coverage[row + column], bent.coverage[row + column]);
            assert!((one - other).abs() < 1e-4, "{column}");
            // Round ends reach a pixel into the gap.
            let phase = column as f32 % 14.0;
            assert!(if (0.0..8.0).contains(&phase) {
                one == 1.0
            } else {
                !(9.5..=11.5).contains(&phase) || one == 0.0
            });
        }
    }

    #[test]
    fn lines_beyond_the_sheet_or_nowhere_do_no_harm() {
        let sheet = drawn(&[&[(f32::NAN, 0.0), (1e30, -1e30), (f32::INFINITY, 3.0), (-500.0, -500.0)]], &[3.0, 3.0]);
        assert!(sheet.coverage.iter().all(|covered| *covered == 0.0));
    }
}
