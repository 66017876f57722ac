//! Bodies: one silhouette each, with marks that show its atoms and its rotation.

use glam::DVec2;

use crate::raster::camera::Camera;
use crate::raster::canvas::{Canvas, Ink};
use crate::raster::silhouette::{Field, Silhouette, Stand};
use crate::raster::theme::Theme;
use jostle_frames::frame::{BodyLook, BodyPose, Disc, Rgb};

/// Atoms with a smaller radius than this, in pixels, are not marked: the marks would be noise.
const SMALLEST_MARKED: f64 = 5.0;

/// Fixed discs have an axle from this radius on, in pixels. Otherwise dots would cover a terrain of small discs.
const SMALLEST_WITH_AXLE: f64 = 12.0;

/// How one body is drawn, at the camera's scale.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Figure {
    silhouette: Silhouette,
    ink: Ink,
    marks: Vec<Mark>,
    mark_ink: Ink,
}

/// A small disc on a body: its centre from the body's, y up, and its radius, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    offset: DVec2,
    radius: f64,
}

impl Figure {
    /// The figure of a body with that fill; `line` is the width of outlines in pixels.
    pub(in crate::raster) fn new(look: &BodyLook, fill: Rgb, camera: &Camera, theme: &Theme, line: f32) -> Figure {
        let scale = camera.pixels_per_meter();
        let outline = theme.outline.of(fill);
        let smallest = look.discs.iter().map(|disc| disc.radius * scale).fold(f64::INFINITY, f64::min);
        let mark = if look.fixed { outline } else { theme.mark.of(fill) };
        Figure {
            silhouette: Silhouette::new(&look.discs, &look.hulls, scale),
            ink: Ink { fill, outline, width: line.min(0.26 * smallest as f32) },
            marks: marks(&look.discs, look.fixed, scale),
            mark_ink: Ink::plain(mark),
        }
    }

    /// Draws the body at its pose.
    pub(in crate::raster) fn draw(&self, pose: &BodyPose, camera: &Camera, canvas: &mut Canvas, field: &mut Field) {
        let center = camera.to_picture(pose.position);
        let (sine, cosine) = (libm::sin(pose.angle), libm::cos(pose.angle));
        let stand = Stand { x: center.x, y: center.y, cosine, sine };
        self.silhouette.draw(&stand, &self.ink, canvas, field);
        for mark in &self.marks {
            let (x, y) = stand.place(mark.offset);
            canvas.disc(x, y, mark.radius as f32, &self.mark_ink);
        }
    }
}

/// A body of several discs shows each. A single mobile disc has its mark off the centre, so that its rotation is
/// visible. A single fixed disc has a small axle.
fn marks(discs: &[Disc], fixed: bool, scale: f64) -> Vec<Mark> {
    let smallest = if fixed { SMALLEST_WITH_AXLE } else { SMALLEST_MARKED };
    let wide = |disc: &&Disc| disc.radius * scale > smallest;
    let mark = |disc: &Disc, share: f64, shift: f64| Mark {
        offset: (disc.offset + DVec2::X * shift * disc.radius) * scale,
        radius: share * disc.radius * scale,
    };
    match (discs, fixed) {
        (_, true) => discs.iter().filter(wide).map(|disc| mark(disc, 0.07, 0.0)).collect(),
        ([only], false) => [only].into_iter().filter(wide).map(|disc| mark(disc, 0.22, 0.5)).collect(),
        (several, false) => several.iter().filter(wide).map(|disc| mark(disc, 0.52, 0.0)).collect(),
    }
}
