//! Filling of shapes by their signed distance: exact edges without a stroker and without seams.
//!
//! All arithmetic is on whole numbers, or addition, multiplication and square root of `f32`. So the bytes are the same
//! on every machine that follows IEEE 754.

use tiny_skia::Pixmap;

use super::light::{mix, mix_value};
use jostle_frames::frame::Rgb;

/// Discs smaller than this are drawn at this radius, in pixels: what moves must be seen.
const SMALLEST_RADIUS: f32 = 1.25;

/// How a shape is coloured: its fill, and a line of `width` pixels along the inside of its edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ink {
    pub(super) fill: Rgb,
    pub(super) outline: Rgb,
    pub(super) width: f32,
}

impl Ink {
    /// Fill without outline.
    pub(super) fn plain(fill: Rgb) -> Ink {
        Ink { fill, outline: fill, width: 0.0 }
    }

    /// Colour and coverage (0 to 1) of a pixel whose centre lies `distance` pixels outside the shape.
    pub(super) fn at(&self, distance: f32) -> (Rgb, f32) {
        let inside = (0.5 - distance).clamp(0.0, 1.0);
        let filled = (0.5 - distance - self.width).clamp(0.0, 1.0);
        if filled <= 0.0 {
            return (self.outline, inside);
        }
        // The fill's share of the covered part. A line thinner than a pixel shares its light with the fill.
        let share = filled / inside;
        (mix(self.outline, self.fill, (share * 256.0 + 0.5) as u32), inside)
    }
}

/// A picture to be drawn on; all its pixels are opaque.
pub(super) struct Canvas<'a> {
    data: &'a mut [u8],
    width: usize,
    height: usize,
}

impl<'a> Canvas<'a> {
    pub(super) fn new(pixmap: &'a mut Pixmap) -> Canvas<'a> {
        let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
        Canvas { data: pixmap.data_mut(), width, height }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    /// One row of pixels, four bytes each.
    pub(super) fn row(&mut self, y: usize) -> &mut [u8] {
        let bytes = 4 * self.width;
        &mut self.data[y * bytes..(y + 1) * bytes]
    }

    /// A disc by its centre and radius in pixels.
    pub(super) fn disc(&mut self, x: f32, y: f32, radius: f32, ink: &Ink) {
        let radius = radius.max(SMALLEST_RADIUS);
        let solid = radius - ink.width - 0.5;
        for row in span(y, radius + 0.5, self.height) {
            let dy = row as f32 + 0.5 - y;
            let Some(outer) = half_chord(radius + 0.5, dy) else { continue };
            let columns = span(x, outer, self.width);
            let inner = half_chord(solid, dy).map_or(columns.start..columns.start, |half| {
                let full = span(x, half - 1.0, self.width);
                full.start.max(columns.start)..full.end.clamp(columns.start, columns.end)
            });
            let inner = if inner.is_empty() { columns.end..columns.end } else { inner };
            let pixels = self.row(row);
            fill(&mut pixels[4 * inner.start..4 * inner.end], ink.fill);
            for column in (columns.start..inner.start).chain(inner.end..columns.end) {
                let dx = column as f32 + 0.5 - x;
                let distance = (dx * dx + dy * dy).sqrt() - radius;
                if distance < 0.5 {
                    let (color, coverage) = ink.at(distance);
                    blend(&mut pixels[4 * column..4 * column + 4], color, coverage);
                }
            }
        }
    }
}

/// The pixels that an interval about `center` touches, within 0 to `end`. The range is one longer if the interval ends
/// between two pixels.
pub(super) fn span(center: f32, half: f32, end: usize) -> std::ops::Range<usize> {
    // Casts truncate, saturate, and turn NaN into 0. So the range lies in the picture for every pose. (`floor` and
    // `ceil` would be calls if the processor has no instruction for them.)
    let high = center + half;
    let to = if high > 0.0 { (high as usize).saturating_add(1).min(end) } else { 0 };
    let from = (center - half) as usize;
    from.min(to)..to
}

/// Half the length of the chord of a circle at the distance `dy` from its centre.
fn half_chord(radius: f32, dy: f32) -> Option<f32> {
    let square = radius * radius - dy * dy;
    (radius > 0.0 && square > 0.0).then(|| square.sqrt())
}

/// Sets pixels (four bytes each) to a colour.
pub(super) fn fill(pixels: &mut [u8], Rgb(red, green, blue): Rgb) {
    for pixel in pixels.chunks_exact_mut(4) {
        pixel.copy_from_slice(&[red, green, blue, 255]);
    }
}

/// Lays a colour over one pixel with a coverage of 0 to 1.
pub(super) fn blend(pixel: &mut [u8], Rgb(red, green, blue): Rgb, coverage: f32) {
    let share = (coverage * 256.0 + 0.5) as u32;
    if share >= 256 {
        pixel[..3].copy_from_slice(&[red, green, blue]);
        return;
    }
    for (below, above) in pixel.iter_mut().zip([red, green, blue]) {
        *below = mix_value(*below, above, share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INK: Ink = Ink { fill: Rgb(86, 180, 233), outline: Rgb(30, 36, 48), width: 2.0 };
    const PAPER: Rgb = Rgb(250, 249, 246);

    fn drawn(x: f32, y: f32, radius: f32) -> Pixmap {
        let mut pixmap = Pixmap::new(40, 40).expect("small");
        let mut canvas = Canvas::new(&mut pixmap);
        for row in 0..40 {
            fill(canvas.row(row), PAPER);
        }
        canvas.disc(x, y, radius, &INK);
        pixmap
    }

    #[test]
    fn a_disc_beyond_the_picture_or_nowhere_changes_nothing() {
        let blank = drawn(-500.0, 20.0, 5.0);
        for (x, y) in [(f32::NAN, 20.0), (20.0, f32::NAN), (f32::INFINITY, 20.0), (20.0, 1.0e30)] {
            assert_eq!(drawn(x, y, 5.0).data(), blank.data(), "{x}, {y}");
        }
        assert_eq!(blank.pixel(0, 20), blank.pixel(39, 0));
    }

    #[test]
    fn the_smallest_disc_is_still_seen() {
        let pixmap = drawn(20.0, 20.0, 0.01);
        assert!(pixmap.pixel(20, 20).expect("inside").red() < 128);
    }
}
