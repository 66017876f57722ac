//! Text as outlines: letters of the shipped font become paths, set one after the other without shaping.

use std::collections::BTreeMap;

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};
use tiny_skia::{Path, PathBuilder, Transform};

/// The weights of the shipped font, Inter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    SemiBold,
}

impl Weight {
    fn file(self) -> &'static [u8] {
        match self {
            Weight::Regular => include_bytes!("../../assets/fonts/Inter-Regular.ttf"),
            Weight::SemiBold => include_bytes!("../../assets/fonts/Inter-SemiBold.ttf"),
        }
    }
}

/// One letter: its outline at the origin of the baseline (y down), none for a space, and the way to the next one.
#[derive(Clone, Debug)]
struct Letter {
    outline: Option<Path>,
    advance: f32,
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
        let letters = FontRef::new(weight.file()).map(|font| outline(&font, size, text)).unwrap_or_default();
        Lettering { letters, size }
    }

    /// Like [`Lettering::new`], but all digits are as wide as the widest, so that a running clock stands still.
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

    /// The outline of a text whose baseline begins at (`x`, `y`) in the picture; `None` if there is nothing to draw.
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

fn outline(font: &FontRef, size: f32, text: &str) -> BTreeMap<char, Letter> {
    let (size, location) = (Size::new(size), LocationRef::default());
    let (characters, outlines) = (font.charmap(), font.outline_glyphs());
    let metrics = font.glyph_metrics(size, location);
    let draw = |character: char| {
        let glyph = characters.map(character).unwrap_or_default();
        let mut pen = Pen(PathBuilder::new());
        let drawn = outlines.get(glyph).map(|outline| outline.draw(DrawSettings::unhinted(size, location), &mut pen));
        let outline = drawn.and_then(Result::ok).and_then(|_| pen.0.finish());
        Letter { outline, advance: metrics.advance_width(glyph).unwrap_or(0.0) }
    };
    text.chars().map(|character| (character, draw(character))).collect()
}

/// Takes the outline of a letter; the y axis turns over on the way.
struct Pen(PathBuilder);

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, -y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, -y);
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        self.0.quad_to(cx0, -cy0, x, -y);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.0.cubic_to(cx0, -cy0, cx1, -cy1, x, -y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_have_the_letters_of_science() {
        let text = "Aaé ßØµ αβγλμωΩΔ m² s⁻¹ 10³ – — “x” … ± × · ° ≤ ≈ → 0123456789";
        for weight in [Weight::Regular, Weight::SemiBold] {
            let font = FontRef::new(weight.file()).expect("the shipped font reads");
            for letter in text.chars() {
                assert!(font.charmap().map(letter).is_some(), "{weight:?} lacks {letter}");
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
