//! Files that are either complete or not there.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::OutputError;

/// Writes `text` to `path`, replacing what is there, or leaves everything as it was.
///
/// # Errors
/// [`OutputError::Io`] with the path and the system's reason.
pub fn write_text_atomically(path: impl AsRef<Path>, text: &str) -> Result<(), OutputError> {
    write_atomically(path.as_ref(), |out| Ok(out.write_all(text.as_bytes())?))
}

/// What goes wrong inside a writer: the disk, or the encoding of the contents.
pub(crate) enum WriteError {
    Io(std::io::Error),
    Contents(OutputError),
}

impl From<std::io::Error> for WriteError {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Lets `write` fill a temporary file beside `path`, and renames it once it is complete and on the disk.
pub(crate) fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), WriteError>,
) -> Result<(), OutputError> {
    let temporary = beside(path);
    let result = fill(&temporary, write).and_then(|()| Ok(fs::rename(&temporary, path)?));
    result.map_err(|error| {
        // Nothing is lost if this fails too: the first error is the one to report.
        let _ = fs::remove_file(&temporary);
        match error {
            WriteError::Io(source) => OutputError::Io { path: path.to_path_buf(), source },
            WriteError::Contents(error) => error,
        }
    })
}

fn fill(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    let mut out = BufWriter::new(File::create_new(path)?);
    write(&mut out)?;
    let file = out.into_inner().map_err(std::io::IntoInnerError::into_error)?;
    Ok(file.sync_all()?)
}

/// A name in the same folder, so that the renaming stays within one file system, that no other thread or process uses.
fn beside(path: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    path.with_file_name(name)
}
