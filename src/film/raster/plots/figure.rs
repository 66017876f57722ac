//! Plots as a still figure, below each other, with names at the axes.

use tiny_skia::Pixmap;

use super::chart::{Chart, Naming, Tools};
use super::panel_style::{Sizes, Tones};
use super::stroke::Area;
use crate::raster::canvas::{Canvas, fill};
use crate::raster::{SizeError, Theme};
use jostle_frames::plot::Plot;

/// Letters of a figure are larger than those beside a film: it is looked at alone, and often made smaller.
pub(super) const LETTERS: f32 = 1.45;

/// The least width of a figure, and the least height of each of its plots, in pixels. That holds a title, labels at both axes and a
/// curve, in the smallest letters that can be read.
pub const LEAST: (u32, u32) = (160, 95);

/// Width and height in pixels of the smallest plot with letters as large as beside a wide film.
const ROOM: (f32, f32) = (240.0, 160.0);

/// Draws plots below each other, in their final state.
///
/// # Errors
/// A [`SizeError`] if there is no picture of that size.
pub fn figure(plots: &[Plot], theme: &Theme, (width, height): (u32, u32)) -> Result<Pixmap, SizeError> {
    let mut picture = Pixmap::new(width, height).ok_or(SizeError { width, height })?;
    let count = plots.len().max(1) as f32;
    let each = height as f32 / count;
    let unit = LETTERS * (width as f32 * each / (1280.0 * 720.0)).sqrt();
    // In a flat or narrow figure the short side bounds the letters.
    let sizes = Sizes::new(unit.min(width as f32 / ROOM.0).min(each / ROOM.1));
    let tones = Tones::new(theme);
    let mut canvas = Canvas::new(&mut picture);
    for row in 0..canvas.height() {
        fill(canvas.row(row), tones.card);
    }
    let mut tools = Tools::default();
    for (index, plot) in plots.iter().enumerate() {
        let top = index as f32 * each;
        let pad = 1.2 * sizes.pad;
        let area = Area {
            left: pad.round(),
            top: (top + pad).round(),
            right: (width as f32 - 1.4 * pad).round(),
            bottom: (top + each - 0.7 * pad).round(),
        };
        let chart = Chart::new(plot, area, Naming::Full, &sizes, &tones);
        chart.draw_furniture(&mut picture);
        chart.draw_until(&mut picture, f64::INFINITY, &mut tools);
    }
    Ok(picture)
}
