//! Themes: every colour of a film. Each is a file `assets/themes/*.ron`, and all are part of the program.

use serde::{Deserialize, Deserializer, de};

use jostle_frames::color_names::{COLOR_NAMES, THEMES};
use jostle_frames::frame::Rgb;

/// Every colour of a film.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Theme {
    /// The colour of the empty background.
    #[serde(deserialize_with = "hexadecimal")]
    pub background: Rgb,
    /// The lines of the grid on the background.
    #[serde(deserialize_with = "hexadecimal")]
    pub grid: Rgb,
    /// Deep behind a wall.
    #[serde(deserialize_with = "hexadecimal")]
    pub ground: Rgb,
    /// The band along a wall, for walls without a colour of their own.
    #[serde(deserialize_with = "hexadecimal")]
    pub wall: Rgb,
    /// The title.
    #[serde(deserialize_with = "hexadecimal")]
    pub ink: Rgb,
    /// The clock and other small print.
    #[serde(deserialize_with = "hexadecimal")]
    pub quiet_ink: Rgb,
    /// From a fill to its outline.
    pub outline: Tint,
    /// From a fill to the marks on it: the atoms of a body, the spoke of a ball.
    pub mark: Tint,
    /// From the fill of a body to its trail.
    pub trail: Tint,
    /// Arrows of forces, and contact points.
    #[serde(deserialize_with = "hexadecimal")]
    pub force: Rgb,
    /// Arrows of velocities.
    #[serde(deserialize_with = "hexadecimal")]
    pub velocity: Rgb,
    /// Name of the palette's colour for fixed bodies without a colour of their own.
    pub fixed: String,
    /// Names of the palette's colours given in turn to moving bodies without a colour of their own.
    pub cycle: Vec<String>,
    /// The colours a scene may name.
    pub palette: Vec<Swatch>,
}

/// A step from any colour towards another.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Tint {
    /// The colour to go to.
    #[serde(deserialize_with = "hexadecimal")]
    pub toward: Rgb,
    /// The share of the way: 0 stays, 1 arrives.
    pub share: f32,
}

/// One named colour.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Swatch {
    /// The name in scenes.
    pub name: String,
    /// The colour.
    #[serde(deserialize_with = "hexadecimal")]
    pub color: Rgb,
}

impl Theme {
    /// The theme of that name, or `None`.
    ///
    /// ```
    /// # extern crate jostle_film as jostle;
    /// use jostle::raster::Theme;
    /// assert!(Theme::named("paper").is_some());
    /// assert!(Theme::named("wallpaper").is_none());
    /// ```
    pub fn named(name: &str) -> Option<Theme> {
        let (_, text) = THEMES.iter().find(|(known, _)| *known == name)?;
        Theme::read(text).ok()
    }

    /// A theme from its RON text, written like those in `assets/themes`.
    ///
    /// # Errors
    /// The error names the mistake, with line and column if they are known. A theme has exactly the colours of
    /// [`COLOR_NAMES`], in their order, so that scenes can count on them.
    pub fn read(text: &str) -> Result<Theme, String> {
        let theme: Theme = ron::from_str(text).map_err(|error| {
            let begin = error.span.start;
            format!("line {}, column {}: {}", begin.line, begin.col, error.code)
        })?;
        if !theme.color_names().eq(COLOR_NAMES) {
            return Err(format!("its palette must have these colours in this order: {}", COLOR_NAMES.join(", ")));
        }
        if theme.cycle.is_empty() {
            return Err("its `cycle` has no colours".to_owned());
        }
        if let Some(name) = theme.cycle.iter().chain([&theme.fixed]).find(|name| theme.color(name).is_none()) {
            return Err(format!("\"{name}\" is none of its colours"));
        }
        Ok(theme)
    }

    /// The names of all themes; the first is the default.
    pub fn names() -> Vec<&'static str> {
        THEMES.iter().map(|(name, _)| *name).collect()
    }

    /// The colour a scene means by a name of the palette (`"teal"`) or by `"#rrggbb"`; `None` if neither.
    pub fn color(&self, name: &str) -> Option<Rgb> {
        let swatch = self.palette.iter().find(|swatch| swatch.name == name);
        swatch.map_or_else(|| parse(name), |swatch| Some(swatch.color))
    }

    /// The colour of a layer's mark: a role of the theme, a colour that a scene may name, or ink.
    pub fn mark_color(&self, name: Option<&str>) -> Rgb {
        match name {
            Some("force") => self.force,
            Some("velocity") => self.velocity,
            Some("quiet") => self.quiet_ink,
            Some(name) => self.color(name).unwrap_or(self.ink),
            None => self.ink,
        }
    }

    /// The names of the palette's colours, in the order of the theme.
    pub fn color_names(&self) -> impl Iterator<Item = &str> {
        self.palette.iter().map(|swatch| swatch.name.as_str())
    }

    /// The fill of a body. It is the requested colour, or grey if the body is fixed. Otherwise it is the next colour in
    /// turn, counted from 0. An unknown name counts as no request, because the reader of the scene has reported it.
    pub fn body(&self, asked: Option<&str>, fixed: bool, turn: usize) -> Rgb {
        let own = asked.and_then(|name| self.color(name));
        let by_turn = || {
            let turn = turn.checked_rem(self.cycle.len())?;
            let name = if fixed { &self.fixed } else { &self.cycle[turn] };
            self.color(name)
        };
        own.or_else(by_turn).unwrap_or(self.ink)
    }
}

impl Tint {
    /// The colour that lies `share` of the way from `from`.
    pub fn of(self, from: Rgb) -> Rgb {
        let step = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * self.share + 0.5) as u8;
        Rgb(step(from.0, self.toward.0), step(from.1, self.toward.1), step(from.2, self.toward.2))
    }
}

/// Reads `"#rrggbb"`.
fn parse(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#')?;
    // `from_str_radix` alone would take a sign as well.
    if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let [_, red, green, blue] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some(Rgb(red, green, blue))
}

fn hexadecimal<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Rgb, D::Error> {
    let text = String::deserialize(deserializer)?;
    parse(&text).ok_or_else(|| de::Error::custom(format!("`{text}` is not a colour: write \"#rrggbb\"")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_theme_reads_and_names_only_colours_it_has() {
        for (name, text) in THEMES {
            Theme::read(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }

    #[test]
    fn a_theme_that_lacks_something_is_refused() {
        let paper = THEMES[0].1;
        for (from, to, message) in [
            ("(name: \"teal\"", "(name: \"tael\"", "sky, orange, teal"),
            ("fixed: \"grey\"", "fixed: \"gray\"", "\"gray\" is none"),
            ("background: \"#FAF9F6\"", "background: \"#FAF9\"", "write \"#rrggbb\""),
            ("wall:", "wal:", "wal"),
        ] {
            assert!(paper.contains(from), "{from}");
            let error = Theme::read(&paper.replacen(from, to, 1)).expect_err(to);
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn colours_are_read_by_name_and_by_digits() {
        let theme = Theme::named("paper").expect("shipped");
        assert_eq!(theme.color("teal"), Some(Rgb(0x01, 0x95, 0x66)));
        assert_eq!(theme.color("#0a0B0c"), Some(Rgb(10, 11, 12)));
        for wrong in ["#+12345", "#12345", "#1234567", "123456", "#12345g", "tael", ""] {
            assert_eq!(theme.color(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_body_takes_its_own_colour_then_grey_then_its_turn() {
        let theme = Theme::named("paper").expect("shipped");
        assert_eq!(theme.body(Some("#010203"), true, 0), Rgb(1, 2, 3));
        assert_eq!(theme.body(None, true, 1), theme.color("grey").expect("known"));
        assert_eq!(theme.body(None, false, 1), theme.color("orange").expect("known"));
        assert_eq!(theme.body(Some("no such"), false, 0), theme.color("sky").expect("known"));
        assert_eq!(theme.body(None, false, theme.cycle.len()), theme.body(None, false, 0));
    }
}
