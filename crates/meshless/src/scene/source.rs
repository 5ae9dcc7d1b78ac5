//! The text of a scene file, and places in it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::error::{Excerpt, SceneError};

/// Longest scene file that is read, in bytes: room for a polygon of a hundred thousand vertices.
pub const MAX_FILE_BYTES: usize = 8 << 20;

/// A file's name and text.
#[derive(Clone)]
pub(super) struct Source {
    pub(super) file: String,
    pub(super) text: String,
}

/// The text would drown everything else.
impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Source({})", self.file)
    }
}

impl Source {
    pub(super) fn new(file: &str, text: &str) -> Self {
        Self { file: file.to_owned(), text: text.to_owned() }
    }

    pub(super) fn read(path: &Path) -> Result<Self, SceneError> {
        let source = Self::new(&path.display().to_string(), "");
        let about_file = |message: String| source.error_of_file(message);
        let length = std::fs::metadata(path).map_err(|e| about_file(format!("cannot be read: {e}")))?.len();
        if length > MAX_FILE_BYTES as u64 {
            return Err(source.too_long(length));
        }
        let bytes = std::fs::read(path).map_err(|e| about_file(format!("cannot be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|e| {
            about_file(format!("is not UTF-8 text: byte {} is wrong", e.utf8_error().valid_up_to()))
        })?;
        Ok(Self { text, ..source })
    }

    pub(super) fn too_long(&self, bytes: u64) -> SceneError {
        self.error_of_file(format!("has {bytes} bytes, more than the {MAX_FILE_BYTES} that a scene can have"))
    }

    fn error_of_file(&self, message: String) -> SceneError {
        let (file, key, help) = (self.file.clone(), String::new(), String::new());
        SceneError { file, line: 0, column: 0, key, message, help, excerpt: None }
    }

    /// Line and column of a byte, both from 1, the column in characters; and the bytes of the line.
    fn locate(&self, byte: usize) -> (usize, usize, Range<usize>) {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &self.text[..byte];
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let end = self.text[byte..].find('\n').map_or(self.text.len(), |newline| byte + newline);
        let line = 1 + before.bytes().filter(|b| *b == b'\n').count();
        (line, 1 + before[start..].chars().count(), start..end)
    }
}

/// A place in a scene file: the bytes of a value or table, and its key.
#[derive(Clone)]
pub struct Place {
    source: Arc<Source>,
    /// Dotted path such as `regions[0].diffusivity`.
    pub key: String,
    pub(super) span: Range<usize>,
}

impl fmt::Debug for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.position();
        write!(f, "{}:{line}:{column}: {}", self.source.file, self.key)
    }
}

impl Place {
    pub(super) fn new(source: &Arc<Source>, key: impl Into<String>, span: Range<usize>) -> Self {
        Self { source: source.clone(), key: key.into(), span }
    }

    /// The text that stands there.
    pub(super) fn text(&self) -> &str {
        self.source.text.get(self.span.clone()).unwrap_or_default()
    }

    /// The same key with other bytes of it.
    /// The whole file.
    pub(crate) fn source_text(&self) -> &str {
        &self.source.text
    }

    pub(super) fn at(&self, span: Range<usize>) -> Self {
        Self { span, ..self.clone() }
    }

    /// The same bytes under another key.
    pub(super) fn named(&self, key: String) -> Self {
        Self { key, ..self.clone() }
    }

    /// The folder of the file, for paths that are relative to it.
    pub(crate) fn folder(&self) -> PathBuf {
        Path::new(&self.source.file).parent().map(Path::to_path_buf).unwrap_or_default()
    }

    /// A file that is named here, beside the scene unless its path is absolute, and its bytes.
    pub(crate) fn read_beside(
        &self,
        file: impl AsRef<Path>,
        max_bytes: u64,
    ) -> Result<(PathBuf, Vec<u8>), SceneError> {
        let path = self.folder().join(file);
        let wrong = |what: String, help: &str| self.error(format!("{} {what}", path.display()), help);
        let unreadable =
            |e: std::io::Error| wrong(format!("cannot be read: {e}"), "the path is relative to the scene");
        let length = std::fs::metadata(&path).map_err(unreadable)?.len();
        if length > max_bytes {
            return Err(wrong(format!("has {length} bytes, more than {max_bytes}"), "give a smaller file"));
        }
        let bytes = std::fs::read(&path).map_err(unreadable)?;
        Ok((path, bytes))
    }

    /// The same for text in UTF-8.
    pub(crate) fn read_text_beside(
        &self,
        file: impl AsRef<Path>,
        max_bytes: u64,
    ) -> Result<(PathBuf, String), SceneError> {
        let (path, bytes) = self.read_beside(file, max_bytes)?;
        let text = String::from_utf8(bytes).map_err(|e| {
            let byte = e.utf8_error().valid_up_to();
            self.error(format!("{} is not UTF-8 text: byte {byte} is wrong", path.display()), "")
        })?;
        Ok((path, text))
    }

    /// Line and column, both from 1; the column counts characters.
    pub fn position(&self) -> (usize, usize) {
        let (line, column, _) = self.source.locate(self.span.start);
        (line, column)
    }

    /// An error about what stands there.
    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        let (line, column, bytes) = self.source.locate(self.span.start);
        let text = self.source.text[bytes.clone()].trim_end_matches('\r');
        let end = self.source.text.get(..self.span.end.clamp(bytes.start, bytes.end));
        let width = end.map_or(1, |end| end[bytes.start..].chars().count().saturating_sub(column - 1));
        let excerpt = (!text.trim().is_empty()).then(|| Box::new(Excerpt::new(text, column - 1, width)));
        SceneError {
            file: self.source.file.clone(),
            line,
            column,
            key: self.key.clone(),
            message: message.into(),
            help: help.into(),
            excerpt,
        }
    }
}
