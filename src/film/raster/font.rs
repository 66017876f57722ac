//! The outlines of a font, as `tools/font_outlines.py` writes them.
//!
//! The first line has the units per em. Each line after it describes one character: its number (hexadecimal), the
//! advance to the next character, and the outline. The outline is in units of the font, y up. In the outline `@x,y`
//! shifts the following part, and `/x,y` begins a contour. `x,y` is the next point on it, and `~x,y` the control point
//! of a quadratic curve. Between two control points the curve goes through their middle.

use std::collections::BTreeMap;

use tiny_skia::{Path, PathBuilder};

/// The replacement for a character that the font lacks.
const LACKING: char = '\0';

/// One letter: its outline at the origin of the baseline (y down), and its advance. A space has no outline.
#[derive(Clone, Debug)]
pub(super) struct Letter {
    pub(super) outline: Option<Path>,
    pub(super) advance: f32,
}

/// The lines of a font by their character.
pub(super) struct Font<'a> {
    units_per_em: f64,
    lines: BTreeMap<char, &'a str>,
}

impl<'a> Font<'a> {
    /// Reads the text of a font; a letter only when it is asked for.
    pub(super) fn read(text: &'a str) -> Option<Self> {
        let (units_per_em, lines) = text.split_once('\n')?;
        let line = |line: &'a str| {
            let (code, letter) = line.split_once(' ')?;
            Some((char::from_u32(u32::from_str_radix(code, 16).ok()?)?, letter))
        };
        Some(Self { units_per_em: units_per_em.parse().ok()?, lines: lines.lines().map(line).collect::<Option<_>>()? })
    }

    /// Whether the font has this character.
    #[cfg(test)]
    pub(super) fn has(&self, character: char) -> bool {
        self.lines.contains_key(&character)
    }

    /// A letter at a size in pixels per em. A character that the font lacks becomes an empty box.
    pub(super) fn letter(&self, character: char, size: f32) -> Option<Letter> {
        let line = self.lines.get(&character).or_else(|| self.lines.get(&LACKING))?;
        let (advance, outline) = line.split_once(' ').unwrap_or((line, ""));
        let grid = Grid::new(size, self.units_per_em);
        let mut pen = Pen { grid, ..Pen::default() };
        outline.split_terminator(' ').try_for_each(|word| pen.follow(word))?;
        pen.close();
        Some(Letter { outline: pen.path.finish(), advance: grid.advance(advance.parse().ok()?) })
    }
}

/// A grid of 1/64 pixel for the points of outlines, as in rasterisers of TrueType fonts.
#[derive(Clone, Copy, Default)]
struct Grid {
    /// Steps of the grid per unit of the font.
    scale: f64,
}

impl Grid {
    const STEPS: f32 = 64.0;
    /// The scale itself has 16 bits behind the point, and so do advances in pixels.
    const FINE: f64 = 65536.0;

    fn new(size: f32, units_per_em: f64) -> Self {
        Self { scale: (f64::from((size * Self::STEPS).trunc()) * Self::FINE / units_per_em).round() / Self::FINE }
    }

    fn snap(self, units: i32) -> i32 {
        (f64::from(units) * self.scale).round() as i32
    }

    fn advance(self, units: i32) -> f32 {
        ((f64::from(units) * self.scale * Self::FINE / f64::from(Self::STEPS)).round() / Self::FINE) as f32
    }
}

/// A point on the grid.
type Point = (i32, i32);

/// Follows the words of an outline.
#[derive(Default)]
struct Pen {
    path: PathBuilder,
    grid: Grid,
    shift: Point,
    start: Point,
    /// The control point of the curve that is not drawn yet.
    control: Option<Point>,
}

impl Pen {
    fn follow(&mut self, word: &str) -> Option<()> {
        let sign = word.chars().next().filter(|first| "@/~".contains(*first));
        let (x, y) = word[sign.map_or(0, char::len_utf8)..].split_once(',')?;
        let (x, y) = (self.grid.snap(x.parse().ok()?), self.grid.snap(y.parse().ok()?));
        let point = (x + self.shift.0, y + self.shift.1);
        match sign {
            Some('@') => self.shift = (x, y),
            Some('/') => {
                self.close();
                self.path.move_to(pixels(point.0), -pixels(point.1));
                self.start = point;
            }
            Some(_) => {
                if let Some(control) = self.control.replace(point) {
                    self.curve(control, ((control.0 + point.0) / 2, (control.1 + point.1) / 2));
                }
            }
            None => self.on_curve(point),
        }
        Some(())
    }

    fn on_curve(&mut self, point: Point) {
        match self.control.take() {
            Some(control) => self.curve(control, point),
            None => self.path.line_to(pixels(point.0), -pixels(point.1)),
        }
    }

    fn curve(&mut self, control: Point, to: Point) {
        self.path.quad_to(pixels(control.0), -pixels(control.1), pixels(to.0), -pixels(to.1));
    }

    /// Closes the current contour at its first point.
    fn close(&mut self) {
        if let Some(control) = self.control.take() {
            self.curve(control, self.start);
        }
        self.path.close();
    }
}

fn pixels(steps: i32) -> f32 {
    steps as f32 / Grid::STEPS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 64 units per em at 1 pixel per em: a unit is a step of the grid.
    const FONT: &str = "64\n0 64 @0,0 /0,0 64,0 64,64\n41 50 @0,0 /0,0 ~0,8 ~8,8 8,0 @0,16 /0,0 8,0 0,8\n20 32\n";

    #[test]
    fn lines_become_outlines() {
        let font = Font::read(FONT).expect("a font");
        let letter = font.letter('A', 64.0).expect("a letter");
        assert_eq!(letter.advance, 50.0);
        let mut expected = PathBuilder::new();
        expected.move_to(0.0, 0.0);
        expected.quad_to(0.0, -8.0, 4.0, -8.0);
        expected.quad_to(8.0, -8.0, 8.0, 0.0);
        expected.close();
        expected.move_to(0.0, -16.0);
        expected.line_to(8.0, -16.0);
        expected.line_to(0.0, -24.0);
        expected.close();
        assert_eq!(letter.outline, expected.finish());
        assert!(font.letter(' ', 64.0).expect("a space").outline.is_none());
    }

    #[test]
    fn points_lie_on_the_grid() {
        let font = Font::read(FONT).expect("a font");
        // A unit is 0.4 steps: 8 units are 3.2 of them.
        let bounds = font.letter('A', 0.4).expect("a letter").outline.expect("an outline").bounds();
        assert_eq!(bounds.right(), 3.0 / 64.0);
    }

    #[test]
    fn the_box_stands_for_what_is_lacking() {
        let font = Font::read(FONT).expect("a font");
        assert!(font.has('A') && !font.has('?'));
        assert_eq!(font.letter('?', 64.0).expect("the box").advance, 64.0);
    }

    #[test]
    fn what_is_no_outline_is_refused() {
        for wrong in ["", "64", "x\n20 32\n", "64\nzz 32\n", "64\n20\n"] {
            assert!(Font::read(wrong).is_none(), "{wrong:?}");
        }
        for letter in ["x", "32 @0", "32 @0,0 /1,b", "32 %1,1"] {
            let text = format!("64\n41 {letter}\n");
            assert!(Font::read(&text).expect("lines").letter('A', 20.0).is_none(), "{letter}");
        }
    }
}
