//! A file that is written in one go: a table, a report, a text.

use std::io::Write;
use std::path::Path;

use super::OutputError;
use super::part::{PartFile, Unfinished};

/// Writes a file so that whoever looks finds the old one or the whole new one, never a part. A file that is there keeps
/// its permissions; a link stays a link; a file that is read-only stays as it is.
///
/// # Errors
/// If the system refuses to write.
pub fn write_whole(path: &Path, text: &str) -> Result<(), OutputError> {
    let told = |cause| OutputError::io(path, cause);
    // Renaming would put a file in the place of a link.
    let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let before = std::fs::metadata(&target).ok();
    // Renaming would replace it all the same.
    if before.as_ref().is_some_and(|before| before.permissions().readonly()) {
        return Err(told(std::io::Error::new(std::io::ErrorKind::PermissionDenied, "it is read-only")));
    }
    let mut file = PartFile::create(&target, Unfinished::Removed)?;
    if let Some(before) = before {
        std::fs::set_permissions(file.part(), before.permissions()).map_err(told)?;
    }
    file.write_all(text.as_bytes()).map_err(told)?;
    file.complete().map(|_| ())
}
