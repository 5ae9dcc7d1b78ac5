//! Domains with curved faces: closure is exact, faces agree, and the volume converges with order two.

mod common;

use std::f64::consts::PI;

use common::*;
use meshless_cells::{Cell, CellError, Container, Cut, FaceKind, Plane};

fn norm<const D: usize>(x: &[f64; D]) -> f64 {
    distance(x, &[0.0; D])
}

/// Nodes of the unit ball (disc): a jittered grid of spacing `h` that keeps away from the sphere, and nodes on the sphere
/// at about the same spacing.
fn ball_cloud<const D: usize>(h: f64) -> Vec<[f64; D]> {
    let n = (2.0 / h).round() as usize;
    let mut points: Vec<[f64; D]> =
        jittered::<D>(n, 0.5, 7).iter().map(|x| x.map(|t| 2.0 * t - 1.0)).collect();
    points.retain(|x| norm(x) < 1.0 - 0.6 * h);
    let count = if D == 2 { 2.0 * PI / h } else { 4.0 * PI / (h * h) }.round() as usize;
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    for k in 0..count {
        let fraction = (k as f64 + 0.5) / count as f64;
        let mut x = [0.0; D];
        if D == 2 {
            (x[0], x[1]) = ((2.0 * PI * fraction).cos(), (2.0 * PI * fraction).sin());
        } else {
            // Fibonacci's lattice.
            let (z, angle) = (1.0 - 2.0 * fraction, golden * k as f64);
            let r = (1.0 - z * z).sqrt();
            (x[0], x[1], x[2]) = (r * angle.cos(), r * angle.sin(), z);
        }
        points.push(x);
    }
    points
}

fn check_cells<const D: usize>(cells: &[Cell<D>]) {
    let asymmetry = asymmetry(cells);
    assert!(asymmetry < 1e-12, "asymmetry {asymmetry:e}");
    for cell in cells {
        assert!(closure_defect(cell) < 1e-12);
    }
}

/// Error of the sum of the volumes for the unit ball, cut by a level set that is no distance.
fn ball_error<const D: usize>(h: f64, exact: f64) -> f64 {
    let points = ball_cloud::<D>(h);
    let level = |x: &[f64; D]| 3.0 * (norm(x).powi(4) - 1.0);
    let cuts = [Cut { level: &level, face: 5 }];
    let container = Container { min: [-1.0; D], max: [1.0; D], planes: &[], cuts: &cuts, walls: None };
    let cells = cells_of(&points, 3.0 * h, &container);
    check_cells(&cells);
    for (x, cell) in points.iter().zip(&cells) {
        if norm(x) == 1.0 {
            let caps: Vec<_> = cell.faces.iter().filter(|f| f.kind == FaceKind::Boundary(5)).collect();
            assert_eq!(caps.len(), 1);
            let outward: f64 = caps[0].normal.iter().zip(x).map(|(n, x)| n * x).sum();
            assert!(outward > 1.0 - h * h, "the normal is not radial: {outward}");
        }
    }
    exact - cells.iter().map(|cell| cell.volume).sum::<f64>()
}

#[test]
fn the_volume_of_a_disc_converges_with_order_two() {
    let errors = [0.2, 0.1, 0.05].map(|h| ball_error::<2>(h, PI));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.3).contains(&order), "errors {errors:?}");
    }
    // Chords lie inside the disc.
    assert!(errors[2] > 0.0 && errors[2] < 2e-3, "errors {errors:?}");
}

#[test]
fn the_volume_of_a_ball_converges_with_order_two() {
    let errors = [0.4, 0.2, 0.1].map(|h| ball_error::<3>(h, 4.0 * PI / 3.0));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.7..2.3).contains(&order), "errors {errors:?}");
    }
}

#[test]
fn a_hole_is_cut_out() {
    // The square (-1, 1)^2 without a disc of radius 1/2: the domain is not convex, nor are the cells.
    let level = |x: &[f64; 2]| 0.5 - norm(x);
    let planes = meshless_cells::box_planes(&[-1.0; 2], &[1.0; 2]);
    let cuts = [Cut { level: &level, face: 9 }];
    let container = Container { min: [-1.0; 2], max: [1.0; 2], planes: &planes, cuts: &cuts, walls: None };
    let error = |n: usize| {
        let mut points: Vec<[f64; 2]> =
            jittered::<2>(n, 0.5, 3).iter().map(|x| x.map(|t| 2.0 * t - 1.0)).collect();
        points.retain(|x| norm(x) > 0.5);
        let cells = cells_of(&points, 5.0 / n as f64, &container);
        check_cells(&cells);
        (cells.iter().map(|cell| cell.volume).sum::<f64>() - (4.0 - 0.25 * PI)).abs()
    };
    let (coarse, fine) = (error(20), error(80));
    assert!(fine < coarse / 10.0 && fine < 1e-3, "{coarse} {fine}");
}

#[test]
fn a_flat_level_set_is_as_good_as_a_plane() {
    let points: Vec<[f64; 3]> = jittered(6, 0.8, 11);
    let planes = unit_planes();
    // A quarter that meets itself in an edge, by level sets that are far from linear.
    let levels = [|x: &[f64; 3]| (0.5 - x[0]).exp() - 1.0, |x: &[f64; 3]| (x[1] - 0.6).powi(3)];
    let cuts = [Cut { level: &levels[0], face: 77 }, Cut { level: &levels[1], face: 78 }];
    let cut = Container { cuts: &cuts, ..unit(&planes) };
    let mut quarter = planes.clone();
    quarter.push(Plane { normal: [-1.0, 0.0, 0.0], offset: -0.5, face: 77 });
    quarter.push(Plane { normal: [0.0, 1.0, 0.0], offset: 0.6, face: 78 });
    let nodes: Vec<[f64; 3]> = points.into_iter().filter(|x| x[0] >= 0.5 && x[1] <= 0.6).collect();
    let (by_curve, by_plane) = (cells_of(&nodes, 0.5, &cut), cells_of(&nodes, 0.5, &unit(&quarter)));
    for (a, b) in by_curve.iter().zip(&by_plane) {
        let radius = 0.5 * a.reach;
        assert!((a.volume - b.volume).abs() < 1e-12 * radius.powi(3));
        assert_eq!(a.faces.len(), b.faces.len());
        for face in &a.faces {
            let other = b.faces.iter().find(|f| f.kind == face.kind).unwrap();
            assert!((face.area - other.area).abs() < 1e-12 * radius * radius);
            assert!(
                distance(&face.centroid, &other.centroid) < 1e-10 * radius
                    || face.area < 1e-6 * radius * radius
            );
        }
    }
}

#[test]
fn an_interval_ends_at_the_root() {
    let level = |x: &[f64; 1]| x[0] * x[0] - 2.0;
    let cuts = [Cut { level: &level, face: 1 }];
    let container = Container { min: [-2.0], max: [2.0], planes: &[], cuts: &cuts, walls: None };
    let points = [[-2.0_f64.sqrt()], [-0.3], [0.4], [1.1]];
    let cells = cells_of(&points, 0.5, &container);
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((total - 8.0_f64.sqrt()).abs() < 1e-14);
    assert_eq!(cells[3].faces[1].kind, FaceKind::Boundary(1));
    assert!((cells[3].faces[1].centroid[0] - 2.0_f64.sqrt()).abs() < 1e-14);
    check_cells(&cells);
}

#[test]
fn trouble_with_a_level_set_is_reported() {
    let planes = unit_planes::<2>();
    let others = [(1, [0.2, 0.5]), (2, [0.8, 0.5]), (3, [0.5, 0.2]), (4, [0.5, 0.8])];
    let build = |level: &(dyn Fn(&[f64; 2]) -> f64 + Sync)| {
        let cuts = [Cut { level, face: 6 }];
        let container = Container { cuts: &cuts, ..unit(&planes) };
        meshless_cells::voronoi_cell(&[0.5; 2], &others, f64::INFINITY, &container, &mut Default::default())
    };
    assert!(matches!(build(&|_| f64::NAN), Err(CellError::LevelNotANumber { face: 6, .. })));
    // Not a number only at some distance from the node.
    assert!(matches!(
        build(&|x| if x[0] > 0.6 { f64::NAN } else { -1.0 }),
        Err(CellError::LevelNotANumber { face: 6, .. })
    ));
    assert!(build(&|x| 0.45 - x[1]).is_ok());
    assert!(matches!(build(&|x| 0.55 - x[1]), Err(CellError::OutsideDomain { face: 6, .. })));
    // A disc within the cell of a single node.
    assert!(matches!(build(&|x| distance(x, &[0.5; 2]) - 0.05), Err(CellError::Unresolved { face: 6, .. })));
}
