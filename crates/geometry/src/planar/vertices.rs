//! The points where pieces of interfaces and boundaries meet at an angle, or more than two of them do.

use std::f64::consts::{PI, TAU};

use super::{PlanarPiece, PlanarPieces};
use crate::domain::FaceId;
use crate::vector::{axpy, distance};

/// Angle below which two pieces lead on without a bend, in radians: far above rounding, far below what matters.
const STRAIGHT_ON: f64 = 1e-7;

/// What the curvatures of two arcs of one circle may differ by, relative: rounding.
const SAME_CIRCLE: f64 = 1e-9;

/// A piece of an interface or of the boundary as seen from a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Direction in which it leaves the vertex, from 0 to 2 pi.
    pub angle: f64,
    /// The face that it is part of, on the boundary of the domain.
    pub face: Option<FaceId>,
    /// Its curvature, of a circle's arc where it is not straight: positive where it bends counterclockwise.
    pub curvature: f64,
}

/// A point where pieces of interfaces and boundaries meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Where.
    pub at: [f64; 2],
    /// What meets there, counterclockwise.
    pub rays: Vec<Ray>,
    /// The region between every ray and the next one, the last one and the first; `None` outside of the domain.
    pub sectors: Vec<Option<u16>>,
    /// Distance within which there is nothing but these rays, each as long at least.
    pub clear: f64,
}

/// One end of a piece.
struct End<'a> {
    piece: &'a PlanarPiece,
    index: usize,
    at: [f64; 2],
    angle: f64,
    /// As that of a ray.
    curvature: f64,
    /// The region on the counterclockwise side, as seen from this end.
    left: Option<u16>,
}

impl PlanarPieces {
    /// The vertices: bends, ends and crossings of the pieces, and the points of the boundary in `breaks`, where its conditions
    /// change.
    pub fn vertices(&self, breaks: &[[f64; 2]]) -> Vec<Vertex> {
        let ends = self.ends();
        let mut order: Vec<usize> = (0..ends.len()).collect();
        order.sort_by(|&a, &b| ends[a].at[0].total_cmp(&ends[b].at[0]).then(a.cmp(&b)));
        let mut taken = vec![false; ends.len()];
        // Every point with what meets there.
        let mut points: Vec<([f64; 2], Vec<usize>)> = Vec::new();
        for (rank, &first) in order.iter().enumerate() {
            if taken[first] {
                continue;
            }
            let at = ends[first].at;
            let near = order[rank..].iter().take_while(|&&k| ends[k].at[0] - at[0] <= 4.0 * self.tolerance);
            let here: Vec<usize> = near
                .copied()
                .filter(|&k| !taken[k] && distance(&ends[k].at, &at) <= 4.0 * self.tolerance)
                .collect();
            here.iter().for_each(|&k| taken[k] = true);
            // The interface that leaves a crossing with a level set is no piece, so nothing is known of what meets there.
            if !self.crossings.iter().any(|x| distance(x, &at) <= 4.0 * self.tolerance) {
                points.push((at, here));
            }
        }
        let broken = |at: &[f64; 2]| breaks.iter().any(|b| distance(b, at) <= 4.0 * self.tolerance);
        let leads_on = |at: &[f64; 2], here: &[usize]| {
            here.len() == 2 && !broken(at) && {
                let [a, b] = [&ends[here[0]], &ends[here[1]]];
                let bend = ((a.angle - b.angle).rem_euclid(TAU) - PI).abs();
                // Circles begin and end somewhere.
                let largest = a.curvature.abs().max(b.curvature.abs());
                let same = (a.curvature + b.curvature).abs() <= SAME_CIRCLE * largest;
                bend <= STRAIGHT_ON && same && a.piece.face == b.piece.face && a.left == b.right()
            }
        };
        let (smooth, corners): (Vec<_>, Vec<_>) =
            points.into_iter().partition(|(at, here)| leads_on(at, here));
        let mut vertices: Vec<Vertex> =
            corners.iter().map(|(at, here)| self.vertex(*at, here, &ends, &smooth)).collect();
        for at in
            breaks.iter().filter(|at| !corners.iter().any(|(x, _)| distance(x, at) <= 4.0 * self.tolerance))
        {
            vertices.extend(self.on_a_piece(at));
        }
        for vertex in &mut vertices {
            let nearest = self.others.iter().map(|x| distance(x, &vertex.at)).fold(f64::INFINITY, f64::min);
            vertex.clear = vertex.clear.min((nearest - self.between_others).max(self.tolerance));
        }
        vertices
    }

    fn ends(&self) -> Vec<End<'_>> {
        let angle = |[x, y]: [f64; 2]| y.atan2(x).rem_euclid(TAU);
        let mut all = Vec::with_capacity(2 * self.pieces.len());
        for (index, piece) in self.pieces.iter().enumerate() {
            let ([left, right], bend) = (piece.sides, piece.curve.curvature());
            let back = piece.curve.along(1.0).map(|x| -x);
            let ends = [(0.0, piece.curve.along(0.0), bend, left), (1.0, back, -bend, right)];
            all.extend(ends.map(|(t, along, curvature, left)| {
                let (at, angle) = (piece.at(t), angle(along));
                End { piece, index, at, angle, curvature, left }
            }));
        }
        all
    }

    fn vertex(
        &self,
        at: [f64; 2],
        here: &[usize],
        ends: &[End<'_>],
        smooth: &[([f64; 2], Vec<usize>)],
    ) -> Vertex {
        let mut here: Vec<&End<'_>> = here.iter().map(|&k| &ends[k]).collect();
        here.sort_by(|a, b| a.angle.total_cmp(&b.angle));
        let ray = |end: &&End<'_>| Ray { angle: end.angle, face: end.piece.face, curvature: end.curvature };
        // Pieces that lead on from those that meet here belong to the same rays.
        let mut own: Vec<usize> = Vec::new();
        let mut clear = f64::INFINITY;
        for end in &here {
            let (mut piece, mut tip) = (end.index, far_end(end));
            own.push(piece);
            while let Some((_, pair)) = smooth.iter().find(|(x, pair)| {
                distance(x, &tip) <= 4.0 * self.tolerance && pair.iter().any(|&k| ends[k].index == piece)
            }) {
                let Some(&next) = pair.iter().find(|&&k| ends[k].index != piece) else { break };
                if own.contains(&ends[next].index) {
                    break;
                }
                piece = ends[next].index;
                tip = far_end(&ends[next]);
                own.push(piece);
            }
            clear = clear.min(distance(&tip, &at));
        }
        let others = self.pieces.iter().enumerate().filter(|(k, _)| !own.contains(k));
        let clear = others.fold(clear, |c, (_, piece)| c.min(piece.curve.distance(&at)));
        Vertex {
            at,
            rays: here.iter().map(ray).collect(),
            sectors: here.iter().map(|end| end.left).collect(),
            clear,
        }
    }

    /// The vertex at a point inside of a piece of the boundary.
    fn on_a_piece(&self, at: &[f64; 2]) -> Option<Vertex> {
        let near =
            |piece: &&PlanarPiece| piece.face.is_some() && piece.curve.distance(at) <= 4.0 * self.tolerance;
        let piece = self.pieces.iter().find(near)?;
        let t = piece.curve.place_of(at);
        let along = piece.curve.along(t);
        let ahead = along[1].atan2(along[0]).rem_euclid(TAU);
        let back = (ahead + PI).rem_euclid(TAU);
        let ([left, right], bend) = (piece.sides, piece.curve.curvature());
        let mut rays = [(ahead, left, bend), (back, right, -bend)];
        rays.sort_by(|a, b| a.0.total_cmp(&b.0));
        let others = self.pieces.iter().filter(|other| !std::ptr::eq(*other, piece));
        let ends = [0.0, 1.0].map(|t| distance(&piece.at(t), at));
        let clear = others.fold(ends[0].min(ends[1]), |c, other| c.min(other.curve.distance(at)));
        let ray = |(angle, _, curvature)| Ray { angle, face: piece.face, curvature };
        Some(Vertex { at: *at, rays: rays.map(ray).to_vec(), sectors: rays.map(|r| r.1).to_vec(), clear })
    }
}

impl End<'_> {
    /// The region on the clockwise side.
    fn right(&self) -> Option<u16> {
        let [left, right] = self.piece.sides;
        if self.left == left { right } else { left }
    }
}

fn far_end(end: &End<'_>) -> [f64; 2] {
    let [start, stop] = [0.0, 1.0].map(|t| end.piece.at(t));
    if distance(&start, &end.at) < distance(&stop, &end.at) { stop } else { start }
}

impl Vertex {
    /// The point at a distance along a ray.
    pub fn along(&self, ray: usize, distance: f64) -> [f64; 2] {
        let (sin, cos) = self.rays[ray].angle.sin_cos();
        axpy(&self.at, distance, &[cos, sin])
    }

    /// The angle of a sector.
    pub fn opening(&self, sector: usize) -> f64 {
        let next = self.rays[(sector + 1) % self.rays.len()].angle;
        let opening = (next - self.rays[sector].angle).rem_euclid(TAU);
        if opening == 0.0 { TAU } else { opening }
    }
}

#[cfg(test)]
mod tests {
    use super::super::PlanarPieces;
    use crate::{Domain, RegionMap, Shape};

    fn square(low: [f64; 2], high: [f64; 2]) -> Shape<2> {
        Shape::cuboid(low, high).expect("a box")
    }

    #[test]
    fn a_chip_in_a_plate() {
        let domain = Domain::boxed([-1.0; 2], [1.0; 2]).expect("a domain");
        let regions = RegionMap::new(vec![Some(square([-0.3; 2], [0.3; 2])), None]).expect("regions");
        let vertices = PlanarPieces::new(&domain, &regions).vertices(&[]);
        assert_eq!(vertices.len(), 8);
        let corner =
            vertices.iter().find(|v| (v.at[0] - 0.3).abs() + (v.at[1] - 0.3).abs() < 1e-12).expect("there");
        assert_eq!(corner.rays.len(), 2);
        assert!((corner.clear - 0.6).abs() < 1e-12);
        let inner = corner.sectors.iter().position(|&s| s == Some(0)).expect("the chip");
        assert!((corner.opening(inner) - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn what_is_hidden_or_flush_makes_no_vertex() {
        // Two boxes that overlap make one; a region that is flush with the boundary meets it at two points.
        let union = Shape::union(vec![square([0.0, 0.0], [2.0, 1.0]), square([1.0, 0.0], [3.0, 1.0])])
            .expect("a union");
        let domain = Domain::from_shape(union, None).expect("a domain");
        let regions = RegionMap::new(vec![Some(square([0.0, 0.0], [0.5, 1.0])), None]).expect("regions");
        let vertices = PlanarPieces::new(&domain, &regions).vertices(&[]);
        let mut at: Vec<[f64; 2]> = vertices.iter().map(|v| v.at).collect();
        at.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert_eq!(at, [[0.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 1.0], [3.0, 0.0], [3.0, 1.0]]);
        let wall = vertices.iter().find(|v| v.at == [0.5, 0.0]).expect("there");
        assert_eq!((wall.rays.len(), wall.sectors.iter().flatten().count()), (3, 2));
        assert!((wall.clear - 0.5).abs() < 1e-12);
    }

    #[test]
    fn quadrants_meet_in_one_point_and_breaks_are_vertices() {
        let domain = Domain::boxed([-1.0; 2], [1.0; 2]).expect("a domain");
        let both =
            Shape::union(vec![square([0.0; 2], [1.0; 2]), square([-1.0; 2], [0.0; 2])]).expect("a union");
        let regions = RegionMap::new(vec![Some(both), None]).expect("regions");
        let pieces = PlanarPieces::new(&domain, &regions);
        let vertices = pieces.vertices(&[[0.25, 1.0]]);
        let middle = vertices.iter().find(|v| v.at == [0.0, 0.0]).expect("there");
        assert_eq!(middle.rays.len(), 4);
        assert_eq!(middle.sectors, [Some(0), Some(1), Some(0), Some(1)]);
        let broken = vertices.iter().find(|v| v.at == [0.25, 1.0]).expect("there");
        assert_eq!((broken.rays.len(), broken.clear), (2, 0.25));
    }

    #[test]
    fn corners_beyond_a_level_set_belong_to_their_own_region() {
        // The curve leaves the square below, nearer to the left corner than to the middle, and above, nearer to the right one.
        let domain = Domain::boxed([-1.0; 2], [1.0; 2]).expect("a domain");
        let curve = Shape::level_set(std::sync::Arc::new(|x: &[f64; 2]| 2.0 * x[0].powi(3) - x[1]));
        let regions = RegionMap::new(vec![Some(curve), None]).expect("regions");
        let vertices = PlanarPieces::new(&domain, &regions).vertices(&[]);
        assert_eq!(vertices.len(), 4);
        for vertex in vertices {
            let expected = u16::from(2.0 * vertex.at[0].powi(3) > vertex.at[1]);
            let found: Vec<u16> = vertex.sectors.iter().copied().flatten().collect();
            assert_eq!(found, [expected], "{:?}", vertex.at);
        }
    }

    #[test]
    fn circles_meet_walls_and_have_no_corner_of_their_own() {
        let domain = Domain::boxed([0.0; 2], [1.0; 2]).expect("a domain");
        let disc = |c: [f64; 2]| Shape::ball(c, 0.5).expect("a disc");
        let regions = |s: Shape<2>| RegionMap::new(vec![Some(s), None]).expect("regions");
        let vertices = PlanarPieces::new(&domain, &regions(disc([0.0, 0.0]))).vertices(&[]);
        assert_eq!(vertices.iter().filter(|v| v.rays.len() == 3).count(), 2);
        assert!(
            vertices
                .iter()
                .filter(|v| v.rays.len() == 3)
                .all(|v| v.rays.iter().any(|r| r.curvature.abs() == 2.0))
        );
        let lens = Shape::intersection(vec![disc([0.3, 0.5]), disc([0.7, 0.5])]).expect("a lens");
        let vertices = PlanarPieces::new(&domain, &regions(lens)).vertices(&[]);
        assert_eq!(vertices.len(), 6);
        let whole =
            RegionMap::new(vec![Some(Shape::ball([0.5, 0.5], 0.2).expect("a disc")), None]).expect("regions");
        assert_eq!(PlanarPieces::new(&domain, &whole).vertices(&[]).len(), 4);
    }
}
