//! The door to files around a scene: those that it includes, pictures, courses, packings, themes.

use std::cell::RefCell;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::source::Source;

/// What is wrong with a file, and what to do.
pub type Wrong = (String, String);

/// A mistake in a sentence.
pub fn told((message, help): Wrong) -> String {
    if help.is_empty() { message } else { format!("{message}; {help}") }
}

/// What a scene may read, and what it has read.
#[derive(Debug, Default)]
pub struct Door {
    /// The folder around which files may lie; none: anywhere.
    home: Option<PathBuf>,
    opened: RefCell<Vec<PathBuf>>,
}

impl Door {
    /// The door of a scene.
    pub fn of(source: &Source) -> Self {
        let folder = source.folder.as_ref().filter(|_| !source.outside);
        let home = folder.map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
        Self { home: home.and_then(|home| home.canonicalize().ok()), opened: RefCell::default() }
    }

    /// Lets a file through that messages call `name`, unless it may not be read. What is missing is told by its reader.
    pub fn admit(&self, path: &Path, name: &str) -> Result<(), Wrong> {
        let Ok(real) = path.canonicalize() else { return Ok(()) };
        let folder = real.parent().unwrap_or(&real);
        if self.home.as_ref().is_some_and(|home| !folder.starts_with(home) && !home.starts_with(folder)) {
            let message = format!("`{name}` lies neither in the folder of the scene or below it, nor in one above it");
            let help = "copy it beside the scene, or let scenes read files anywhere with --allow-outside";
            return Err((message, help.to_owned()));
        }
        if std::fs::metadata(&real).is_ok_and(|about| !about.is_file() && !about.is_dir()) {
            return Err((
                format!("`{name}` is a device or a pipe"),
                "name a file; pipes have no place in scenes".into(),
            ));
        }
        self.opened.borrow_mut().push(real);
        Ok(())
    }

    /// The files that were let through.
    pub fn opened(&self) -> Vec<PathBuf> {
        self.opened.borrow().clone()
    }
}

/// What is read.
pub struct Wanted {
    /// The largest file, in bytes.
    pub most: u64,
    /// What a folder of that name should have been: `a PNG picture`.
    pub noun: &'static str,
    /// How to make a file smaller.
    pub smaller: &'static str,
}

impl Wanted {
    /// Reads the file that a scene names, at a path that messages call `name`.
    pub fn read(&self, door: &Door, path: &Path, name: &str) -> Result<Vec<u8>, Wrong> {
        door.admit(path, name)?;
        self.take(path, name, "the path begins at the folder of the file in which this stands")
    }

    /// Reads a file; `here` says where its path begins.
    pub fn take(&self, path: &Path, name: &str, here: &str) -> Result<Vec<u8>, Wrong> {
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
    pub fn bytes(&self, reader: impl Read, name: &str) -> Result<Vec<u8>, Wrong> {
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
