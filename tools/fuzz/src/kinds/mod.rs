//! What is mutated: one file for each kind of input, and one line here.

mod beside;
mod scenes;
mod snapshots;

use std::path::{Path, PathBuf};

/// A kind of input.
pub trait Kind {
    /// The ending of its files.
    fn ending(&self) -> &'static str;

    /// Mutant `number` of a seed: the same on every machine.
    fn mutant(&mut self, seed: u64, number: u64) -> Vec<u8>;

    /// Whether mutants are text, which the hunt can make smaller piece by piece.
    fn is_text(&self) -> bool {
        true
    }

    /// Tries one mutant in the child process. It marks where it is. A broken promise ends the process.
    fn attempt(&mut self, mutant: &[u8], number: u64, scratch: &Path);
}

/// Makes a kind whose mutants begin with the files below the folders.
type Maker = fn(&[PathBuf]) -> std::io::Result<Box<dyn Kind>>;

/// All kinds, by their names on the command line.
const KINDS: [(&str, Maker); 5] = [
    ("scenes", scenes::make),
    ("svg", beside::drawings),
    ("csv", beside::tables),
    ("png", beside::pictures),
    ("snapshots", snapshots::make),
];

/// The names of all kinds.
pub fn names() -> Vec<&'static str> {
    KINDS.iter().map(|(name, _)| *name).collect()
}

/// The kind of this name.
///
/// # Errors
/// When there is none, or the files to begin with cannot be read.
pub fn make(name: &str, folders: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    let known = KINDS.iter().find(|(known, _)| *known == name);
    known.map_or_else(|| Err(std::io::Error::other(format!("there is no kind `{name}`"))), |(_, make)| make(folders))
}
