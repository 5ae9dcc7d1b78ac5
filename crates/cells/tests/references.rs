//! Agreement with independent tessellations: spade in two dimensions, meshless_voronoi in three.

mod common;

use common::*;
use glam::DVec3;
use meshless_cells::Cell;
use meshless_voronoi::{Dimensionality, Voronoi};
use spade::{DelaunayTriangulation, Point2, Triangulation};

/// Agreement asked for, relative to the cell's size.
const AGREEMENT: f64 = 1e-12;

fn clouds<const D: usize>(n: usize) -> Vec<Vec<[f64; D]>> {
    vec![jittered(n, 0.4, 1), jittered(n, 0.9, 2), jittered(n, 1.0, 3)]
}

/// Area of a Voronoi cell, and its edges `(neighbour, length)`.
type AreaAndEdges = (f64, Vec<(usize, f64)>);

/// The Voronoi cell of each node; `None` if it is unbounded or leaves the unit square.
fn spade_cells(points: &[[f64; 2]]) -> Vec<Option<AreaAndEdges>> {
    let triangulation: DelaunayTriangulation<Point2<f64>> =
        DelaunayTriangulation::bulk_load_stable(points.iter().map(|p| Point2::new(p[0], p[1])).collect())
            .expect("distinct points");
    let inside = |p: &Point2<f64>| p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0;
    triangulation
        .vertices()
        .map(|vertex| {
            let (mut area, mut edges) = (0.0, Vec::new());
            let site = vertex.position();
            for edge in vertex.as_voronoi_face().adjacent_edges() {
                let (a, b) = (edge.from().position()?, edge.to().position()?);
                if !inside(&a) || !inside(&b) {
                    return None;
                }
                let delaunay = edge.as_delaunay_edge();
                let ends = [delaunay.from().index(), delaunay.to().index()];
                let neighbour = if ends[0] == vertex.index() { ends[1] } else { ends[0] };
                edges.push((neighbour, distance(&[a.x, a.y], &[b.x, b.y])));
                area += 0.5 * ((a.x - site.x) * (b.y - site.y) - (a.y - site.y) * (b.x - site.x));
            }
            Some((area.abs(), edges))
        })
        .collect()
}

#[test]
fn interior_cells_in_the_plane_agree_with_spade() {
    for points in clouds::<2>(20) {
        let planes = unit_planes();
        let cells = cells_of(&points, 0.1, &unit(&planes));
        let mut compared = 0;
        for (cell, reference) in cells.iter().zip(spade_cells(&points)) {
            let Some((area, edges)) = reference else { continue };
            compared += 1;
            let radius = 0.5 * cell.reach;
            assert!((cell.volume - area).abs() < AGREEMENT * radius * radius);
            assert!(!cell.touches_boundary());
            for &(j, length) in &edges {
                assert!((face_size(cell, j) - length).abs() < AGREEMENT * radius);
            }
            for (j, face) in cell.neighbors() {
                assert!(face.area < AGREEMENT * radius || edges.iter().any(|e| e.0 == j as usize));
            }
        }
        assert!(compared > 300, "only {compared} cells compared");
    }
}

#[test]
fn cells_in_the_box_agree_with_meshless_voronoi() {
    for points in clouds::<3>(7) {
        let planes = unit_planes();
        let cells = cells_of(&points, 0.3, &unit(&planes));
        let generators: Vec<DVec3> = points.iter().map(|&p| DVec3::from_array(p)).collect();
        let reference = Voronoi::build(&generators, DVec3::ZERO, DVec3::ONE, Dimensionality::ThreeD, false);
        let mut boundary = vec![0.0; cells.len()];
        let radius = |cell: &Cell<3>| 0.5 * cell.reach;
        for (cell, other) in cells.iter().zip(reference.cells()) {
            assert!((cell.volume - other.volume()).abs() < AGREEMENT * radius(cell).powi(3));
            assert!(distance(&cell.centroid, &other.centroid().to_array()) < 1e-11 * radius(cell));
        }
        for face in reference.faces() {
            let cell = &cells[face.left()];
            if let Some(j) = face.right() {
                assert!((face_size(cell, j) - face.area()).abs() < AGREEMENT * radius(cell).powi(2));
            } else {
                boundary[face.left()] += face.area();
            }
        }
        for (cell, boundary) in cells.iter().zip(boundary) {
            let own: f64 = surface(cell) - cell.neighbors().map(|(_, face)| face.area).sum::<f64>();
            assert!((own - boundary).abs() < AGREEMENT * radius(cell).powi(2));
        }
    }
}
