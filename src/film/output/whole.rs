//! A file that is written at once: a table, a report, a text.

use std::io::Write;
use std::path::Path;

use super::OutputError;
use super::partial_file::{self, PartFile, Unfinished};

/// Writes a file so that a reader finds the old one or the whole new one, never a part. An existing file keeps its
/// permissions, and a link stays a link. A read-only file is not changed.
///
/// # Errors
/// If the system refuses to write.
pub fn write_whole(path: &Path, content: impl AsRef<[u8]>) -> Result<(), OutputError> {
    written(path, content.as_ref())?.complete()
}

/// Whether a file can be written, as far as that is known beforehand.
///
/// # Errors
/// If it is read-only, a folder, a device or a pipe.
pub fn may_be_written(path: &Path) -> Result<(), OutputError> {
    partial_file::look_at(path).map_err(|cause| OutputError::io(path, cause))
}

/// Writes a file with an unused name. If another file takes the name meanwhile, that file stays.
///
/// # Errors
/// If there is such a file, or the system refuses to write.
pub fn write_new(path: &Path, content: impl AsRef<[u8]>) -> Result<(), OutputError> {
    if path.symlink_metadata().is_ok() {
        return Err(OutputError::io(path, std::io::ErrorKind::AlreadyExists));
    }
    written(path, content.as_ref())?.complete_new()
}

fn written(path: &Path, content: &[u8]) -> Result<PartFile, OutputError> {
    let mut file = PartFile::create(path, Unfinished::Removed)?;
    file.write_all(content).map_err(|cause| OutputError::io(path, cause))?;
    Ok(file)
}
