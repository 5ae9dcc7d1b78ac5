//! Invariants of cells on random clouds.

mod common;

use common::*;
use meshless_cells::{Cell, CellError, CellScratch, Container, FaceKind, Plane, voronoi_cell};
use proptest::prelude::*;

/// Cells that must tile the unit cube.
fn check_tiling<const D: usize>(points: &[[f64; D]], radius: f64) -> Result<Vec<Cell<D>>, TestCaseError> {
    let planes = unit_planes();
    let cells = cells_of(points, radius, &unit(&planes));
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    prop_assert!((total - 1.0).abs() < 1e-12, "volumes add up to {total}");
    prop_assert!(asymmetry(&cells) < 1e-12, "asymmetry {:e}", asymmetry(&cells));
    for (x, cell) in points.iter().zip(&cells) {
        prop_assert!(closure_defect(cell) < 1e-12);
        for face in &cell.faces {
            // A face with a neighbour lies on the bisector.
            if let FaceKind::Neighbor(j) = face.kind {
                let (to_own, to_other) =
                    (distance(&face.centroid, x), distance(&face.centroid, &points[j as usize]));
                prop_assert!((to_own - to_other).abs() < 1e-9 * cell.reach);
            }
            prop_assert!((face.normal.iter().map(|n| n * n).sum::<f64>() - 1.0).abs() < 1e-14);
        }
        // Kraus et al. (2022), below eq. 19: 1/(2d) sum |Gamma_ij| |x_j - x_i|.
        if !cell.touches_boundary() {
            let cones: f64 =
                cell.neighbors().map(|(j, face)| face.area * distance(x, &points[j as usize])).sum();
            prop_assert!(
                (cell.volume - cones / (2 * D) as f64).abs() < 1e-12 * (0.5 * cell.reach).powi(D as i32)
            );
        }
    }
    Ok(cells)
}

/// Nodes without any spacing: their cells are as thin as they come.
fn random<const D: usize>(count: usize, seed: u64) -> Vec<[f64; D]> {
    let mut uniform = Uniform(seed);
    (0..count).map(|_| std::array::from_fn(|_| uniform.sample())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn cells_tile_the_line(count in 1_usize..40, seed: u64) {
        check_tiling::<1>(&random(count, seed), 0.1)?;
    }

    #[test]
    fn cells_tile_the_square(count in 1_usize..120, seed: u64) {
        check_tiling::<2>(&random(count, seed), 0.2)?;
    }

    #[test]
    fn cells_tile_the_cube(count in 1_usize..120, seed: u64) {
        check_tiling::<3>(&random(count, seed), 0.3)?;
    }

    #[test]
    fn nearly_regular_grids_are_tiled(exponent in -17..-1_i32, seed: u64) {
        check_tiling::<2>(&jittered(8, 10_f64.powi(exponent), seed), 0.3)?;
        check_tiling::<3>(&jittered(4, 10_f64.powi(exponent), seed), 0.5)?;
    }

    #[test]
    fn the_order_of_the_candidates_does_not_matter(seed: u64, rotate in 0_usize..60) {
        let planes = unit_planes::<3>();
        let points = random::<3>(60, seed);
        let mut candidates: Vec<_> = (1_u32..).zip(points[1..].iter().copied()).collect();
        let mut scratch = CellScratch::default();
        let one = voronoi_cell(&points[0], &candidates, f64::INFINITY, &unit(&planes), &mut scratch).unwrap();
        candidates.rotate_left(rotate % 59);
        candidates.reverse();
        let other = voronoi_cell(&points[0], &candidates, f64::INFINITY, &unit(&planes), &mut scratch).unwrap();
        prop_assert_eq!(one, other);
    }

    #[test]
    fn motions_and_scaling_carry_cells_along(
        seed: u64, angle in 0.0..6.3, scale in prop_oneof![Just(1e-6), 0.1..10.0, Just(1e6)], shift in -1.0..1.0,
    ) {
        let points = jittered::<2>(7, 0.9, seed);
        let planes = unit_planes();
        let (sin, cos) = f64::sin_cos(angle);
        let turn = |x: &[f64; 2]| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]];
        let map = |x: &[f64; 2]| turn(x).map(|t| scale * (t + shift));
        let moved: Vec<_> = points.iter().map(map).collect();
        let moved_planes: Vec<_> = planes.iter().map(|plane| {
            let normal = turn(&plane.normal);
            let offset = scale * (plane.offset + shift * (normal[0] + normal[1]));
            Plane { normal, offset, face: plane.face }
        }).collect();
        let container =
            Container { min: [-3.0 * scale; 2], max: [3.0 * scale; 2], planes: &moved_planes, cuts: &[], walls: None };
        let cells = cells_of(&points, 0.3, &unit(&planes));
        let others = cells_of(&moved, 0.3 * scale, &container);
        for (cell, other) in cells.iter().zip(&others) {
            let radius = 0.5 * cell.reach;
            prop_assert!((cell.volume - other.volume / scale.powi(2)).abs() < 1e-12 * radius * radius);
            prop_assert!((cell.reach - other.reach / scale).abs() < 1e-12);
            prop_assert!(distance(&map(&cell.centroid), &other.centroid) < 1e-12 * scale);
            for face in cell.faces.iter().filter(|face| face.area > 1e-9 * radius) {
                let image = other.faces.iter().find(|f| f.kind == face.kind);
                prop_assert!(image.is_some_and(|f| (face.area - f.area / scale).abs() < 1e-12 * radius));
            }
        }
    }

    #[test]
    fn a_cell_is_complete_or_says_so(seed: u64, searched in 0.01..1.0_f64) {
        let planes = unit_planes::<2>();
        let points = random::<2>(50, seed);
        let all: Vec<_> = (1_u32..).zip(points[1..].iter().copied()).collect();
        let near: Vec<_> = all.iter().copied().filter(|c| distance(&c.1, &points[0]) <= searched).collect();
        let mut scratch = CellScratch::default();
        let whole = voronoi_cell(&points[0], &all, f64::INFINITY, &unit(&planes), &mut scratch).unwrap();
        match voronoi_cell(&points[0], &near, searched, &unit(&planes), &mut scratch) {
            Ok(cell) => {
                prop_assert!((cell.volume - whole.volume).abs() < 1e-13 * whole.reach.powi(2));
                prop_assert_eq!(cell.faces.len(), whole.faces.len());
            }
            Err(CellError::Incomplete { needed, .. }) => {
                prop_assert!(needed > searched && searched < whole.reach);
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn no_input_makes_it_panic(
        center in prop::array::uniform3(wild()),
        others in prop::collection::vec((0_u32..20, prop::array::uniform3(wild())), 0..12),
        searched in wild(),
    ) {
        let planes = unit_planes::<3>();
        let mut scratch = CellScratch::default();
        if let Ok(cell) = voronoi_cell(&center, &others, searched, &unit(&planes), &mut scratch) {
            prop_assert!(cell.volume > 0.0 && cell.volume <= 1.0 + 1e-9);
            prop_assert!(cell.faces.iter().all(|face| face.area.is_finite()));
        }
    }
}

/// Coordinates with special values among them.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..1.0,
        2 => prop::sample::select(vec![0.0, 0.25, 0.5, 0.75, 1.0]),
        1 => prop::sample::select(vec![-1.0, 2.0, 1e-300, 1e200, f64::INFINITY, f64::NAN, 0.5 + 1e-16]),
    ]
}
