//! Trails: each is one area whose cover fades with age, laid over the picture once. So no seam shows between its
//! pieces, or at its crossings with itself.

use glam::DVec2;

use crate::raster::Camera;
use crate::raster::canvas::{Canvas, blend, span};
use jostle_frames::frame::Rgb;

/// Half the width of a trail at its young end in line widths, and its share at the old end.
const HALF_WIDTH: f64 = 1.9;
const OLD_SHARE: f64 = 0.25;

/// The opacity of the young end of a trail.
const COVER: f64 = 0.92;

/// Points nearer than this to the one before, in pixels, are passed over.
const CLOSE: f64 = 2.5;

/// The cover of each pixel of a picture by the trail at hand, 0 to 255; all zero between trails. Kept from frame to frame.
#[derive(Debug, Default)]
pub(in crate::raster) struct Cover(Vec<u8>);

/// A trail in the picture.
pub(in crate::raster) struct Trail<'a> {
    pub(in crate::raster) points: &'a [DVec2],
    /// Age from point to point; the last one has age 0, and nothing is seen at age 1.
    pub(in crate::raster) step: f64,
    pub(in crate::raster) color: Rgb,
}

/// A point of a trail in pixels, with half its width there and its cover.
#[derive(Clone, Copy)]
struct Knot {
    x: f32,
    y: f32,
    half: f32,
    cover: f32,
}

impl Trail<'_> {
    /// Draws the trail with widths that go with lines of `width` pixels.
    pub(in crate::raster) fn draw(&self, canvas: &mut Canvas, camera: &Camera, width: f32, cover: &mut Cover) {
        cover.0.resize(canvas.width() * canvas.height(), 0);
        let knots = self.knots(camera, f64::from(width));
        for pair in knots.windows(2) {
            pair[0].lift_to(&pair[1], canvas, cover);
        }
        for pair in knots.windows(2) {
            let (columns, rows) = pair[0].reach(&pair[1], canvas);
            for row in rows {
                let start = row * canvas.width();
                let covers = &mut cover.0[start + columns.start..start + columns.end];
                let pixels = &mut canvas.row(row)[4 * columns.start..4 * columns.end];
                for (pixel, cover) in pixels.chunks_exact_mut(4).zip(covers) {
                    // A pixel that is covered once is not covered again by the next piece.
                    if *cover > 0 {
                        blend(pixel, self.color, f32::from(*cover) / 255.0);
                        *cover = 0;
                    }
                }
            }
        }
    }

    fn knots(&self, camera: &Camera, width: f64) -> Vec<Knot> {
        let mut knots: Vec<Knot> = Vec::new();
        let mut last: Option<DVec2> = None;
        let newest = self.points.len().saturating_sub(1);
        for (index, point) in self.points.iter().enumerate() {
            let at = camera.to_picture(*point);
            let age = (newest - index) as f64 * self.step;
            let near = last.is_some_and(|last| last.distance(at) < CLOSE) && index < newest;
            if near || age >= 1.0 || !at.is_finite() {
                continue;
            }
            last = Some(at);
            let youth = 1.0 - age;
            let half = HALF_WIDTH * width * (OLD_SHARE + (1.0 - OLD_SHARE) * youth);
            let cover = 255.0 * COVER * youth;
            knots.push(Knot { x: at.x as f32, y: at.y as f32, half: half as f32, cover: cover as f32 });
        }
        knots
    }
}

impl Knot {
    /// The pixels that the piece from here to there may touch.
    fn reach(&self, to: &Knot, canvas: &Canvas) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
        let half = self.half.max(to.half) + 0.5;
        let about = |a: f32, b: f32, end: usize| span(0.5 * (a + b), 0.5 * (a - b).abs() + half, end);
        (about(self.x, to.x, canvas.width()), about(self.y, to.y, canvas.height()))
    }

    /// Raises the cover of the pixels along the piece from here to there.
    fn lift_to(&self, to: &Knot, canvas: &Canvas, cover: &mut Cover) {
        let (columns, rows) = self.reach(to, canvas);
        let (along_x, along_y) = (to.x - self.x, to.y - self.y);
        let square = along_x * along_x + along_y * along_y;
        let inverse = if square > 1e-6 { 1.0 / square } else { 0.0 };
        for row in rows {
            let dy = row as f32 + 0.5 - self.y;
            let covers = &mut cover.0[row * canvas.width()..][columns.clone()];
            for (cover, column) in covers.iter_mut().zip(columns.clone()) {
                let dx = column as f32 + 0.5 - self.x;
                let share = ((dx * along_x + dy * along_y) * inverse).clamp(0.0, 1.0);
                let (to_x, to_y) = (dx - share * along_x, dy - share * along_y);
                let half = self.half + share * (to.half - self.half);
                let inside = (0.5 + half - (to_x * to_x + to_y * to_y).sqrt()).clamp(0.0, 1.0);
                let own = inside * (self.cover + share * (to.cover - self.cover)) + 0.5;
                *cover = (*cover).max(own as u8);
            }
        }
    }
}
