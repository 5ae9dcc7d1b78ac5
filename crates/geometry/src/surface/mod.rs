//! Closed surfaces of triangles, with exact signed distance.

mod closest;
mod creases;
mod normals;
mod stl;
mod topology;
mod tree;
mod weld;

pub use stl::{MAX_STL_TRIANGLES, read_stl};

use crate::aabb::Aabb;
use crate::error::GeometryError;
use crate::vector::{distance, normalized, scale, sub};
use closest::Part;
pub(crate) use creases::CreaseLine;
use tree::Tree;

/// Angle between the normals of two triangles, in degrees, beyond which their common edge is a crease unless said
/// otherwise: an edge of the part and not of its triangulation.
pub const DEFAULT_CREASE: f64 = 30.0;

/// Distance from a smooth surface, over the longest edge of the nearest triangle, up to which its gradient is the
/// interpolated normal: difference quotients of the normal then see the curvature of the part, and not the flat triangle.
const NEAR: f64 = 0.01;

/// A closed surface of triangles; 3-D.
///
/// The distance is that from the triangles themselves. Inside and outside are told by the angle-weighted pseudonormal of
/// the face, edge or vertex that holds the nearest point (Baerentzen and Aanaes 2005, "Signed distance computation using
/// the angle weighted pseudonormal"), which is right for every closed surface that does not intersect itself.
#[derive(Debug, Clone)]
pub struct TriangleSurface {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
    face_normals: Vec<[f64; 3]>,
    vertex_normals: Vec<[f64; 3]>,
    /// For every corner of a triangle the mean normal of the triangles about it up to the next creases.
    corner_normals: Vec<[[f64; 3]; 3]>,
    tree: Tree,
    bounds: Aabb<3>,
    volume: f64,
    crease_cosine: f64,
    smooth: bool,
    degenerate: usize,
    corners: Vec<u32>,
    lines: Vec<CreaseLine>,
}

/// How a surface is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceParams {
    /// Factor of all coordinates, such as 0.001 for millimetres in a scene in metres.
    pub scale: f64,
    /// Angle between normals beyond which an edge is a crease, in degrees.
    pub crease: f64,
    /// Whether normals between creases are interpolated from those at vertices: second order in the size of the triangles
    /// rather than first. Otherwise they are those of the triangles.
    pub smooth: bool,
}

impl Default for SurfaceParams {
    fn default() -> Self {
        Self { scale: 1.0, crease: DEFAULT_CREASE, smooth: true }
    }
}

/// The point of a surface nearest to another.
pub(crate) struct NearestTriangle {
    pub(crate) point: [f64; 3],
    /// Unit normal there: of the face, the mean over an edge or a vertex, or interpolated.
    pub(crate) normal: [f64; 3],
    /// Negative inside.
    pub(crate) distance: f64,
    /// How far from the surface `normal` is its gradient: for flat triangles only on it.
    pub(crate) reach: f64,
}

impl TriangleSurface {
    /// The surface of these triangles, in any order, all of them counter-clockwise as seen from outside or all of them
    /// clockwise. Vertices are welded where they differ by rounding to single precision; triangles that have no extent
    /// then are left out and counted.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] for coordinates that are not finite, a surface that is not closed or whose
    /// triangles disagree about the outside (with the edge), one that encloses nothing, and parameters out of range.
    pub fn new(triangles: &[[[f64; 3]; 3]], params: &SurfaceParams) -> Result<Self, GeometryError> {
        let invalid = |reason: String| Err(GeometryError::invalid("surface", reason));
        if !(params.scale.is_finite() && params.scale > 0.0) {
            return invalid(format!("scale {} must be positive and finite", params.scale));
        }
        if !(params.crease > 0.0 && params.crease < 180.0) {
            return invalid(format!("crease {} must be an angle between 0 and 180 degrees", params.crease));
        }
        let scaled: Vec<[[f64; 3]; 3]> =
            triangles.iter().map(|t| t.map(|v| scale(params.scale, &v))).collect();
        if let Some(k) = scaled.iter().position(|t| !t.iter().flatten().all(|c| c.is_finite())) {
            return invalid(format!("triangle {} has a coordinate that is not finite", k + 1));
        }
        let mut welded = weld::weld(&scaled);
        if welded.triangles.len() < 4 {
            let (kept, none) = (welded.triangles.len(), welded.degenerate);
            return invalid(format!("{kept} triangles ({none} more have no extent) enclose nothing"));
        }
        let mut neighbors = topology::neighbors(&welded)?;
        let bounds = Aabb::of_points(&welded.vertices)?;
        let mut volume = topology::volume(&welded);
        if volume.abs() <= 1e-12 * bounds.measure() {
            return invalid("it encloses no volume".to_owned());
        }
        if volume < 0.0 {
            // Inside out: edges keep their numbers if the first two corners change places and edges 1 and 2 do.
            volume = -volume;
            welded.triangles.iter_mut().for_each(|t| t.swap(0, 1));
            neighbors.iter_mut().for_each(|n| n.swap(1, 2));
        }
        let tree = Tree::new(&welded.vertices, &welded.triangles);
        let mut surface = Self {
            face_normals: Vec::new(),
            vertex_normals: Vec::new(),
            corner_normals: Vec::new(),
            vertices: welded.vertices,
            triangles: welded.triangles,
            neighbors,
            tree,
            bounds,
            volume,
            crease_cosine: params.crease.to_radians().cos(),
            smooth: params.smooth,
            degenerate: welded.degenerate,
            corners: Vec::new(),
            lines: Vec::new(),
        };
        surface.find_normals();
        surface.find_creases();
        Ok(surface)
    }

    /// Vertices, each once.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// Indices of the triangles' vertices, counter-clockwise as seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Triangles without an extent that were left out.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// Whether normals are interpolated between vertices.
    pub fn is_smooth(&self) -> bool {
        self.smooth
    }

    /// Whether it has edges of the part, and not of its triangulation only.
    #[must_use]
    pub fn has_creases(&self) -> bool {
        self.crease_lines().next().is_some()
    }

    /// Enclosed volume.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The smallest box that holds the surface.
    pub fn bounds(&self) -> Aabb<3> {
        self.bounds
    }

    /// Vertices in which creases end or bend.
    pub(crate) fn corners(&self) -> impl Iterator<Item = &[f64; 3]> {
        self.corners.iter().map(|&v| &self.vertices[v as usize])
    }

    /// Creases between corners, as polylines.
    pub(crate) fn crease_lines(&self) -> impl Iterator<Item = (Vec<[f64; 3]>, bool)> {
        let points = |line: &CreaseLine| line.vertices.iter().map(|&v| self.vertices[v as usize]).collect();
        self.lines.iter().map(move |line| (points(line), line.closed))
    }

    pub(crate) fn nearest(&self, x: &[f64; 3]) -> NearestTriangle {
        let hit = self.tree.nearest(&self.vertices, &self.triangles, x);
        let normal = self.part_normal(hit.triangle, hit.part);
        let away = sub(x, &hit.point);
        let outside = crate::vector::dot(&away, &normal) >= 0.0;
        let distance = if outside { hit.squared.sqrt() } else { -hit.squared.sqrt() };
        let normal = if self.smooth { self.interpolated(hit.triangle, &hit.weights) } else { normal };
        let reach = if self.smooth { NEAR * self.longest_edge(hit.triangle) } else { 0.0 };
        NearestTriangle { point: hit.point, normal, distance, reach }
    }

    fn longest_edge(&self, triangle: u32) -> f64 {
        let corners = self.triangles[triangle as usize].map(|v| &self.vertices[v as usize]);
        (0..3).map(|k| distance(corners[k], corners[(k + 1) % 3])).fold(0.0, f64::max)
    }

    /// Adds the outward normals at a point of the surface: one, two on a crease, and in a corner one of every piece of
    /// the surface between creases. `tolerance` is the distance up to which a point is on an edge or vertex.
    pub(crate) fn normals_at(&self, x: &[f64; 3], tolerance: f64, mut add: impl FnMut([f64; 3])) {
        let hit = self.tree.nearest(&self.vertices, &self.triangles, x);
        let triangle = &self.triangles[hit.triangle as usize];
        let corner = |k: usize| &self.vertices[triangle[k % 3] as usize];
        if let Some(k) = (0..3).find(|&k| distance(corner(k), &hit.point) <= tolerance) {
            for (t, j) in self.around(hit.triangle, k) {
                add(self.corner_normals[t as usize][j]);
            }
            return;
        }
        let on_edge = |k: &usize| {
            let (a, b) = (corner(*k), corner(*k + 1));
            let foot = closest::closest(&hit.point, [a, b, a]).0;
            distance(&foot, &hit.point) <= tolerance
        };
        let Some(k) = (0..3).find(on_edge) else {
            return add(self.surface_normal(hit.triangle, Part::Face, &hit.weights));
        };
        if !self.is_crease(hit.triangle, k) {
            return add(self.surface_normal(hit.triangle, Part::Edge(k as u8), &hit.weights));
        }
        add(self.surface_normal(hit.triangle, Part::Face, &hit.weights));
        let other = self.neighbors[hit.triangle as usize][k];
        let there = self.triangles[other as usize].map(|v| &self.vertices[v as usize]);
        add(self.surface_normal(other, Part::Face, &closest::closest(x, there).1));
    }
}

pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// Unit normal of a triangle, and twice its area; `None` for one without an area.
fn normal_of(corners: [&[f64; 3]; 3]) -> Option<[f64; 3]> {
    normalized(&cross(&sub(corners[1], corners[0]), &sub(corners[2], corners[0])))
}
