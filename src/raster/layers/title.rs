//! The scene's title.

use tiny_skia::{FillRule, Pixmap, Transform};

use super::labels::{Column, break_lines};
use super::paint;
use crate::raster::text::Lettering;
use crate::raster::theme::Theme;

/// Draws the title into its column; gives the height it took, in pixels.
pub(in crate::raster) fn draw(
    pixmap: &mut Pixmap,
    title: &str,
    lettering: &Lettering,
    column: &Column,
    theme: &Theme,
) -> f32 {
    let leading = 1.3 * lettering.size();
    let lines = break_lines(title, lettering, column.width);
    for (place, line) in lines.iter().enumerate() {
        // Capitals are 0.73 em high: the first line's upper edge is the column's.
        let baseline = column.top + 0.73 * lettering.size() + leading * place as f32;
        if let Some(path) = lettering.path(line, column.left, baseline) {
            pixmap.fill_path(&path, &paint(theme.ink), FillRule::Winding, Transform::identity(), None);
        }
    }
    leading * lines.len() as f32
}
