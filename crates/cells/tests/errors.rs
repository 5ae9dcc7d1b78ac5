//! Wrong input is refused with a message that says where.

mod common;

use common::{unit, unit_planes};
use meshless_cells::{Cell, CellError, CellScratch, Container, Plane, voronoi_cell};

const OTHERS: [(u32, [f64; 2]); 3] = [(1, [0.2, 0.5]), (2, [0.8, 0.4]), (3, [0.5, 0.9])];

fn build(center: [f64; 2], others: &[(u32, [f64; 2])], planes: &[Plane<2>]) -> Result<Cell<2>, CellError> {
    voronoi_cell(&center, others, f64::INFINITY, &unit(planes), &mut CellScratch::default())
}

#[test]
fn duplicates_are_named() {
    let planes = unit_planes();
    let mut others = OTHERS.to_vec();
    others.push((7, [0.5, 0.5]));
    let error = build([0.5, 0.5], &others, &planes).unwrap_err();
    assert_eq!(error, CellError::Duplicate { index: 7, center: vec![0.5, 0.5] });
    others[3] = (7, [0.8, 0.4]);
    let error = build([0.5, 0.5], &others, &planes).unwrap_err();
    assert_eq!(error, CellError::DuplicateCandidates { first: 2, second: 7, position: vec![0.8, 0.4] });
    assert!(error.to_string().contains("[0.8, 0.4]"));
}

#[test]
fn nodes_outside_are_named() {
    let planes = unit_planes();
    assert!(matches!(build([1.2, 0.5], &OTHERS, &planes), Err(CellError::OutsideDomain { face: 1, .. })));
    assert!(matches!(build([0.5, 3.0], &OTHERS, &planes), Err(CellError::OutsideBox { .. })));
    assert!(matches!(build([0.5, -2e-3], &OTHERS, &planes), Err(CellError::OutsideDomain { face: 2, .. })));
    // Off by round-off only: still a boundary node.
    let beyond = build([0.5, -1e-12], &OTHERS, &planes).unwrap();
    let on = build([0.5, 0.0], &OTHERS, &planes).unwrap();
    assert!((beyond.volume - on.volume).abs() < 1e-11);
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let planes = unit_planes();
    let mut others = OTHERS.to_vec();
    others[1].1[0] = f64::NAN;
    assert!(matches!(build([0.5; 2], &others, &planes), Err(CellError::CandidateNotFinite { index: 2, .. })));
    assert!(matches!(build([f64::NAN, 0.0], &OTHERS, &planes), Err(CellError::CenterNotFinite { .. })));
    let scratch = &mut CellScratch::default();
    let error = voronoi_cell(&[0.5; 2], &OTHERS, f64::NAN, &unit(&planes), scratch).unwrap_err();
    assert!(matches!(error, CellError::InvalidRadius { .. }));
}

#[test]
fn an_invalid_container_is_named() {
    let mut planes = unit_planes();
    planes[2].normal = [0.0, -2.0];
    assert!(matches!(build([0.5; 2], &OTHERS, &planes), Err(CellError::InvalidPlane { plane: 2, .. })));
    let planes = unit_planes();
    let container = Container { max: [1.0, 0.0], ..unit(&planes) };
    let error = voronoi_cell(&[0.5; 2], &OTHERS, 1.0, &container, &mut CellScratch::default()).unwrap_err();
    assert!(matches!(error, CellError::InvalidBox { axis: 1, .. }));
    // The box alone is not a boundary: nothing closes the cell below.
    let without_bottom = [planes[0], planes[1], planes[3]];
    assert!(matches!(build([0.5; 2], &OTHERS, &without_bottom), Err(CellError::OpenContainer { .. })));
}

#[test]
fn a_search_that_is_too_short_says_how_far() {
    let planes = unit_planes();
    let scratch = &mut CellScratch::default();
    let Err(CellError::Incomplete { searched, needed, .. }) =
        voronoi_cell(&[0.5; 2], &OTHERS, 0.45, &unit(&planes), scratch)
    else {
        panic!("the cell reaches farther than the search");
    };
    assert!(searched == 0.45 && needed > 0.45);
    assert!(voronoi_cell(&[0.5; 2], &[], 0.0, &unit(&planes), scratch).is_err());
}
