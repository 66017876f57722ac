//! A file that is written in one go: a table, a report, a text.

use std::io::Write;
use std::path::Path;

use super::OutputError;
use super::part::{PartFile, Unfinished};

/// Writes a file so that whoever looks finds the old one or the whole new one, never a part. A file that is there keeps
/// its permissions; a link stays a link.
///
/// # Errors
/// If the system refuses to write.
pub fn write_whole(path: &Path, text: &str) -> Result<(), OutputError> {
    let told = |cause| OutputError::io(path, cause);
    // Renaming would put a file in the place of a link.
    let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = PartFile::create(&target, Unfinished::Removed)?;
    if let Ok(before) = std::fs::metadata(&target) {
        std::fs::set_permissions(file.part(), before.permissions()).map_err(told)?;
    }
    file.write_all(text.as_bytes()).map_err(told)?;
    file.complete().map(|_| ())
}
