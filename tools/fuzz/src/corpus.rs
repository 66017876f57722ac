//! The files that mutants are made from: all of one ending below the folders given.

use std::io;
use std::path::{Path, PathBuf};

use crate::tokens::{Token, tokens};

/// Files larger than this many bytes are left out: they would only make every mutant slow.
const LARGEST: u64 = 20_000;

/// A scene in tokens: the pieces, blanks and comments included.
pub type Seed = Vec<Token>;

/// All scenes below the folders, in the order of their paths.
pub struct Corpus {
    /// Scenes that are meant to be good.
    pub good: Vec<Seed>,
    /// Scenes beside which a message stands, `NAME.txt`: they are wrong.
    pub wrong: Vec<Seed>,
}

/// Reads the texts of one ending.
///
/// # Errors
/// When a folder or file cannot be read, or there is no such file.
pub fn read(folders: &[PathBuf], ending: &str) -> io::Result<Corpus> {
    let mut corpus = Corpus { good: Vec::new(), wrong: Vec::new() };
    for file in files(folders, ending)? {
        // Wrong scenes need not be UTF-8; a mutant is.
        let text = String::from_utf8_lossy(&std::fs::read(&file)?).into_owned();
        let kind = if file.with_extension("txt").exists() { &mut corpus.wrong } else { &mut corpus.good };
        kind.push(tokens(&text));
    }
    Ok(corpus)
}

/// Reads the files of one ending as they are.
///
/// # Errors
/// When a folder or file cannot be read, or there is no such file.
pub fn read_bytes(folders: &[PathBuf], ending: &str) -> io::Result<Vec<Vec<u8>>> {
    files(folders, ending)?.into_iter().map(std::fs::read).collect()
}

fn files(folders: &[PathBuf], ending: &str) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for folder in folders {
        collect(folder, ending, &mut files)?;
    }
    files.sort();
    files.dedup();
    if files.is_empty() { Err(io::Error::other(format!("no file ends with `{ending}`"))) } else { Ok(files) }
}

fn collect(path: &Path, wanted: &str, files: &mut Vec<PathBuf>) -> io::Result<()> {
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        for entry in std::fs::read_dir(path)? {
            let entry = entry?.path();
            let hidden = entry.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            // Build results are no scenes, and benchmarks are large on purpose.
            let other = entry.file_name().is_some_and(|name| name == "target" || name == "benchmarks");
            if !hidden && !other {
                collect(&entry, wanted, files)?;
            }
        }
    } else if path.to_string_lossy().ends_with(wanted) && about.len() <= LARGEST {
        files.push(path.to_owned());
    }
    Ok(())
}
