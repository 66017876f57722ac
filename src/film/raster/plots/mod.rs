//! The panel beside the film: plots in step with its clock, and a legend. The cards lie at the right, or below a
//! picture that is taller than wide.

mod axis;
mod axis_ticks;
mod chart;
mod diagram;
mod figure;
mod legend;
mod panel_style;
mod pen;
mod stroke;

use std::sync::Arc;

use tiny_skia::Pixmap;

pub(super) use chart::Tools;
pub use diagram::{Diagram, Look, Sign, Spot, draw_diagram};
pub use figure::figure;

use super::canvas::{Canvas, fill};
use super::theme::Theme;
use chart::{Chart, Naming};
use figure::LETTERS;
use jostle_frames::frame::Rgb;
use jostle_frames::plot::Board;
use legend::Key;
use panel_style::{Sizes, Tones};
use stroke::Area;

/// The share of the picture that the panel takes of its longer side.
const SHARE: f32 = 0.297;
/// Below the film the cards lie side by side, and the panel takes more.
const SHARE_BELOW: f32 = 0.34;
/// Narrower than this, or lower, no panel can be read, in pixels.
const SMALLEST: u32 = 110;

/// The height of a plot's card in its width.
const PROPORTION: f32 = 0.96;
/// It is not lower than so many lines of text, in their size.
const LOWEST: f32 = 18.0;

/// The panel of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    board: Arc<Board>,
    size: (u32, u32),
}

impl Panel {
    /// The panel of a picture whose full size is `size` pixels. `None` if it has no room or no content.
    pub fn new(board: &Arc<Board>, size: (u32, u32)) -> Option<Panel> {
        let panel = Panel { board: board.clone(), size };
        let (width, height) = size;
        let (stage_width, stage_height) = panel.stage();
        let shows = !board.plots.is_empty() || !board.legend.entries.is_empty();
        let fits = if panel.is_below() {
            height - stage_height >= SMALLEST && width >= SMALLEST
        } else {
            width - stage_width >= SMALLEST && height >= SMALLEST
        };
        (shows && fits).then_some(panel)
    }

    fn is_below(&self) -> bool {
        self.size.1 > self.size.0
    }

    /// The part of the picture, from its upper left corner, that is left to the film.
    pub fn stage(&self) -> (u32, u32) {
        let (width, height) = self.size;
        let rest = |side: u32, share: f32| side - (side as f32 * share).round() as u32;
        if self.is_below() { (width, rest(height, SHARE_BELOW)) } else { (rest(width, SHARE), height) }
    }

    /// Width and height of the whole picture in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The same in a picture of another size.
    pub fn resized(&self, size: (u32, u32)) -> Option<Panel> {
        Panel::new(&self.board, size)
    }
}

/// A panel ready to be drawn.
#[derive(Clone, Debug)]
pub(super) struct Cards {
    whole: Area,
    cards: Vec<(Area, Card)>,
    sizes: Sizes,
    tones: Tones,
    background: Rgb,
}

#[derive(Clone, Debug)]
enum Card {
    Chart(Box<Chart>),
    Key(Key),
}

impl Cards {
    /// Sets a panel; `fills` are the colours of the cast's bodies.
    pub(super) fn new(panel: &Panel, theme: &Theme, fills: &[Rgb]) -> Cards {
        let ((width, height), (stage_width, stage_height)) = (panel.size, panel.stage());
        let unit = (width as f32 * height as f32 / (1280.0 * 720.0)).sqrt();
        let (sizes, tones) = (Sizes::new(unit), Tones::new(theme).with_bodies(theme, fills));
        let (left, top) = if panel.is_below() { (0, stage_height) } else { (stage_width, 0) };
        let whole = Area { left: left as f32, top: top as f32, right: width as f32, bottom: height as f32 };
        let plots = &panel.board.plots;
        let gap = sizes.gap.round();
        let free =
            Area { left: whole.left + gap, top: whole.top + gap, right: whole.right - gap, bottom: whole.bottom - gap };
        let key = |most: usize, width: f32| {
            Key::new(&panel.board.legend, most, width - 2.0 * sizes.pad, (theme, fills), &sizes, &tones)
        };
        let mut cards = Vec::new();
        let chart = |area: &Area, index: usize| {
            Card::Chart(Box::new(Chart::new(&plots[index], inside(area, &sizes), Naming::Brief, &sizes, &tones)))
        };
        if panel.is_below() {
            let most = ((free.height() - 2.0 * sizes.pad - 4.9 * sizes.title) / (2.0 * sizes.legend)) as usize;
            let has_key = plots.len() < 3;
            let count = plots.len() + usize::from(has_key);
            let width = (free.width() - gap * (count as f32 - 1.0)) / count as f32;
            for index in 0..count {
                let left = (free.left + index as f32 * (width + gap)).round();
                let area = Area { left, right: (left + width).round(), ..free };
                let card =
                    if index < plots.len() { chart(&area, index) } else { Card::Key(key(2 * most.min(5), width)) };
                cards.push((area, card));
            }
        } else {
            // The legend gives way to the plots.
            let ideal = (PROPORTION * free.width()).max(LOWEST * sizes.text);
            let left_for = |key: Option<&Key>| {
                let taken = key.map_or(0.0, |key| key.height() + 2.0 * sizes.pad + gap);
                let count = plots.len().max(1) as f32;
                ((free.height() - taken - gap * (count - 1.0)) / count).min(ideal)
            };
            let keys = [10, 8, 6, 4, 2].map(|most| key(most, free.width()));
            let fits = |key: &&Key| {
                if plots.is_empty() {
                    left_for(Some(key)) > 0.0
                } else {
                    left_for(Some(key)) >= (0.62 * ideal).max(LOWEST * sizes.text)
                }
            };
            let key = keys.iter().find(fits);
            let height = left_for(key);
            let mut top = free.top;
            for index in 0..plots.len() {
                let area = Area { top: top.round(), bottom: (top + height).round(), ..free };
                let card = chart(&area, index);
                cards.push((area, card));
                top += height + gap;
            }
            if let Some(key) = key {
                let area = Area { top: top.round(), bottom: (top + key.height() + 2.0 * sizes.pad).round(), ..free };
                cards.push((area, Card::Key(key.clone())));
            }
        }
        Cards { whole, cards, sizes, tones, background: theme.background }
    }

    /// Draws the constant parts.
    pub(super) fn draw_furniture(&self, picture: &mut Pixmap) {
        let (left, width) = (self.whole.left as usize, self.whole.right as usize);
        let mut canvas = Canvas::new(picture);
        for row in self.whole.top as usize..self.whole.bottom as usize {
            fill(&mut canvas.row(row)[4 * left..4 * width], self.background);
        }
        for (area, card) in &self.cards {
            let Tones { card: color, border, .. } = self.tones;
            // Borders on whole pixels.
            let line = self.sizes.hair;
            let half = 0.5 * line;
            let border_area = Area {
                left: area.left + half,
                top: area.top + half,
                right: area.right - half,
                bottom: area.bottom - half,
            };
            pen::card(picture, &border_area, 0.55 * self.sizes.pad, color, border, line);
            match card {
                Card::Chart(chart) => chart.draw_furniture(picture),
                Card::Key(key) => key.draw(picture, &inside(area, &self.sizes)),
            }
        }
    }

    /// Draws the panel at a time (s). The constant parts are copied from the backdrop, over bodies that left the
    /// picture.
    pub(super) fn draw(&self, picture: &mut Pixmap, backdrop: &Pixmap, time: f64, tools: &mut Tools) {
        let across = 4 * backdrop.width() as usize;
        let columns = 4 * self.whole.left as usize..across;
        let first = self.whole.top as usize;
        let rows = picture.data_mut().chunks_exact_mut(across).zip(backdrop.data().chunks_exact(across));
        for (row, below) in rows.skip(first) {
            row[columns.clone()].copy_from_slice(&below[columns.clone()]);
        }
        for (_, card) in &self.cards {
            if let Card::Chart(chart) = card {
                chart.draw_until(picture, time, tools);
            }
        }
    }

    /// The flat colours.
    pub(super) fn flat_colors(&self) -> impl Iterator<Item = Rgb> {
        self.tones.flat()
    }
}

/// The part of a card within its padding.
fn inside(area: &Area, sizes: &Sizes) -> Area {
    let pad = sizes.pad.round();
    Area { left: area.left + pad, top: area.top + pad, right: area.right - pad, bottom: area.bottom - pad }
}
