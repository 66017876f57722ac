//! The record of a sweep beside its table, by which a killed sweep continues.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::result_table::Row;
use jostle_language::digest::of_bytes;

/// The beginning of a record, which the sweep's identity follows.
const HEAD: &str = "jostle sweep ";

/// A larger file is no record.
const LARGEST: u64 = 1 << 30;

/// A line for each run that has ended: the check sum of the rest, and its row.
pub(super) struct Record {
    path: PathBuf,
    /// Locked, so that no other sweep writes into the folder at the same time.
    file: File,
    /// Rows of runs that an interrupted sweep has made, by their numbers.
    pub rows: BTreeMap<usize, Row>,
}

impl Record {
    /// Opens the record of a sweep, or begins one. A record of another sweep is given up.
    pub fn open(path: &Path, sweep: &str) -> Result<Self, String> {
        let shown = path.display();
        if path.symlink_metadata().is_ok_and(|about| !about.is_file()) {
            return Err(format!("`{shown}` is no file, but a sweep keeps its finished runs there: move it away"));
        }
        let told = |cause: std::io::Error| format!("`{shown}` cannot be written: {cause}");
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let mut file = opened.map_err(told)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(format!("another sweep writes into this folder (`{shown}`): wait for it, or name another"));
            }
            // Some systems have no locks.
            Err(TryLockError::Error(_)) | Ok(()) => {}
        }
        let mut text = Vec::new();
        (&mut file).take(LARGEST).read_to_end(&mut text).map_err(told)?;
        // A full disk may have left a part of the head.
        if !text.starts_with(HEAD.as_bytes()) && !HEAD.as_bytes().starts_with(&text) {
            return Err(format!("`{shown}` is no record of finished runs of a sweep: move it away"));
        }
        let head = format!("{HEAD}{sweep}\n");
        let (rows, good) = match text.strip_prefix(head.as_bytes()) {
            Some(lines) => read(lines),
            None => (BTreeMap::new(), 0),
        };
        // An incomplete line after a kill is overwritten.
        let length = if good > 0 || text.starts_with(head.as_bytes()) { head.len() + good } else { 0 };
        file.set_len(length as u64).and_then(|()| file.seek(SeekFrom::End(0)).map(|_| ())).map_err(told)?;
        if length == 0 {
            file.write_all(head.as_bytes()).map_err(told)?;
        }
        Ok(Self { path: path.to_owned(), file, rows })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a run that has ended.
    pub fn add(&mut self, row: &Row) -> Result<(), String> {
        let told = |cause: &dyn std::fmt::Display| format!("`{}` cannot be written: {cause}", self.path.display());
        let row = serde_json::to_string(row).map_err(|cause| told(&cause))?;
        let line = format!("{} {row}\n", sum(&row));
        self.file.write_all(line.as_bytes()).map_err(|cause| told(&cause))
    }

    /// Removes the record of a sweep whose table is written.
    pub fn close(self) -> Result<(), String> {
        let removed = std::fs::remove_file(&self.path);
        removed.map_err(|cause| format!("`{}` cannot be removed: {cause}", self.path.display()))
    }
}

fn sum(text: &str) -> String {
    format!("{:016x}", of_bytes(text.bytes()))
}

/// The rows of whole lines, and how many bytes those have.
fn read(lines: &[u8]) -> (BTreeMap<usize, Row>, usize) {
    let (mut rows, mut good) = (BTreeMap::new(), 0);
    for line in lines.split_inclusive(|&byte| byte == b'\n') {
        let text = line.strip_suffix(b"\n").and_then(|line| std::str::from_utf8(line).ok());
        let whole = text.and_then(|text| text.split_once(' ')).filter(|(known, row)| *known == sum(row));
        let Some(row) = whole.and_then(|(_, row)| serde_json::from_str::<Row>(row).ok()) else { break };
        rows.insert(row.run, row);
        good += line.len();
    }
    (rows, good)
}
