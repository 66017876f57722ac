//! `--max-size`: a GIF that fits. Colours, size and rate are lowered step by step, in an order that keeps the film
//! worth watching. The physics is run once, and the frames come from a spool.

use super::film::{FilmRequest, Trouble};
use super::flags::bytes_in_words;
use super::say::{number, say};
use crate::output::{self, Draft, Film, FilmSettings, OutputError, WrittenFilm};
use crate::raster::View;

/// A film within a size.
pub(super) struct Squeeze<'a> {
    pub settings: FilmSettings,
    pub view: &'a View,
    /// The size in bytes.
    pub most: u64,
    /// The number of frames that were kept aside.
    pub frames: u64,
}

/// One compromise.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rung {
    /// Width and height, as a share of the requested ones.
    scale: f64,
    /// Every so manieth frame is shown.
    every: u64,
    colors: usize,
}

const fn rung(scale: f64, every: u64, colors: usize) -> Rung {
    Rung { scale, every, colors }
}

/// From the requested film down to a minimal one. Numbers of colours leave an entry for the transparent one.
const LADDER: [Rung; 16] = [
    rung(1.0, 1, 255),
    rung(1.0, 1, 127),
    rung(1.0, 1, 63),
    rung(0.85, 1, 63),
    rung(0.85, 2, 63),
    rung(0.7, 2, 63),
    rung(0.6, 2, 63),
    rung(0.5, 2, 63),
    rung(0.5, 2, 31),
    rung(0.4, 2, 31),
    rung(0.4, 3, 31),
    rung(0.3, 3, 31),
    rung(0.25, 3, 31),
    rung(0.25, 6, 31),
    rung(0.2, 6, 15),
    rung(0.125, 6, 15),
];

/// A film that uses this share of its size is large enough.
const GOOD_USE: f64 = 0.9;
/// The tries of other picture sizes between two rungs, each of which costs a film.
const MOST_REFINEMENTS: usize = 3;

impl Rung {
    /// The same with larger pictures, so that a film of `bytes` bytes would reach the limit. They are at most as large
    /// as requested. Bytes grow with the side for edges, and with its square for full changes.
    fn grown(self, bytes: u64, most: u64) -> Rung {
        let room = 0.5 * (1.0 + GOOD_USE) * most as f64 / bytes.max(1) as f64;
        Rung { scale: (self.scale * room.powf(1.0 / 1.5)).min(1.0), ..self }
    }

    /// The approximate size of a film of this rung, as a share of the first one. Edges grow with the side, and areas
    /// are cheap. With fewer frames each has more changes. It only selects the next rung to try.
    fn weight(&self) -> f64 {
        let colors = (self.colors as f64 / 255.0).powf(0.2);
        self.scale.powf(1.3) * (self.every as f64).powf(-0.8) * colors
    }
}

impl Squeeze<'_> {
    /// Makes the best film that fits. `play` shows every so manieth frame to a film.
    pub fn make(
        &self,
        order: &FilmRequest,
        mut play: impl FnMut(&mut dyn Film, u64) -> Result<(), Trouble>,
    ) -> Result<WrittenFilm, Trouble> {
        // Only the best one gets its name, and the earlier film stays until then.
        let mut best: Option<(usize, Draft)> = None;
        // All rungs before this one are known to be too large.
        let (mut low, mut next) = (0, 0);
        let mut smallest = 0.0;
        while best.as_ref().is_none_or(|(fits, _)| low < *fits) {
            match self.attempt(order, LADDER[next], &mut play) {
                Ok(draft) => {
                    best = Some((next, draft));
                    next = low + (next - low) / 2;
                }
                Err(Trouble::Output(OutputError::TooLarge { bytes, frames, .. })) => {
                    let shown = self.frames.div_ceil(LADDER[next].every).max(1);
                    smallest = bytes as f64 * shown as f64 / frames.max(1) as f64;
                    low = next + 1;
                    let end = best.as_ref().map_or(LADDER.len() - 1, |(fits, _)| *fits);
                    if low > end || next == LADDER.len() - 1 {
                        break;
                    }
                    let wanted = LADDER[next].weight() * self.most as f64 / smallest;
                    let fits = |rung: &usize| LADDER[*rung].weight() <= wanted;
                    next = if best.is_some() { low + (end - low) / 2 } else { (low..end).find(fits).unwrap_or(end) };
                }
                Err(other) => return Err(other),
            }
        }
        let Some((index, fitting)) = best else {
            let (most, smallest) = (bytes_in_words(self.most as f64), bytes_in_words(smallest));
            order.request.usage(&format!(
                "the film does not fit into {most}. At an eighth of its size, with a sixth of its frames and 15 colours, it \
                 takes {smallest}. Show less of the run with the film's `from` and `to`, or raise --max-size"
            ));
            return Err(Trouble::Told);
        };
        let (rung, draft) = self.refine(order, LADDER[index], fitting, &mut play)?;
        let written = draft.keep()?;
        if !order.quiet {
            self.tell(rung);
        }
        Ok(written)
    }

    /// Enlarges the pictures of a fitting film as far as possible, because the rungs of the ladder are far apart.
    fn refine(
        &self,
        order: &FilmRequest,
        mut rung: Rung,
        mut draft: Draft,
        play: &mut impl FnMut(&mut dyn Film, u64) -> Result<(), Trouble>,
    ) -> Result<(Rung, Draft), Trouble> {
        let mut next = rung.grown(draft.bytes(), self.most);
        for _ in 0..MOST_REFINEMENTS {
            if draft.bytes() as f64 >= GOOD_USE * self.most as f64 || self.size(next) == self.size(rung) {
                break;
            }
            match self.attempt(order, next, play) {
                Ok(larger) => {
                    (rung, draft) = (next, larger);
                    next = rung.grown(draft.bytes(), self.most);
                }
                Err(Trouble::Output(OutputError::TooLarge { .. })) => {
                    next.scale = (rung.scale * next.scale).sqrt();
                }
                Err(other) => return Err(other),
            }
        }
        Ok((rung, draft))
    }

    fn attempt(
        &self,
        order: &FilmRequest,
        rung: Rung,
        play: &mut impl FnMut(&mut dyn Film, u64) -> Result<(), Trouble>,
    ) -> Result<Draft, Trouble> {
        let view = self.view.resized(self.size(rung));
        let settings = FilmSettings {
            frames_per_second: self.settings.frames_per_second / rung.every as f64,
            colors: rung.colors,
            most_bytes: Some(self.most),
            ..self.settings
        };
        let mut film = output::open(&order.place.target, &settings, view)?;
        play(film.as_mut(), rung.every)?;
        Ok(film.close()?)
    }

    /// Width and height in pixels.
    fn size(&self, rung: Rung) -> (u32, u32) {
        let (width, height) = self.view.size();
        let side = |side: u32| ((f64::from(side) * rung.scale).round() as u32).max(side.min(16));
        (side(width), side(height))
    }

    /// Reports the reduction.
    fn tell(&self, rung: Rung) {
        let limit = bytes_in_words(self.most as f64);
        let ((width, height), (small_width, small_height)) = (self.view.size(), self.size(rung));
        let rate = self.settings.frames_per_second;
        let mut traded = Vec::new();
        if rung.scale < 1.0 {
            traded.push(format!("{small_width} x {small_height} pixels instead of {width} x {height}"));
        }
        if rung.every > 1 {
            let less = number(rate / rung.every as f64);
            traded.push(format!("{less} frames per second instead of {}", number(rate)));
        }
        if rung.colors < LADDER[0].colors {
            traded.push(format!("{} colours instead of {}", rung.colors, LADDER[0].colors));
        }
        let resized = self.view.resized((small_width, small_height));
        if self.view.panel.is_some() && resized.panel.is_none() {
            traded.push("no plots, as there is no room".to_owned());
        }
        say(&match traded.is_empty() {
            true => format!("--max-size {limit}: the film fits as it is"),
            false => format!("--max-size {limit}: {}", traded.join(", ")),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rung_is_smaller_than_the_one_before() {
        for pair in LADDER.windows(2) {
            assert!(pair[1].weight() < pair[0].weight(), "{pair:?}");
        }
    }
}
