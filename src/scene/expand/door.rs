//! The door to files that stand beside a scene: pictures, courses, packings.

use std::io::Read;
use std::path::Path;

/// What is wrong with a file, and what to do.
pub(crate) type Wrong = (String, String);

/// What is read.
pub(crate) struct Wanted {
    /// The largest file, in bytes.
    pub(crate) most: u64,
    /// What a folder of that name should have been: `a PNG picture`.
    pub(crate) noun: &'static str,
    /// How to make a file smaller.
    pub(crate) smaller: &'static str,
}

impl Wanted {
    /// Reads the file at a path that messages call `name`.
    pub(crate) fn read(&self, path: &Path, name: &str) -> Result<Vec<u8>, Wrong> {
        let here = "the path begins at the folder of the file in which this stands";
        match std::fs::metadata(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err((format!("there is no file `{name}`"), here.to_owned()));
            }
            Ok(about) if about.is_dir() => {
                return Err((format!("`{name}` is a folder"), format!("name {} in it", self.noun)));
            }
            _ => {}
        }
        let opened = std::fs::File::open(path).map_err(|error| self.unreadable(name, &error))?;
        self.bytes(opened, name)
    }

    /// All that a reader gives.
    pub(crate) fn bytes(&self, reader: impl Read, name: &str) -> Result<Vec<u8>, Wrong> {
        let mut bytes = Vec::new();
        reader.take(self.most + 1).read_to_end(&mut bytes).map_err(|error| self.unreadable(name, &error))?;
        if bytes.len() as u64 > self.most {
            return Err((format!("`{name}` is larger than {} MiB", self.most >> 20), self.smaller.to_owned()));
        }
        Ok(bytes)
    }

    fn unreadable(&self, name: &str, error: &std::io::Error) -> Wrong {
        let help = format!("check the path and its permissions, and that it is {}", self.noun);
        (format!("cannot read `{name}`: {error}"), help)
    }
}
