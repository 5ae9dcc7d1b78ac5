//! What matrices refuse, what reports find, what Matrix Market files say.

mod common;

use common::grid;
use meshless_sparse::{Csr, DifferenceMatrix, MarketError, MatrixError, read_matrix_market};

#[test]
fn parts_that_do_not_make_a_matrix_are_refused() {
    let parts = |offsets: &[usize], indices: &[u32], values: &[f64]| {
        Csr::try_from_parts(2, 3, offsets.to_vec(), indices.to_vec(), values.to_vec()).unwrap_err()
    };
    assert_eq!(parts(&[0, 1], &[0], &[1.0]), MatrixError::Offsets { row: 2 });
    assert_eq!(parts(&[0, 2, 1], &[0], &[1.0]), MatrixError::Offsets { row: 1 });
    assert_eq!(parts(&[0, 1, 2], &[0, 1], &[1.0]), MatrixError::Offsets { row: 2 });
    let out = MatrixError::ColumnOutOfRange { row: 1, column: 3, ncols: 3 };
    assert_eq!(parts(&[0, 1, 2], &[0, 3], &[1.0, 1.0]), out);
    assert_eq!(parts(&[0, 2, 2], &[1, 0], &[1.0; 2]), MatrixError::Unsorted { row: 0, column: 0 });
    assert_eq!(parts(&[0, 2, 2], &[1, 1], &[1.0; 2]), MatrixError::Unsorted { row: 0, column: 1 });
    let infinite = MatrixError::NotFinite { row: 1, column: 2, value: f64::INFINITY };
    assert_eq!(parts(&[0, 0, 1], &[2], &[f64::INFINITY]), infinite);
}

#[test]
fn of_several_bad_rows_the_lowest_is_reported() {
    let n = 10_000;
    let build =
        |i: usize, row: &mut meshless_sparse::RowBuilder| row.push(if i % 3000 == 2999 { n } else { i }, 1.0);
    let error = Csr::from_rows(n, n, build).unwrap_err();
    assert_eq!(error, MatrixError::ColumnOutOfRange { row: 2999, column: n, ncols: n });
    let huge = Csr::from_rows(2, 2, |_, row| row.push(usize::MAX, 1.0)).unwrap_err();
    assert_eq!(huge, MatrixError::ColumnOutOfRange { row: 0, column: usize::MAX, ncols: 2 });
    let infinite =
        DifferenceMatrix::from_rows(3, |i, row| row.add_to_row_sum(1.0 / (1.0 - i as f64))).unwrap_err();
    assert_eq!(infinite, MatrixError::NotFinite { row: 1, column: 1, value: f64::INFINITY });
    // Finite pushes that overflow where they meet.
    let sum = Csr::from_rows(1, 1, |_, row| (0..2).for_each(|_| row.push(0, f64::MAX))).unwrap_err();
    assert_eq!(sum, MatrixError::NotFinite { row: 0, column: 0, value: f64::INFINITY });
}

#[test]
fn errors_of_closures_come_through() {
    let error = DifferenceMatrix::try_from_rows(5000, Vec::<f64>::new, |scratch, i, row| {
        scratch.clear();
        row.push(0, 1.0);
        if i >= 2000 { Err(MatrixError::NoPin { cluster: i, reason: "test" }) } else { Ok(()) }
    });
    assert_eq!(error.unwrap_err(), MatrixError::NoPin { cluster: 2000, reason: "test" });
}

#[test]
fn a_grid_is_an_m_matrix_that_conserves() {
    let grid = grid(12, |p| 1.0 + 1e6 * p[0], 1.0, |_| 0.0);
    let whole = grid.matrix.report(Some(&[1.0; 144])).unwrap();
    assert!(whole.wrong_signs == 0 && whole.column_sum_max_relative.unwrap() < 1e-15);
    // Nothing holds it: singular, hence no M-matrix in the sense of the report.
    assert!(!whole.is_m_matrix && whole.row_sum_max_relative == 0.0);
    let reduced = grid.reduced.matrix.report(None).unwrap();
    assert!(reduced.is_m_matrix && reduced.column_sum_max_relative.is_none());
    assert!(reduced.row_sum_min_relative >= 0.0 && reduced.row_sum_max_relative > 0.1);
}

#[test]
fn reports_name_what_breaks_the_maximum_principle() {
    let rows = |sign: f64| {
        DifferenceMatrix::from_rows(3, move |i, row| {
            row.push((i + 1) % 3, -4.0 * sign);
            if i == 1 {
                row.push(0, 1.0 * sign);
            }
            row.add_to_row_sum(sign);
        })
        .unwrap()
        .report(Some(&[1.0, 2.0, 1.0]))
        .unwrap()
    };
    // The sign of a row does not matter.
    assert_eq!(rows(1.0), rows(-1.0));
    let report = rows(1.0);
    let worst = report.largest_wrong_sign.unwrap();
    assert_eq!((worst.row, worst.column, worst.relative, report.wrong_signs), (1, 0, 0.25, 1));
    assert!(!report.is_m_matrix);
    // Columns: 5 + 2 - 4, -4 + 8, -8 + 5; sizes 11, 12, 13.
    assert_eq!(report.column_sum_max_relative, Some(4.0 / 12.0));
    let empty = DifferenceMatrix::from_rows(2, |_, _| {}).unwrap().report(None).unwrap();
    assert!(empty.zero_diagonal == Some(0) && !empty.is_m_matrix);
}

#[test]
fn elimination_checks_what_it_is_given() {
    let matrix = DifferenceMatrix::from_rows(2, |i, row| row.push(1 - i, -1.0)).unwrap();
    let short = matrix.eliminate(&[None], &[0.0; 2]).unwrap_err();
    assert_eq!(short, MatrixError::Length { what: "prescribed values", found: 1, expected: 2 });
    let bad = matrix.eliminate(&[None, Some(f64::INFINITY)], &[0.0; 2]).unwrap_err();
    assert!(matches!(bad, MatrixError::BadNumber { node: 1, .. }));
    // All known: an empty system.
    let reduced = matrix.eliminate(&[Some(1.0), Some(2.0)], &[0.0; 2]).unwrap();
    assert_eq!(
        (reduced.matrix.n(), reduced.expand(&[], &[Some(1.0), Some(2.0)]).unwrap()),
        (0, vec![1.0, 2.0])
    );
}

#[test]
fn market_files_are_read_with_the_line_of_every_error() {
    let head = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n\n";
    let a = read_matrix_market(format!("{head}2 2 2\n1 1 2.5\n2 1 -1e-3\n").as_bytes()).unwrap();
    assert_eq!((a.get(0, 0), a.get(0, 1), a.get(1, 0), a.get(1, 1)), (2.5, -1e-3, -1e-3, 0.0));
    for (text, wrong) in [
        (String::new(), 1),
        ("%%MatrixMarket matrix array real general\n".to_owned(), 1),
        (head.to_owned(), 2),
        (format!("{head}2 2\n"), 4),
        (format!("{head}2 2 1\n1 one 2.0\n"), 5),
        (format!("{head}2 2 1\n0 1 2.0\n"), 5),
        (format!("{head}2 2 1\n1 3 2.0\n"), 5),
        (format!("{head}2 2 1\n1 1 nan\n"), 5),
        (format!("{head}2 2 1\n1 1 2.0 3.0\n"), 5),
        // Both triangles would count twice.
        (format!("{head}2 2 2\n2 1 2.0\n1 2 2.0\n"), 6),
        (format!("{head}2 3 1\n1 1 2.0\n"), 4),
        (format!("{head}4000000000 4000000000 1\n1 1 2.0\n"), 4),
    ] {
        let Err(MarketError::Line { line, .. }) = read_matrix_market(text.as_bytes()) else {
            panic!("accepted {text:?}");
        };
        assert_eq!(line, wrong, "{text:?}");
    }
    let count = read_matrix_market(format!("{head}2 2 2\n1 1 1.0\n").as_bytes()).unwrap_err();
    assert!(matches!(count, MarketError::Count { found: 1, announced: 2 }));
    let large = read_matrix_market(format!("{head}99999999999 99999999999 0\n").as_bytes()).unwrap_err();
    assert!(matches!(large, MarketError::Matrix(MatrixError::TooLarge { size: 99_999_999_999 })));
}
