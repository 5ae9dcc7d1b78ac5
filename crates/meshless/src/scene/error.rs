//! What is wrong with a scene: where, what, and what to do about it.

use std::fmt;

/// Widest excerpt of a line that is shown; a longer line is cut around the place.
const EXCERPT_COLUMNS: usize = 120;
/// Columns of a longer line that are shown before the place.
const EXCERPT_BEFORE: usize = 40;

/// Why a file is not a scene, or why its scene cannot be evaluated.
///
/// Displayed as
///
/// ```text
/// scene.toml:12:15: regions[0].diffusivity: expected a number or an expression, found a boolean
///    12 | diffusivity = true
///       |               ^^^^
///    help: write a number or an expression in quotes
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneError {
    /// The file, as it was named.
    pub file: String,
    /// Line, from 1; 0 where the error is about the file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 where the error is about the file as a whole.
    pub column: usize,
    /// Dotted path such as `regions[0].diffusivity`; empty for errors of syntax.
    pub key: String,
    /// What was found, and what was expected.
    pub message: String,
    /// What to do about it; may be empty.
    pub help: String,
    /// The line of the file with the place in it.
    pub(super) excerpt: Option<Box<Excerpt>>,
}

/// One line of the file and the characters of it that are meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Excerpt {
    text: String,
    /// Characters before the place.
    start: usize,
    /// Characters of the place, at least 1.
    width: usize,
}

impl Excerpt {
    /// `start` and `width` count characters of `line`; characters that a terminal would obey are replaced.
    pub(super) fn new(line: &str, start: usize, width: usize) -> Self {
        let printable = |c: char| match c {
            '\t' => ' ',
            c if c.is_control() => '\u{fffd}',
            c => c,
        };
        let length = line.chars().count();
        let skipped = if length > EXCERPT_COLUMNS { start.saturating_sub(EXCERPT_BEFORE) } else { 0 };
        let text: String = line.chars().skip(skipped).take(EXCERPT_COLUMNS).map(printable).collect();
        let shown = text.chars().count();
        let start = start - skipped;
        Self { text, start, width: width.min(shown.saturating_sub(start)).max(1) }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        write!(f, ": {}", self.message)?;
        if let Some(excerpt) = &self.excerpt {
            let Excerpt { text, start, width } = &**excerpt;
            write!(f, "\n{:>5} | {text}\n      | {:start$}{:^<width$}", self.line, "", "")?;
        }
        if !self.help.is_empty() {
            write!(f, "\n   help: {}", self.help)?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let line = format!("{}WRONG{}", "a".repeat(500), "b".repeat(500));
        let excerpt = Excerpt::new(&line, 500, 5);
        assert_eq!(excerpt.text.chars().count(), EXCERPT_COLUMNS);
        assert_eq!(&excerpt.text[excerpt.start..excerpt.start + excerpt.width], "WRONG");
    }

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        let excerpt = Excerpt::new("a\t\u{1b}[31m", 2, 1);
        assert_eq!(excerpt.text, "a \u{fffd}[31m");
    }
}
