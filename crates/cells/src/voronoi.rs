//! The construction of a cell: start from a box, clip by planes, then by bisectors from near to far, then by curves.

use crate::body::{Body, Measure, Piece, Source};
use crate::cell::Cell;
use crate::container::{Container, Cut, Interfaces, check_walls};
use crate::error::CellError;
use crate::faces::collect_faces;
use crate::interval::Interval;
use crate::polygon::Polygon;
use crate::polyhedron::Polyhedron;
use crate::split::Division;

/// Distance by which a node may lie beyond the boundary, as a fraction of the radius of its cell. Boundary nodes come
/// from projections, which end some digits before round-off; a cell that is off by more than this has another shape.
const OUTSIDE_TOLERANCE: f64 = 1e-3;

/// Distance, relative to the coordinates' magnitude, up to which a candidate coincides with the node: a few units in the
/// last place, below which the direction to the candidate means nothing.
const COINCIDENCE_TOLERANCE: f64 = 4.0 * f64::EPSILON;

/// Volume, relative to the cell's radius to the power D, below which a cell is degenerate: round-off of the volume.
const VOLUME_TOLERANCE: f64 = 1e-15;

/// Half-width of the box to start from, in units of the searched radius. Whatever lies beyond one half of that radius is
/// unknown; the excess lets a cell that reaches the box be told from one that just fits.
const START_HALF_WIDTH: f64 = 0.505;

/// Margin about the domain's bounding box, as a fraction of its extent: the box must not touch a curved face that it
/// encloses tightly.
const BOX_MARGIN: f64 = 0.25;

/// Excess of the reach over the searched radius that is put down to round-off.
const REACH_TOLERANCE: f64 = 1e-12;

/// Buffers for [`voronoi_cell`], to be kept from call to call; one for each thread.
#[derive(Debug, Default)]
pub struct CellScratch {
    /// Squared distance and place in the list of candidates, near to far.
    order: Vec<(f64, u32)>,
    pieces: Vec<Piece>,
    interval: Interval,
    polygon: Polygon,
    polyhedron: Polyhedron,
    division: Division,
    /// Numbers of the pieces on walls.
    walls: Vec<u16>,
}

/// The Voronoi cell of the node at `center` among `candidates`, clipped to `container`, for `D` = 1, 2 or 3.
///
/// `candidates` are the other nodes nearby, with the numbers that the cell's faces are to carry, in any order: the cell
/// does not depend on it. All nodes within the distance `searched` of the centre must be among them (infinity if all
/// nodes are). The node may lie on the boundary; its cell is then what lies on the inner side.
///
/// The volume is that of the divergence theorem (for an interior cell `1/(2D) sum area * distance`, Kraus et al. 2022,
/// below eq. 19). Faces between neighbours agree, seen from either side, to round-off.
///
/// # Errors
/// [`CellError::Incomplete`] if nodes beyond `searched` might touch the cell: search farther and try again. The other
/// errors say what is wrong with the node, a candidate or the domain.
pub fn voronoi_cell<const D: usize>(
    center: &[f64; D],
    candidates: &[(u32, [f64; D])],
    searched: f64,
    container: &Container<D>,
    scratch: &mut CellScratch,
) -> Result<Cell<D>, CellError> {
    let mut bodies = CellScratch::bodies::<D>(scratch);
    bodies.clip(center, candidates, searched, container)?;
    let reach = 2.0 * bodies.keep(center, container)?;
    if reach > searched * (1.0 + REACH_TOLERANCE) {
        return Err(CellError::Incomplete { center: center.to_vec(), searched, needed: reach });
    }
    let Bodies { order, pieces, walls, measure, .. } = bodies;
    let radius = 0.5 * reach;
    if measure.volume.is_nan() || measure.volume <= VOLUME_TOLERANCE * power::<D>(radius) * radius {
        return Err(CellError::Degenerate { center: center.to_vec(), volume: measure.volume, radius });
    }
    let faces = collect_faces(center, candidates, order, container, walls, pieces, power::<D>(radius))?;
    let centroid = std::array::from_fn(|axis| center[axis] + measure.moment[axis] / measure.volume);
    Ok(Cell { volume: measure.volume, centroid, faces, reach })
}

/// The parts that interfaces divide the cell of the node at `center` into, as `(label, volume)`, those with the same label as one; for
/// the other arguments see [`voronoi_cell`]. `None` where more than [`MOST_WALLS`](crate::MOST_WALLS) planes cross the cell.
///
/// # Errors
/// As [`voronoi_cell`].
pub fn voronoi_parts<const D: usize>(
    center: &[f64; D],
    candidates: &[(u32, [f64; D])],
    searched: f64,
    container: &Container<D>,
    interfaces: &Interfaces<D>,
    scratch: &mut CellScratch,
) -> Result<Option<Vec<(u16, f64)>>, CellError> {
    check_walls(interfaces.walls)?;
    let mut bodies = CellScratch::bodies::<D>(scratch);
    bodies.clip(center, candidates, searched, container)?;
    let reach = 2.0 * bodies.keep(center, container)?;
    if reach > searched * (1.0 + REACH_TOLERANCE) {
        return Err(CellError::Incomplete { center: center.to_vec(), searched, needed: reach });
    }
    let Bodies { body, division, .. } = bodies;
    // What replaces walls has been cut off already, or no wall crosses the cell.
    let walls = container.walls.iter().flat_map(|walls| walls.walls).chain(interfaces.walls);
    if !division.find(center, &body, walls) {
        return Ok(None);
    }
    let at = |x: [f64; 3]| std::array::from_fn(|axis| center[axis] + x[axis]);
    let label = |x: [f64; 3]| {
        let x = at(x);
        let is_inside = container.walls.is_none_or(|walls| (walls.beyond)(&x).is_none());
        is_inside.then(|| (interfaces.label)(&x))
    };
    let mut found: Vec<(u16, f64)> = Vec::new();
    for part in division.divide(&body, label) {
        let (Some(label), volume) = part.volume() else { continue };
        match found.iter_mut().find(|known| known.0 == *label) {
            Some(known) => known.1 += volume,
            None => found.push((*label, volume)),
        }
    }
    Ok(Some(found))
}

/// The cell that is being made.
struct Bodies<'s> {
    order: &'s mut Vec<(f64, u32)>,
    body: Body<'s>,
    division: &'s mut Division,
    pieces: &'s mut Vec<Piece>,
    walls: &'s mut Vec<u16>,
    measure: Measure,
}

impl CellScratch {
    fn bodies<const D: usize>(&mut self) -> Bodies<'_> {
        const { assert!(D >= 1 && D <= 3, "cells exist in one, two and three dimensions") };
        let Self { order, pieces, interval, polygon, polyhedron, division, walls } = self;
        let body = match D {
            1 => Body::Interval(interval),
            2 => Body::Polygon(polygon),
            _ => Body::Polyhedron(polyhedron),
        };
        Bodies { order, body, division, pieces, walls, measure: Measure { volume: 0.0, moment: [0.0; 3] } }
    }
}

impl Bodies<'_> {
    /// The part of the domain, without what walls leave out of it, that is nearest to the node.
    fn clip<const D: usize>(
        &mut self,
        center: &[f64; D],
        candidates: &[(u32, [f64; D])],
        searched: f64,
        container: &Container<D>,
    ) -> Result<(), CellError> {
        container.check()?;
        if searched.is_nan() || searched < 0.0 {
            return Err(CellError::InvalidRadius { searched });
        }
        sort_candidates(center, candidates, self.order)?;
        let (lo, hi) = start_box(center, searched, container)?;
        self.body.reset(&lo, &hi);
        let beyond = clip_by_planes(center, container, &mut self.body);
        clip_by_candidates(center, candidates, self.order, &mut self.body)?;
        check_inside(center, beyond, &self.body)?;
        cut_by_curves(center, container.cuts, 0, &mut self.body)
    }

    /// Measures what of the body walls leave in the domain; returns the distance of its farthest vertex.
    fn keep<const D: usize>(
        &mut self,
        center: &[f64; D],
        container: &Container<D>,
    ) -> Result<f64, CellError> {
        let Self { body, division, pieces, walls: numbers, measure, .. } = self;
        pieces.clear();
        numbers.clear();
        let whole = |body: &Body<'_>, pieces: &mut Vec<Piece>| (body.measure(pieces), body.radius());
        let radius;
        (*measure, radius) = match container.walls {
            None => whole(body, pieces),
            Some(walls) if division.find(center, body, walls.walls.iter()) => {
                let at = |x: [f64; 3]| std::array::from_fn(|axis| center[axis] + x[axis]);
                let kept = division.keep(body, |x| (walls.beyond)(&at(x)), pieces, numbers);
                if kept.outside > OUTSIDE_TOLERANCE * body.radius() {
                    let face = (walls.beyond)(center).unwrap_or_default();
                    let distance = kept.outside.min(body.radius());
                    return Err(CellError::OutsideDomain { center: center.to_vec(), face, distance });
                }
                (kept.measure, kept.radius)
            }
            Some(walls) => {
                cut_by_curves(center, walls.cuts, container.cuts.len(), body)?;
                whole(body, pieces)
            }
        };
        Ok(radius)
    }
}

/// `length^(D-1)`.
fn power<const D: usize>(length: f64) -> f64 {
    (1..D).map(|_| length).product()
}

/// Sorts the candidates by distance, then by position, so that neither their order nor their numbers matter.
fn sort_candidates<const D: usize>(
    center: &[f64; D],
    candidates: &[(u32, [f64; D])],
    order: &mut Vec<(f64, u32)>,
) -> Result<(), CellError> {
    if !center.iter().all(|x| x.is_finite()) {
        return Err(CellError::CenterNotFinite { center: center.to_vec() });
    }
    let magnitude = center.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let coincident = (COINCIDENCE_TOLERANCE * magnitude).powi(2);
    order.clear();
    for (place, (index, position)) in (0_u32..).zip(candidates) {
        let squared = (0..D).map(|axis| (position[axis] - center[axis]).powi(2)).sum::<f64>();
        if !squared.is_finite() {
            return Err(CellError::CandidateNotFinite { index: *index, position: position.to_vec() });
        }
        if squared <= coincident {
            return Err(CellError::Duplicate { index: *index, center: center.to_vec() });
        }
        order.push((squared, place));
    }
    order.sort_unstable_by(|a, b| {
        a.0.total_cmp(&b.0).then_with(|| {
            let (a, b) = (&candidates[a.1 as usize].1, &candidates[b.1 as usize].1);
            a.iter()
                .zip(b)
                .map(|(x, y)| x.total_cmp(y))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        })
    });
    Ok(())
}

/// The box to start from, relative to the centre.
fn start_box<const D: usize>(
    center: &[f64; D],
    searched: f64,
    container: &Container<D>,
) -> Result<([f64; D], [f64; D]), CellError> {
    let extent = (0..D).map(|axis| container.max[axis] - container.min[axis]).fold(0.0, f64::max);
    let margin = BOX_MARGIN * extent;
    let half_width = START_HALF_WIDTH * searched;
    let lo: [f64; D] =
        std::array::from_fn(|axis| (container.min[axis] - margin - center[axis]).max(-half_width));
    let hi: [f64; D] =
        std::array::from_fn(|axis| (container.max[axis] + margin - center[axis]).min(half_width));
    if searched == 0.0 {
        return Err(CellError::Incomplete { center: center.to_vec(), searched, needed: extent });
    }
    if (0..D).any(|axis| lo[axis] >= 0.0 || hi[axis] <= 0.0) {
        return Err(CellError::OutsideBox { center: center.to_vec() });
    }
    Ok((lo, hi))
}

/// Clips by the planes. Returns the plane that the node lies farthest beyond, if any, and by how much.
fn clip_by_planes<const D: usize>(
    center: &[f64; D],
    container: &Container<D>,
    body: &mut Body,
) -> Option<(u16, f64)> {
    let mut beyond: Option<(u16, f64)> = None;
    for (k, plane) in (0_u32..).zip(container.planes) {
        let height = plane.normal.iter().zip(center).map(|(n, x)| n * x).sum::<f64>() - plane.offset;
        if height > beyond.map_or(0.0, |worst| worst.1) {
            beyond = Some((plane.face, height));
        }
        body.clip(&plane.normal, -height, Source::Plane(k));
    }
    beyond
}

/// Refuses a node that lies beyond a plane by more than a small part of its cell, and a cell of which nothing is left.
fn check_inside<const D: usize>(
    center: &[f64; D],
    beyond: Option<(u16, f64)>,
    body: &Body,
) -> Result<(), CellError> {
    let radius = if body.is_empty() { 0.0 } else { body.radius() };
    match beyond {
        Some((face, distance)) if distance > OUTSIDE_TOLERANCE * radius => {
            Err(CellError::OutsideDomain { center: center.to_vec(), face, distance })
        }
        _ if body.is_empty() => Err(CellError::Degenerate { center: center.to_vec(), volume: 0.0, radius }),
        _ => Ok(()),
    }
}

/// Clips by the bisectors with the candidates, from near to far, until the next one is too far away to matter.
fn clip_by_candidates<const D: usize>(
    center: &[f64; D],
    candidates: &[(u32, [f64; D])],
    order: &[(f64, u32)],
    body: &mut Body,
) -> Result<(), CellError> {
    let mut reach = 2.0 * body.radius();
    let mut previous: Option<&(u32, [f64; D])> = None;
    for (rank, &(squared, place)) in (0_u32..).zip(order) {
        if squared > reach * reach {
            break;
        }
        let candidate = &candidates[place as usize];
        if let Some(twin) = previous.filter(|previous| previous.1 == candidate.1) {
            let (first, second) = (twin.0.min(candidate.0), twin.0.max(candidate.0));
            return Err(CellError::DuplicateCandidates { first, second, position: candidate.1.to_vec() });
        }
        previous = Some(candidate);
        let normal: [f64; D] = std::array::from_fn(|axis| candidate.1[axis] - center[axis]);
        if body.clip(&normal, 0.5 * squared, Source::Candidate(rank)) {
            reach = 2.0 * body.radius();
        }
    }
    Ok(())
}

/// Cuts by level sets, whose sources count on from `first`.
fn cut_by_curves<const D: usize>(
    center: &[f64; D],
    cuts: &[Cut<'_, D>],
    first: usize,
    body: &mut Body,
) -> Result<(), CellError> {
    for (k, cut) in (first as u32..).zip(cuts) {
        let face = cut.face;
        let undefined = || CellError::LevelNotANumber { face, center: center.to_vec() };
        let level = |x: &[f64; D]| (cut.level)(&std::array::from_fn(|axis| center[axis] + x[axis]));
        let at_center = (cut.level)(center);
        if at_center.is_nan() {
            return Err(undefined());
        }
        let largest = body.cut(level, Source::Cut(k)).ok_or_else(undefined)?;
        if at_center > OUTSIDE_TOLERANCE * largest {
            return Err(CellError::OutsideDomain { center: center.to_vec(), face, distance: at_center });
        }
        if body.is_empty() {
            return Err(CellError::Unresolved { face, center: center.to_vec() });
        }
    }
    Ok(())
}
