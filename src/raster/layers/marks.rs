//! What layers add: lines, arrows and circles of one width.

use glam::DVec2;
use tiny_skia::{LineCap, Path, PathBuilder, Pixmap, Stroke, Transform};

use super::paint;
use crate::raster::{Camera, Theme};
use crate::record::layers::{Mark, MarkShape};

/// Length of an arrow's head in line widths.
const HEAD: f64 = 5.0;

/// Draws marks with lines of `width` pixels.
pub(in crate::raster) fn draw(picture: &mut Pixmap, marks: &[Mark], camera: &Camera, theme: &Theme, width: f32) {
    for mark in marks {
        let color = mark.color.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.ink);
        let stroke = Stroke { width, line_cap: LineCap::Round, ..Stroke::default() };
        if let Some(path) = path(&mark.shape, camera, f64::from(width)) {
            picture.stroke_path(&path, &paint(color), &stroke, Transform::identity(), None);
        }
    }
}

/// The outline of a mark in pixels; `None` if it lies nowhere or has no extent.
fn path(shape: &MarkShape, camera: &Camera, width: f64) -> Option<Path> {
    let mut path = PathBuilder::new();
    match *shape {
        MarkShape::Line(from, to) => line(&mut path, camera.to_picture(from), camera.to_picture(to)),
        MarkShape::Arrow(from, to) => {
            let (from, to) = (camera.to_picture(from), camera.to_picture(to));
            line(&mut path, from, to);
            let length = (to - from).length();
            if length > 0.0 {
                let back = (from - to) / length * (HEAD * width).min(length);
                line(&mut path, to + back + 0.5 * back.perp(), to);
                line(&mut path, to + back - 0.5 * back.perp(), to);
            }
        }
        MarkShape::Circle(center, radius) => {
            let center = camera.to_picture(center);
            path.push_circle(center.x as f32, center.y as f32, (radius * camera.pixels_per_meter()) as f32);
        }
    }
    path.finish()
}

fn line(path: &mut PathBuilder, from: DVec2, to: DVec2) {
    path.move_to(from.x as f32, from.y as f32);
    path.line_to(to.x as f32, to.y as f32);
}
