//! The one writer of files: each gets its name when it is complete, and until then nothing that has a name is touched.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::OutputError;

/// What becomes of a file that is never completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unfinished {
    /// It stays where it is, unless it is empty: its beginning can be shown.
    Kept,
    /// It goes: its beginning is of no use.
    Removed,
}

/// The ending of names of files in the making.
const ENDING: &str = ".part";

/// A name with more bytes than this leaves no room for the random letters and the ending in most file systems.
const LONGEST_BEGINNING: usize = 200;

/// So many links lead on from each other in Linux; more of them lead in a circle.
const MOST_LINKS: usize = 40;

/// A file in the making: `<name>.<random letters>.part` beside its target. Two programs that write one target have a file each.
#[derive(Debug)]
pub(super) struct PartFile {
    /// As messages call it.
    name: PathBuf,
    /// What takes the place: the file that a link leads to.
    target: PathBuf,
    /// Where the file is, as messages call the folder.
    shown: PathBuf,
    /// None once complete.
    part: Option<TempPath>,
    /// None once complete.
    file: Option<BufWriter<File>>,
    bytes: u64,
    unfinished: Unfinished,
}

impl PartFile {
    /// Creates the temporary file for a target. A target that is there keeps its permissions and, if it is a link, stays one.
    pub(super) fn create(name: &Path, unfinished: Unfinished) -> Result<PartFile, OutputError> {
        let told = |cause: io::Error| OutputError::io(name, cause);
        let target = behind_links(name).map_err(told)?;
        let before = writable(&target).map_err(told)?;
        let (folder, beginning) = (folder_of(&target), beginning(&target));
        let mut maker = tempfile::Builder::new();
        // Permissions are those of any new file: the maker's own way would let only the user read it.
        let make = |path: &Path| File::options().write(true).create_new(true).open(path);
        let made = maker.prefix(&beginning).suffix(ENDING).make_in(folder, make);
        let (file, part) = made.map_err(told)?.into_parts();
        if let Some(before) = before {
            file.set_permissions(before).map_err(told)?;
        }
        let shown = target.with_file_name(part.file_name().unwrap_or_default());
        let file = Some(BufWriter::with_capacity(1 << 16, file));
        Ok(PartFile { name: name.to_path_buf(), target, shown, part: Some(part), file, bytes: 0, unfinished })
    }

    /// Where the file is until it is complete.
    pub(super) fn part(&self) -> &Path {
        &self.shown
    }

    /// How many bytes were written so far.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    fn is_kept(&self) -> bool {
        self.unfinished == Unfinished::Kept && self.bytes > 0
    }

    /// Writes over what was written at a place.
    pub(super) fn overwrite(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        // Seeking writes out what waits.
        let end = file.stream_position()?;
        file.seek(SeekFrom::Start(place))?;
        file.write_all(bytes)?;
        file.seek(SeekFrom::Start(end)).map(|_| ())
    }

    /// Gives the file its name.
    pub(super) fn complete(mut self) -> Result<(), OutputError> {
        let named = self.name_it(|part, target| part.persist(target));
        named.and_then(|()| sync_folder(folder_of(&self.target))).map_err(|cause| self.failed(cause))
    }

    /// The same where no file has the name yet.
    pub(super) fn complete_new(mut self) -> Result<(), OutputError> {
        let named = self.name_it(|part, target| part.persist_noclobber(target));
        named.and_then(|()| sync_folder(folder_of(&self.target))).map_err(|cause| self.failed(cause))
    }

    /// The same for one of many files in a folder that is written out after the last of them.
    pub(super) fn complete_one_of_many(mut self) -> Result<(), OutputError> {
        self.name_it(|part, target| part.persist(target)).map_err(|cause| self.failed(cause))
    }

    fn failed(&self, cause: io::Error) -> OutputError {
        let kept = self.is_kept().then(|| self.part().to_path_buf());
        OutputError::Io { path: self.name.clone(), cause, kept }
    }

    /// Makes sure that a machine without power finds the old file or the whole new one.
    fn name_it(
        &mut self,
        persist: impl FnOnce(TempPath, &Path) -> Result<(), tempfile::PathPersistError>,
    ) -> io::Result<()> {
        self.flush()?;
        if let Some(file) = &self.file {
            file.get_ref().sync_all()?;
        }
        let Some(part) = self.part.take() else { return Ok(()) };
        if let Err(refused) = persist(part, &self.target) {
            self.part = Some(refused.path);
            return Err(refused.error);
        }
        self.file = None;
        Ok(())
    }
}

impl Write for PartFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(file) = &mut self.file else { return Ok(0) };
        let count = file.write(bytes)?;
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for PartFile {
    fn drop(&mut self) {
        // The temporary file goes with its path, unless its beginning can be shown.
        let kept = self.is_kept();
        if let Some(part) = &mut self.part {
            part.disable_cleanup(kept);
        }
    }
}

/// Finds reasons against a target, and changes nothing.
pub(super) fn look_at(name: &Path) -> io::Result<()> {
    behind_links(name).and_then(|target| writable(&target)).map(|_| ())
}

/// The file that a name stands for: renaming would put a file in the place of a link.
fn behind_links(name: &Path) -> io::Result<PathBuf> {
    let mut target = name.to_path_buf();
    for _ in 0..MOST_LINKS {
        // A link may lead to a file that is still to be made.
        let Ok(next) = fs::read_link(&target) else { return Ok(target) };
        target = folder_of(&target).join(next);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "its links lead in a circle"))
}

/// The permissions of a file that is there. Renaming would replace it even where it may not be written.
fn writable(target: &Path) -> io::Result<Option<fs::Permissions>> {
    let before = match fs::metadata(target) {
        Ok(before) => before,
        Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
        Err(cause) => return Err(cause),
    };
    if before.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !before.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is a device or a pipe, not a file"));
    }
    if before.permissions().readonly() {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "it is read-only"));
    }
    // Opening changes nothing, and the system knows more reasons against it than the permissions tell.
    File::options().write(true).open(target)?;
    Ok(Some(before.permissions()))
}

/// The folder in which a path ends.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What the names of temporary files for a target begin with.
fn beginning(target: &Path) -> OsString {
    let mut name = target.file_name().unwrap_or_default().to_os_string();
    if name.len() > LONGEST_BEGINNING {
        let text = name.to_string_lossy();
        name = text[..text.floor_char_boundary(LONGEST_BEGINNING)].into();
    }
    name.push(".");
    name
}

/// Writes out that a file has its name. Some systems have no such thing for folders, and some folders may not be read.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        Err(cause) if matches!(cause.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        synced => synced,
    }
}
