//! Access to the files around a scene: included files, pictures, courses, packings, themes.

use std::cell::RefCell;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::source::Source;

/// The mistake in a file, and the remedy.
pub type FileMistake = (String, String);

/// A mistake in a sentence.
pub fn told((message, help): FileMistake) -> String {
    if help.is_empty() { message } else { format!("{message}; {help}") }
}

/// The files that a scene may read, and those that it has read.
#[derive(Debug, Default)]
pub struct Door {
    /// The folder around which files may lie. `None`: anywhere.
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

    /// Admits a file that messages call `name`, unless the scene may not read it. The reader of the file reports an
    /// absent one.
    pub fn admit(&self, path: &Path, name: &str) -> Result<(), FileMistake> {
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

/// The description of a file that an entry names.
pub struct FileRequest {
    /// The largest file, in bytes.
    pub most: u64,
    /// The expected kind of file, for the message about a folder: `a PNG picture`.
    pub noun: &'static str,
    /// A way to make a file smaller.
    pub smaller: &'static str,
}

impl FileRequest {
    /// Reads the file that a scene names, at a path that messages call `name`.
    pub fn read(&self, door: &Door, path: &Path, name: &str) -> Result<Vec<u8>, FileMistake> {
        door.admit(path, name)?;
        self.take(path, name, "the path begins at the folder of the file in which this stands")
    }

    /// Reads a file; `here` is the beginning of its path.
    pub fn take(&self, path: &Path, name: &str, here: &str) -> Result<Vec<u8>, FileMistake> {
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
    pub fn bytes(&self, reader: impl Read, name: &str) -> Result<Vec<u8>, FileMistake> {
        let mut bytes = Vec::new();
        reader.take(self.most + 1).read_to_end(&mut bytes).map_err(|error| self.unreadable(name, &error))?;
        if bytes.len() as u64 > self.most {
            return Err((format!("`{name}` is larger than {} MiB", self.most >> 20), self.smaller.to_owned()));
        }
        Ok(bytes)
    }

    fn unreadable(&self, name: &str, error: &std::io::Error) -> FileMistake {
        let help = format!("check the path and its permissions, and that it is {}", self.noun);
        (format!("cannot read `{name}`: {error}"), help)
    }
}
