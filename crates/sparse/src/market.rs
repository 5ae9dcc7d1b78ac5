//! Matrix Market files: coordinate, real, general or symmetric.

use crate::csr::Csr;
use crate::error::MatrixError;
use std::io::{self, BufRead, Write};
use thiserror::Error;

/// What is wrong with a Matrix Market file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MarketError {
    /// Reading or writing failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A line is not as it must be.
    #[error("line {line}: {expected}, found \"{found}\"")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What was expected.
        expected: &'static str,
        /// The line.
        found: String,
    },
    /// Fewer or more entries than announced.
    #[error("{found} entries, but the size line announces {announced}")]
    Count {
        /// Entries found.
        found: usize,
        /// Entries announced.
        announced: usize,
    },
    /// The entries do not make a matrix.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}

/// Rows that a file may have without an entry for every [`ROWS_PER_ENTRY`] of them.
const FEW_ROWS: usize = 1 << 20;

/// Rows that there may be for an entry, in larger files: memory is for what a file has, not for what its size line claims.
const ROWS_PER_ENTRY: usize = 64;

/// Reads `%%MatrixMarket matrix coordinate real|integer general|symmetric`. Repeated entries add up; symmetric files have the lower
/// triangle only.
///
/// # Errors
/// [`MarketError`] gives the line.
pub fn read_matrix_market(reader: impl BufRead) -> Result<Csr, MarketError> {
    let mut lines = reader.lines().enumerate().map(|(k, line)| line.map(|line| (k + 1, line)));
    let (line, header) = lines.next().transpose()?.unwrap_or((1, String::new()));
    let words: Vec<String> = header.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let symmetric = match words[..] {
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "general"] => false,
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "symmetric"] => true,
        _ => {
            let expected = "expected \"%%MatrixMarket matrix coordinate real general\" or \"... symmetric\"";
            return Err(MarketError::Line { line, expected, found: header });
        }
    };
    let mut size = None;
    let mut too_many = None;
    let mut triplets = Vec::new();
    let mut found = 0;
    for entry in lines {
        let (line, text) = entry?;
        if text.trim().is_empty() || text.starts_with('%') {
            continue;
        }
        let wrong = |expected| MarketError::Line { line, expected, found: text.clone() };
        let Some((nrows, ncols, _)) = size else {
            let sizes = size_line(&text).ok_or_else(|| wrong("expected \"rows columns entries\""))?;
            if sizes.0.max(sizes.1) > u32::MAX as usize {
                return Err(MatrixError::TooLarge { size: sizes.0.max(sizes.1) }.into());
            }
            if symmetric && sizes.0 != sizes.1 {
                return Err(wrong("expected as many rows as columns of a symmetric matrix"));
            }
            size = Some(sizes);
            too_many = Some(wrong("expected fewer rows or columns, almost all of them have no entry"));
            continue;
        };
        let (i, j, value) = entry_line(&text).ok_or_else(|| wrong("expected \"row column value\""))?;
        if !(1..=nrows).contains(&i) || !(1..=ncols).contains(&j) {
            return Err(wrong("expected a row and a column within the size, counted from 1"));
        }
        if symmetric && j > i {
            return Err(wrong("expected an entry on or below the diagonal of a symmetric matrix"));
        }
        if !value.is_finite() {
            return Err(wrong("expected a finite value"));
        }
        found += 1;
        triplets.push((i - 1, j - 1, value));
        if symmetric && i != j {
            triplets.push((j - 1, i - 1, value));
        }
    }
    let no_size = || MarketError::Line { line: 2, expected: "expected a size line", found: String::new() };
    let (nrows, ncols, announced) = size.ok_or_else(no_size)?;
    if found != announced {
        return Err(MarketError::Count { found, announced });
    }
    let large = nrows.max(ncols);
    if let Some(error) = too_many.filter(|_| large > FEW_ROWS && large / ROWS_PER_ENTRY > found) {
        return Err(error);
    }
    Ok(Csr::from_triplets(nrows, ncols, &triplets)?)
}

fn size_line(text: &str) -> Option<(usize, usize, usize)> {
    let mut words = text.split_whitespace();
    let size = (words.next()?.parse().ok()?, words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    words.next().is_none().then_some(size)
}

fn entry_line(text: &str) -> Option<(usize, usize, f64)> {
    let mut words = text.split_whitespace();
    let entry = (words.next()?.parse().ok()?, words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    words.next().is_none().then_some(entry)
}

/// Writes all entries in the general form, with as many digits as it takes to read the same numbers back.
///
/// # Errors
/// Those of the writer.
pub fn write_matrix_market(matrix: &Csr, mut writer: impl Write) -> io::Result<()> {
    writeln!(writer, "%%MatrixMarket matrix coordinate real general")?;
    writeln!(writer, "{} {} {}", matrix.nrows(), matrix.ncols(), matrix.nnz())?;
    for i in 0..matrix.nrows() {
        let (columns, values) = matrix.row(i);
        for (j, a) in columns.iter().zip(values) {
            writeln!(writer, "{} {} {a:e}", i + 1, j + 1)?;
        }
    }
    Ok(())
}
