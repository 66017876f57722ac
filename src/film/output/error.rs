//! The errors of writing a film. Each names the file, the cause and the remedy.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::raster::SizeError;
use jostle_language::number;

/// Why a film could not be written.
#[derive(Debug)]
pub enum OutputError {
    /// The ending of the target belongs to no known format.
    UnknownFormat {
        /// The target.
        path: PathBuf,
        /// The known endings, as people write them.
        known: Vec<&'static str>,
    },
    /// A picture of that size cannot be made, or not in this format.
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The longest side the format allows, in pixels; 0 if it is not the format that objects.
        longest: u32,
    },
    /// A sheet of so many frames is larger than programs show.
    Sheet {
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// Columns and rows.
        frames: (u32, u32),
    },
    /// The format cannot show so many, or so few, frames in a second.
    Rate {
        /// Frames per second.
        frames_per_second: f64,
        /// The lowest and the highest rate of the format.
        allowed: (f64, f64),
    },
    /// A frame has not one pose for each body.
    Poses {
        /// The time of the frame in seconds.
        time: f64,
        /// The number of bodies that the cast has.
        bodies: usize,
        /// The number of poses that the frame has.
        poses: usize,
    },
    /// The film ended without a frame.
    NoFrames {
        /// The target.
        path: PathBuf,
    },
    /// The system refused to write.
    Io {
        /// The file or directory.
        path: PathBuf,
        /// The message of the system.
        cause: io::Error,
        /// The path of the part that was written, if there is one.
        kept: Option<PathBuf>,
    },
    /// The program that makes videos is not installed.
    NoEncoder {
        /// The target.
        path: PathBuf,
    },
    /// The program that makes videos has failed.
    Encoder {
        /// The target.
        path: PathBuf,
        /// The way in which the program ended.
        ended: String,
        /// Its last message.
        said: String,
    },
    /// The film has grown beyond the size it may have.
    TooLarge {
        /// The target.
        path: PathBuf,
        /// Its size so far in bytes.
        bytes: u64,
        /// The number of frames in the picture.
        frames: u64,
    },
    /// A write followed a failed one.
    GivenUp {
        /// The target.
        path: PathBuf,
    },
}

impl OutputError {
    pub(super) fn io(path: &Path, cause: impl Into<io::Error>) -> OutputError {
        OutputError::Io { path: path.to_path_buf(), cause: cause.into(), kept: None }
    }
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OutputError::UnknownFormat { path, known } => {
                write!(
                    f,
                    "`{}` has no ending of a known format. Known endings are {}",
                    path.display(),
                    known.join(", ")
                )
            }
            OutputError::Size { width, height, longest: 0 } => {
                write!(f, "a picture of {width} x {height} pixels cannot be made; both sides need at least one pixel")?;
                write!(f, " and all of them must fit into memory")
            }
            OutputError::Size { width, height, longest } => {
                write!(f, "a picture of {width} x {height} pixels does not fit the format; ")?;
                write!(f, "its sides may be {longest} pixels long at most")
            }
            OutputError::Sheet { width, height, frames: (columns, rows) } => {
                write!(
                    f,
                    "{columns} x {rows} frames would be a picture of {width} x {height} pixels, more than can be "
                )?;
                write!(f, "shown; take fewer frames, or smaller ones with --size")
            }
            OutputError::Rate { frames_per_second, allowed: (lowest, highest) } => {
                write!(f, "{frames_per_second} frames per second cannot be shown in this format; ")?;
                let [lowest, highest] = [lowest, highest].map(|rate| number(*rate));
                write!(f, "from {lowest} to {highest} can. For slow motion lower the film's `speed` instead")
            }
            OutputError::Poses { time, bodies, poses } => {
                write!(f, "the frame at {time} s has {poses} poses for {bodies} bodies")
            }
            OutputError::NoFrames { path } => write!(f, "`{}` was not written: the film has no frame", path.display()),
            OutputError::Io { path, cause, kept } => {
                write!(f, "`{}` could not be written: {cause}", path.display())?;
                if let Some(remedy) = remedy(cause.kind()) {
                    write!(f, "; {remedy}")?;
                }
                match kept {
                    Some(kept) => write!(f, ". The part written so far is in `{}`", kept.display()),
                    None => Ok(()),
                }
            }
            OutputError::NoEncoder { path } => {
                write!(
                    f,
                    "`{}` needs the program `ffmpeg`, which is not installed (not found on PATH); ",
                    path.display()
                )?;
                write!(f, "install it, or write a .gif or .apng, which need nothing else")
            }
            OutputError::Encoder { path, ended, said } => {
                write!(f, "`{}` could not be written: `ffmpeg` {ended}", path.display())?;
                if said.is_empty() { write!(f, " and said nothing") } else { write!(f, " and said:\n{said}") }
            }
            OutputError::TooLarge { path, bytes, frames } => {
                write!(f, "`{}` was given up: it had {bytes} bytes after {frames} frames", path.display())
            }
            OutputError::GivenUp { path } => write!(f, "`{}` was given up after an earlier error", path.display()),
        }
    }
}

/// The remedy against an error of the system.
fn remedy(kind: io::ErrorKind) -> Option<&'static str> {
    match kind {
        io::ErrorKind::NotFound => Some("create its directory first"),
        io::ErrorKind::NotADirectory => Some("a part of its path is a file; choose another path"),
        io::ErrorKind::IsADirectory => Some("it is a directory; end the path with / to write a PNG sequence into it"),
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            Some("choose a place that you may write to")
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            Some("free some space, choose another disk, or write less: a smaller or shorter film, fewer channels")
        }
        io::ErrorKind::BrokenPipe => Some("the program that read it ended before the film"),
        _ => None,
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            OutputError::Io { cause, .. } => Some(cause),
            _ => None,
        }
    }
}

impl From<SizeError> for OutputError {
    fn from(SizeError { width, height }: SizeError) -> OutputError {
        OutputError::Size { width, height, longest: 0 }
    }
}
