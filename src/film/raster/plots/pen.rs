//! Letters and cards of the panel: all constant parts.

use tiny_skia::{FillRule, Path, PathBuilder, Pixmap, Stroke, Transform};

use super::stroke::Area;
use crate::raster::layers::paint;
use crate::raster::text::{Lettering, Weight};
use jostle_frames::frame::Rgb;

/// The alignment of a text about its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

/// Letters of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ink {
    pub(super) size: f32,
    pub(super) weight: Weight,
    pub(super) color: Rgb,
}

impl Ink {
    pub(super) fn width(&self, text: &str) -> f32 {
        Lettering::new(self.weight, self.size, text).width(text)
    }

    /// Writes a line with its baseline at `y`; returns how wide it is.
    pub(super) fn write(&self, picture: &mut Pixmap, text: &str, (x, y): (f32, f32), align: Align) -> f32 {
        self.write_turned(picture, text, (x, y), align, Transform::identity())
    }

    /// Writes a line that reads upwards.
    pub(super) fn write_upwards(&self, picture: &mut Pixmap, text: &str, (x, y): (f32, f32), align: Align) {
        let turn = Transform::from_row(0.0, -1.0, 1.0, 0.0, x, y);
        self.write_turned(picture, text, (0.0, 0.0), align, turn);
    }

    fn write_turned(&self, picture: &mut Pixmap, text: &str, (x, y): (f32, f32), align: Align, turn: Transform) -> f32 {
        let letters = Lettering::new(self.weight, self.size, text);
        let width = letters.width(text);
        let left = match align {
            Align::Left => x,
            Align::Middle => x - 0.5 * width,
            Align::Right => x - width,
        };
        if let Some(path) = letters.path(text, left, y) {
            picture.fill_path(&path, &paint(self.color), FillRule::Winding, turn, None);
        }
        width
    }

    /// The text, shortened to a width.
    pub(super) fn shortened(&self, text: &str, width: f32) -> String {
        if self.width(text) <= width {
            return text.to_owned();
        }
        let mut letters: Vec<char> = text.chars().collect();
        while letters.pop().is_some() {
            let short = letters.iter().collect::<String>().trim_end().to_owned() + "…";
            if self.width(&short) <= width {
                return short;
            }
        }
        String::new()
    }
}

/// A card with round corners.
pub(super) fn card(picture: &mut Pixmap, area: &Area, radius: f32, fill: Rgb, border: Rgb, line: f32) {
    let Some(path) = rounded(area, radius) else { return };
    picture.fill_path(&path, &paint(fill), FillRule::Winding, Transform::identity(), None);
    let stroke = Stroke { width: line, ..Stroke::default() };
    picture.stroke_path(&path, &paint(border), &stroke, Transform::identity(), None);
}

fn rounded(area: &Area, radius: f32) -> Option<Path> {
    let radius = radius.min(0.5 * area.width()).min(0.5 * area.height());
    // The handle of a cubic that is nearest to a quarter of a circle, from its corner.
    let handle = radius * (1.0 - 0.552_284_8);
    let Area { left, top, right, bottom } = *area;
    let mut path = PathBuilder::new();
    path.move_to(left + radius, top);
    path.line_to(right - radius, top);
    path.cubic_to(right - handle, top, right, top + handle, right, top + radius);
    path.line_to(right, bottom - radius);
    path.cubic_to(right, bottom - handle, right - handle, bottom, right - radius, bottom);
    path.line_to(left + radius, bottom);
    path.cubic_to(left + handle, bottom, left, bottom - handle, left, bottom - radius);
    path.line_to(left, top + radius);
    path.cubic_to(left, top + handle, left + handle, top, left + radius, top);
    path.close();
    path.finish()
}

/// A patch with an outline, like that of a body.
pub(super) fn patch(picture: &mut Pixmap, area: &Area, fill: Rgb, outline: Rgb, line: f32) {
    let inner = Area {
        left: area.left + 0.5 * line,
        top: area.top + 0.5 * line,
        right: area.right - 0.5 * line,
        bottom: area.bottom - 0.5 * line,
    };
    card(picture, &inner, 0.28 * area.height(), fill, outline, line);
}
