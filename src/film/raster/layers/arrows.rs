//! Arrows, filled by exact distance: a shaft and a head as one area within a halo. The halo separates them from bodies.

use glam::DVec2;
use tiny_skia::Pixmap;

use crate::raster::canvas::{Canvas, Ink, blend, span};
use jostle_frames::frame::Rgb;

/// Widths and lengths in line widths.
const SHAFT: f32 = 1.5;
const HEAD_LENGTH: f32 = 5.6;
const HEAD_WIDTH: f32 = 5.2;
const HALO: f32 = 0.7;

/// The head takes at most this share of a short arrow; its widths shrink with it.
const HEAD_SHARE: f32 = 0.6;

/// The distance from the first head to the second one, in lengths of heads.
const SECOND: f64 = 0.8;

/// Draws an arrow between two points in pixels, with `heads` heads, in its colour within a halo. Lines are `width`
/// pixels wide. An arrow is not drawn if it has no length, or if an end is NaN or infinite.
pub(in crate::raster) fn arrow(
    picture: &mut Pixmap,
    (from, to): (DVec2, DVec2),
    heads: usize,
    (color, halo): (Rgb, Rgb),
    width: f32,
) {
    let Some(along) = (to - from).try_normalize() else { return };
    let back = along * (SECOND * f64::from(HEAD_LENGTH * width));
    for head in 0..heads {
        // The second head lies behind, within its halo, so that both are visible.
        Arrow::new(from, to - back * head as f64, width).draw(&mut Canvas::new(picture), color, halo);
    }
}

/// An arrow in the picture.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct Arrow {
    from: (f32, f32),
    /// Direction, of length 1.
    along: (f32, f32),
    length: f32,
    head_length: f32,
    /// Half the width of the head.
    wing: f32,
    /// Half the width of the shaft.
    shaft: f32,
    halo: f32,
}

impl Arrow {
    pub(in crate::raster) fn new(from: DVec2, to: DVec2, width: f32) -> Arrow {
        let (length, along) = (from.distance(to) as f32, (to - from).normalize_or_zero());
        let scale = width.min(HEAD_SHARE * length / HEAD_LENGTH);
        Arrow {
            from: (from.x as f32, from.y as f32),
            along: (along.x as f32, along.y as f32),
            length,
            head_length: HEAD_LENGTH * scale,
            wing: 0.5 * HEAD_WIDTH * scale,
            shaft: 0.5 * SHAFT * scale,
            halo: HALO * scale,
        }
    }

    fn draw(&self, canvas: &mut Canvas, color: Rgb, halo: Rgb) {
        // The halo is the outline of the arrow grown by it.
        let ink = Ink { fill: color, outline: halo, width: self.halo };
        let reach = self.wing + self.halo + 0.5;
        let half = |along: f32| 0.5 * self.length * along.abs() + reach;
        let middle = (self.from.0 + 0.5 * self.length * self.along.0, self.from.1 + 0.5 * self.length * self.along.1);
        for row in span(middle.1, half(self.along.1), canvas.height()) {
            let dy = row as f32 + 0.5 - self.from.1;
            // Of the row only what lies in the strip along the arrow.
            let mut columns = span(middle.0, half(self.along.0), canvas.width());
            if self.along.1.abs() > 1e-3 {
                let center = self.from.0 + dy * self.along.0 / self.along.1;
                let strip = span(center, reach / self.along.1.abs(), canvas.width());
                columns = columns.start.max(strip.start)..columns.end.min(strip.end);
            }
            if columns.is_empty() {
                continue;
            }
            let pixels = &mut canvas.row(row)[4 * columns.start..4 * columns.end];
            for (pixel, column) in pixels.chunks_exact_mut(4).zip(columns) {
                let dx = column as f32 + 0.5 - self.from.0;
                let (ahead, aside) =
                    (dx * self.along.0 + dy * self.along.1, (dy * self.along.0 - dx * self.along.1).abs());
                let distance = self.distance(ahead, aside) - self.halo;
                if distance < 0.5 {
                    let (color, coverage) = ink.at(distance);
                    blend(pixel, color, coverage);
                }
            }
        }
    }

    /// Distance of a point from the arrow in pixels, negative inside: `ahead` of its beginning, `aside` of its middle.
    fn distance(&self, ahead: f32, aside: f32) -> f32 {
        let length = |x: f32, y: f32| (x * x + y * y).sqrt();
        // The shaft runs on into the head, so that no seam shows at the neck.
        let shaft_end = self.length - 0.5 * self.head_length;
        let (out_ahead, out_aside) = ((-ahead).max(ahead - shaft_end), aside - self.shaft);
        let shaft = length(out_ahead.max(0.0), out_aside.max(0.0)) + out_ahead.max(out_aside).min(0.0);
        // The head: the slanted edge from the tip to the wing, and the base from the wing to the middle.
        let (base, before_tip) = (self.length - self.head_length - ahead, ahead - self.length);
        let side = length(self.head_length, self.wing);
        let slant = (before_tip * self.wing + aside * self.head_length) / side;
        let inside = slant.max(base);
        if inside <= 0.0 {
            return inside.min(shaft);
        }
        let share = ((-before_tip * self.head_length + aside * self.wing) / (side * side)).clamp(0.0, 1.0);
        let to_slant = length(before_tip + share * self.head_length, aside - share * self.wing);
        let to_base = length(base, (aside - self.wing).max(0.0));
        shaft.min(to_slant).min(to_base)
    }
}
