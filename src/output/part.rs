//! A file that gets its name when it is complete.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::OutputError;

/// What becomes of a file that is never completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unfinished {
    /// It stays where it is, unless it is empty: its beginning can be shown.
    Kept,
    /// It goes: its beginning is of no use.
    Removed,
}

/// A file in the making, `<name>.part` beside its target.
#[derive(Debug)]
pub(super) struct PartFile {
    target: PathBuf,
    part: PathBuf,
    /// None once complete.
    file: Option<BufWriter<File>>,
    bytes: u64,
    unfinished: Unfinished,
}

impl PartFile {
    /// Creates the temporary file for a target.
    pub(super) fn create(target: &Path, unfinished: Unfinished) -> Result<PartFile, OutputError> {
        let mut name = target.file_name().unwrap_or_default().to_os_string();
        name.push(".part");
        let part = target.with_file_name(name);
        if target.exists() && !target.is_dir() && !target.is_file() {
            // Renaming would put a file in the place of a device or pipe.
            let cause = io::Error::new(io::ErrorKind::InvalidInput, "it is a device or a pipe, not a file");
            return Err(OutputError::io(target, cause));
        }
        if target.is_dir() {
            return Err(OutputError::io(target, io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let file = File::create(&part).map_err(|cause| OutputError::io(target, cause))?;
        Ok(PartFile {
            target: target.to_path_buf(),
            part,
            file: Some(BufWriter::with_capacity(1 << 16, file)),
            bytes: 0,
            unfinished,
        })
    }

    /// Where the file is until it is complete.
    pub(super) fn part(&self) -> &Path {
        &self.part
    }

    /// How many bytes were written so far.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    fn is_kept(&self) -> bool {
        self.unfinished == Unfinished::Kept && self.bytes > 0
    }

    /// Writes over what was written at a place.
    pub(super) fn overwrite(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        // Seeking writes out what waits.
        let end = file.stream_position()?;
        file.seek(SeekFrom::Start(place))?;
        file.write_all(bytes)?;
        file.seek(SeekFrom::Start(end)).map(|_| ())
    }

    /// The same as [`PartFile::complete`] for a file that another program has written.
    pub(super) fn complete_elsewhere(mut self) -> Result<u64, OutputError> {
        let length = fs::metadata(&self.part).map(|written| written.len());
        self.bytes = length.map_err(|cause| OutputError::io(&self.target, cause))?;
        self.complete()
    }

    /// Gives the file its name; returns its length in bytes.
    pub(super) fn complete(mut self) -> Result<u64, OutputError> {
        let renamed = self.flush().and_then(|()| fs::rename(&self.part, &self.target));
        renamed.map_err(|cause| OutputError::Io {
            path: self.target.clone(),
            cause,
            kept: self.is_kept().then(|| self.part.clone()),
        })?;
        self.file = None;
        Ok(self.bytes)
    }
}

impl Write for PartFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(file) = &mut self.file else { return Ok(0) };
        let count = file.write(bytes)?;
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for PartFile {
    fn drop(&mut self) {
        if self.file.is_some() && !self.is_kept() {
            // Nobody is left to be told if this fails, and the file does no harm.
            let _ = fs::remove_file(&self.part);
        }
    }
}
