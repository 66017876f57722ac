//! PNG: one still, or a sequence `frame_00000.png`, `frame_00001.png` ... in a directory. True colours, lossless.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tiny_skia::Pixmap;

use super::partial_file::{PartFile, Unfinished, sync_folder};
use super::studio::{Easel, Studio};
use super::whole::write_whole;
use super::{Draft, Film, FilmSettings, Format, Opened, OutputError, WrittenFilm, crew};
use crate::raster::{Painter, View};
use jostle_frames::frame::Frame;

/// A single picture: the last frame pushed.
pub(super) const STILL: Format = Format { ending: ".png", open: open_still };

/// A directory of pictures, one for each frame.
pub(super) const SEQUENCE: Format = Format { ending: "/", open: open_sequence };

/// Frames drawn at once, for each thread.
const FRAMES_PER_THREAD: usize = 4;

/// Possible rates of a sequence, in frames per second. Picture files do not store a rate.
const RATES: (f64, f64) = (1e-6, 1e6);

fn open_still(path: &Path, _: &FilmSettings, view: View) -> Opened {
    let file = PartFile::create(path, Unfinished::Removed)?;
    Ok(Box::new(Still { path: path.to_path_buf(), file, studio: Studio::new(view), last: None }))
}

struct Still {
    path: PathBuf,
    file: PartFile,
    studio: Studio,
    last: Option<Frame>,
}

impl Film for Still {
    fn push(&mut self, frame: Frame) -> Result<(), OutputError> {
        Studio::check(&frame)?;
        self.last = Some(frame);
        Ok(())
    }

    fn close(mut self: Box<Self>) -> Result<Draft, OutputError> {
        let Some(frame) = self.last.take() else { return Err(OutputError::NoFrames { path: self.path }) };
        let painter = self.studio.painter(&frame)?;
        let mut easel = self.studio.easel()?;
        easel.paint(&painter, &frame);
        let packed = pack(&easel.picture, &mut Vec::new()).map_err(|cause| OutputError::io(&self.path, cause))?;
        self.file.write_all(&packed).map_err(|cause| OutputError::io(&self.path, cause))?;
        let written = WrittenFilm { path: self.path, frames: 1, bytes: self.file.bytes(), seconds: 0.0, left_over: 0 };
        Ok(Draft { written, file: Some(self.file) })
    }
}

fn open_sequence(path: &Path, settings: &FilmSettings, view: View) -> Opened {
    let (rate, (lowest, highest)) = (settings.frames_per_second, RATES);
    if !(lowest..=highest).contains(&rate) {
        return Err(OutputError::Rate { frames_per_second: rate, allowed: RATES });
    }
    fs::create_dir_all(path).map_err(|cause| OutputError::io(path, cause))?;
    let studio = Studio::new(view);
    let workers = (0..settings.threads.max(1)).map(|_| Ok(Worker { easel: studio.easel()?, rgb: Vec::new() }));
    Ok(Box::new(Sequence {
        path: path.to_path_buf(),
        workers: workers.collect::<Result<_, OutputError>>()?,
        studio,
        frames_per_second: rate,
        waiting: Vec::new(),
        frames: 0,
        bytes: 0,
        given_up: false,
    }))
}

struct Sequence {
    path: PathBuf,
    studio: Studio,
    workers: Vec<Worker>,
    frames_per_second: f64,
    waiting: Vec<Job>,
    frames: u64,
    bytes: u64,
    given_up: bool,
}

struct Worker {
    easel: Easel,
    rgb: Vec<u8>,
}

/// One frame to be written.
struct Job {
    frame: Frame,
    painter: Arc<Painter>,
    path: PathBuf,
    written: Result<u64, OutputError>,
}

impl Job {
    fn write(&self, worker: &mut Worker) -> Result<u64, OutputError> {
        worker.easel.paint(&self.painter, &self.frame);
        let packed =
            pack(&worker.easel.picture, &mut worker.rgb).map_err(|cause| OutputError::io(&self.path, cause))?;
        let mut file = PartFile::create(&self.path, Unfinished::Removed)?;
        file.write_all(&packed).map_err(|cause| OutputError::io(&self.path, cause))?;
        file.complete_one_of_many().map(|()| packed.len() as u64)
    }
}

impl Sequence {
    fn file(&self, index: u64) -> PathBuf {
        self.path.join(format!("frame_{index:05}.png"))
    }

    /// Marks the sequence as broken, and adds the path of its first frames to the error.
    fn gave_up(&mut self, error: OutputError) -> OutputError {
        self.given_up = true;
        match error {
            OutputError::Io { path, cause, .. } => {
                OutputError::Io { path, cause, kept: (self.frames > 0).then(|| self.path.clone()) }
            }
            other => other,
        }
    }

    fn check(&self) -> Result<(), OutputError> {
        if self.given_up { Err(OutputError::GivenUp { path: self.path.clone() }) } else { Ok(()) }
    }

    fn write_waiting(&mut self) -> Result<(), OutputError> {
        let mut jobs = std::mem::take(&mut self.waiting);
        crew::share_out(&mut self.workers, &mut jobs, |worker, job| job.written = job.write(worker));
        for job in jobs {
            self.bytes += job.written.map_err(|error| self.gave_up(error))?;
            self.frames += 1;
        }
        Ok(())
    }
}

impl Film for Sequence {
    fn push(&mut self, frame: Frame) -> Result<(), OutputError> {
        self.check()?;
        Studio::check(&frame)?;
        let painter = self.studio.painter(&frame)?;
        let path = self.file(self.frames + self.waiting.len() as u64);
        self.waiting.push(Job { frame, painter, path, written: Ok(0) });
        if self.waiting.len() < FRAMES_PER_THREAD * self.workers.len() { Ok(()) } else { self.write_waiting() }
    }

    fn close(mut self: Box<Self>) -> Result<Draft, OutputError> {
        self.check()?;
        self.write_waiting()?;
        if self.frames == 0 {
            return Err(OutputError::NoFrames { path: self.path });
        }
        sync_folder(&self.path).map_err(|cause| OutputError::io(&self.path, cause))?;
        let left_over = (self.frames..).take_while(|index| self.file(*index).exists()).count() as u64;
        let seconds = self.frames as f64 / self.frames_per_second;
        let written = WrittenFilm { path: self.path, frames: self.frames, bytes: self.bytes, seconds, left_over };
        Ok(Draft { written, file: None })
    }
}

/// Writes one picture that is already drawn; returns how many bytes it takes.
///
/// # Errors
/// If the system refuses to write.
pub fn write_picture(path: &Path, picture: &Pixmap) -> Result<u64, OutputError> {
    let packed = pack(picture, &mut Vec::new()).map_err(|cause| OutputError::io(path, cause))?;
    write_whole(path, &packed).map(|()| packed.len() as u64)
}

/// A picture of few colours, such as a diagram, as the bytes of a PNG file. It is small, but slower than a film could
/// afford for each frame.
///
/// # Errors
/// When there is no such picture.
pub fn flat_picture(picture: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = picture.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut packed = Vec::new();
    let mut encoder = png::Encoder::new(&mut packed, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(packed)
}

/// A picture as the bytes of a PNG file. `rgb` is room for its pixels, kept to spare allocations.
///
/// Fast compression needs the Paeth filter, because without a filter it would hardly compress the picture.
pub(super) fn pack(picture: &Pixmap, rgb: &mut Vec<u8>) -> Result<Vec<u8>, png::EncodingError> {
    rgb.clear();
    rgb.extend(picture.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]));
    let mut packed = Vec::with_capacity(rgb.len() / 8);
    let mut encoder = png::Encoder::new(&mut packed, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Paeth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(packed)
}
