//! The legend: the meaning of the colours of bodies and of the marks of layers, and a few facts.

use tiny_skia::Pixmap;

use super::panel_style::{Sizes, Tones};
use super::pen::{Align, patch};
use super::stroke::{Area, Sheet};
use crate::raster::canvas::{self, Canvas};
use crate::raster::theme::Theme;
use jostle_frames::frame::Rgb;
use jostle_frames::plot::{Legend, LegendEntry, LegendMark};

/// The title of the card.
const TITLE: &str = "Legend";

/// A legend with the colours of a cast, shortened to what fits.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Key {
    lines: Vec<Line>,
    facts: Vec<String>,
    columns: usize,
    sizes: Sizes,
    tones: Tones,
}

#[derive(Clone, Debug)]
struct Line {
    label: String,
    mark: Mark,
}

#[derive(Clone, Debug)]
enum Mark {
    Patch(Rgb, Rgb),
    Arrow(Rgb),
    Line(Rgb),
    Ring(Rgb),
    Nothing,
}

impl Key {
    /// A legend of at most `most` lines, in a column `width` pixels wide. `fills` are the colours of the cast's bodies.
    pub(in crate::raster) fn new(
        legend: &Legend,
        most: usize,
        width: f32,
        (theme, fills): (&Theme, &[Rgb]),
        sizes: &Sizes,
        tones: &Tones,
    ) -> Key {
        // Bodies give way, because the marks of a layer are visible everywhere.
        let is_body = |entry: &&LegendEntry| matches!(entry.mark, LegendMark::Body(_));
        let bodies: Vec<&LegendEntry> = legend.entries.iter().filter(is_body).collect();
        let others = legend.entries.iter().filter(|entry| !is_body(entry));
        let most = most.saturating_sub(others.clone().count());
        let all = bodies.len() + legend.more;
        // "and 1 more" would take the place of that one.
        let shown = if all > most { most.saturating_sub(1) } else { all }.min(bodies.len());
        let color = |name: &Option<String>| name.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.ink);
        let line = |entry: &LegendEntry| {
            let mark = match &entry.mark {
                LegendMark::Body(index) => {
                    let fill = fills.get(*index).copied().unwrap_or(theme.ink);
                    Mark::Patch(fill, theme.outline.of(fill))
                }
                LegendMark::Arrow(name) => Mark::Arrow(color(name)),
                LegendMark::Line(name) => Mark::Line(color(name)),
                LegendMark::Ring(name) => Mark::Ring(color(name)),
            };
            Line { label: entry.label.clone(), mark }
        };
        let mut lines: Vec<Line> = bodies[..shown].iter().map(|entry| line(entry)).collect();
        if shown < all && most > 0 {
            lines.push(Line { label: format!("and {} more", all - shown), mark: Mark::Nothing });
        }
        lines.extend(others.map(line));
        let label = tones.label(sizes);
        let widest = lines.iter().map(|line| label.width(&line.label)).fold(0.0, f32::max);
        let columns = if lines.len() > 1 && widest + indent(sizes) <= 0.5 * width - 0.4 * sizes.legend { 2 } else { 1 };
        Key { lines, facts: legend.facts.clone(), columns, sizes: *sizes, tones: tones.clone() }
    }

    fn rows(&self) -> usize {
        self.lines.len().div_ceil(self.columns)
    }

    /// The height it takes, in pixels.
    pub(in crate::raster) fn height(&self) -> f32 {
        let Sizes { title, legend, text, .. } = self.sizes;
        let facts = if self.facts.is_empty() { 0.0 } else { 0.5 * text + 1.6 * text * self.facts.len() as f32 };
        1.7 * title + 2.0 * legend * self.rows() as f32 + facts
    }

    /// Draws it into an area.
    pub(in crate::raster) fn draw(&self, picture: &mut Pixmap, area: &Area) {
        let (sizes, tones) = (&self.sizes, &self.tones);
        let legend = sizes.legend;
        tones.title(sizes).write(picture, TITLE, (area.left, area.top + 0.8 * sizes.title), Align::Left);
        let label = tones.label(sizes);
        let width = area.width() / self.columns as f32;
        let top = area.top + 1.7 * sizes.title;
        for (index, line) in self.lines.iter().enumerate() {
            let (column, row) = (index / self.rows(), index % self.rows());
            let (x, y) = ((area.left + column as f32 * width).round(), top + (row as f32 + 0.5) * 2.0 * legend);
            self.mark(picture, &line.mark, x, y.round());
            let beside = matches!(line.mark, Mark::Nothing);
            let left = if beside { x } else { x + indent(sizes) };
            let text = label.shortened(&line.label, area.left + (column + 1) as f32 * width - left);
            label.write(picture, &text, (left, y.round() + 0.36 * legend), Align::Left);
        }
        let small = tones.small(sizes);
        let mut baseline = top + 2.0 * legend * self.rows() as f32 + 0.5 * sizes.text;
        for fact in &self.facts {
            baseline += 1.6 * sizes.text;
            let text = small.shortened(fact, area.width());
            small.write(picture, &text, (area.left, baseline - 0.5 * sizes.text), Align::Left);
        }
    }

    fn mark(&self, picture: &mut Pixmap, mark: &Mark, x: f32, y: f32) {
        let (sizes, wide) = (&self.sizes, (1.75 * self.sizes.legend).round());
        let mut sheet = Sheet::default();
        sheet.begin(&Area { left: x - 2.0, top: y - wide, right: x + wide + 2.0, bottom: y + wide });
        match mark {
            Mark::Patch(fill, outline) => {
                let half = (0.58 * sizes.legend).round();
                let area = Area { left: x, top: y - half, right: x + wide, bottom: y + half };
                patch(picture, &area, *fill, *outline, sizes.line.min(0.3 * half));
            }
            Mark::Arrow(color) => {
                let (tip, head) = (x + wide, 0.42 * sizes.legend);
                sheet.line(&[(x + 1.0, y), (tip - 1.0, y)], sizes.line, &[], &[]);
                sheet.line(
                    &[(tip - head - 1.0, y - 0.7 * head), (tip - 1.0, y), (tip - head - 1.0, y + 0.7 * head)],
                    sizes.line,
                    &[],
                    &[],
                );
                sheet.put(&mut Canvas::new(picture), *color);
            }
            Mark::Line(color) => {
                sheet.line(&[(x + 1.0, y), (x + wide - 1.0, y)], sizes.line, &[], &[]);
                sheet.put(&mut Canvas::new(picture), *color);
            }
            Mark::Ring(color) => {
                let radius = 0.5 * sizes.legend;
                let ink = canvas::Ink { fill: self.tones.card, outline: *color, width: sizes.line };
                Canvas::new(picture).disc(x + 0.5 * wide, y, radius, &ink);
            }
            Mark::Nothing => (),
        }
    }
}

/// From a line's mark to its text.
fn indent(sizes: &Sizes) -> f32 {
    2.45 * sizes.legend
}
