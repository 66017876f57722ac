//! The clock: the time of the frame, with digits that stand still.

use tiny_skia::Pixmap;

use super::labels::{Column, Label};
use crate::raster::text::{Lettering, Weight};
use crate::raster::theme::Theme;

/// The clock of a film.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Clock {
    lettering: Lettering,
    decimals: usize,
}

impl Clock {
    /// A clock with letters of `size` pixels that shows so many decimals of a second.
    pub(in crate::raster) fn new(size: f32, decimals: usize) -> Clock {
        Clock { lettering: Lettering::tabular(Weight::Regular, size, "t = s-.0123456789infNa"), decimals }
    }

    /// The width of a time of two digits, in pixels.
    pub(in crate::raster) fn width(&self) -> f32 {
        self.lettering.width(&self.text(10.0))
    }

    /// Draws the time (s) below `above` pixels of its column.
    pub(in crate::raster) fn draw(&self, pixmap: &mut Pixmap, time: f64, column: &Column, above: f32, theme: &Theme) {
        let size = self.lettering.size();
        let path = self.lettering.path(&self.text(time), column.left, column.top + above + 0.73 * size);
        if let Some(path) = path {
            Label::new(path, size, column.in_room).draw(pixmap, theme.quiet_ink, theme);
        }
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
        assert_eq!(Clock::new(20.0, 3).text(2.0675), "t = 2.067 s");
    }
}
