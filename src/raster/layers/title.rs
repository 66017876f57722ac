//! The scene's title.

use tiny_skia::{Path, PathBuilder, Pixmap};

use super::labels::{Column, Label, break_lines};
use crate::raster::text::Lettering;
use crate::raster::theme::Theme;

/// The title, set in lines.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Title {
    label: Option<Label>,
    height: f32,
}

impl Title {
    /// Sets the title into its column.
    pub(in crate::raster) fn new(title: &str, lettering: &Lettering, column: &Column) -> Title {
        let leading = 1.3 * lettering.size();
        let lines = break_lines(title, lettering, column.width);
        let mut builder = PathBuilder::new();
        for (place, line) in lines.iter().enumerate() {
            // Capitals are 0.73 em high: the first line's upper edge is the column's.
            let baseline = column.top + 0.73 * lettering.size() + leading * place as f32;
            lettering.path(line, column.left, baseline).iter().for_each(|path: &Path| builder.push_path(path));
        }
        // A little air before the clock.
        let gap = if lines.is_empty() { 0.0 } else { 0.2 * lettering.size() };
        let label = builder.finish().map(|path| Label::new(path, lettering.size(), column.in_room));
        Title { label, height: leading * lines.len() as f32 + gap }
    }

    /// The height it takes in its column, in pixels.
    pub(in crate::raster) fn height(&self) -> f32 {
        self.height
    }

    /// Draws the title.
    pub(in crate::raster) fn draw(&self, pixmap: &mut Pixmap, theme: &Theme) {
        if let Some(label) = &self.label {
            label.draw(pixmap, theme.ink, theme);
        }
    }
}
