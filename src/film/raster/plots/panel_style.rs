//! Sizes and colours of the panel.

use super::diagram::Look;
use super::pen::Ink;
use crate::raster::text::Weight;
use crate::raster::theme::{Theme, Tint};
use jostle_frames::frame::Rgb;
use jostle_frames::plot::Curve;

/// The colours of curves, by names of the palette. The first ones are far apart for all eyes, in light and in dark
/// themes. Yellow is left out, as a thin line of it is lost on paper.
const CURVES: [&str; 8] = ["vermilion", "blue", "teal", "purple", "orange", "sky", "pink", "brown"];

/// The dashes of lines, on and off in line widths. They cycle with the colours, so that curves differ without colours.
const DASHES: [&[f32]; 5] = [&[], &[], &[3.4, 2.6], &[6.0, 2.4, 1.0, 2.4], &[1.0, 2.2]];

/// Sizes in pixels; the smallest ones are those that can still be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::raster) struct Sizes {
    pub(super) title: f32,
    pub(super) text: f32,
    pub(super) legend: f32,
    pub(super) pad: f32,
    pub(super) gap: f32,
    pub(super) line: f32,
    pub(super) hair: f32,
    pub(super) dot: f32,
}

impl Sizes {
    /// The sizes for a picture so many times as large as 1280 x 720.
    pub(in crate::raster) fn new(unit: f32) -> Sizes {
        Sizes {
            title: (17.0 * unit).max(11.5),
            text: (12.5 * unit).max(9.0),
            legend: (13.5 * unit).max(9.5),
            pad: (18.0 * unit).max(7.0),
            gap: (18.0 * unit).max(6.0),
            line: (2.2 * unit).max(1.3),
            hair: unit.round().max(1.0),
            dot: (4.2 * unit).max(2.6),
        }
    }
}

/// Colours of cards and curves, made from those of a theme.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::raster) struct Tones {
    pub(super) card: Rgb,
    pub(super) border: Rgb,
    pub(super) grid: Rgb,
    pub(super) axis: Rgb,
    pub(super) ink: Rgb,
    pub(super) quiet: Rgb,
    curves: Vec<Rgb>,
    /// Colours of curves of bodies, by places in the cast.
    bodies: Vec<Rgb>,
}

/// A thin line with less contrast than this to its card is invisible, such as yellow on paper.
const LEAST_CONTRAST: f64 = 1.6;

impl Tones {
    pub(in crate::raster) fn new(theme: &Theme) -> Tones {
        let mix = |from: Rgb, toward: Rgb, share: f32| Tint { toward, share }.of(from);
        let Rgb(red, green, blue) = theme.background;
        let light = u32::from(red) + u32::from(green) + u32::from(blue) > 3 * 128;
        // Cards are a little lighter than their background.
        let card = if light {
            mix(theme.background, Rgb(255, 255, 255), 0.85)
        } else {
            mix(theme.background, theme.ink, 0.045)
        };
        Tones {
            card,
            border: mix(card, theme.ink, if light { 0.1 } else { 0.09 }),
            grid: mix(card, theme.ink, if light { 0.095 } else { 0.11 }),
            axis: mix(card, theme.ink, 0.34),
            ink: theme.ink,
            quiet: theme.quiet_ink,
            curves: CURVES.iter().filter_map(|name| theme.color(name)).collect(),
            bodies: Vec::new(),
        }
    }

    /// Adds the colours of the cast's bodies. A measurement of a body has its colour. If a line of that colour would be
    /// invisible, it has that of the outline.
    pub(in crate::raster) fn with_bodies(mut self, theme: &Theme, fills: &[Rgb]) -> Tones {
        let seen = |color: &Rgb| contrast(*color, self.card) >= LEAST_CONTRAST;
        let line = |fill: &Rgb| [*fill, theme.outline.of(*fill)].into_iter().find(seen).unwrap_or(self.ink);
        self.bodies = fills.iter().map(line).collect();
        self
    }

    /// Colours and dashes of the curves of a plot. Curves of one colour differ in their dashes.
    pub(super) fn curves(&self, curves: &[Curve], width: f32) -> Vec<(Rgb, Vec<f32>)> {
        let own = |curve: &Curve| curve.body.and_then(|body| self.bodies.get(body)).copied();
        let tone = |(index, curve): (usize, &Curve)| {
            let Some(color) = own(curve) else { return self.curve(index, &curve.label, width) };
            let before = curves[..index].iter().filter(|other| own(other) == Some(color)).count();
            // The first two entries are both unbroken, because their curves have two colours.
            let dashes = DASHES[1 + before % (DASHES.len() - 1)];
            (color, dashes.iter().map(|length| length * width).collect())
        };
        curves.iter().enumerate().map(tone).collect()
    }

    /// The colour of a curve by its index, and its dashes for a line of some width. A total is grey and dashed, because
    /// it sums up the other curves.
    pub(super) fn curve(&self, index: usize, label: &str, width: f32) -> (Rgb, Vec<f32>) {
        let total = label == "total" || label.ends_with(".total");
        self.look(if total { Look::Aside(2) } else { Look::Main { color: index, dash: index } }, width)
    }

    /// The colour of a curve that looks so, and its dashes for a line of some width. Of those in grey the first two are unbroken: they
    /// differ in their greys.
    pub(super) fn look(&self, look: Look, width: f32) -> (Rgb, Vec<f32>) {
        let (color, dash) = match look {
            Look::Main { color, dash } => {
                (color.checked_rem(self.curves.len()).map_or(self.ink, |turn| self.curves[turn]), dash)
            }
            Look::Aside(index) => (if index % DASHES.len() == 0 { self.axis } else { self.quiet }, index),
        };
        (color, DASHES[dash % DASHES.len()].iter().map(|length| length * width).collect())
    }

    /// The flat colours.
    pub(in crate::raster) fn flat(&self) -> impl Iterator<Item = Rgb> {
        let own = [self.card, self.border, self.grid, self.axis, self.ink, self.quiet];
        own.into_iter().chain(self.curves.iter().copied().take(4))
    }

    pub(super) fn title(&self, sizes: &Sizes) -> Ink {
        Ink { size: sizes.title, weight: Weight::SemiBold, color: self.ink }
    }

    pub(super) fn small(&self, sizes: &Sizes) -> Ink {
        Ink { size: sizes.text, weight: Weight::Regular, color: self.quiet }
    }

    pub(super) fn label(&self, sizes: &Sizes) -> Ink {
        Ink { size: sizes.legend, weight: Weight::Regular, color: self.ink }
    }
}

/// Contrast of two colours by WCAG 2.2, from 1 to 21.
fn contrast(a: Rgb, b: Rgb) -> f64 {
    let linear = |channel: u8| {
        let value = f64::from(channel) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
    };
    let luminance = |Rgb(red, green, blue): Rgb| 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a measurement of a body has the body's colour, and curves that share one differ in their dashes. A colour
    /// that is invisible on the card is replaced by a visible one. Black on white is 21 to 1 by the standard.
    #[test]
    fn curves_of_bodies_have_their_colours() {
        assert!((contrast(Rgb(0, 0, 0), Rgb(255, 255, 255)) - 21.0).abs() < 1e-9);
        for name in Theme::names() {
            let theme = Theme::named(name).expect("shipped");
            let color = |name: &str| theme.color(name).expect("in the palette");
            let fills = [color("teal"), color("pink"), Tones::new(&theme).card];
            let tones = Tones::new(&theme).with_bodies(&theme, &fills);
            let curve = |body: Option<usize>| Curve { label: "x".into(), body, samples: Vec::new() };
            let found = tones.curves(&[Some(1), None, Some(0), Some(1), Some(2)].map(curve), 2.0);
            assert_eq!([found[0].0, found[2].0, found[3].0], [fills[1], fills[0], fills[1]], "{name}");
            assert_eq!(found[1], tones.curve(1, "x", 2.0), "{name}");
            assert!(found[0].1.is_empty() && found[2].1.is_empty() && !found[3].1.is_empty(), "{name}");
            assert!(contrast(found[4].0, tones.card) >= LEAST_CONTRAST, "{name}");
        }
    }
}
