//! A work-precision diagram: the cost of runs against their error, a curve for each method, on logarithmic axes.

use tiny_skia::Pixmap;

use super::LETTERS;
use super::chart::{Chart, Naming, Tools};
use super::panel_style::{Sizes, Tones};
use super::pen::Align;
use super::stroke::{Area, Point, Sheet};
use crate::raster::canvas::{Canvas, Ink, fill};
use crate::raster::theme::{Theme, Tint};
use crate::raster::{SizeError, canvas};
use jostle_frames::frame::Rgb;
use jostle_frames::plot::Plot;

/// The sign at a point of a diagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// A setting.
    Dot,
    /// A setting that no other one beats.
    Best,
    /// A setting that failed.
    Cross,
}

/// A point of a diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The curve that it belongs to, by its place.
    pub curve: usize,
    /// Its value to the right.
    pub x: f64,
    /// Its value upwards.
    pub y: f64,
    /// Its sign.
    pub sign: Sign,
}

/// How a curve looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// In a colour and with dashes, by their indices among colours and dashes.
    Main {
        /// Curves of one kind have one colour.
        color: usize,
        /// They differ in their dashes.
        dash: usize,
    },
    /// In grey, by its index among such curves.
    Aside(usize),
}

/// A diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// The axes with their ranges, and the curves, as phases.
    pub plot: Plot,
    /// The text beside the title.
    pub aside: String,
    /// The look of its curves.
    pub looks: Vec<Look>,
    /// Its points, from back to front.
    pub spots: Vec<Spot>,
    /// An upright line, and the text along it.
    pub floor: Option<(f64, String)>,
    /// The beginning of the useless range to the right, and the text there.
    pub useless: (f64, String),
}

/// The share of the colour of letters in a useless region.
const SHADE: f32 = 0.045;

/// Draws a diagram.
///
/// # Errors
/// A [`SizeError`] if there is no picture of that size.
pub fn draw_diagram(diagram: &Diagram, theme: &Theme, (width, height): (u32, u32)) -> Result<Pixmap, SizeError> {
    let mut picture = Pixmap::new(width, height).ok_or(SizeError { width, height })?;
    let sizes = Sizes::new(LETTERS * (width as f32 * height as f32 / (1280.0 * 720.0)).sqrt());
    let tones = Tones::new(theme);
    let mut canvas = Canvas::new(&mut picture);
    for row in 0..canvas.height() {
        fill(canvas.row(row), tones.card);
    }
    let pad = 1.2 * sizes.pad;
    let area = Area {
        left: pad.round(),
        top: pad.round(),
        right: (width as f32 - 1.4 * pad).round(),
        bottom: (height as f32 - 0.7 * pad).round(),
    };
    let chart = Chart::new(&diagram.plot, area, Naming::Full, &sizes, &tones)
        .with_aside(&diagram.aside)
        .with_looks(&diagram.looks);
    let inner = *chart.inner();
    let shade = Tint { toward: theme.ink, share: SHADE }.of(tones.card);
    let from = chart.spot(diagram.useless.0, 1.0).0.clamp(inner.left, inner.right);
    Area { left: from, ..inner }.fill(&mut Canvas::new(&mut picture), shade);
    chart.draw_furniture(&mut picture);
    let small = tones.small(&sizes);
    let beside = 0.8 * sizes.text;
    let middle = (0.5 * (from + inner.right) + 0.36 * sizes.text, inner.top + beside);
    let useless = small.shortened(&diagram.useless.1, inner.height() - 2.0 * beside);
    small.write_upwards(&mut picture, &useless, middle, Align::Right);
    let mut sheet = Sheet::default();
    if let Some((value, text)) = &diagram.floor {
        let x = chart.spot(*value, 1.0).0;
        if x > inner.left {
            let line = [(x, inner.bottom), (x, inner.top)];
            stroke(&mut picture, &mut sheet, &inner, &line, (sizes.hair, tones.quiet));
        }
        let text = small.shortened(text, inner.height() - 2.0 * beside);
        // No curve is left of the line.
        let has_room = x - inner.left > 2.0 * sizes.text;
        let baseline = if has_room { x - 0.5 * sizes.text } else { x.max(inner.left) + 1.4 * sizes.text };
        small.write_upwards(&mut picture, &text, (baseline, inner.bottom - beside), Align::Left);
    }
    chart.draw_until(&mut picture, f64::INFINITY, &mut Tools::default());
    for spot in &diagram.spots {
        let color = chart.color(spot.curve);
        let (x, y) = chart.spot(spot.x, spot.y);
        match spot.sign {
            Sign::Cross => {
                let arm = 1.1 * sizes.dot;
                for line in [[(x - arm, y - arm), (x + arm, y + arm)], [(x - arm, y + arm), (x + arm, y - arm)]] {
                    stroke(&mut picture, &mut sheet, &inner, &line, (sizes.line, color));
                }
            }
            Sign::Dot => disc(&mut picture, (x, y), 0.85 * sizes.dot, color),
            Sign::Best => {
                disc(&mut picture, (x, y), 1.75 * sizes.dot, color);
                disc(&mut picture, (x, y), 1.75 * sizes.dot - sizes.line, tones.card);
                disc(&mut picture, (x, y), 0.7 * sizes.dot, color);
            }
        }
    }
    Ok(picture)
}

fn disc(picture: &mut Pixmap, (x, y): Point, radius: f32, color: Rgb) {
    Canvas::new(picture).disc(x, y, radius, &Ink::plain(color));
}

fn stroke(picture: &mut Pixmap, sheet: &mut Sheet, inner: &Area, line: &[Point; 2], (width, color): (f32, Rgb)) {
    let reach = 4.0 * width + 8.0;
    let Area { left, top, right, bottom } = *inner;
    sheet.begin(&Area { left: left - reach, top: top - reach, right: right + reach, bottom: bottom + reach });
    sheet.line(line, width, &[], &[]);
    sheet.put(&mut canvas::Canvas::new(picture), color);
}
