//! Scales: the scale bar of the picture, and the keys of arrows, each in a line of small print.

use glam::DVec2;
use tiny_skia::{Pixmap, Rect, Transform};

use super::labels::Column;
use super::writing::Writing;
use super::{arrows, paint};
use crate::raster::camera::Camera;
use crate::raster::theme::Theme;
use jostle_frames::frame::Rgb;
use jostle_frames::mark::{Mark, MarkShape};

/// The longest scale bar, in pixels at the usual letters of 16 pixels.
const LONGEST: f64 = 110.0;

/// Draws the scales among the marks, from the bottom of the column upwards. If there is only one line, they stand side
/// by side. `line` is the width of lines in pixels.
pub(in crate::raster) fn draw(
    picture: &mut Pixmap,
    marks: &[Mark],
    (camera, theme): (&Camera, &Theme),
    column: &Column,
    writing: &Writing,
    line: f32,
) {
    let size = writing.size();
    let (mut left, mut baseline) = (column.left, column.bottom);
    for mark in marks {
        let (length, text, arrow) = match &mark.shape {
            MarkShape::ScaleBar => {
                let (length, text) = round_length(camera.pixels_per_meter(), LONGEST / 16.0 * f64::from(size));
                (length, text, false)
            }
            MarkShape::Key { length, text } => (length * camera.pixels_per_meter(), text.clone(), true),
            _ => continue,
        };
        // A key of an arrow beyond the picture states nothing.
        if !(length.is_finite() && length < f64::from(picture.width())) {
            continue;
        }
        let middle = (baseline - 0.36 * size).round();
        let text = writing.text(&text);
        if arrow {
            let (from, to) = (DVec2::new(f64::from(left), f64::from(middle)), DVec2::X * length);
            let colors = (theme.mark_color(mark.color.as_deref()), writing.below());
            arrows::arrow(picture, (from, from + to), 1, colors, line);
        } else {
            bar(picture, (left, middle, length as f32), size, (theme.ink, writing.below()));
        }
        let beside = left + length as f32 + 0.6 * size;
        text.put(picture, beside, baseline);
        if column.one_line {
            left = (beside + text.width() + 1.6 * size).round();
        } else {
            baseline -= (1.7 * size).round();
        }
    }
}

/// A bar with its ends marked, at whole pixels, so that it is sharp.
fn bar(picture: &mut Pixmap, (left, middle, length): (f32, f32, f32), size: f32, (ink, below): (Rgb, Rgb)) {
    let thick = (0.1 * size).round().max(1.0);
    let high = (0.25 * size).round().max(2.0);
    let right = (left + length).round();
    let mut fill = |left: f32, top: f32, right: f32, bottom: f32, color: Rgb| {
        if let Some(rectangle) = Rect::from_ltrb(left, top, right, bottom) {
            picture.fill_rect(rectangle, &paint(color), Transform::identity(), None);
        }
    };
    for (grown, color) in [(thick, below), (0.0, ink)] {
        fill(left - grown, middle - grown, right + grown, middle + thick + grown, color);
        for end in [left, right - thick] {
            fill(end - grown, middle - high - grown, end + thick + grown, middle + thick + high + grown, color);
        }
    }
}

/// The longest round length that takes at most `longest` pixels: in pixels, and in words.
fn round_length(pixels_per_meter: f64, longest: f64) -> (f64, String) {
    let most = longest / pixels_per_meter;
    let mut decade: i32 = 0;
    let power =
        |decade: i32| if decade < 0 { 1.0 / libm::exp10(f64::from(-decade)) } else { libm::exp10(f64::from(decade)) };
    while power(decade + 1) <= most && decade < 300 {
        decade += 1;
    }
    while power(decade) > most && decade > -300 {
        decade -= 1;
    }
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power(decade) <= most).unwrap_or(1.0);
    // The prefix of a power of a thousand, and the remaining factor.
    let (unit, factor) = match decade {
        9..=11 => ("Gm", decade - 9),
        6..=8 => ("Mm", decade - 6),
        3..=5 => ("km", decade - 3),
        0..=2 => ("m", decade),
        -2..=-1 => ("cm", decade + 2),
        -3 => ("mm", 0),
        -6..=-4 => ("µm", decade + 6),
        -9..=-7 => ("nm", decade + 9),
        _ => return (digit * power(decade) * pixels_per_meter, format!("{digit}e{decade} m")),
    };
    (digit * power(decade) * pixels_per_meter, format!("{} {unit}", digit * power(factor)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_have_round_lengths_in_a_unit_that_suits() {
        for (pixels_per_meter, pixels, text) in [
            (100.0, 100.0, "1 m"),
            (109.0, 109.0, "1 m"),
            (111.0, 55.5, "50 cm"),
            (1000.0, 100.0, "10 cm"),
            (4.0, 80.0, "20 m"),
            (4e-4, 80.0, "200 km"),
            (2e-6, 100.0, "50 Mm"),
            (2e-9, 100.0, "50 Gm"),
            (2e4, 100.0, "5 mm"),
            (5e6, 100.0, "20 µm"),
            (1e-12, 100.0, "1e14 m"),
        ] {
            let (found, words) = round_length(pixels_per_meter, 110.0);
            assert_eq!(words, text);
            assert!((found - pixels).abs() < 1e-6 * pixels, "{text}: {found}");
        }
    }
}
