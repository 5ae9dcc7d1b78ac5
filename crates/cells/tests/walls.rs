//! Cells of domains with flat faces and re-entrant edges: unions of boxes, polygons, boxes with holes.

mod common;

use common::*;
use meshless_cells::{
    Cell, CellError, CellScratch, Container, Cut, FaceKind, Interfaces, Wall, Walls, box_planes,
    voronoi_cell, voronoi_parts,
};
use proptest::prelude::*;

type Box<const D: usize> = ([f64; D], [f64; D]);

fn walls_of<const D: usize>(boxes: &[Box<D>]) -> Vec<Wall<D>> {
    let mut walls = Vec::new();
    for (min, max) in boxes {
        for plane in box_planes(min, max) {
            let (mut lo, mut hi) = (*min, *max);
            for axis in 0..D {
                if plane.normal[axis] < 0.0 {
                    hi[axis] = min[axis];
                } else if plane.normal[axis] > 0.0 {
                    lo[axis] = max[axis];
                }
            }
            walls.push(Wall { normal: plane.normal, offset: plane.offset, min: lo, max: hi });
        }
    }
    walls
}

fn holds<const D: usize>((min, max): &Box<D>, x: &[f64; D]) -> bool {
    (0..D).all(|k| x[k] >= min[k] && x[k] <= max[k])
}

/// Boxes with corners on a coarse lattice, so that faces lie in common planes, touch and overlap.
fn boxes<const D: usize>(count: usize, seed: u64) -> Vec<Box<D>> {
    let mut uniform = Uniform(seed);
    (0..count)
        .map(|_| {
            let (mut min, mut max) = ([0.0; D], [0.0; D]);
            for k in 0..D {
                let a = (5.0 * uniform.sample()).floor();
                let b = a + 1.0 + ((5.0 - a) * uniform.sample()).floor();
                (min[k], max[k]) = (0.2 * a, 0.2 * b);
            }
            (min, max)
        })
        .collect()
}

/// Volume of a union of boxes, and the area of its surface by the direction that it faces: by the lattice of all their corners.
fn truth<const D: usize>(boxes: &[Box<D>]) -> (f64, Vec<f64>) {
    let n = 7_usize;
    let inside = |k: usize| {
        let x: [f64; D] = std::array::from_fn(|axis| 0.2 * ((k / n.pow(axis as u32) % n) as f64 - 1.0 + 0.5));
        boxes.iter().any(|b| holds(b, &x))
    };
    let (mut volume, mut areas) = (0.0, vec![0.0; 2 * D]);
    for k in (0..n.pow(D as u32)).filter(|&k| inside(k)) {
        volume += 0.2_f64.powi(D as i32);
        for axis in 0..D {
            let step = n.pow(axis as u32);
            for (side, other) in [(0, k - step), (1, k + step)] {
                if !inside(other) {
                    areas[2 * axis + side] += 0.2_f64.powi(D as i32 - 1);
                }
            }
        }
    }
    (volume, areas)
}

/// Nodes in a union of boxes: scattered, and at corners of boxes that are on its surface.
fn nodes<const D: usize>(boxes: &[Box<D>], count: usize, seed: u64) -> Vec<[f64; D]> {
    let mut uniform = Uniform(seed);
    let mut found: Vec<[f64; D]> = Vec::new();
    for (min, max) in boxes {
        for corner in 0..1_usize << D {
            let x: [f64; D] = std::array::from_fn(|k| if corner >> k & 1 == 1 { max[k] } else { min[k] });
            if uniform.sample() < 0.7 && found.iter().all(|y| distance(&x, y) > 0.05) {
                found.push(x);
            }
        }
    }
    while found.len() < count {
        let x = std::array::from_fn(|_| uniform.sample());
        if boxes.iter().any(|b| holds(b, &x)) && found.iter().all(|y| distance(&x, y) > 1e-3) {
            found.push(x);
        }
    }
    found
}

fn cells_in<const D: usize>(
    boxes: &[Box<D>],
    points: &[[f64; D]],
    radius: f64,
) -> Result<Vec<Cell<D>>, CellError> {
    let walls = walls_of(boxes);
    let beyond = |x: &[f64; D]| (!boxes.iter().any(|b| holds(b, x))).then_some(7);
    let container = Container {
        min: [0.0; D],
        max: [1.0; D],
        planes: &[],
        cuts: &[],
        walls: Some(Walls { walls: &walls, beyond: &beyond, cuts: &[] }),
    };
    let mut scratch = CellScratch::default();
    (0..points.len()).map(|i| cell_of(points, i, radius, &container, &mut scratch)).collect()
}

fn check_union<const D: usize>(number: usize, count: usize, seed: u64) -> Result<(), TestCaseError> {
    let boxes = boxes::<D>(number, seed);
    let points = nodes(&boxes, count, seed ^ 1);
    // Parts across a gap, which nodes do not resolve here, are farther away than cells that end at it are wide.
    let cells = cells_in(&boxes, &points, f64::INFINITY).map_err(|e| TestCaseError::fail(e.to_string()))?;
    let (volume, areas) = truth(&boxes);
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    prop_assert!((total - volume).abs() < 1e-12, "volumes add up to {total} for {volume}");
    prop_assert!(asymmetry(&cells) < 1e-9, "asymmetry {:e}", asymmetry(&cells));
    let mut found = vec![0.0; 2 * D];
    for cell in &cells {
        prop_assert!(closure_defect(cell) < 1e-11, "open by {:e}", closure_defect(cell));
        for face in cell.faces.iter().filter(|face| matches!(face.kind, FaceKind::Boundary(_))) {
            prop_assert_eq!(face.kind, FaceKind::Boundary(7));
            let axis = (0..D).find(|&k| face.normal[k].abs() > 0.5).expect("a unit normal");
            prop_assert!((face.normal[axis].abs() - 1.0).abs() < 1e-12);
            found[2 * axis + usize::from(face.normal[axis] > 0.0)] += face.area;
        }
    }
    for (found, expected) in found.iter().zip(&areas) {
        prop_assert!((found - expected).abs() < 1e-11, "{found} of a side of {expected}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn cells_fill_unions_of_intervals(number in 1_usize..4, count in 8_usize..20, seed: u64) {
        check_union::<1>(number, count, seed)?;
    }

    #[test]
    fn cells_fill_unions_of_rectangles(number in 1_usize..6, count in 20_usize..80, seed: u64) {
        check_union::<2>(number, count, seed)?;
    }

    #[test]
    fn cells_fill_unions_of_boxes(number in 1_usize..6, count in 48_usize..100, seed: u64) {
        check_union::<3>(number, count, seed)?;
    }

    #[test]
    fn interfaces_divide_cells_exactly(number in 1_usize..5, inner in 1_usize..4, seed: u64) {
        let (domain, part) = (boxes::<3>(number, seed), boxes::<3>(inner, seed ^ 2));
        let points = nodes(&domain, 60, seed ^ 1);
        let (walls, interfaces) = (walls_of(&domain), walls_of(&part));
        let beyond = |x: &[f64; 3]| (!domain.iter().any(|b| holds(b, x))).then_some(0);
        let label = |x: &[f64; 3]| u16::from(part.iter().any(|b| holds(b, x)));
        let container = Container {
            min: [0.0; 3],
            max: [1.0; 3],
            planes: &[],
            cuts: &[],
            walls: Some(Walls { walls: &walls, beyond: &beyond, cuts: &[] }),
        };
        let divided = Interfaces { walls: &interfaces, label: &label };
        let mut scratch = CellScratch::default();
        let mut inside = 0.0;
        for (i, x) in points.iter().enumerate() {
            let others: Vec<_> =
                (0_u32..).zip(points.iter().copied()).filter(|(j, _)| *j as usize != i).collect();
            let parts = voronoi_parts(x, &others, f64::INFINITY, &container, &divided, &mut scratch);
            let parts = parts.map_err(|e| TestCaseError::fail(e.to_string()))?;
            inside += parts.iter().flatten().filter(|part| part.0 == 1).map(|part| part.1).sum::<f64>();
        }
        let both: Vec<Box<3>> = domain.iter().flat_map(|a| part.iter().map(|b| {
            (std::array::from_fn(|k| a.0[k].max(b.0[k])), std::array::from_fn(|k| a.1[k].min(b.1[k])))
        })).collect();
        prop_assert!((inside - truth(&both).0).abs() < 1e-12, "{inside} for {}", truth(&both).0);
    }
}

/// A polygon whose sides face in many directions, one re-entrant corner among them.
#[test]
fn a_polygon_has_its_area_and_the_lengths_of_its_sides() {
    let corners: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.1], [0.9, 0.8], [0.5, 0.3], [0.3, 0.9], [-0.1, 0.6]];
    let count = corners.len();
    let side = |k: usize| (corners[k], corners[(k + 1) % count]);
    let walls: Vec<Wall<2>> = (0..count)
        .map(|k| {
            let (a, b) = side(k);
            let length = distance(&a, &b);
            let normal = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
            Wall {
                normal,
                offset: normal[0] * a[0] + normal[1] * a[1],
                min: [a[0].min(b[0]), a[1].min(b[1])],
                max: [a[0].max(b[0]), a[1].max(b[1])],
            }
        })
        .collect();
    let inside = |x: &[f64; 2]| {
        let crossed = |k: usize| {
            let (a, b) = side(k);
            (a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        };
        (0..count).filter(|&k| crossed(k)).count() % 2 == 1
    };
    let beyond = |x: &[f64; 2]| (!inside(x)).then_some(3);
    let container = Container {
        min: [-0.1, 0.0],
        max: [1.0, 0.9],
        planes: &[],
        cuts: &[],
        walls: Some(Walls { walls: &walls, beyond: &beyond, cuts: &[] }),
    };
    let mut points: Vec<[f64; 2]> = jittered::<2>(12, 0.8, 5).into_iter().filter(|x| inside(x)).collect();
    points.extend(corners);
    let cells = cells_of(&points, 0.3, &container);
    let area: f64 = (0..count).map(side).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum();
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((total - area).abs() < 1e-13, "{total} for {area}");
    for wall in 0..count {
        let on = |face: &&meshless_cells::CellFace<2>| {
            matches!(face.kind, FaceKind::Boundary(3))
                && (face.normal[0] * walls[wall].normal[0] + face.normal[1] * walls[wall].normal[1])
                    > 1.0 - 1e-9
        };
        let length: f64 = cells.iter().flat_map(|cell| &cell.faces).filter(on).map(|face| face.area).sum();
        let (a, b) = side(wall);
        assert!((length - distance(&a, &b)).abs() < 1e-13, "side {wall}: {length}");
    }
}

/// A slot that is thinner than the cells, with a node in none of it.
#[test]
fn faces_carry_the_number_of_what_is_beyond() {
    let hole = ([0.45, 0.2], [0.55, 1.0]);
    let walls = walls_of(&[hole]);
    let beyond = |x: &[f64; 2]| holds(&hole, x).then_some(9);
    let planes = box_planes(&[0.0; 2], &[1.0; 2]);
    let container = Container {
        min: [0.0; 2],
        max: [1.0; 2],
        planes: &planes,
        cuts: &[],
        walls: Some(Walls { walls: &walls, beyond: &beyond, cuts: &[] }),
    };
    let points = [[0.2, 0.5], [0.8, 0.5], [0.5, 0.1]];
    let cells = cells_of(&points, 1.0, &container);
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((total - 0.92).abs() < 1e-14);
    let of = |number: u16| -> f64 {
        let all = cells.iter().flat_map(|cell| &cell.faces);
        all.filter(|face| face.kind == FaceKind::Boundary(number)).map(|face| face.area).sum()
    };
    // The slot is open above: its upper side is on the wall.
    assert!((of(9) - 1.7).abs() < 1e-14 && (of(3) - 0.9).abs() < 1e-14, "{} {}", of(9), of(3));
    let outside = voronoi_cell(&[0.5, 0.5], &[], f64::INFINITY, &container, &mut CellScratch::default());
    assert!(matches!(outside, Err(CellError::OutsideDomain { face: 9, .. })), "{outside:?}");
}

/// More walls than a cell is divided by: the level set takes their place.
#[test]
fn too_many_walls_are_cut_as_a_curve() {
    let sides = 200;
    let walls: Vec<Wall<2>> = (0..sides)
        .map(|k| {
            let angle = f64::from(k) * std::f64::consts::TAU / f64::from(sides);
            Wall { normal: [angle.cos(), angle.sin()], offset: 1.0, min: [-2.0; 2], max: [2.0; 2] }
        })
        .collect();
    let level = |x: &[f64; 2]| x[0].hypot(x[1]) - 1.0;
    let beyond = |x: &[f64; 2]| (level(x) > 0.0).then_some(4);
    let cuts = [Cut { level: &level, face: 4 }];
    let container = Container {
        min: [-1.0; 2],
        max: [1.0; 2],
        planes: &[],
        cuts: &[],
        walls: Some(Walls { walls: &walls, beyond: &beyond, cuts: &cuts }),
    };
    let points: Vec<[f64; 2]> = jittered::<2>(40, 0.5, 3)
        .into_iter()
        .map(|x| x.map(|t| 2.0 * t - 1.0))
        .filter(|x| level(x) < 0.0)
        .collect();
    let cells = cells_of(&points, 0.3, &container);
    let total: f64 = cells.iter().map(|cell| cell.volume).sum();
    assert!((total - std::f64::consts::PI).abs() < 5e-3, "{total}");
    assert!(cells.iter().flat_map(|cell| &cell.faces).all(|face| face.kind != FaceKind::Boundary(0)));
}
