//! Marks of layers in front of the bodies: lines, arrows, circles, dots, rectangles.

use glam::DVec2;
use tiny_skia::{LineCap, Path, PathBuilder, Pixmap, Stroke, Transform};

use super::arrows::arrow;
use super::paint;
use crate::raster::canvas::{Canvas, Ink};
use crate::raster::{Camera, Theme};
use jostle_frames::frame::Rgb;
use jostle_frames::mark::{Mark, MarkShape};

/// Radius of a dot in line widths.
const DOT: f32 = 1.7;

/// Draws marks with lines of `width` pixels. Trails, labels and marks in corners are drawn elsewhere.
pub(in crate::raster) fn draw(picture: &mut Pixmap, marks: &[Mark], camera: &Camera, theme: &Theme, width: f32) {
    let place = |point: DVec2| camera.to_picture(point);
    for mark in marks {
        let color = theme.mark_color(mark.color.as_deref());
        match mark.shape {
            MarkShape::Line(from, to) => stroke(picture, line(place(from), place(to)), color, width),
            MarkShape::Circle(center, radius) => {
                let center = place(center);
                let mut path = PathBuilder::new();
                path.push_circle(center.x as f32, center.y as f32, (radius * camera.pixels_per_meter()) as f32);
                stroke(picture, path.finish(), color, width);
            }
            MarkShape::Rectangle(low, high) => {
                stroke(picture, rectangle(place(low), place(high)), color, 0.6 * width);
            }
            MarkShape::Dot(at) => {
                let (at, ink) = (place(at), Ink { fill: color, outline: theme.background, width: 0.5 * width });
                Canvas::new(picture).disc(at.x as f32, at.y as f32, DOT * width, &ink);
            }
            MarkShape::Arrow(from, to) => arrow(picture, (place(from), place(to)), 1, (color, theme.background), width),
            MarkShape::LongArrow(from, to) => {
                arrow(picture, (place(from), place(to)), 2, (color, theme.background), width);
            }
            MarkShape::Trail { .. } | MarkShape::Label { .. } => (),
            MarkShape::Key { .. } | MarkShape::Inset { .. } | MarkShape::ScaleBar | MarkShape::Time => (),
        }
    }
}

pub(super) fn stroke(picture: &mut Pixmap, path: Option<Path>, color: Rgb, width: f32) {
    let stroke = Stroke { width, line_cap: LineCap::Round, ..Stroke::default() };
    if let Some(path) = path {
        picture.stroke_path(&path, &paint(color), &stroke, Transform::identity(), None);
    }
}

fn line(from: DVec2, to: DVec2) -> Option<Path> {
    let mut path = PathBuilder::new();
    path.move_to(from.x as f32, from.y as f32);
    path.line_to(to.x as f32, to.y as f32);
    path.finish()
}

pub(super) fn rectangle(a: DVec2, b: DVec2) -> Option<Path> {
    polygon(&[a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)])
}

fn polygon(corners: &[DVec2]) -> Option<Path> {
    let mut path = PathBuilder::new();
    let (first, others) = corners.split_first()?;
    path.move_to(first.x as f32, first.y as f32);
    for corner in others {
        path.line_to(corner.x as f32, corner.y as f32);
    }
    path.close();
    path.finish()
}
