//! Insets: parts of the picture, enlarged in its corners.
//!
//! Each has a separate painter, with a nearer camera. A thin frame shows which part of the picture it is.

use glam::DVec2;
use tiny_skia::Pixmap;

use super::marks::{rectangle, stroke};
use crate::raster::canvas::Canvas;
use crate::raster::{Camera, Painter, SizeError, View, Weights};
use jostle_frames::frame::{Frame, Rgb};
use jostle_frames::mark::MarkShape;

/// Between an inset and the border of the picture, in its pads.
const AIR: f32 = 0.75;

/// One inset of a film.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Inset {
    pub(in crate::raster) painter: Painter,
    /// Its upper left corner in the picture, in pixels.
    at: (usize, usize),
    /// The lower left and upper right corner of the part, in metres.
    part: (DVec2, DVec2),
    color: Rgb,
    line: f32,
}

impl Inset {
    /// Those of a film that begins with this frame.
    ///
    /// # Errors
    /// A [`SizeError`] if there is no picture of the size of one.
    pub(in crate::raster) fn all(view: &View, frame: &Frame) -> Result<Vec<Inset>, SizeError> {
        let ((width, height), weights) = (view.camera.size(), Weights::of(view.size()));
        let air = (AIR * weights.pad).round() as u32;
        // The camera of an inset is fixed, whatever the film's camera follows.
        let still = Frame { center: None, ..frame.clone() };
        let mut insets = Vec::new();
        for mark in &frame.marks {
            let MarkShape::Inset { center, height: part, corner, share } = mark.shape else { continue };
            let room = width.min(height).saturating_sub(2 * air).max(1);
            let side = ((f64::from(width.min(height)) * share).round() as u32).clamp(1, room);
            let far =
                |whole: u32, end: bool| if end { whole.saturating_sub(side + air) } else { air.min(whole - side) };
            let at = (far(width, corner.right) as usize, far(height, corner.bottom) as usize);
            let camera = Camera::look(center, part, (side, side));
            let view = View { camera, panel: None, ..view.clone() };
            let half = DVec2::splat(0.5 * part);
            insets.push(Inset {
                painter: Painter::without_insets(&view, &still, "")?,
                at,
                part: (center - half, center + half),
                color: view.theme.mark_color(mark.color.as_deref()),
                line: weights.line,
            });
        }
        Ok(insets)
    }

    /// Puts its picture into that of the film, with frames around both.
    pub(in crate::raster) fn put(&self, own: &Pixmap, camera: &Camera, picture: &mut Pixmap) {
        let corners = (camera.to_picture(self.part.0), camera.to_picture(self.part.1));
        stroke(picture, rectangle(corners.0, corners.1), self.color, 0.6 * self.line);
        let (left, top) = self.at;
        let bytes = 4 * own.width() as usize;
        let mut canvas = Canvas::new(picture);
        for (row, pixels) in own.data().chunks_exact(bytes).enumerate() {
            canvas.row(top + row)[4 * left..4 * left + bytes].copy_from_slice(pixels);
        }
        let low = DVec2::new(left as f64, top as f64);
        let high = low + DVec2::new(f64::from(own.width()), f64::from(own.height()));
        stroke(picture, rectangle(low, high), self.color, self.line);
    }
}
