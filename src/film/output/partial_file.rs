//! Atomic writing of files: each file gets its name when it is complete. Until then no file with a name is touched.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::OutputError;

/// The fate of a file that is never completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unfinished {
    /// It stays in place unless it is empty, because its beginning can be shown.
    Kept,
    /// It is removed, because its beginning is useless. If the system allows it, the file has no name until it is
    /// complete. So a killed program leaves no file.
    Removed,
    /// It is removed, but has a name because another program writes into it.
    Shared,
}

/// The ending of names of files in the making.
const ENDING: &str = ".part";

/// In most file systems a longer name, in bytes, leaves no room for the random letters and the ending.
const LONGEST_BEGINNING: usize = 200;

/// Linux follows at most this many links. More of them form a circle.
const MOST_LINKS: usize = 40;

/// A file in the making: without a name, or `<name>.<random letters>.part` beside its target. Two programs that write one target
/// have a file each.
#[derive(Debug)]
pub(super) struct PartFile {
    /// As messages call it.
    name: PathBuf,
    /// The file that is replaced: the end of the chain of links.
    target: PathBuf,
    /// The path of the file, with the folder as in messages.
    shown: PathBuf,
    /// `None` once complete, and while it has no name.
    part: Option<TempPath>,
    /// `None` once complete.
    file: Option<BufWriter<File>>,
    bytes: u64,
    unfinished: Unfinished,
}

impl PartFile {
    /// Creates the temporary file for a target. An existing target keeps its permissions. If it is a link, it stays
    /// one.
    pub(super) fn create(name: &Path, unfinished: Unfinished) -> Result<PartFile, OutputError> {
        let told = |cause: io::Error| OutputError::io(name, cause);
        let target = behind_links(name).map_err(told)?;
        let before = writable(&target).map_err(told)?;
        let unnamed = (unfinished == Unfinished::Removed).then(|| unnamed::create(folder_of(&target))).flatten();
        let (file, part) = match unnamed {
            Some(file) => (file, None),
            None => {
                let (file, part) = named(&target).map_err(told)?;
                (file, Some(part))
            }
        };
        if let Some(before) = before {
            file.set_permissions(before).map_err(told)?;
        }
        let shown = part.as_ref().and_then(|part| part.file_name());
        let shown = shown.map_or_else(|| target.clone(), |name| target.with_file_name(name));
        let file = Some(BufWriter::with_capacity(1 << 16, file));
        Ok(PartFile { name: name.to_path_buf(), target, shown, part, file, bytes: 0, unfinished })
    }

    /// The path of the incomplete file, if it has a name: see [`Unfinished`].
    pub(super) fn part(&self) -> &Path {
        &self.shown
    }

    /// The path at which its beginning stays if it is never completed.
    pub(super) fn beginning(&self) -> Option<PathBuf> {
        (self.unfinished == Unfinished::Kept).then(|| self.shown.clone())
    }

    /// The number of bytes that were written so far.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    fn is_kept(&self) -> bool {
        self.unfinished == Unfinished::Kept && self.bytes > 0
    }

    /// Overwrites the bytes at an offset.
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

    /// Like `complete`, but only if no file has the name yet.
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
            if self.part.is_none() {
                self.part = Some(unnamed::name(file.get_ref(), &self.target)?);
            }
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

/// A new file beside a target with an unused name, which is removed together with the path.
fn named(target: &Path) -> io::Result<(File, TempPath)> {
    // Permissions are those of any new file: the maker's own way would let only the user read it.
    made_at(target, |path| File::options().write(true).create_new(true).open(path))
}

/// The result of `make` with an unused name.
fn made_at<T>(target: &Path, make: impl FnMut(&Path) -> io::Result<T>) -> io::Result<(T, TempPath)> {
    let mut maker = tempfile::Builder::new();
    let made = maker.prefix(&beginning(target)).suffix(ENDING).make_in(folder_of(target), make)?;
    Ok(made.into_parts())
}

/// Files without a name: the system frees their space when the program ends, however it does.
#[cfg(target_os = "linux")]
mod unnamed {
    use std::fs::File;
    use std::io::{self, ErrorKind, Seek};
    use std::os::fd::AsRawFd;
    use std::path::{Path, PathBuf};

    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};
    use tempfile::TempPath;

    use super::{made_at, named};

    /// A file without a name in a folder; `None` if the system cannot make one.
    pub(super) fn create(folder: &Path) -> Option<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file = File::from(open(folder, flags, Mode::from_raw_mode(0o666)).ok()?);
        // It gets its name by way of this entry.
        entry(&file).try_exists().is_ok_and(|there| there).then_some(file)
    }

    fn entry(file: &File) -> PathBuf {
        format!("/proc/self/fd/{}", file.as_raw_fd()).into()
    }

    /// Gives a complete file a name beside its target.
    pub(super) fn name(file: &File, target: &Path) -> io::Result<TempPath> {
        let link = |path: &Path| Ok(linkat(CWD, entry(file), CWD, path, AtFlags::SYMLINK_FOLLOW)?);
        match made_at(target, link) {
            Ok(((), part)) => Ok(part),
            Err(cause) if cause.kind() == ErrorKind::StorageFull => Err(cause),
            // A file system that has such files and cannot name them.
            Err(_) => {
                let (mut copy, part) = named(target)?;
                let mut whole = file;
                whole.rewind()?;
                io::copy(&mut whole, &mut copy)?;
                copy.set_permissions(file.metadata()?.permissions())?;
                copy.sync_all()?;
                Ok(part)
            }
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod unnamed {
    use std::fs::File;
    use std::io::{self, ErrorKind};
    use std::path::Path;

    use tempfile::TempPath;

    pub(super) fn create(_: &Path) -> Option<File> {
        None
    }

    pub(super) fn name(_: &File, _: &Path) -> io::Result<TempPath> {
        Err(ErrorKind::Unsupported.into())
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
        // The temporary file disappears with its path, unless its beginning can be shown.
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

/// The file behind a name, whether it exists or not. Renaming would replace a link by a file.
///
/// # Errors
/// An error if links form a circle, or if a name with another ending leads to a scene.
pub fn behind_links(name: &Path) -> io::Result<PathBuf> {
    let mut target = name.to_path_buf();
    for _ in 0..MOST_LINKS {
        // A link may lead to a file that is still to be made.
        let Ok(next) = fs::read_link(&target) else {
            // A name with another ending leads to a scene only by mistake.
            if is_scene(&target) && !is_scene(name) {
                return Err(io::Error::new(ErrorKind::InvalidInput, "it is a link to a scene"));
            }
            return Ok(target);
        };
        target = folder_of(&target).join(next);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "its links lead in a circle"))
}

fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"))
}

/// The permissions of an existing file. Renaming would replace even a read-only file.
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
    // Opening changes nothing, and the system has more reasons to refuse than the permissions show.
    File::options().write(true).open(target)?;
    Ok(Some(before.permissions()))
}

/// The folder in which a path ends.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The prefix of the names of temporary files for a target.
fn beginning(target: &Path) -> OsString {
    let mut name = target.file_name().unwrap_or_default().to_os_string();
    if name.len() > LONGEST_BEGINNING {
        let text = name.to_string_lossy();
        name = text[..text.floor_char_boundary(LONGEST_BEGINNING)].into();
    }
    name.push(".");
    name
}

/// Synchronises a folder, so that the name of a file is on the disk. Some systems cannot do it for folders, and some
/// folders are unreadable.
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
