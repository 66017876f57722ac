//! Text as outlines: letters of the shipped font become paths, one after the other without shaping.

use std::collections::BTreeMap;

use tiny_skia::{Path, PathBuilder, Transform};

use super::font::{Font, Letter};

/// The weights of the shipped font, Inter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    SemiBold,
}

impl Weight {
    fn text(self) -> &'static str {
        match self {
            Weight::Regular => include_str!("../../../assets/fonts/Inter-Regular.txt"),
            Weight::SemiBold => include_str!("../../../assets/fonts/Inter-SemiBold.txt"),
        }
    }
}

/// A set of letters at one size, drawn once and used for every label.
#[derive(Clone, Debug)]
pub(super) struct Lettering {
    letters: BTreeMap<char, Letter>,
    size: f32,
}

impl Lettering {
    /// The letters that occur in `text`, at a size in pixels per em. A letter the font lacks becomes its empty box.
    pub(super) fn new(weight: Weight, size: f32, text: &str) -> Lettering {
        // A shipped font that does not read would give empty labels; the tests see that it does.
        let font = Font::read(weight.text());
        let letter = |character: char| Some((character, font.as_ref()?.letter(character, size)?));
        Lettering { letters: text.chars().filter_map(letter).collect(), size }
    }

    /// Like [`Lettering::new`], but all digits are as wide as the widest, so that a running clock does not jitter.
    pub(super) fn tabular(weight: Weight, size: f32, text: &str) -> Lettering {
        let mut lettering = Lettering::new(weight, size, text);
        let digits = || '0'..='9';
        let widths = digits().filter_map(|digit| lettering.letters.get(&digit)).map(|letter| letter.advance);
        let widest = widths.fold(0.0, f32::max);
        for digit in digits() {
            if let Some(letter) = lettering.letters.get_mut(&digit) {
                let shift = Transform::from_translate(0.5 * (widest - letter.advance), 0.0);
                letter.outline = letter.outline.take().and_then(|path| path.transform(shift));
                letter.advance = widest;
            }
        }
        lettering
    }

    /// Pixels per em.
    pub(super) fn size(&self) -> f32 {
        self.size
    }

    /// The width of a text in pixels.
    pub(super) fn width(&self, text: &str) -> f32 {
        text.chars().filter_map(|letter| self.letters.get(&letter)).map(|letter| letter.advance).sum()
    }

    /// The outline of a text whose baseline begins at (`x`, `y`) in the picture; `None` if it is empty.
    pub(super) fn path(&self, text: &str, x: f32, y: f32) -> Option<Path> {
        let mut builder = PathBuilder::new();
        let mut pen = x;
        for letter in text.chars().filter_map(|letter| self.letters.get(&letter)) {
            let placed = letter.outline.clone().and_then(|path| path.transform(Transform::from_translate(pen, y)));
            if let Some(path) = placed {
                builder.push_path(&path);
            }
            pen += letter.advance;
        }
        builder.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_have_the_letters_of_science() {
        let text = "Aaé ßØµ αβγλμωΩΔ m² s⁻¹ 10³ – — “x” … ± × · ° ≤ ≈ → 0123456789";
        for weight in [Weight::Regular, Weight::SemiBold] {
            let font = Font::read(weight.text()).expect("the shipped font reads");
            for letter in text.chars() {
                assert!(font.has(letter), "{weight:?} lacks {letter}");
                assert!(font.letter(letter, 20.0).is_some(), "{weight:?}: {letter} does not read");
            }
        }
    }

    #[test]
    fn every_time_of_a_clock_is_equally_wide() {
        let clock = Lettering::tabular(Weight::Regular, 20.0, "0123456789.");
        let width = clock.width("1.11");
        assert!(width > 20.0);
        assert_eq!(clock.width("0.00"), width);
        assert_eq!(clock.width("8.47"), width);
        // The font's own digits are not: the 1 is narrow.
        let plain = Lettering::new(Weight::Regular, 20.0, "0123456789.");
        assert!(plain.width("1.11") < plain.width("0.00"));
    }

    #[test]
    fn a_text_stands_on_its_baseline() {
        let title = Lettering::new(Weight::SemiBold, 20.0, "H");
        let bounds = title.path("H", 10.0, 50.0).expect("a letter").bounds();
        assert!((bounds.bottom() - 50.0).abs() < 0.01 && bounds.left() > 10.0);
        // Inter's capitals are 0.727 em high.
        assert!((bounds.height() - 0.727 * 20.0).abs() < 0.1);
        assert!(title.path(" ", 0.0, 0.0).is_none());
    }
}
