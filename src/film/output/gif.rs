//! GIF films: one palette for the whole film, only the changes from frame to frame, exact length, endless.
//!
//! A GIF counts time in hundredths of a second. At 30 frames per second the frames of a film last 3, 3, 4, 3, 3, 4 ...
//! of them. So the film as a whole has its exact length.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::delta::Patch;
use super::lzw::Packer;
use super::palette::{Histogram, Matcher, Palette};
use super::partial_file::{PartFile, Unfinished};
use super::studio::{Easel, Studio};
use super::{Draft, Film, FilmSettings, Format, Opened, OutputError, WrittenFilm, crew};
use crate::raster::{Painter, View};
use jostle_frames::frame::Frame;

pub(super) const FORMAT: Format = Format { ending: ".gif", open };

/// The palette comes from this many frames out of the first [`SAMPLED_FROM`]. They are always the same ones, whatever
/// the number of threads.
const SAMPLES: usize = 8;
const SAMPLED_FROM: usize = 48;

/// Frames packed at once, for each thread.
const FRAMES_PER_THREAD: usize = 4;

const LONGEST_SIDE: u32 = u16::MAX as u32;
const LONGEST_DELAY: f64 = u16::MAX as f64;

/// Browsers show a frame that is shorter than two hundredths of a second for ten of them instead.
const MOST_FRAMES_PER_SECOND: f64 = 50.0;

fn open(path: &Path, settings: &FilmSettings, view: View) -> Opened {
    let (width, height) = view.size();
    if width.max(height) > LONGEST_SIDE {
        return Err(OutputError::Size { width, height, longest: LONGEST_SIDE });
    }
    let (rate, allowed) = (settings.frames_per_second, (100.0 / LONGEST_DELAY, MOST_FRAMES_PER_SECOND));
    if !(allowed.0..=allowed.1).contains(&rate) {
        return Err(OutputError::Rate { frames_per_second: rate, allowed });
    }
    // A film with a limit of size is useless beyond it.
    let useless = settings.whole || settings.most_bytes.is_some();
    let unfinished = if useless { Unfinished::Removed } else { Unfinished::Kept };
    let file = PartFile::create(path, unfinished)?;
    let studio = Studio::new(view);
    let workers = (0..settings.threads.max(1)).map(|_| studio.easel().map(Worker::new));
    Ok(Box::new(Gif {
        path: path.to_path_buf(),
        part: file.beginning(),
        workers: workers.collect::<Result<_, _>>()?,
        width: width as usize,
        height: height as usize,
        studio,
        stage: Stage::Sampling(file),
        scenery: None,
        waiting: Vec::new(),
        last: Vec::new(),
        frames: 0,
        settings: *settings,
    }))
}

struct Gif {
    path: PathBuf,
    part: Option<PathBuf>,
    studio: Studio,
    workers: Vec<Worker>,
    width: usize,
    height: usize,
    stage: Stage,
    scenery: Option<Arc<Scenery>>,
    waiting: Vec<Frame>,
    /// The last written frame, as palette indices; empty before the first.
    last: Vec<u8>,
    frames: u64,
    settings: FilmSettings,
}

/// How far the film is.
enum Stage {
    /// Frames are collected for the palette.
    Sampling(PartFile),
    Running(Palette, gif::Encoder<PartFile>),
    /// An error has ended it.
    GivenUp,
}

/// The tools of one thread.
struct Worker {
    easel: Easel,
    matcher: Matcher,
    packer: Packer,
    symbols: Vec<u8>,
    alternatives: Vec<u8>,
}

impl Worker {
    fn new(easel: Easel) -> Worker {
        let (symbols, alternatives) = (Vec::new(), Vec::new());
        Worker { easel, matcher: Matcher::default(), packer: Packer::default(), symbols, alternatives }
    }

    /// Packs what changed. Pixels that did not are transparent, or keep their colour where that packs better.
    fn pack(&mut self, before: &[u8], after: &[u8], width: usize, palette: &Palette) -> Packed {
        let transparent = palette.transparent();
        self.symbols.clear();
        self.alternatives.clear();
        let patch = if before.is_empty() {
            self.symbols.extend_from_slice(after);
            Patch::whole(width, after.len() / width)
        } else if let Some(patch) = Patch::between(before, after, width) {
            for (before, after) in patch.cut(before, width).zip(patch.cut(after, width)) {
                let pairs = before.iter().zip(after);
                self.symbols.extend(pairs.map(|(before, after)| if before == after { transparent } else { *after }));
                self.alternatives.extend_from_slice(after);
            }
            patch
        } else {
            // Every frame must be there for its time to pass, and no frame may be empty.
            self.symbols.push(transparent);
            Patch::whole(1, 1)
        };
        let data = self.packer.pack(&self.symbols, &self.alternatives, transparent, palette.bits());
        Packed { patch, data }
    }
}

/// The parts that never move, as palette indices.
struct Scenery {
    painter: Arc<Painter>,
    indices: Vec<u8>,
}

/// One frame on its way.
struct Job {
    frame: Frame,
    scenery: Arc<Scenery>,
    indices: Vec<u8>,
}

struct Packed {
    patch: Patch,
    data: Vec<u8>,
}

impl Gif {
    /// Writes all full groups of the waiting frames, or all frames.
    fn advance(&mut self, all: bool) -> Result<(), OutputError> {
        let stage = std::mem::replace(&mut self.stage, Stage::GivenUp);
        let (palette, mut encoder) = match stage {
            Stage::GivenUp => return Err(OutputError::GivenUp { path: self.path.clone() }),
            Stage::Sampling(file) if self.waiting.is_empty() || !(all || self.waiting.len() >= SAMPLED_FROM) => {
                self.stage = Stage::Sampling(file);
                return Ok(());
            }
            Stage::Sampling(file) => self.begin(file)?,
            Stage::Running(palette, encoder) => (palette, encoder),
        };
        let group = FRAMES_PER_THREAD * self.workers.len();
        while self.waiting.len() >= group || (all && !self.waiting.is_empty()) {
            self.write_group(group, &palette, &mut encoder)?;
        }
        self.stage = Stage::Running(palette, encoder);
        Ok(())
    }

    /// Chooses the palette and writes the head of the file.
    fn begin(&mut self, file: PartFile) -> Result<(Palette, gif::Encoder<PartFile>), OutputError> {
        let first = self.studio.painter(&self.waiting[0])?;
        let pinned = first.flat_colors();
        let count = self.waiting.len().min(SAMPLED_FROM);
        let mut indices: Vec<usize> = (0..SAMPLES).map(|sample| sample * count / SAMPLES).collect();
        indices.dedup();
        let mut jobs = Vec::new();
        for frame in indices.into_iter().map(|index| &self.waiting[index]) {
            jobs.push((frame, self.studio.painter(frame)?, Histogram::default()));
        }
        crew::share_out(&mut self.workers, &mut jobs, |worker, (frame, painter, histogram)| {
            worker.easel.paint(painter, frame);
            histogram.count(worker.easel.picture.data());
        });
        let mut histogram = Histogram::default();
        for (_, _, own) in jobs {
            histogram.merge(own);
        }
        let palette = Palette::new(&pinned, histogram, self.settings.colors);
        let encoder = gif::Encoder::new(file, self.width as u16, self.height as u16, &palette.table());
        let endless = encoder.and_then(|mut encoder| encoder.set_repeat(gif::Repeat::Infinite).map(|()| encoder));
        Ok((palette, endless.map_err(|cause| self.failed(cause))?))
    }

    /// Draws, packs and writes the next frames.
    fn write_group(
        &mut self,
        group: usize,
        palette: &Palette,
        encoder: &mut gif::Encoder<PartFile>,
    ) -> Result<(), OutputError> {
        let frames: Vec<Frame> = self.waiting.drain(..group.min(self.waiting.len())).collect();
        let mut jobs = Vec::with_capacity(frames.len());
        for frame in frames {
            let scenery = self.scenery(&frame, palette)?;
            jobs.push(Job { frame, scenery, indices: vec![0; self.width * self.height] });
        }
        crew::share_out(&mut self.workers, &mut jobs, |worker, job| {
            let Scenery { painter, indices } = &*job.scenery;
            worker.easel.paint(painter, &job.frame);
            let backdrop = (painter.backdrop().data(), indices.as_slice());
            worker.matcher.match_over(palette, worker.easel.picture.data(), backdrop, &mut job.indices);
        });
        let last = std::mem::take(&mut self.last);
        let before = std::iter::once(last.as_slice()).chain(jobs.iter().map(|job| job.indices.as_slice()));
        let mut pairs: Vec<_> = before.zip(&jobs).map(|(before, job)| (before, job, None)).collect();
        crew::share_out(&mut self.workers, &mut pairs, |worker, (before, job, packed)| {
            *packed = Some(worker.pack(before, &job.indices, self.width, palette));
        });
        for packed in pairs.into_iter().filter_map(|(_, _, packed)| packed) {
            let frame = gif::Frame {
                delay: delay(self.frames, self.settings.frames_per_second),
                transparent: Some(palette.transparent()),
                left: packed.patch.left as u16,
                top: packed.patch.top as u16,
                width: packed.patch.width as u16,
                height: packed.patch.height as u16,
                buffer: packed.data.into(),
                ..gif::Frame::default()
            };
            encoder.write_lzw_pre_encoded_frame(&frame).map_err(|cause| self.failed(cause))?;
            self.frames += 1;
            let bytes = encoder.get_ref().bytes();
            if self.settings.most_bytes.is_some_and(|most| bytes > most) {
                return Err(OutputError::TooLarge { path: self.path.clone(), bytes, frames: self.frames });
            }
        }
        self.last = jobs.pop().map(|job| job.indices).unwrap_or_default();
        Ok(())
    }

    /// The scenery of a frame. It is reused while the cast stays the same.
    fn scenery(&mut self, frame: &Frame, palette: &Palette) -> Result<Arc<Scenery>, OutputError> {
        if let Some(scenery) = self.scenery.as_ref().filter(|scenery| scenery.painter.suits(frame)) {
            return Ok(scenery.clone());
        }
        let painter = self.studio.painter(frame)?;
        let mut indices = vec![0; self.width * self.height];
        Matcher::default().match_all(palette, painter.backdrop().data(), &mut indices);
        let scenery = Arc::new(Scenery { painter, indices });
        self.scenery = Some(scenery.clone());
        Ok(scenery)
    }

    fn failed(&self, cause: gif::EncodingError) -> OutputError {
        let cause = match cause {
            gif::EncodingError::Io(cause) => cause,
            other => io::Error::other(other),
        };
        OutputError::Io { path: self.path.clone(), cause, kept: self.part.clone().filter(|_| self.frames > 0) }
    }
}

impl Film for Gif {
    fn push(&mut self, frame: Frame) -> Result<(), OutputError> {
        Studio::check(&frame)?;
        self.waiting.push(frame);
        self.advance(false)
    }

    fn close(mut self: Box<Self>) -> Result<Draft, OutputError> {
        self.advance(true)?;
        let Stage::Running(_, encoder) = std::mem::replace(&mut self.stage, Stage::GivenUp) else {
            return Err(OutputError::NoFrames { path: self.path });
        };
        let file = encoder.into_inner().map_err(|cause| self.failed(cause))?;
        let seconds = end(self.frames, self.settings.frames_per_second) / 100.0;
        let written = WrittenFilm { path: self.path, frames: self.frames, bytes: file.bytes(), seconds, left_over: 0 };
        Ok(Draft { written, file: Some(file) })
    }
}

/// The duration of a frame, in hundredths of a second.
fn delay(frame: u64, frames_per_second: f64) -> u16 {
    (end(frame + 1, frames_per_second) - end(frame, frames_per_second)) as u16
}

/// When so many frames have been shown, in whole hundredths of a second.
fn end(frames: u64, frames_per_second: f64) -> f64 {
    // A rate such as 1/0.07 must not lose a hundredth to rounding.
    (frames as f64 * 100.0 / frames_per_second + 1e-6).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_add_up_to_the_length_of_the_film() {
        let first: Vec<u16> = (0..6).map(|frame| delay(frame, 30.0)).collect();
        assert_eq!(first, [3, 3, 4, 3, 3, 4]);
        for (rate, frames, hundredths) in [(30.0, 600, 2000), (24.0, 240, 1000), (25.0, 7, 28), (50.0, 100, 200)] {
            let sum: u64 = (0..frames).map(|frame| u64::from(delay(frame, rate))).sum();
            assert_eq!(sum, hundredths, "{frames} frames at {rate}");
            assert!((0..frames).all(|frame| delay(frame, rate) >= 2));
        }
        assert_eq!(delay(3, 1.0 / 0.07), 7);
        assert_eq!(delay(0, 100.0 / LONGEST_DELAY), u16::MAX);
    }
}
