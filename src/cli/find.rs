//! The scenes of a folder.

use std::io;
use std::path::Path;

/// The ending of scenes.
const ENDING: &str = "ron";
/// A program can restore folders with this file, so their contents are not scenes of a user
/// (<https://bford.info/cachedir/>). Cargo marks `target` so.
const CACHE: &str = "CACHEDIR.TAG";

/// The names of all files `*.ron` in a folder and the folders in it, in the order of their names. Hidden folders and
/// those that programs keep for themselves are left out.
pub(super) fn scenes_in(folder: &Path) -> io::Result<Vec<String>> {
    let mut found = Vec::new();
    walk(folder, &mut found)?;
    Ok(found)
}

fn walk(folder: &Path, found: &mut Vec<String>) -> io::Result<()> {
    let mut entries = std::fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let (path, kind) = (entry.path(), entry.file_type()?);
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        // A link to a folder may lead back here.
        if kind.is_dir() && !hidden && !path.join(CACHE).exists() {
            walk(&path, found)?;
        } else if path.is_file() && path.extension().is_some_and(|ending| ending == ENDING) {
            let shown = path.strip_prefix(".").unwrap_or(&path);
            found.push(shown.display().to_string());
        }
    }
    Ok(())
}
