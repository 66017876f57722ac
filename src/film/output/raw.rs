//! Raw pictures for other programs, to standard output (`-`) or a file. Each pixel has four bytes (red, green, blue,
//! 255). Rows run from the top, frame after frame. There is no header, so size and rate must be known otherwise.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::partial_file::{PartFile, Unfinished};
use super::stream::{Closed, Sink, Stream};
use super::{FilmSettings, Format, Opened, OutputError};
use crate::raster::View;

pub(super) const FORMAT: Format = Format { ending: ".rgba", open };

/// The name of standard output on the command line.
pub(super) const STANDARD_OUTPUT: &str = "-";

/// Possible rates of the frames, in frames per second. The bytes do not store a rate.
const RATES: (f64, f64) = (1e-6, 1e6);

fn open(path: &Path, settings: &FilmSettings, view: View) -> Opened {
    let rate = settings.frames_per_second;
    if !(RATES.0..=RATES.1).contains(&rate) {
        return Err(OutputError::Rate { frames_per_second: rate, allowed: RATES });
    }
    let (way, path) = if path == Path::new(STANDARD_OUTPUT) {
        (Way::Out(io::stdout()), PathBuf::from("standard output"))
    } else {
        (Way::File(PartFile::create(path, Unfinished::Removed)?), path.to_path_buf())
    };
    let sink = Raw { path: path.clone(), way, bytes: 0, rate };
    Ok(Box::new(Stream::new(path, settings, view, sink)?))
}

enum Way {
    Out(io::Stdout),
    File(PartFile),
}

struct Raw {
    path: PathBuf,
    way: Way,
    bytes: u64,
    rate: f64,
}

impl Sink for Raw {
    type Packed = Vec<u8>;
    const COMPARES: bool = false;

    fn pack(&self, _: &[u8], picture: Cow<[u8]>) -> io::Result<Vec<u8>> {
        Ok(picture.into_owned())
    }

    fn write(&mut self, picture: Vec<u8>) -> Result<(), OutputError> {
        let written = match &mut self.way {
            // A reader is to see each frame at once.
            Way::Out(out) => out.write_all(&picture).and_then(|()| out.flush()),
            Way::File(file) => file.write_all(&picture),
        };
        self.bytes += picture.len() as u64;
        written.map_err(|cause| OutputError::io(&self.path, cause))
    }

    fn close(self, frames: u64) -> Result<Closed, OutputError> {
        let file = match self.way {
            Way::File(file) => Some(file),
            Way::Out(_) => None,
        };
        Ok(Closed { file, bytes: self.bytes, seconds: frames as f64 / self.rate })
    }
}
