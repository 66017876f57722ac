//! The title of the scene.

use tiny_skia::{PathBuilder, Pixmap};

use super::labels::{Column, Sticker, break_lines, halo};
use crate::raster::text::Lettering;
use crate::raster::theme::Theme;

/// The title, set in lines.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Title {
    sticker: Option<Sticker>,
    height: f32,
}

impl Title {
    /// Sets the title into its column.
    pub(in crate::raster) fn new(title: &str, lettering: &Lettering, column: &Column, theme: &Theme) -> Title {
        let leading = 1.3 * lettering.size();
        let lines = break_lines(title, lettering, column.width);
        let mut builder = PathBuilder::new();
        for (index, line) in lines.iter().enumerate() {
            // Capitals are 0.73 em high: the first line's upper edge is the column's.
            let baseline = column.top + 0.73 * lettering.size() + leading * index as f32;
            if let Some(path) = lettering.path(line, column.left, baseline) {
                builder.push_path(&path);
            }
        }
        let sticker = builder.finish().and_then(|letters| {
            let halo = if column.in_room { halo(&letters, lettering.size()) } else { None };
            let below = halo.iter().map(|halo| (halo, theme.background));
            Sticker::new(&below.chain([(&letters, theme.ink)]).collect::<Vec<_>>())
        });
        // A little air before the clock.
        let gap = if lines.is_empty() { 0.0 } else { 0.2 * lettering.size() };
        Title { sticker, height: leading * lines.len() as f32 + gap }
    }

    /// The height it takes in its column, in pixels.
    pub(in crate::raster) fn height(&self) -> f32 {
        self.height
    }

    /// Draws the title.
    pub(in crate::raster) fn draw(&self, pixmap: &mut Pixmap) {
        if let Some(sticker) = &self.sticker {
            sticker.put(pixmap, 0, 0);
        }
    }
}
