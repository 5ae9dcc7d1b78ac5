//! Clouds, and the cells of all their nodes.
#![allow(dead_code, reason = "every test file uses a part")]

use meshless_cells::{Cell, CellError, CellScratch, Container, FaceKind, Plane, box_planes, voronoi_cell};

/// SplitMix64: uniform numbers in [0, 1) that are the same everywhere.
pub(crate) struct Uniform(pub u64);

impl Uniform {
    pub(crate) fn sample(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// `n^D` nodes in the cells of a regular grid of the unit cube, each moved by up to `jitter` of half a spacing.
pub(crate) fn jittered<const D: usize>(n: usize, jitter: f64, seed: u64) -> Vec<[f64; D]> {
    let mut uniform = Uniform(seed);
    let h = 1.0 / n as f64;
    (0..n.pow(D as u32))
        .map(|k| {
            std::array::from_fn(|axis| {
                let place = k / n.pow(axis as u32) % n;
                h * (place as f64 + 0.5 + 0.5 * jitter * (2.0 * uniform.sample() - 1.0))
            })
        })
        .collect()
}

/// A regular grid with `n + 1` nodes on each axis of the unit cube, on the boundary too.
pub(crate) fn grid<const D: usize>(n: usize) -> Vec<[f64; D]> {
    (0..(n + 1).pow(D as u32))
        .map(|k| std::array::from_fn(|axis| (k / (n + 1).pow(axis as u32) % (n + 1)) as f64 / n as f64))
        .collect()
}

/// The cell of node `i`, searching farther until the cell is complete.
pub(crate) fn cell_of<const D: usize>(
    points: &[[f64; D]],
    i: usize,
    radius: f64,
    container: &Container<D>,
    scratch: &mut CellScratch,
) -> Result<Cell<D>, CellError> {
    let mut searched = radius;
    loop {
        let near: Vec<(u32, [f64; D])> = (0_u32..)
            .zip(points.iter().copied())
            .filter(|&(j, x)| j as usize != i && distance(&x, &points[i]) <= searched)
            .collect();
        match voronoi_cell(&points[i], &near, searched, container, scratch) {
            Err(CellError::Incomplete { needed, .. }) => {
                assert!(needed > searched, "asked for {needed} after {searched}");
                searched = 1.01 * needed;
            }
            other => return other,
        }
    }
}

/// The cells of all nodes.
pub(crate) fn cells_of<const D: usize>(
    points: &[[f64; D]],
    radius: f64,
    container: &Container<D>,
) -> Vec<Cell<D>> {
    let mut scratch = CellScratch::default();
    (0..points.len()).map(|i| cell_of(points, i, radius, container, &mut scratch).expect("a cell")).collect()
}

/// The unit cube and its planes.
pub(crate) fn unit_planes<const D: usize>() -> Vec<Plane<D>> {
    box_planes(&[0.0; D], &[1.0; D])
}

pub(crate) fn unit<const D: usize>(planes: &[Plane<D>]) -> Container<'_, D> {
    Container { min: [0.0; D], max: [1.0; D], planes, cuts: &[], walls: None }
}

pub(crate) fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
}

/// Size of the face with neighbour `j`, 0 if there is none.
pub(crate) fn face_size<const D: usize>(cell: &Cell<D>, j: usize) -> f64 {
    cell.faces.iter().find(|f| f.kind == FaceKind::Neighbor(j as u32)).map_or(0.0, |f| f.area)
}

/// Norm of `sum area * normal`, relative to the surface of the cell.
pub(crate) fn closure_defect<const D: usize>(cell: &Cell<D>) -> f64 {
    let mut sum = [0.0; D];
    for face in &cell.faces {
        for axis in 0..D {
            sum[axis] += face.area * face.normal[axis];
        }
    }
    distance(&sum, &[0.0; D]) / surface(cell)
}

pub(crate) fn surface<const D: usize>(cell: &Cell<D>) -> f64 {
    cell.faces.iter().map(|face| face.area).sum()
}

/// Largest difference between the sizes of a face seen from its two sides, relative to the cell's radius to the
/// power D-1.
pub(crate) fn asymmetry<const D: usize>(cells: &[Cell<D>]) -> f64 {
    let mut worst = 0.0_f64;
    for (i, cell) in cells.iter().enumerate() {
        let scale = (0.5 * cell.reach).powi(D as i32 - 1);
        for (j, face) in cell.neighbors() {
            worst = worst.max((face.area - face_size(&cells[j as usize], i)).abs() / scale);
        }
    }
    worst
}
