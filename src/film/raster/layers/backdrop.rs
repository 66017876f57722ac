//! The background and its faint grid, whose lines lie at round lengths.

use glam::DVec2;
use tiny_skia::Pixmap;

use crate::raster::camera::Camera;
use crate::raster::canvas::{Canvas, fill};
use crate::raster::theme::Theme;

/// Lines of the grid from bottom to top of the picture, at most.
const LINES: f64 = 12.0;

/// Fills the picture with the background and draws the grid.
pub(in crate::raster) fn draw(pixmap: &mut Pixmap, camera: &Camera, theme: &Theme) {
    let mut canvas = Canvas::new(pixmap);
    for row in 0..canvas.height() {
        fill(canvas.row(row), theme.background);
    }
    let view = camera.view();
    let step = step(view.high.y - view.low.y);
    for x in lines(view.low.x, view.high.x, step) {
        // One whole pixel: a line between two pixels would be grey over both.
        let column = camera.to_picture(DVec2::new(x, 0.0)).x.floor().max(0.0) as usize;
        if column < canvas.width() {
            for row in 0..canvas.height() {
                fill(&mut canvas.row(row)[4 * column..4 * column + 4], theme.grid);
            }
        }
    }
    for y in lines(view.low.y, view.high.y, step) {
        let row = camera.to_picture(DVec2::new(0.0, y)).y.floor().max(0.0) as usize;
        if row < canvas.height() {
            fill(canvas.row(row), theme.grid);
        }
    }
}

/// The distance of the lines: the smallest 1, 2 or 5 times a power of ten within the limit. The limit is [`LINES`]
/// lines in a picture `height` metres high.
fn step(height: f64) -> f64 {
    let wanted = height / LINES;
    let mut decade = 1.0;
    while decade < wanted && decade < 1e300 {
        decade *= 10.0;
    }
    while decade / 10.0 >= wanted && decade > 1e-300 {
        decade /= 10.0;
    }
    [0.2, 0.5].into_iter().map(|part| part * decade).find(|step| *step >= wanted).unwrap_or(decade)
}

/// The multiples of `step` from `low` to `high`.
fn lines(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil(), (high / step).floor());
    // Far from the origin the multiples run together; then there is no grid to show.
    let count = if last - first < 1000.0 && last.abs() < 1e15 { (last - first).max(-1.0) as i64 + 1 } else { 0 };
    (0..count).map(move |line| (first + line as f64) * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_stand_at_round_lengths() {
        for (height, expected) in [(6.6, 1.0), (12.0, 1.0), (12.1, 2.0), (25.0, 5.0), (0.5, 0.05), (1e-6, 1e-7)] {
            assert!((step(height) / expected - 1.0).abs() < 1e-9, "{height}: {}", step(height));
        }
        assert_eq!(lines(-0.5, 2.0, 1.0).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
        assert_eq!(lines(0.1, 0.9, 1.0).count(), 0);
        assert_eq!(lines(1e300, 2e300, 1.0).count(), 0);
    }
}
