//! What can be wrong with a matrix and with what is given beside it.

use thiserror::Error;

/// What is wrong with a matrix, or with the vectors and maps that were given with it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// More rows or columns than 32-bit indices can name.
    #[error("{size} rows or columns; indices have 32 bits, so at most 4294967295 are possible")]
    TooLarge {
        /// Rows or columns asked for.
        size: usize,
    },
    /// The offsets of the rows do not fit the entries.
    #[error("the offsets do not fit the entries near row {row}: they start at 0, never fall, and end at nnz")]
    Offsets {
        /// First row that does not fit, or the number of rows.
        row: usize,
    },
    /// A column index is too large.
    #[error("row {row} has an entry in column {column}, but there are only {ncols} columns")]
    ColumnOutOfRange {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// Number of columns.
        ncols: usize,
    },
    /// A row index is too large.
    #[error("an entry names row {row}, but there are only {nrows} rows")]
    RowOutOfRange {
        /// Row.
        row: usize,
        /// Number of rows.
        nrows: usize,
    },
    /// Columns of a row are not strictly increasing.
    #[error(
        "the columns of row {row} are not strictly increasing at column {column}; sort them and add repeats"
    )]
    Unsorted {
        /// Row.
        row: usize,
        /// Column that does not exceed the one before it.
        column: usize,
    },
    /// A value is infinite or not a number.
    #[error("the entry in row {row}, column {column} is {value}; check the coefficients of this row")]
    NotFinite {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// The value.
        value: f64,
    },
    /// A square matrix is needed.
    #[error("a square matrix is needed, this one has {nrows} rows and {ncols} columns")]
    NotSquare {
        /// Rows.
        nrows: usize,
        /// Columns.
        ncols: usize,
    },
    /// A vector has the wrong length.
    #[error("{what} of length {found}, but the matrix needs {expected}")]
    Length {
        /// Which vector.
        what: &'static str,
        /// Its length.
        found: usize,
        /// What the matrix needs.
        expected: usize,
    },
    /// A numbering that is not one.
    #[error("position {position} of the permutation names {index}, which is out of range or named before")]
    NotAPermutation {
        /// Position.
        position: usize,
        /// What it names.
        index: usize,
    },
    /// A number given with the matrix is infinite or not a number.
    #[error("{what} of node {node} is {value}; it must be finite")]
    BadNumber {
        /// Which number.
        what: &'static str,
        /// Node.
        node: usize,
        /// The number.
        value: f64,
    },
    /// A node belongs to a group that does not exist.
    #[error("node {node} is in group {group}, but there are only {groups} groups")]
    NoSuchGroup {
        /// Node.
        node: usize,
        /// Its group.
        group: usize,
        /// Number of groups.
        groups: usize,
    },
    /// A cluster cannot be pinned.
    #[error("cluster {cluster} has no node to pin: {reason}")]
    NoPin {
        /// Cluster.
        cluster: usize,
        /// Why.
        reason: &'static str,
    },
}

impl MatrixError {
    pub(crate) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected { Ok(()) } else { Err(Self::Length { what, found, expected }) }
    }

    pub(crate) fn check_finite(what: &'static str, values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|v| !v.is_finite()) {
            None => Ok(()),
            Some(node) => Err(Self::BadNumber { what, node, value: values[node] }),
        }
    }
}
