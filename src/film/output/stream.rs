//! A fork-join pipeline for films of true colours. Threads draw and pack a group of frames, then one writes them in
//! order.

use std::borrow::Cow;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::partial_file::PartFile;
use super::studio::{Easel, Studio};
use super::{Draft, Film, FilmSettings, OutputError, WrittenFilm, crew};
use crate::raster::{Painter, View};
use jostle_frames::frame::Frame;

/// Frames drawn at once, for each thread. They are whole pictures: more of them would take more memory than time is won.
const FRAMES_PER_THREAD: usize = 2;

/// The packing and the target of a format.
pub(super) trait Sink: Send + Sync {
    /// A packed picture.
    type Packed: Send;

    /// Packs a picture (four bytes each pixel: red, green, blue, 255). `before` is the one before it, empty for the
    /// first.
    fn pack(&self, before: &[u8], picture: Cow<[u8]>) -> io::Result<Self::Packed>;

    /// Whether [`Sink::pack`] looks at the picture before.
    const COMPARES: bool;

    /// Writes the next picture.
    fn write(&mut self, packed: Self::Packed) -> Result<(), OutputError>;

    /// Writes the rest.
    fn close(self, frames: u64) -> Result<Closed, OutputError>;
}

/// A film whose pictures are all written.
pub(super) struct Closed {
    /// The file that is to get its name; `None` for standard output.
    pub file: Option<PartFile>,
    /// The number of bytes that it has.
    pub bytes: u64,
    /// Its duration.
    pub seconds: f64,
}

/// A film in the making.
pub(super) struct Stream<S> {
    path: PathBuf,
    studio: Studio,
    easels: Vec<Easel>,
    group: usize,
    waiting: Vec<(Frame, Arc<Painter>)>,
    /// The last picture written; empty before the first.
    last: Vec<u8>,
    frames: u64,
    /// `None` after an error.
    sink: Option<S>,
}

impl<S: Sink> Stream<S> {
    pub(super) fn new(path: PathBuf, settings: &FilmSettings, view: View, sink: S) -> Result<Self, OutputError> {
        let studio = Studio::new(view);
        let easels = (0..settings.threads.max(1)).map(|_| studio.easel()).collect::<Result<Vec<_>, _>>()?;
        let group = if settings.live { 1 } else { FRAMES_PER_THREAD * easels.len() };
        let (waiting, last) = (Vec::new(), Vec::new());
        Ok(Self { path, studio, easels, group, waiting, last, frames: 0, sink: Some(sink) })
    }

    fn given_up(&self) -> OutputError {
        OutputError::GivenUp { path: self.path.clone() }
    }

    /// Draws, packs and writes what waits. After an error the film is given up.
    fn write_waiting(&mut self) -> Result<(), OutputError> {
        let mut sink = self.sink.take().ok_or_else(|| self.given_up())?;
        let mut drawn: Vec<_> = self.waiting.drain(..).map(|waiting| (waiting, Vec::new())).collect();
        crew::share_out(&mut self.easels, &mut drawn, |easel, ((frame, painter), picture)| {
            easel.paint(painter, frame);
            picture.extend_from_slice(easel.picture.data());
        });
        let pictures: Vec<Vec<u8>> = drawn.into_iter().map(|(_, picture)| picture).collect();
        for packed in self.pack(&sink, pictures) {
            sink.write(packed.map_err(|cause| OutputError::io(&self.path, cause))?)?;
            self.frames += 1;
        }
        self.sink = Some(sink);
        Ok(())
    }

    /// Packs pictures and keeps the last one for the next group, if the format compares frames.
    fn pack(&mut self, sink: &S, mut pictures: Vec<Vec<u8>>) -> Vec<io::Result<S::Packed>> {
        if !S::COMPARES {
            return pictures.into_iter().map(|picture| sink.pack(&[], picture.into())).collect();
        }
        let before = std::mem::take(&mut self.last);
        self.last = pictures.last().cloned().unwrap_or_default();
        pictures.insert(0, before);
        let mut jobs: Vec<_> = pictures.windows(2).map(|pair| (pair, None)).collect();
        crew::share_out(&mut self.easels, &mut jobs, |_, (pair, packed)| {
            *packed = Some(sink.pack(&pair[0], pair[1].as_slice().into()));
        });
        jobs.into_iter().filter_map(|(_, packed)| packed).collect()
    }
}

impl<S: Sink> Film for Stream<S> {
    fn push(&mut self, frame: Frame) -> Result<(), OutputError> {
        if self.sink.is_none() {
            return Err(self.given_up());
        }
        Studio::check(&frame)?;
        let painter = self.studio.painter(&frame)?;
        self.waiting.push((frame, painter));
        if self.waiting.len() < self.group { Ok(()) } else { self.write_waiting() }
    }

    fn close(mut self: Box<Self>) -> Result<Draft, OutputError> {
        self.write_waiting()?;
        let Some(sink) = self.sink.take().filter(|_| self.frames > 0) else {
            return Err(OutputError::NoFrames { path: self.path });
        };
        let Closed { file, bytes, seconds } = sink.close(self.frames)?;
        let written = WrittenFilm { path: self.path, frames: self.frames, bytes, seconds, left_over: 0 };
        Ok(Draft { written, file })
    }
}
