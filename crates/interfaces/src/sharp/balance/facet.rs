//! Polygons on smooth surfaces in space, whose edges are on other smooth surfaces.
//!
//! Vertices are where three surfaces meet, to round-off, and integrals follow surface and edges exactly as far as a quadrature does:
//! a cell whose faces are such polygons is closed although its surface is curved.

/// Newton steps to a point of three surfaces.
const STEPS: usize = 25;

/// Steps shorter than this, over the size of what is looked at, are the last: what they leave is as large as their square.
const LAST_STEP: f64 = 1e-8;

/// Distance from a surface, over the coordinates, up to which a vertex is on it.
const ON: f64 = 1e-14;

/// Area of a polygon, over its size squared, up to which it is none.
const NO_AREA: f64 = 1e-13;

/// Parts of an edge that is looked at for where a curved surface cuts it, and of a curved edge for where a plane does.
const PARTS: usize = 4;
const CURVED_PARTS: usize = 3;

/// How far a curved polygon reaches beyond its vertices, and a curved surface between them, over their largest distance: as much of
/// the angle that it turns by, twice what an arc has, and this at least and at most.
const BULGE: f64 = 0.5;
const BULGES: [f64; 2] = [0.05, 0.5];

/// How often a polygon is halved until a surface cuts it in one line.
const HALVINGS: usize = 5;

/// A level set and its gradient.
pub(super) type Level<'a> = dyn Fn(&[f64; 3]) -> (f64, [f64; 3]) + Sync + 'a;

/// A plane, `normal . x = offset`, or where a level set is zero.
#[derive(Clone, Copy)]
pub(super) enum Surface<'a> {
    Plane { normal: [f64; 3], offset: f64 },
    Level(&'a Level<'a>),
}

/// A polygon; edge k, on `edges[k]`, leads from vertex k to the next.
#[derive(Clone)]
pub(super) struct Facet<'a> {
    surface: Surface<'a>,
    vertices: Vec<[f64; 3]>,
    edges: Vec<Surface<'a>>,
    /// Length that steps and areas are small against.
    size: f64,
}

/// A point of a facet: place, unit normal along the gradient of the surface, weight.
pub(super) type Point = ([f64; 3], [f64; 3], f64);

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + t b`.
fn along(a: &[f64; 3], t: f64, b: &[f64; 3]) -> [f64; 3] {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

fn length(a: &[f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Solves `rows x = right`.
fn solve(rows: &[[f64; 3]; 3], right: &[f64; 3]) -> [f64; 3] {
    let others = [cross(&rows[1], &rows[2]), cross(&rows[2], &rows[0]), cross(&rows[0], &rows[1])];
    let determinant = dot(&rows[0], &others[0]);
    std::array::from_fn(|k| (0..3).map(|row| right[row] * others[row][k]).sum::<f64>() / determinant)
}

/// The point near `x` that three surfaces share; `None` where there is none within `size`.
fn meet(surfaces: [&Surface<'_>; 3], x: &[f64; 3], size: f64) -> Option<[f64; 3]> {
    let (mut at, mut last) = (*x, f64::INFINITY);
    let planes = surfaces.iter().all(|surface| surface.is_plane());
    for _ in 0..STEPS {
        let found = surfaces.map(|surface| surface.value(&at));
        let step = solve(&found.map(|(_, gradient)| gradient), &found.map(|(value, _)| value));
        at = minus(&at, &step);
        last = length(&step);
        if planes || !(last > LAST_STEP * size && last <= size) {
            break;
        }
    }
    let converged = if planes { last <= size } else { last <= LAST_STEP * size };
    (converged && length(&minus(&at, x)) <= size).then_some(at)
}

impl<'a> Surface<'a> {
    pub(super) fn value(&self, x: &[f64; 3]) -> (f64, [f64; 3]) {
        match self {
            Self::Plane { normal, offset } => (dot(normal, x) - offset, *normal),
            Self::Level(level) => level(x),
        }
    }

    pub(super) fn is_plane(&self) -> bool {
        matches!(self, Self::Plane { .. })
    }

    /// The plane through a point.
    pub(super) fn through(point: &[f64; 3], normal: [f64; 3]) -> Self {
        Self::Plane { normal, offset: dot(&normal, point) }
    }

    /// The plane that is as far from one point as from another; its level is negative at the first.
    pub(super) fn between(a: &[f64; 3], b: &[f64; 3]) -> Self {
        let normal = minus(b, a);
        let size = length(&normal);
        Self::through(&[0, 1, 2].map(|k| 0.5 * (a[k] + b[k])), normal.map(|n| n / size))
    }

    /// Distance of a point, to first order.
    pub(super) fn distance(&self, x: &[f64; 3]) -> f64 {
        let (value, gradient) = self.value(x);
        value.abs() / length(&gradient)
    }

    /// The unit normal, towards larger levels.
    pub(super) fn normal(&self, x: &[f64; 3]) -> [f64; 3] {
        let (_, gradient) = self.value(x);
        let size = length(&gradient);
        gradient.map(|g| g / size)
    }

    /// The level over the length of its gradient, nothing within round-off of the coordinates.
    fn height(&self, x: &[f64; 3], size: f64) -> f64 {
        let (value, gradient) = self.value(x);
        let height = value / length(&gradient);
        let magnitude = x.iter().fold(size, |a, b| a.max(b.abs()));
        if height.abs() <= ON * magnitude { 0.0 } else { height }
    }

    /// The point of the surface over `x` in a direction.
    fn lift(&self, x: &[f64; 3], direction: &[f64; 3], size: f64) -> Option<[f64; 3]> {
        let (mut at, mut last) = (*x, f64::INFINITY);
        for _ in 0..STEPS {
            let (value, gradient) = self.value(&at);
            let step = value / dot(&gradient, direction);
            at = along(&at, -step, direction);
            last = step.abs();
            if !(last > LAST_STEP * size && last <= size) {
                break;
            }
        }
        (last <= LAST_STEP * size && length(&minus(&at, x)) <= size).then_some(at)
    }
}

impl<'a> Facet<'a> {
    /// The square of a half width on a surface, about the foot of a point; `None` where the surface turns away.
    pub(super) fn square(surface: Surface<'a>, x: &[f64; 3], half_width: f64) -> Option<Self> {
        let size = 4.0 * half_width;
        let foot = surface.lift(x, &surface.normal(x), size)?;
        let normal = surface.normal(&foot);
        let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))?;
        let first = cross(&normal, &std::array::from_fn(|k| f64::from(u8::from(k == least))));
        let first = first.map(|t| t / length(&first));
        let second = cross(&normal, &first);
        let mut facet = Self { surface, vertices: Vec::new(), edges: Vec::new(), size };
        for (s, t, across) in [
            (-1.0, -1.0, [0.0, -1.0]),
            (1.0, -1.0, [1.0, 0.0]),
            (1.0, 1.0, [0.0, 1.0]),
            (-1.0, 1.0, [-1.0, 0.0]),
        ] {
            let corner = along(&along(&foot, s * half_width, &first), t * half_width, &second);
            facet.vertices.push(surface.lift(&corner, &normal, size)?);
            let out = along(&first.map(|x| across[0] * x), across[1], &second);
            facet.edges.push(Surface::through(&corner, out));
        }
        Some(facet)
    }

    fn next(&self, k: usize) -> &[f64; 3] {
        &self.vertices[(k + 1) % self.vertices.len()]
    }

    /// The angle by which the polygon turns, or what its edges are on, the largest: zero where all is flat. A little less for large angles.
    pub(super) fn turn(&self) -> Option<f64> {
        let between = |surface: &Surface<'_>, a: &[f64; 3], b: &[f64; 3]| {
            length(&minus(&surface.normal(a), &surface.normal(b)))
        };
        let mut turn = 0.0_f64;
        if !self.surface.is_plane() {
            let middle = self.middle()?;
            let away = self.vertices.iter().map(|x| between(&self.surface, &middle, x));
            turn = 2.0 * away.fold(0.0, f64::max);
        }
        for (k, edge) in self.edges.iter().enumerate().filter(|(_, edge)| !edge.is_plane()) {
            turn = turn.max(between(edge, &self.vertices[k], self.next(k)));
        }
        Some(turn)
    }

    /// Whether all vertices are on a surface.
    pub(super) fn is_on(&self, surface: &Surface<'_>) -> bool {
        self.vertices.iter().all(|x| surface.height(x, self.size) == 0.0)
    }

    fn is_straight(&self) -> bool {
        self.surface.is_plane() && self.edges.iter().all(Surface::is_plane)
    }

    /// A point of an edge, and its derivative by the parameter.
    fn on_edge(&self, k: usize, t: f64) -> Option<([f64; 3], [f64; 3])> {
        let (from, to, edge) = (&self.vertices[k], self.next(k), &self.edges[k]);
        let chord = minus(to, from);
        let at = along(from, t, &chord);
        if self.surface.is_plane() && edge.is_plane() {
            return Some((at, chord));
        }
        let size = length(&chord);
        let across = Surface::through(&at, chord.map(|c| c / size));
        let at = meet([&self.surface, edge, &across], &at, size)?;
        let rows = [&self.surface, edge, &across].map(|surface| surface.value(&at).1);
        Some((at, solve(&rows, &[0.0, 0.0, size])))
    }

    /// Points along the outline: the vertices, and points of edges in between, each with whether it is a vertex and with its edge.
    /// Straight edges are divided as well if `all` are to be.
    fn outline(&self, parts: usize, all: bool) -> Option<Vec<(bool, [f64; 3], Surface<'a>)>> {
        let mut outline = Vec::with_capacity(parts * self.vertices.len());
        for (k, (vertex, edge)) in self.vertices.iter().zip(&self.edges).enumerate() {
            outline.push((true, *vertex, *edge));
            let is_straight = self.surface.is_plane() && edge.is_plane();
            if (is_straight && !all) || length(&minus(self.next(k), vertex)) <= ON * self.size {
                continue;
            }
            for part in 1..parts {
                outline.push((false, self.on_edge(k, part as f64 / parts as f64)?.0, *edge));
            }
        }
        Some(outline)
    }

    /// A point amid the outline, on the surface.
    pub(super) fn middle(&self) -> Option<[f64; 3]> {
        let outline = self.outline(2, false)?;
        let mean =
            std::array::from_fn(|k| outline.iter().map(|(_, x, _)| x[k]).sum::<f64>() / outline.len() as f64);
        match self.surface {
            Surface::Plane { .. } => Some(mean),
            Surface::Level(_) => self.surface.lift(&mean, &self.surface.normal(&mean), self.size),
        }
    }

    /// Distance of the farthest point of the outline, about.
    pub(super) fn radius(&self, x: &[f64; 3]) -> Option<f64> {
        let outline = self.outline(2, false)?;
        Some(outline.iter().map(|(_, v, _)| length(&minus(v, x))).fold(0.0, f64::max))
    }

    fn has_area(&self) -> Option<bool> {
        let outline = self.outline(2, false)?;
        let Some((_, first, _)) = outline.first() else { return Some(false) };
        let mut area = [0.0; 3];
        for ((_, a, _), (_, b, _)) in outline.iter().zip(outline.iter().skip(1)) {
            area = along(&area, 0.5, &cross(&minus(a, first), &minus(b, first)));
        }
        Some(length(&area) > NO_AREA * self.size * self.size)
    }

    /// Whether all of the polygon is where the level of a surface is negative, as far as is told at once.
    pub(super) fn is_within(&self, by: &Surface<'_>) -> bool {
        self.side(by) == Some(0)
    }

    /// The side of a surface on which all of the polygon is; `None` where that takes a closer look.
    fn side(&self, by: &Surface<'_>) -> Option<usize> {
        let bulge = match by.is_plane() && self.is_straight() {
            true => 0.0,
            false => self.radius_of_vertices() * self.bulge(by),
        };
        let positive = by.height(&self.vertices[0], self.size) > 0.0;
        let is_apart = |x: &[f64; 3]| {
            let height = by.height(x, self.size);
            (height > 0.0) == positive && height.abs() >= bulge
        };
        self.vertices.iter().all(is_apart).then_some(usize::from(positive))
    }

    /// How far the polygon or a surface beside it may reach beyond the vertices, over their largest distance.
    fn bulge(&self, by: &Surface<'_>) -> f64 {
        let turn = |surface: &Surface<'_>| {
            let first = surface.normal(&self.vertices[0]);
            let others = self.vertices.iter().skip(1).map(|x| length(&minus(&surface.normal(x), &first)));
            others.fold(0.0, f64::max)
        };
        let curved = [&self.surface, by].into_iter().chain(&self.edges).filter(|surface| !surface.is_plane());
        (BULGE * curved.map(turn).fold(0.0, f64::max)).clamp(BULGES[0], BULGES[1])
    }

    fn radius_of_vertices(&self) -> f64 {
        let from = self.vertices.iter().skip(1);
        from.map(|v| length(&minus(v, &self.vertices[0]))).fold(0.0, f64::max)
    }

    /// What is on either side of a surface, where its level is negative and where it is positive. `None` where it is cut more than once.
    fn halves(&self, by: Surface<'a>) -> Option<[Option<Self>; 2]> {
        if let Some(side) = self.side(&by) {
            let mut halves = [None, None];
            halves[side] = Some(self.clone());
            return Some(halves);
        }
        let outline = self.outline(if by.is_plane() { CURVED_PARTS } else { PARTS }, !by.is_plane())?;
        let heights: Vec<f64> = outline.iter().map(|(_, x, _)| by.height(x, self.size)).collect();
        if heights.iter().any(|h| !h.is_finite()) {
            return None;
        }
        let count = heights.len();
        let changes = (0..count).filter(|&k| (heights[k] > 0.0) != (heights[(k + 1) % count] > 0.0)).count();
        match changes {
            0 if heights[0] > 0.0 => return Some([None, Some(self.clone())]),
            0 => return Some([Some(self.clone()), None]),
            2 => {}
            _ => return None,
        }
        let mut halves = [(); 2].map(|()| Self { vertices: Vec::new(), edges: Vec::new(), ..*self });
        for k in 0..count {
            let (here, there) = (heights[k], heights[(k + 1) % count]);
            let own = usize::from(here > 0.0);
            let ((is_vertex, from, edge), (_, to, _)) = (&outline[k], &outline[(k + 1) % count]);
            if *is_vertex {
                halves[own].vertices.push(*from);
                halves[own].edges.push(*edge);
            }
            if (there > 0.0) == (here > 0.0) {
                continue;
            }
            let chord = minus(to, from);
            let crossing = if here == 0.0 {
                *from
            } else if there == 0.0 {
                *to
            } else {
                let guess = along(from, here / (here - there), &chord);
                meet([&self.surface, edge, &by], &guess, length(&chord))?
            };
            halves[own].vertices.push(crossing);
            halves[own].edges.push(by);
            halves[1 - own].vertices.push(crossing);
            halves[1 - own].edges.push(*edge);
        }
        let [inner, outer] = halves;
        let has_area = |half: Self| Some(if half.has_area()? { Some(half) } else { None });
        Some([has_area(inner)?, has_area(outer)?])
    }

    /// The parts on either side of a surface; `None` where they cannot be told.
    fn cut(self, by: Surface<'a>, halvings: usize, parts: &mut [Vec<Self>; 2]) -> Option<()> {
        if let Some([inner, outer]) = self.halves(by) {
            parts[0].extend(inner);
            parts[1].extend(outer);
            return Some(());
        }
        if halvings == 0 {
            return None;
        }
        let middle = self.middle()?;
        let farthest = self
            .vertices
            .iter()
            .max_by(|a, b| length(&minus(a, &middle)).total_cmp(&length(&minus(b, &middle))))?;
        let across = minus(farthest, &middle);
        let size = length(&across);
        let plane = Surface::through(&middle, across.map(|t| t / size));
        self.halves(plane)?.into_iter().flatten().try_for_each(|half| half.cut(by, halvings - 1, parts))
    }

    /// The parts where a level is negative.
    pub(super) fn inside(self, by: Surface<'a>) -> Option<Vec<Self>> {
        let mut parts = [Vec::new(), Vec::new()];
        self.cut(by, HALVINGS, &mut parts)?;
        let [inner, _] = parts;
        Some(inner)
    }

    /// The parts that some surfaces divide a polygon into.
    pub(super) fn divided(self, by: impl Iterator<Item = Surface<'a>>) -> Option<Vec<Self>> {
        let mut all = vec![self];
        for surface in by {
            let mut parts = [Vec::new(), Vec::new()];
            all.into_iter().try_for_each(|facet| facet.cut(surface, HALVINGS, &mut parts))?;
            let [inner, outer] = parts;
            all = inner;
            all.extend(outer);
        }
        Some(all)
    }

    /// The parts on the inner side of all of some surfaces.
    pub(super) fn within(self, by: impl Iterator<Item = Surface<'a>>) -> Option<Vec<Self>> {
        let mut all = vec![self];
        for surface in by {
            let mut left = Vec::new();
            for facet in all {
                left.extend(facet.inside(surface)?);
            }
            all = left;
        }
        Some(all)
    }

    /// Quadrature over the polygon, in triangles with a corner in common, by rules on [0, 1] along the edges and across them. `None` where
    /// the surface cannot be followed.
    pub(super) fn points(&self, [along_edge, across]: [&[(f64, f64)]; 2]) -> Option<Vec<Point>> {
        let flat = self.surface.is_plane();
        let apex = if self.is_straight() { self.vertices[0] } else { self.middle()? };
        let up = self.surface.normal(&apex);
        let level = |v: &[f64; 3]| if flat { *v } else { along(v, -dot(v, &up), &up) };
        let mut points = Vec::with_capacity(self.edges.len() * along_edge.len() * across.len());
        let mut total = 0.0;
        for k in 0..self.edges.len() {
            let near = ON * self.size;
            let ends = [&self.vertices[k], self.next(k)];
            if length(&minus(ends[1], ends[0])) <= near
                || ends.iter().any(|x| length(&minus(x, &apex)) <= near)
            {
                continue;
            }
            for (t, of_t) in along_edge {
                let (edge, slope) = self.on_edge(k, *t)?;
                let way = level(&minus(&edge, &apex));
                let turn = dot(&cross(&way, &level(&slope)), &up);
                for (s, of_s) in across {
                    let at = along(&apex, *s, &way);
                    let (at, normal) = match flat {
                        true => (at, up),
                        false => {
                            let at = self.surface.lift(&at, &up, self.size)?;
                            (at, self.surface.normal(&at))
                        }
                    };
                    let weight = turn * s * of_s * of_t / dot(&normal, &up);
                    total += weight;
                    points.push((at, normal, weight));
                }
            }
        }
        // The vertices may go either way round.
        let sign = f64::signum(total);
        points.iter_mut().for_each(|(_, _, weight)| *weight *= sign);
        total.is_finite().then_some(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshless_geometry::gauss;
    use proptest::prelude::*;

    fn ball(center: [f64; 3], radius: f64) -> impl Fn(&[f64; 3]) -> (f64, [f64; 3]) + Sync {
        move |x| {
            let way = minus(x, &center);
            let distance = length(&way);
            (distance - radius, way.map(|w| w / distance))
        }
    }

    fn area(points: &[Point]) -> f64 {
        points.iter().map(|(_, _, weight)| weight).sum()
    }

    fn planes(half: [f64; 6]) -> Vec<Surface<'static>> {
        let axis = |k: usize, sign: f64| std::array::from_fn(|axis| if axis == k { sign } else { 0.0 });
        (0..6)
            .map(|k| Surface::Plane {
                normal: axis(k / 2, if k % 2 == 0 { -1.0 } else { 1.0 }),
                offset: half[k],
            })
            .collect()
    }

    /// The part of a sphere of radius R over the square [-a, a]^2 has the area `4 R (2 a asin(a / sqrt(R^2 - a^2)) - R asin(a^2 / (R^2 - a^2)))`.
    #[test]
    fn the_area_of_a_part_of_a_sphere() {
        let (radius, a) = (1.0_f64, 0.3_f64);
        let level = ball([0.0; 3], radius);
        let square = Facet::square(Surface::Level(&level), &[0.01, -0.02, 0.9], 0.5).unwrap();
        let parts = square.within(planes([a, a, a, a, 2.0, 2.0]).into_iter()).unwrap();
        let rule = gauss(10);
        let found: f64 = parts.iter().map(|part| area(&part.points([&rule, &rule]).unwrap())).sum();
        let beside = radius * radius - a * a;
        let exact = 4.0 * radius * (2.0 * a * (a / beside.sqrt()).asin() - radius * (a * a / beside).asin());
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} for {exact}");
    }

    #[test]
    fn a_plane_is_divided_by_a_sphere_into_a_disc_and_the_rest() {
        let level = ball([0.1, 0.2, 0.1], 0.5);
        let plane = Surface::Plane { normal: [0.0, 0.0, 1.0], offset: 0.0 };
        // A corner of the square is in the middle of the disc, so that a quarter of that is in the square.
        let square = Facet::square(plane, &[0.6, 0.7, 0.3], 0.5).unwrap();
        let parts = square.divided(std::iter::once(Surface::Level(&level))).unwrap();
        let rule = gauss(12);
        let mut areas: Vec<f64> =
            parts.iter().map(|part| area(&part.points([&rule, &rule]).unwrap())).collect();
        areas.sort_by(f64::total_cmp);
        let quarter = 0.25 * std::f64::consts::PI * (0.25 - 0.01);
        assert_eq!(areas.len(), 2);
        assert!((areas[0] - quarter).abs() < 1e-9, "{areas:?} for {quarter}");
        assert!((areas[1] - (1.0 - quarter)).abs() < 1e-9, "{areas:?}");
    }

    proptest! {
        /// What a plane and a sphere leave of a box is closed: its vector areas add up to nothing.
        #[test]
        fn boxes_cut_by_a_sphere_are_closed(
            half in prop::array::uniform6(0.5_f64..1.0),
            tilt in prop::array::uniform3(-0.3_f64..0.3),
            height in -0.2_f64..0.2,
            radius in 3.0_f64..10.0,
        ) {
            let level = ball([tilt[0], tilt[1], -radius], radius);
            let sphere = Surface::Level(&level);
            let mut walls = planes(half);
            let size = length(&[tilt[0], 1.0, tilt[2]]);
            walls.push(Surface::Plane { normal: [tilt[0] / size, 1.0 / size, tilt[2] / size], offset: 0.4 + height });
            let rule = gauss(8);
            let (mut sum, mut whole) = ([0.0; 3], 0.0);
            let mut add = |parts: Vec<Facet<'_>>| {
                for (_, normal, weight) in parts.iter().flat_map(|part| part.points([&rule, &rule]).unwrap()) {
                    sum = along(&sum, weight, &normal);
                    whole += weight;
                }
            };
            for (k, wall) in walls.iter().enumerate() {
                let others = walls.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, wall)| *wall);
                let square = Facet::square(*wall, &[0.0; 3], 2.5).unwrap();
                add(square.within(others.chain([sphere])).unwrap());
            }
            add(Facet::square(sphere, &[0.0, 0.0, 0.1], 1.8).unwrap().within(walls.iter().copied()).unwrap());
            prop_assert!(length(&sum) < 1e-9 * whole, "{sum:?} of {whole}");
        }
    }
}
