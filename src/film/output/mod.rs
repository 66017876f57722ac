//! From frames to files: films as GIF, APNG, video or raw pictures; stills as PNG. Each format has one file.
//!
//! Frames stream: they are drawn and packed in small groups, several at once, and written in order. So the memory does
//! not grow with the length of the film. Nor do the bytes depend on the number of threads. A file is written beside its
//! target as `<name>.<random letters>.part` and takes the target's name when it is complete.

mod apng;
mod crew;
pub mod csv;
mod delta;
mod error;
mod gif;
mod lzw;
mod palette;
mod partial_file;
mod png;
mod raw;
pub mod sheet;
mod stream;
mod studio;
mod video;
mod whole;

use std::path::{Path, PathBuf};

use partial_file::PartFile;

pub use self::png::{flat_picture, write_picture};
pub use error::OutputError;
pub use partial_file::behind_links;
pub use whole::{may_be_written, write_new, write_whole};

use crate::raster::View;
use jostle_frames::frame::Frame;

/// How a film is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSettings {
    /// Frames per second of film.
    pub frames_per_second: f64,
    /// The number of threads that draw and pack; 0 counts as 1. The bytes do not depend on it.
    pub threads: usize,
    /// Whether each frame is written as soon as it is pushed, for a reader that shows it at once. Otherwise several are
    /// drawn together. Only raw pictures and videos use it.
    pub live: bool,
    /// Colours of a GIF, from 3 to 255; other formats have them all.
    pub colors: usize,
    /// A GIF that grows beyond so many bytes is given up.
    pub most_bytes: Option<u64>,
    /// Whether nothing stays of a GIF that is dropped before its end.
    pub whole: bool,
}

impl Default for FilmSettings {
    /// 30 frames per second by one thread, without a limit of size, in the most colours of the format.
    fn default() -> FilmSettings {
        FilmSettings { frames_per_second: 30.0, threads: 1, live: false, colors: 255, most_bytes: None, whole: false }
    }
}

/// A film in the making.
///
/// A film that is dropped before [`Film::finish`] leaves the frames written so far in its `.part` file.
pub trait Film: Send {
    /// Adds the next frame.
    ///
    /// # Errors
    /// If the frame has not one pose for each body, or the system refuses to write. After an error of the system the
    /// film is lost beyond the frames written so far.
    fn push(&mut self, frame: Frame) -> Result<(), OutputError>;

    /// Writes the rest, and lets the caller decide whether the film is kept. May be called at any time: the film then
    /// ends with the last frame pushed.
    ///
    /// # Errors
    /// If there is no frame, or the system refuses to write.
    fn close(self: Box<Self>) -> Result<Draft, OutputError>;

    /// Writes the rest and gives the file its name.
    ///
    /// # Errors
    /// If there is no frame, or the system refuses to write.
    fn finish(self: Box<Self>) -> Result<WrittenFilm, OutputError> {
        self.close()?.keep()
    }
}

/// A complete film whose file has no name yet. If it is dropped, it is removed like any unfinished film.
#[derive(Debug)]
pub struct Draft {
    /// The report of the film, once it has its name.
    written: WrittenFilm,
    /// `None` for an output without a name.
    file: Option<PartFile>,
}

impl Draft {
    /// The number of bytes that it has.
    pub fn bytes(&self) -> u64 {
        self.written.bytes
    }

    /// Gives the film its name.
    ///
    /// # Errors
    /// If the system refuses to write.
    pub fn keep(self) -> Result<WrittenFilm, OutputError> {
        let Draft { written, file } = self;
        file.map_or(Ok(()), PartFile::complete)?;
        Ok(written)
    }
}

/// The report of a written film.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenFilm {
    /// The file, or the directory of a sequence.
    pub path: PathBuf,
    /// The number of frames.
    pub frames: u64,
    /// The number of bytes of all files together.
    pub bytes: u64,
    /// The duration of the film in seconds, or 0 for a still.
    pub seconds: f64,
    /// Pictures of an earlier, longer sequence that still lie in the directory, after the last frame of this one.
    pub left_over: u64,
}

/// A format of films.
#[derive(Debug)]
struct Format {
    /// The ending of its files, as people write it.
    ending: &'static str,
    open: fn(&Path, &FilmSettings, View) -> Opened,
}

type Opened = Result<Box<dyn Film>, OutputError>;

/// Every format, the directory of a sequence last.
const FORMATS: [&Format; 7] =
    [&gif::FORMAT, &apng::FORMAT, &video::MP4, &video::WEBM, &raw::FORMAT, &png::STILL, &png::SEQUENCE];

/// The path and format of a film.
#[derive(Clone, Debug)]
pub struct OutputTarget {
    path: PathBuf,
    format: &'static Format,
}

impl OutputTarget {
    /// The target at a path, whose ending gives the format. `film.gif` is a film, and so are `.apng`, `.mp4`, `.webm`
    /// and `.rgba` (raw pictures). `-` is raw pictures to standard output, and `picture.png` is the last frame pushed.
    /// A path that ends with `/`, or an existing directory, is a sequence of `frame_00000.png` and so on.
    ///
    /// # Errors
    /// [`OutputError::UnknownFormat`] names the known endings.
    pub fn new(path: impl Into<PathBuf>) -> Result<OutputTarget, OutputError> {
        let path: PathBuf = path.into();
        let name = path.to_string_lossy().to_lowercase();
        let known = FORMATS.into_iter().find(|format| name.ends_with(format.ending));
        match known {
            _ if path == Path::new(raw::STANDARD_OUTPUT) => Ok(OutputTarget { path, format: &raw::FORMAT }),
            _ if path.is_dir() => Ok(OutputTarget { path, format: &png::SEQUENCE }),
            Some(format) => Ok(OutputTarget { path, format }),
            None => Err(OutputError::UnknownFormat { path, known: OutputTarget::endings() }),
        }
    }

    /// The known endings, `/` for a sequence of pictures.
    pub fn endings() -> Vec<&'static str> {
        FORMATS.iter().map(|format| format.ending).collect()
    }

    /// Whether it is raw pictures to standard output.
    pub fn is_standard_output(&self) -> bool {
        self.path == Path::new(raw::STANDARD_OUTPUT)
    }

    /// Whether it is a GIF.
    pub fn is_gif(&self) -> bool {
        self.format.ending == gif::FORMAT.ending
    }

    /// Whether it is raw pictures, which lack size and rate.
    pub fn is_raw(&self) -> bool {
        self.format.ending == raw::FORMAT.ending
    }

    /// The path of the file or directory.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Begins a film. Its size is that of the view's camera. It writes only an empty `.part` file, so that an unwritable
/// target is known before the run.
///
/// # Errors
/// If the format does not allow the size or the rate, or the file cannot be created.
pub fn open(target: &OutputTarget, settings: &FilmSettings, view: View) -> Result<Box<dyn Film>, OutputError> {
    let (width, height) = view.size();
    if width == 0 || height == 0 {
        return Err(OutputError::Size { width, height, longest: 0 });
    }
    (target.format.open)(&target.path, settings, view)
}

#[cfg(test)]
mod tests;
