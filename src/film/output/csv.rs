//! Channels as comma-separated values: a header with names and units, then a row per sample. Numbers are written so
//! that they read back with the same bits.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::OutputError;
use super::partial_file::{PartFile, Unfinished};
use super::raw::STANDARD_OUTPUT;
use jostle_language::visible_line;

pub use jostle_language::exact as number;

/// A table in the making: a `.part` file until it is complete, or standard output.
pub struct Table {
    path: PathBuf,
    way: Way,
    columns: usize,
}

enum Way {
    Out(io::Stdout),
    File(PartFile),
}

impl Table {
    /// Begins a table with a column `time [s]` and one for each name and unit; `-` is standard output.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create<'a>(path: &Path, columns: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, OutputError> {
        let (way, path) = if path == Path::new(STANDARD_OUTPUT) {
            (Way::Out(io::stdout()), PathBuf::from("standard output"))
        } else {
            (Way::File(PartFile::create(path, Unfinished::Kept)?), path.to_owned())
        };
        let mut table = Self { path, way, columns: 0 };
        let mut header = "time [s]".to_owned();
        for (name, unit) in columns {
            table.columns += 1;
            header.push(',');
            header.push_str(&visible_line(name));
            if !unit.is_empty() {
                header.push_str(&format!(" [{unit}]"));
            }
        }
        table.line(&header)?;
        Ok(table)
    }

    /// Adds a row. Values beyond the columns are left out.
    ///
    /// # Errors
    /// If the system refuses to write.
    pub fn row(&mut self, time: f64, values: impl IntoIterator<Item = f64>) -> Result<(), OutputError> {
        let mut line = number(time);
        for value in values.into_iter().take(self.columns) {
            line.push(',');
            line.push_str(&number(value));
        }
        self.line(&line)
    }

    fn line(&mut self, line: &str) -> Result<(), OutputError> {
        let (written, kept) = match &mut self.way {
            Way::Out(out) => (writeln!(out, "{line}"), None),
            Way::File(part) => (writeln!(part, "{line}"), Some(part.part().to_owned())),
        };
        written.map_err(|cause| OutputError::Io { path: self.path.clone(), cause, kept })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If the system refuses to write.
    pub fn finish(self) -> Result<(), OutputError> {
        match self.way {
            Way::Out(mut out) => out.flush().map_err(|cause| OutputError::io(&self.path, cause)),
            Way::File(part) => part.complete(),
        }
    }
}
