//! The clock: the time of the frame, with digits that stand still.

use std::collections::BTreeMap;

use tiny_skia::Pixmap;

use super::labels::{Column, Sticker, halo};
use crate::raster::text::{Lettering, Weight};
use crate::raster::theme::Theme;

/// Every letter a time may need, infinite and undefined ones too.
const LETTERS: &str = "t = s-.0123456789infNa";

/// The clock of a film.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Clock {
    letters: BTreeMap<char, Letter>,
    size: f32,
    decimals: usize,
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
    /// A clock with letters of `size` pixels that shows so many decimals of a second.
    pub(in crate::raster) fn new(size: f32, decimals: usize, theme: &Theme) -> Clock {
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
        Clock { letters: LETTERS.chars().map(letter).collect(), size, decimals }
    }

    /// The width of a time of two digits, in pixels.
    pub(in crate::raster) fn width(&self) -> f32 {
        let text = self.text(10.0);
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
        format!("t = {time:.*} s", self.decimals)
    }
}

/// The decimals that tell two frames `step` seconds apart: at least two, at most nine.
pub(in crate::raster) fn decimals(step: f64) -> usize {
    let mut decimals = 2;
    let mut smallest = 0.01;
    // The last digit may count in steps of a few, not stand still: 1/30 s needs two decimals, 1 ms three.
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
        assert_eq!(Clock::new(20.0, 3, &theme).text(2.0675), "t = 2.067 s");
    }
}
