//! The inputs of a command, which no output may replace.

use std::path::{Path, PathBuf};

use super::destination::is_directory;
use super::load::{EXAMPLE, Request};
use crate::output::behind_links;
use crate::simulation::Simulation;

/// The files that a command has read.
pub(super) struct Inputs(Vec<PathBuf>);

impl Inputs {
    /// The inputs of a scene: its file, included files, pictures, tables.
    pub fn of(request: Request, simulation: &Simulation) -> Self {
        let own = (!request.name.starts_with(EXAMPLE)).then(|| PathBuf::from(request.name));
        Self(own.into_iter().chain(simulation.header().files.iter().cloned()).collect())
    }

    /// One more of them.
    pub fn and(mut self, path: Option<PathBuf>) -> Self {
        self.0.extend(path);
        self
    }

    /// The objection to an output: a file, or the directory of a sequence.
    pub fn objection(&self, output: &Path) -> Option<String> {
        if !is_directory(output) {
            let read = self.0.iter().any(|input| is_same_file(input, output));
            let shown = output.display();
            return read.then(|| format!("`{shown}` is an input of this command: write to another file, with -o"));
        }
        let entries = std::fs::read_dir(output).ok()?;
        let pictures = entries.flatten().filter(|entry| {
            let name = entry.file_name();
            name.as_encoded_bytes().starts_with(b"frame_")
        });
        let mut pictures = pictures.map(|entry| entry.path());
        pictures.find_map(|picture| self.objection(&picture))
    }
}

/// The final path of a file that may not exist yet.
fn destination(path: &Path) -> Option<PathBuf> {
    let target = behind_links(path).ok()?;
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(std::fs::canonicalize(folder).ok()?.join(target.file_name()?))
}

/// Whether two paths lead to one file, also by links of any kind, and if it is not there yet.
pub(super) fn is_same_file(one: &Path, other: &Path) -> bool {
    if destination(one).is_some_and(|one| Some(one) == destination(other)) {
        return true;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let identity = |path: &Path| std::fs::metadata(path).ok().map(|about| (about.dev(), about.ino()));
        identity(one).is_some_and(|one| Some(one) == identity(other))
    }
    #[cfg(not(unix))]
    {
        let real = |path: &Path| std::fs::canonicalize(path).ok();
        real(one).is_some_and(|one| Some(one) == real(other))
    }
}
