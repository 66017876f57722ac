//! The position of the labels: beside the room if there is space, else in its upper left corner.

use glam::DVec2;
use tiny_skia::{FillRule, IntRect, LineJoin, Path, Pixmap, PixmapPaint, Stroke, Transform};

use super::paint;
use crate::raster::text::Lettering;
use jostle_frames::frame::Rgb;

/// The part of the picture without walls, as an upright box in pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::raster) struct Room {
    pub(in crate::raster) low: DVec2,
    pub(in crate::raster) high: DVec2,
}

/// The column the labels are set in, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::raster) struct Column {
    /// Left edge of the text.
    pub(in crate::raster) left: f32,
    /// Upper edge of the first line.
    pub(in crate::raster) top: f32,
    /// The longest line that fits.
    pub(in crate::raster) width: f32,
    /// Whether bodies may pass behind.
    pub(in crate::raster) in_room: bool,
    /// Baseline of the last line.
    pub(in crate::raster) bottom: f32,
    /// Whether the bottom has only that line, on the ground below the room.
    pub(in crate::raster) one_line: bool,
}

impl Column {
    /// The column for a room whose walls have a band `band` pixels wide. `needed` is the width of the widest label that
    /// cannot be broken, and `pad` the distance from borders. `height` is that of the picture, and `small` that of
    /// small print.
    pub(in crate::raster) fn beside_or_in(
        room: Room,
        band: f32,
        needed: f32,
        pad: f32,
        (height, small): (f32, f32),
    ) -> Column {
        let beside = room.low.x as f32 - band - 2.0 * pad;
        if beside >= needed {
            let (left, top, bottom) = (pad.round(), pad.round(), (height - pad).round());
            return Column { left, top, width: beside, in_room: false, bottom, one_line: false };
        }
        let width = (room.high.x - room.low.x) as f32 - 2.0 * pad;
        let (left, top) = (room.low.x as f32 + pad, room.low.y as f32 + pad);
        let below = height - room.high.y as f32 - band;
        let one_line = below >= 1.3 * small;
        // Capitals are 0.73 em high: in the middle of the ground.
        let bottom = if one_line { height - 0.5 * (below - 0.73 * small) } else { room.high.y as f32 - pad };
        let (left, top, bottom) = (left.round(), top.round(), bottom.round());
        Column { left, top, width: width.max(needed), in_room: true, bottom, one_line }
    }
}

/// Outlines that are drawn once, and put on pictures at whole pixels. To fill them in each frame would cost as much as
/// all bodies.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Sticker {
    picture: Pixmap,
    left: i32,
    top: i32,
}

impl Sticker {
    /// The sticker of some outlines, each with its colour, from back to front; `None` if there is nothing to see.
    pub(in crate::raster) fn new(layers: &[(&Path, Rgb)]) -> Option<Sticker> {
        let bounds = layers.iter().filter_map(|(path, _)| path.bounds().round_out()).reduce(|a, b| {
            let (left, top) = (a.left().min(b.left()), a.top().min(b.top()));
            IntRect::from_ltrb(left, top, a.right().max(b.right()), a.bottom().max(b.bottom())).unwrap_or(a)
        })?;
        let mut picture = Pixmap::new(bounds.width(), bounds.height())?;
        let place = Transform::from_translate(-bounds.left() as f32, -bounds.top() as f32);
        for (path, color) in layers {
            picture.fill_path(path, &paint(*color), FillRule::Winding, place, None);
        }
        Some(Sticker { picture, left: bounds.left(), top: bounds.top() })
    }

    /// Puts it on a picture, moved by whole pixels.
    pub(in crate::raster) fn put(&self, pixmap: &mut Pixmap, right: i32, down: i32) {
        let (x, y) = (self.left + right, self.top + down);
        pixmap.draw_pixmap(x, y, self.picture.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
    }
}

/// The outline of a halo around letters `size` pixels high, which keeps them readable over bodies.
pub(in crate::raster) fn halo(letters: &Path, size: f32) -> Option<Path> {
    let stroke = Stroke { width: 0.25 * size, line_join: LineJoin::Round, ..Stroke::default() };
    letters.stroke(&stroke, 1.0)
}

/// The width of the longest word of a text, in pixels.
pub(in crate::raster) fn longest_word(text: &str, lettering: &Lettering) -> f32 {
    text.split_whitespace().map(|word| lettering.width(word)).fold(0.0, f32::max)
}

/// Breaks a text into lines no wider than `width`. A wider word gets one line and exceeds the width.
pub(in crate::raster) fn break_lines(text: &str, lettering: &Lettering, width: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (longer, lines.last_mut()) {
            (Some(longer), Some(line)) if lettering.width(&longer) <= width => *line = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::text::Weight;

    #[test]
    fn a_square_room_in_a_wide_picture_has_its_labels_beside_it() {
        let room = Room { low: DVec2::new(310.0, 36.0), high: DVec2::new(970.0, 684.0) };
        let column = Column::beside_or_in(room, 14.0, 150.0, 24.0, (720.0, 16.0));
        let beside = Column { left: 24.0, top: 24.0, width: 248.0, in_room: false, bottom: 696.0, one_line: false };
        assert_eq!(column, beside);
        let wide = Room { low: DVec2::new(36.0, 36.0), high: DVec2::new(1244.0, 684.0) };
        let column = Column::beside_or_in(wide, 14.0, 150.0, 24.0, (720.0, 16.0));
        let within = Column { left: 60.0, top: 60.0, width: 1160.0, in_room: true, bottom: 715.0, one_line: true };
        assert_eq!(column, within);
        let whole = Room { low: DVec2::ZERO, high: DVec2::new(1280.0, 720.0) };
        let column = Column::beside_or_in(whole, 14.0, 150.0, 24.0, (720.0, 16.0));
        assert_eq!((column.bottom, column.one_line), (696.0, false));
    }

    #[test]
    fn titles_break_between_words() {
        let lettering = Lettering::new(Weight::SemiBold, 20.0, "abcdefghij ");
        let width = lettering.width("abc def");
        assert_eq!(break_lines("abc def ghi", &lettering, width), ["abc def", "ghi"]);
        assert_eq!(break_lines("abcdefghij a", &lettering, 10.0), ["abcdefghij", "a"]);
        assert!(break_lines(" ", &lettering, 10.0).is_empty());
    }
}
