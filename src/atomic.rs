//! Writing files so that a reader, or the next run, never meets half of one.
//!
//! The bytes go to a hidden neighbour, reach the disk, and take the final name in one step. Whoever is killed in between
//! leaves the old file as it was, and at most a hidden neighbour, which [`sweep`] removes.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// How a neighbour's name begins.
pub(crate) const PREFIX: &str = ".shotdamp-";
/// Links that are followed one after the other; more lead in a circle.
const LINKS: u32 = 40;

/// A file that could not be read or written, with its name.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}: {}", from_here(path), in_words(source))]
pub struct FileError {
    /// `read`, `write`, …
    pub action: &'static str,
    /// Which file.
    pub path: PathBuf,
    /// What the system says.
    pub source: io::Error,
}

impl FileError {
    pub(crate) fn new(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self { action, path: path.to_path_buf(), source }
    }
}

/// What the system says, with what to do where permission is missing.
fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::PermissionDenied => {
            "permission denied; change its permissions (chmod), or work in a folder of your own".into()
        }
        io::ErrorKind::ReadOnlyFilesystem => {
            "its file system is read-only; work in a copy of the study elsewhere".into()
        }
        _ => error.to_string(),
    }
}

/// A path as a person sees it: from the current folder if it lies below that.
#[must_use]
pub fn from_here(path: &Path) -> String {
    let here = std::env::current_dir().ok();
    let below = here.as_deref().and_then(|here| path.strip_prefix(here).ok());
    below.filter(|below| !below.as_os_str().is_empty()).unwrap_or(path).display().to_string()
}

/// Writes the whole file or leaves it as it was; makes the folder if it is not there. A link stays, and what it leads to is
/// written. What is no regular file, such as a pipe or a device, takes the bytes as they come: another file in its place would
/// not be what was meant.
///
/// # Errors
/// [`FileError`] with the system's reason.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let fail = |source| FileError::new("write", path, source);
    let path = match target(path).map_err(fail)? {
        Target::Whole(path) => path,
        Target::Through => return File::create(path).and_then(|mut file| file.write_all(bytes)).map_err(fail),
    };
    let folder = folder_of(&path);
    make_folder(folder).map_err(fail)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    // A temporary file is private by default; results are for all to read, as far as the umask lets them.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(fail)?;
    file.write_all(bytes).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    file.persist(&path).map_err(|error| fail(error.error))?;
    // The new name itself is on disk only once its folder is; not every system lets a folder be opened.
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// The error that [`write()`] would meet in the folder of this file, before there is anything to write; leaves nothing behind.
///
/// # Errors
/// [`FileError`] with the system's reason.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    let place = place_of(path);
    let folder = place.ancestors().skip(1).find(|folder| folder.exists()).unwrap_or(Path::new("."));
    let probe = tempfile::Builder::new().prefix(PREFIX).tempfile_in(folder);
    probe.map(drop).map_err(|source| FileError::new("write", path, source))
}

/// What becomes of a path that is written to.
enum Target {
    /// This file is replaced as a whole; it may not be there yet.
    Whole(PathBuf),
    /// It is opened, and the bytes go into it.
    Through,
}

fn target(path: &Path) -> io::Result<Target> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir()) {
        return Ok(Target::Through);
    }
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        let Ok(to) = fs::read_link(&path) else { return Ok(Target::Whole(path)) };
        let folder = folder_of(&path);
        // An open file of this or another process, which need not have a name any more.
        if fs::canonicalize(folder).is_ok_and(|folder| folder.starts_with("/proc")) {
            return Ok(Target::Through);
        }
        path = folder.join(to);
    }
    Err(io::Error::other("its links lead in a circle"))
}

/// Where a file that is written to this path comes to lie: without links, though it and its folders need not be there yet.
#[must_use]
pub fn place_of(path: &Path) -> PathBuf {
    let path = match target(path) {
        Ok(Target::Whole(path)) => path,
        Ok(Target::Through) | Err(_) => path.to_path_buf(),
    };
    let path = std::path::absolute(&path).unwrap_or(path);
    let real = |there: &Path| Some((fs::canonicalize(there).ok()?, path.strip_prefix(there).ok()?.to_path_buf()));
    match path.ancestors().find_map(real) {
        Some((there, rest)) if rest.as_os_str().is_empty() => there,
        Some((there, rest)) => there.join(rest),
        None => path,
    }
}

/// Makes a folder with all above it.
///
/// # Errors
/// The system's reason; where something else stands in the place of a folder, which, and what to do about it.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder).map_err(|error| {
        let in_the_way = folder.ancestors().find(|path| path.symlink_metadata().is_ok()).filter(|path| !path.is_dir());
        in_the_way
            .map_or(error, |path| io::Error::other(format!("`{}` is not a folder: move it away", from_here(path))))
    })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// As [`write()`], but leaves a file alone that holds these bytes already. Returns whether it wrote.
///
/// # Errors
/// As [`write()`].
pub fn write_if_changed(path: &Path, bytes: &[u8]) -> Result<bool, FileError> {
    if fs::metadata(path).is_ok_and(|meta| meta.is_file() && meta.len() == bytes.len() as u64)
        && fs::read(path).is_ok_and(|old| old == bytes)
    {
        return Ok(false);
    }
    write(path, bytes).map(|()| true)
}

/// Removes what killed runs left in a folder. Only for the holder of the study's lock: it would take a neighbour from
/// under the hands of another run.
pub fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        if entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}
