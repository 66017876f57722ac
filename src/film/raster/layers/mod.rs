//! The parts of a picture, one file per part, from back to front.

pub(super) mod arrows;
pub(super) mod backdrop;
pub(super) mod bodies;
pub(super) mod clock;
pub(super) mod insets;
pub(super) mod labels;
mod lines;
pub(super) mod marks;
pub(super) mod scales;
pub(super) mod title;
pub(super) mod trails;
pub(super) mod walls;
pub(super) mod writing;

use tiny_skia::{Color, Paint};

use jostle_frames::frame::Rgb;

/// A colour as tiny-skia paints it.
pub(super) fn paint(Rgb(red, green, blue): Rgb) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, 255));
    paint
}
