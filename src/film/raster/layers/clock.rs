//! The clock: the time of the frame in a unit that suits the steps of the film. Its digits do not jitter.

use std::collections::BTreeMap;

use tiny_skia::Pixmap;

use super::labels::{Column, Sticker, halo};
use crate::raster::text::{Lettering, Weight};
use crate::raster::theme::Theme;

/// Every letter a time may need, infinite and undefined ones too.
const LETTERS: &str = "t = sminhda-.0123456789fN";

/// Minutes, hours, days and years (of 365.25 days, the Julian year of astronomy) in seconds.
const UNITS: [(f64, &str); 4] = [(31_557_600.0, "a"), (86_400.0, "d"), (3600.0, "h"), (60.0, "min")];

/// The clock of a film.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Clock {
    letters: BTreeMap<char, Letter>,
    size: f32,
    decimals: usize,
    unit: (f64, &'static str),
}

/// A letter and its halo, apart: no halo may cover the letter before.
#[derive(Clone, Debug)]
struct Letter {
    ink: Option<Sticker>,
    halo: Option<Sticker>,
    /// To the next letter, in whole pixels.
    advance: i32,
}

impl Clock {
    /// A clock with letters of `size` pixels that distinguishes frames `step` seconds apart. Its unit is the largest
    /// that is not longer than a step.
    pub(in crate::raster) fn new(size: f32, step: f64, theme: &Theme) -> Clock {
        let unit = UNITS.into_iter().find(|(seconds, _)| step >= *seconds).unwrap_or((1.0, "s"));
        let decimals = decimals(step / unit.0);
        let lettering = Lettering::tabular(Weight::Regular, size, LETTERS);
        let letter = |letter: char| {
            let text = letter.to_string();
            let path = lettering.path(&text, 0.0, 0.0);
            let around = path.as_ref().and_then(|path| halo(path, size));
            let made = Letter {
                ink: path.and_then(|path| Sticker::new(&[(&path, theme.quiet_ink)])),
                halo: around.and_then(|path| Sticker::new(&[(&path, theme.background)])),
                advance: lettering.width(&text).round() as i32,
            };
            (letter, made)
        };
        Clock { letters: LETTERS.chars().map(letter).collect(), size, decimals, unit }
    }

    /// The width of a time of two digits, in pixels.
    pub(in crate::raster) fn width(&self) -> f32 {
        let text = self.text(10.0 * self.unit.0);
        text.chars().filter_map(|letter| self.letters.get(&letter)).map(|letter| letter.advance).sum::<i32>() as f32
    }

    /// Draws the time (s) below `above` pixels of its column.
    pub(in crate::raster) fn draw(&self, pixmap: &mut Pixmap, time: f64, column: &Column, above: f32) {
        let baseline = (column.top + above + 0.73 * self.size).round() as i32;
        let text = self.text(time);
        let mut stick = |part: fn(&Letter) -> &Option<Sticker>| {
            let mut pen = column.left as i32;
            for letter in text.chars().filter_map(|letter| self.letters.get(&letter)) {
                if let Some(sticker) = part(letter) {
                    sticker.put(pixmap, pen, baseline);
                }
                pen += letter.advance;
            }
        };
        if column.in_room {
            stick(|letter| &letter.halo);
        }
        stick(|letter| &letter.ink);
    }

    fn text(&self, time: f64) -> String {
        let (seconds, unit) = self.unit;
        format!("t = {} {unit}", grouped(&format!("{:.*}", self.decimals, time / seconds)))
    }
}

/// A number with a blank between thousands, from five digits on.
pub(super) fn grouped(number: &str) -> String {
    let start = usize::from(number.starts_with('-'));
    let end = number.find('.').unwrap_or(number.len());
    if end - start < 5 || !number[start..end].bytes().all(|byte| byte.is_ascii_digit()) {
        return number.to_owned();
    }
    let mut text = number[..start].to_owned();
    for (index, digit) in number[start..end].char_indices() {
        if index > 0 && (end - start - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text + &number[end..]
}

/// The decimals that distinguish two frames `step` seconds apart: at least two, at most nine.
fn decimals(step: f64) -> usize {
    let mut decimals = 2;
    let mut smallest = 0.01;
    // The last digit may advance by a few, but must not stand still. So 1/30 s needs two decimals, 1 ms three.
    while decimals < 9 && step > 0.0 && step < smallest * (1.0 - 1e-9) {
        decimals += 1;
        smallest *= 0.1;
    }
    decimals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_tells_frames_apart() {
        for (step, expected) in [(1.0 / 30.0, 2), (0.01, 2), (0.005, 3), (0.001, 3), (1e-12, 9), (5.0, 2), (0.0, 2)] {
            assert_eq!(decimals(step), expected, "{step}");
        }
        let theme = Theme::named("paper").expect("shipped");
        assert_eq!(Clock::new(20.0, 1e-3, &theme).text(2.0675), "t = 2.067 s");
        // 49 million seconds are 567 days and 3.1 hours.
        for (step, time, text) in [
            (1.0, 18_000.0, "t = 18 000.00 s"),
            (59.0, 590.0, "t = 590.00 s"),
            (60.0, 600.0, "t = 10.00 min"),
            (3600.0, 5400.0, "t = 1.50 h"),
            (1e5, 4.9e7, "t = 567.13 d"),
            (4e7, 3_155_760e3, "t = 100.00 a"),
            (f64::NAN, 1.0, "t = 1.00 s"),
        ] {
            let clock = Clock::new(20.0, step, &theme);
            assert_eq!(clock.text(time), text);
            assert!(text.chars().all(|letter| clock.letters.contains_key(&letter)), "{text}");
        }
    }

    #[test]
    fn thousands_are_set_apart() {
        for (number, expected) in
            [("1234.5", "1234.5"), ("12345.67", "12 345.67"), ("-1234567", "-1 234 567"), ("inf", "inf"), ("0", "0")]
        {
            assert_eq!(grouped(number), expected);
        }
    }
}
