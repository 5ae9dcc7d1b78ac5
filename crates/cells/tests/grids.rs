//! Regular grids, where bisectors pass through vertices and edges of the cells.

mod common;

use common::*;
use meshless_cells::{Cell, FaceKind};

/// Cells of a grid on the whole unit cube: every cell is a box, halved on every side where the node lies on the
/// boundary.
fn check_grid<const D: usize>(n: usize) {
    let points = grid::<D>(n);
    let planes = unit_planes();
    let cells = cells_of(&points, 2.0 / n as f64, &unit(&planes));
    let h = 1.0 / n as f64;
    let scale = h.powi(D as i32 - 1);
    for (i, cell) in cells.iter().enumerate() {
        let width = |axis: usize| {
            let place = i / (n + 1).pow(axis as u32) % (n + 1);
            if place == 0 || place == n { 0.5 * h } else { h }
        };
        let volume: f64 = (0..D).map(width).product();
        assert!((cell.volume - volume).abs() < 1e-13 * scale * h, "{} for {volume}", cell.volume);
        assert_eq!(cell.faces.len(), 2 * D, "faces of node {i}: {:?}", cell.faces);
        for face in &cell.faces {
            let axis = (0..D).find(|&axis| face.normal[axis].abs() > 0.5).expect("a normal");
            assert!((face.area - volume / width(axis)).abs() < 1e-13 * scale);
            assert!((face.normal[axis].abs() - 1.0).abs() < 1e-13);
            let beside = (n + 1).pow(axis as u32);
            match face.kind {
                FaceKind::Neighbor(j) => {
                    let j = j as usize;
                    assert_eq!(j, if face.normal[axis] > 0.0 { i + beside } else { i - beside });
                }
                FaceKind::Boundary(number) => {
                    assert_eq!(usize::from(number), 2 * axis + usize::from(face.normal[axis] > 0.0));
                }
            }
        }
    }
    check_whole(&cells);
}

fn check_whole<const D: usize>(cells: &[Cell<D>]) {
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((total - 1.0).abs() < 1e-12, "volumes add up to {total}");
    assert!(asymmetry(cells) < 1e-12);
    for cell in cells {
        assert!(closure_defect(cell) < 1e-12);
    }
}

#[test]
fn a_grid_on_the_line_is_exact() {
    check_grid::<1>(4);
    check_grid::<1>(30);
}

#[test]
fn a_square_grid_is_exact() {
    check_grid::<2>(3);
    check_grid::<2>(16);
}

#[test]
fn a_cubic_grid_is_exact() {
    check_grid::<3>(3);
    check_grid::<3>(7);
}

#[test]
fn cells_of_a_hexagonal_lattice_are_hexagons() {
    let h = 0.1;
    let height = 0.75_f64.sqrt() * h;
    let mut points = vec![[0.5, 0.5]];
    for row in -3..=3_i32 {
        for column in -3..=3_i32 {
            if (row, column) != (0, 0) {
                let shift = 0.5 * f64::from(row.rem_euclid(2));
                points.push([0.5 + h * (f64::from(column) + shift), 0.5 + height * f64::from(row)]);
            }
        }
    }
    let planes = unit_planes();
    let cell = cell_of(&points, 0, 0.25, &unit(&planes), &mut Default::default()).unwrap();
    assert_eq!(cell.faces.len(), 6);
    assert!((cell.volume - height * h).abs() < 1e-15);
    assert!((cell.reach - 2.0 * h / 3.0_f64.sqrt()).abs() < 1e-15);
    for face in &cell.faces {
        assert!((face.area - h / 3.0_f64.sqrt()).abs() < 1e-15);
    }
}

#[test]
fn cells_of_a_body_centred_lattice_are_truncated_octahedra() {
    // Nodes at the corners of cubes of width 0.2, and the node at the centre of the middle one.
    let mut points = vec![[0.5; 3]];
    for k in 0..64_usize {
        points.push(std::array::from_fn(|axis| 0.2 + 0.2 * (k / 4_usize.pow(axis as u32) % 4) as f64));
    }
    for axis in 0..3 {
        for side in [-0.2, 0.2] {
            let mut x = [0.5; 3];
            x[axis] += side;
            points.push(x);
        }
    }
    let planes = unit_planes();
    let cell = cell_of(&points, 0, 0.3, &unit(&planes), &mut Default::default()).unwrap();
    // Half the volume of the cube; 8 hexagons and 6 squares with edges of sqrt(2)/4 of the width.
    assert!((cell.volume - 0.5 * 0.2_f64.powi(3)).abs() < 1e-16);
    assert_eq!(cell.faces.len(), 14);
    let edge = 0.2 * 2.0_f64.sqrt() / 4.0;
    let squares = cell.faces.iter().filter(|f| (f.area - edge * edge).abs() < 1e-15).count();
    let hexagons =
        cell.faces.iter().filter(|f| (f.area - 6.75_f64.sqrt() * edge * edge).abs() < 1e-15).count();
    assert_eq!((squares, hexagons), (6, 8));
}
