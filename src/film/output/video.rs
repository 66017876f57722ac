//! MP4 (H.264) and WebM (VP9) by the program `ffmpeg`, if it is installed. It receives raw pictures through a pipe. The
//! bytes depend on its version, so they are not promised to stay the same.

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use super::partial_file::{PartFile, Unfinished};
use super::stream::{Closed, Sink, Stream};
use super::{FilmSettings, Format, Opened, OutputError};
use crate::raster::View;

pub(super) const MP4: Format =
    Format { ending: ".mp4", open: |path, settings, view| open(path, settings, view, &H264) };
pub(super) const WEBM: Format =
    Format { ending: ".webm", open: |path, settings, view| open(path, settings, view, &VP9) };

/// The options of ffmpeg. At these qualities the edges of flat colours show no blocks.
const H264: [&str; 10] = ["-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"];
const VP9: [&str; 10] = ["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"];

/// Both codecs halve the resolution of colours, so sides must be even. The last row and column are padded.
const EVEN: [&str; 4] = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"];

/// Rates that videos are made for, in frames per second.
const RATES: (f64, f64) = (0.01, 1000.0);

/// The number of characters of ffmpeg's last message that the error quotes.
const SAID: usize = 600;

fn open(path: &Path, settings: &FilmSettings, view: View, codec: &[&str]) -> Opened {
    let rate = settings.frames_per_second;
    if !(RATES.0..=RATES.1).contains(&rate) {
        return Err(OutputError::Rate { frames_per_second: rate, allowed: RATES });
    }
    let file = PartFile::create(path, Unfinished::Shared)?;
    let (width, height) = view.size();
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-nostdin", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba"]);
    command.args(["-video_size", &format!("{width}x{height}"), "-framerate", &rate.to_string(), "-i", "pipe:0", "-an"]);
    // `file:` keeps names that begin with a dash or hold a colon from being read as something else.
    let mut part = std::ffi::OsString::from("file:");
    part.push(file.part());
    command.args(EVEN).args(codec).arg(part);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    // A Ctrl-C is for this program, which ends the film.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command.spawn().map_err(|cause| match cause.kind() {
        io::ErrorKind::NotFound => OutputError::NoEncoder { path: path.to_path_buf() },
        _ => OutputError::Encoder {
            path: path.to_path_buf(),
            ended: "could not be started".into(),
            said: cause.to_string(),
        },
    })?;
    // A separate thread reads the messages, because a child with a full pipe would wait for ever.
    let said = child.stderr.take().map(|mut messages| {
        std::thread::spawn(move || {
            let mut said = Vec::new();
            let _ = messages.read_to_end(&mut said);
            String::from_utf8_lossy(&said).into_owned()
        })
    });
    let sink = Video { path: path.to_path_buf(), file: Some(file), child, said, rate };
    Ok(Box::new(Stream::new(path.to_path_buf(), settings, view, sink)?))
}

struct Video {
    path: PathBuf,
    /// `None` once complete.
    file: Option<PartFile>,
    child: Child,
    said: Option<JoinHandle<String>>,
    rate: f64,
}

impl Video {
    /// Waits until ffmpeg has ended; an error unless it ended well.
    fn wait(&mut self) -> Result<(), OutputError> {
        // The end of the pictures ends the film.
        drop(self.child.stdin.take());
        let status = self.child.wait().map_err(|cause| OutputError::io(&self.path, cause))?;
        let said = self.said.take().and_then(|said| said.join().ok()).unwrap_or_default();
        if status.success() {
            return Ok(());
        }
        let said = said.trim();
        let begin = said.char_indices().rev().map(|(index, _)| index).take(SAID).last().unwrap_or(0);
        Err(OutputError::Encoder {
            path: self.path.clone(),
            ended: format!("ended with {status}"),
            said: said[begin..].to_owned(),
        })
    }
}

impl Sink for Video {
    type Packed = Vec<u8>;
    const COMPARES: bool = false;

    fn pack(&self, _: &[u8], picture: Cow<[u8]>) -> io::Result<Vec<u8>> {
        Ok(picture.into_owned())
    }

    fn write(&mut self, picture: Vec<u8>) -> Result<(), OutputError> {
        let Some(pipe) = &mut self.child.stdin else { return Err(OutputError::GivenUp { path: self.path.clone() }) };
        let Err(cause) = pipe.write_all(&picture) else { return Ok(()) };
        // It ended before the film did, and its message gives the reason.
        self.wait()?;
        Err(OutputError::io(&self.path, cause))
    }

    fn close(mut self, frames: u64) -> Result<Closed, OutputError> {
        self.wait()?;
        let Some(file) = &self.file else { return Err(OutputError::GivenUp { path: self.path.clone() }) };
        // The empty file was there before it began.
        let written = std::fs::metadata(file.part()).map_err(|cause| OutputError::io(&self.path, cause))?.len();
        if written == 0 {
            return Err(OutputError::Encoder {
                path: self.path.clone(),
                ended: "ended as if all were well, but wrote no film".to_owned(),
                said: String::new(),
            });
        }
        Ok(Closed { file: self.file.take(), bytes: written, seconds: frames as f64 / self.rate })
    }
}

impl Drop for Video {
    /// A film that is given up leaves no program behind.
    fn drop(&mut self) {
        if self.file.is_some() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}
