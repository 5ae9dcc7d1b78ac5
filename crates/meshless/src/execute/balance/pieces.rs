//! Quadrature over a patch of a surface: divided where something else begins on it, with Gauss points on every part.

use meshless_geometry::{Element, Patch, gauss, gauss_from_corner};

/// Panels are so many spacings long at most.
const PANEL: f64 = 2.0;

/// Gauss points of a whole panel, by dimension.
const POINTS: [usize; 3] = [1, 8, 4];

/// Fewest points of a panel, by dimension.
const LEAST_POINTS: [usize; 3] = [1, 6, 3];

/// The same over a chord, which is short.
const LEAST_ON_CHORD: usize = 3;

/// Places a spacing where a patch is asked what it belongs to.
const PROBES: f64 = 4.0;

/// Probes along one parameter at most.
const MOST_PROBES: f64 = 20_000.0;

/// How near the ends of a patch the first and last of them are, over the distance of probes.
const NEAR_END: f64 = 1e-5;

/// Halvings on the way to where something else begins: to round-off of the parameter.
const HALVINGS: usize = 52;

/// Changes that are looked for between two probes at most.
const CHANGES: usize = 4;

/// Halvings on the way to a line that is tangent to an edge: the distance counts by its square root.
const TANGENT_HALVINGS: usize = 40;

/// Points of a panel that begins at a corner, where fluxes may be infinite.
const POINTS_FROM_CORNER: usize = 16;

/// Length of such a panel in spacings: alike on both sides of a corner, where infinite fluxes may cancel. And what it takes of a
/// whole part at most.
const FROM_CORNER: f64 = 1.0;
const MOST_FROM_CORNER: f64 = 0.8;

/// Distance in the parameter below which changes seen from two lines over a patch are the same straight edge.
const SAME: f64 = 1e-9;

/// Lines over a patch along which edges across them are looked for: one in so many spacings, and how many at least and at most.
const LINE_SPACINGS: f64 = 2.0;
const LINES: [f64; 2] = [3.0, 48.0];

/// How finely to integrate.
pub(super) struct Rule<'a, const D: usize> {
    /// The distance of nodes near a point.
    pub(super) spacing: &'a dyn Fn(&[f64; D]) -> f64,
    /// The least of them.
    pub(super) least: f64,
    /// Whether what is integrated in the plane may be infinite at corners.
    pub(super) corners: bool,
}

/// A part of the parameter on which everything is of one kind.
struct Part<T> {
    from: f64,
    to: f64,
    kind: T,
    /// Whether its ends are corners.
    corners: [bool; 2],
}

impl<const D: usize> Rule<'_, D> {
    /// Points with the weights that belong to them as areas, and what they are of: what `kind` says of the part that they are on.
    /// Where it says nothing nothing is integrated.
    pub(super) fn points<T: PartialEq + Clone>(
        &self,
        patch: &Patch<'_, D>,
        kind: &dyn Fn(&Element<D>) -> Option<T>,
    ) -> Vec<(Element<D>, T)> {
        if patch.is_small() {
            let element = patch.at([0.0; 2]);
            return kind(&element).map(|kind| (element, kind)).into_iter().collect();
        }
        if D == 3 { self.over_square(patch, kind) } else { self.along_line(patch, kind) }
    }

    fn along_line<T: PartialEq + Clone>(
        &self,
        patch: &Patch<'_, D>,
        kind: &dyn Fn(&Element<D>) -> Option<T>,
    ) -> Vec<(Element<D>, T)> {
        let mut found = Vec::new();
        for part in self.parts(patch, 0, &|s| kind(&patch.at([s, 0.0]))) {
            for (s, weight) in self.nodes(patch, 0, &part, &|s| [s, 0.0]) {
                let element = patch.at([s, 0.0]);
                found.push((Element { area: weight * element.area, ..element }, part.kind.clone()));
            }
        }
        found
    }

    fn over_square<T: PartialEq + Clone>(
        &self,
        patch: &Patch<'_, D>,
        kind: &dyn Fn(&Element<D>) -> Option<T>,
    ) -> Vec<(Element<D>, T)> {
        let mut found = Vec::new();
        let straight = self.across(patch, kind);
        for first in straight.iter().flat_map(|part| self.between_tangents(patch, part, kind)) {
            for (s, weight) in self.nodes(patch, 0, &first, &|s| [s, 0.5]) {
                for part in self.parts(patch, 1, &|t| kind(&patch.at([s, t]))) {
                    for (t, inner) in self.nodes(patch, 1, &part, &|t| [s, t]) {
                        let element = patch.at([s, t]);
                        let area = weight * inner * element.area;
                        found.push((Element { area, ..element }, part.kind.clone()));
                    }
                }
            }
        }
        found
    }

    /// Parts of the first parameter of a square between straight edges across it: those that two lines see in the same place.
    fn across<T: PartialEq + Clone>(
        &self,
        patch: &Patch<'_, D>,
        kind: &dyn Fn(&Element<D>) -> Option<T>,
    ) -> Vec<Part<()>> {
        let lines = (patch.extent[1] / (LINE_SPACINGS * self.least)).ceil().clamp(LINES[0], LINES[1]);
        let mut seen: Vec<f64> = Vec::new();
        for line in 0..lines as usize {
            let t = (line as f64 + 0.5) / lines;
            let parts = self.all_parts(patch, 0, &|s| kind(&patch.at([s, t])));
            seen.extend(parts.iter().skip(1).map(|part| part.from));
        }
        seen.sort_by(f64::total_cmp);
        let mut edges = vec![0.0];
        for same in seen.chunk_by(|a, b| b - a <= SAME) {
            if same.len() > 1 {
                edges.push(same[same.len() / 2]);
            }
        }
        edges.push(1.0);
        edges.windows(2).map(|e| Part { from: e[0], to: e[1], kind: (), corners: [false; 2] }).collect()
    }

    /// Divides a part of the first parameter of a square where the lines across begin to meet something else: there a curved edge is
    /// tangent to the line, and what it cuts off begins like the square root of the distance.
    fn between_tangents<T: PartialEq + Clone>(
        &self,
        patch: &Patch<'_, D>,
        part: &Part<()>,
        kind: &dyn Fn(&Element<D>) -> Option<T>,
    ) -> Vec<Part<()>> {
        let met = |s: f64| -> Vec<Option<T>> {
            let parts = self.all_parts(patch, 1, &|t| kind(&patch.at([s, t])));
            parts.into_iter().map(|part| part.kind).collect()
        };
        let length = patch.extent[0] * (part.to - part.from);
        let count = (length / (LINE_SPACINGS * self.least)).ceil().clamp(LINES[0], LINES[1]);
        let place = |k: usize| part.from + (part.to - part.from) * (k as f64 + 0.5) / count;
        let mut pieces = vec![Part { from: part.from, to: part.to, kind: (), corners: [false; 2] }];
        let mut before = met(place(0));
        for k in 1..count as usize {
            let here = met(place(k));
            if here == before {
                continue;
            }
            let (mut low, mut high) = (place(k - 1), place(k));
            for _ in 0..TANGENT_HALVINGS {
                let middle = 0.5 * (low + high);
                *(if met(middle) == before { &mut low } else { &mut high }) = middle;
            }
            let change = 0.5 * (low + high);
            if let Some(last) = pieces.last_mut() {
                (last.to, last.corners[1]) = (change, true);
            }
            pieces.push(Part { from: change, to: part.to, kind: (), corners: [true, false] });
            before = here;
        }
        pieces
    }

    /// The parts of a parameter that count.
    fn parts<T: PartialEq>(
        &self,
        patch: &Patch<'_, D>,
        axis: usize,
        kind: &dyn Fn(f64) -> Option<T>,
    ) -> Vec<Part<T>> {
        let parts = self.all_parts(patch, axis, kind).into_iter();
        parts
            .filter_map(|p| Some(Part { from: p.from, to: p.to, corners: p.corners, kind: p.kind? }))
            .collect()
    }

    /// All parts of a parameter.
    fn all_parts<T: PartialEq>(
        &self,
        patch: &Patch<'_, D>,
        axis: usize,
        kind: &dyn Fn(f64) -> Option<T>,
    ) -> Vec<Part<Option<T>>> {
        let cells = (PROBES * patch.extent[axis] / self.least).ceil().clamp(2.0, MOST_PROBES);
        let near = NEAR_END / cells;
        let middles = (0..cells as usize).map(|k| (k as f64 + 0.5) / cells);
        let probes = std::iter::once(near).chain(middles).chain(std::iter::once(1.0 - near));
        let first = kind(near);
        let mut parts = vec![Part { from: 0.0, to: 1.0, kind: first, corners: [patch.ends[axis]; 2] }];
        let mut before = near;
        for probe in probes {
            let here = kind(probe);
            for _ in 0..CHANGES {
                let Some(last) = parts.last_mut().filter(|last| last.kind != here) else { break };
                let (mut low, mut high) = (before, probe);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    *(if kind(middle) == last.kind { &mut low } else { &mut high }) = middle;
                }
                let change = 0.5 * (low + high);
                let corners = [true, last.corners[1]];
                (last.to, last.corners[1]) = (change, true);
                parts.push(Part { from: change, to: 1.0, kind: kind(high), corners });
                before = high;
            }
            before = probe;
        }
        parts
    }

    /// Whether points of a parameter gather at corners of its parts: where fluxes may be infinite in the plane, and tangents in space.
    fn is_graded(&self, axis: usize) -> bool {
        if D == 3 { axis == 0 } else { self.corners }
    }

    /// Gauss points of a part, with their weights.
    fn nodes<T>(
        &self,
        patch: &Patch<'_, D>,
        axis: usize,
        part: &Part<T>,
        at: &dyn Fn(f64) -> [f64; 2],
    ) -> Vec<(f64, f64)> {
        let extent = patch.extent[axis];
        let (most, least) =
            (POINTS[D - 1], if patch.is_chord() { LEAST_ON_CHORD } else { LEAST_POINTS[D - 1] });
        let mut found = Vec::new();
        let of_corners = self.is_graded(axis);
        for (from, to) in self.panels(patch, axis, part, at) {
            // Panels that begin at a corner have it at their first end.
            let length = extent * (to - from).abs();
            let spacing = (self.spacing)(&patch.at(at(0.5 * (from + to))).at);
            let begins = |end: f64, is_corner: bool| of_corners && is_corner && from == end;
            let rule = if begins(part.from, part.corners[0]) || begins(part.to, part.corners[1]) {
                gauss_from_corner(POINTS_FROM_CORNER)
            } else {
                let points = (most as f64 * length / (PANEL * spacing)).ceil() as usize;
                gauss(points.clamp(least, most))
            };
            found.extend(rule.into_iter().map(|(x, w)| (from + (to - from) * x, w * (to - from).abs())));
        }
        found
    }

    /// Panels of a part, as long as spacings are; in the plane one of its own at every corner, from there on.
    fn panels<T>(
        &self,
        patch: &Patch<'_, D>,
        axis: usize,
        part: &Part<T>,
        at: &dyn Fn(f64) -> [f64; 2],
    ) -> Vec<(f64, f64)> {
        let of_corners = self.is_graded(axis);
        let both = of_corners && part.corners == [true; 2];
        let share = (part.to - part.from) * patch.parts[axis] as f64;
        let first = share.ceil().max(if both { 2.0 } else { 1.0 }) as usize;
        let cut = |k: usize| part.from + (part.to - part.from) * k as f64 / first as f64;
        let mut waiting: Vec<(f64, f64)> = (0..first).rev().map(|k| (cut(k), cut(k + 1))).collect();
        let mut panels = Vec::new();
        while let Some((from, to)) = waiting.pop() {
            let middle = 0.5 * (from + to);
            let spacing = [from, middle, to].map(|s| (self.spacing)(&patch.at(at(s)).at));
            let smallest = spacing.into_iter().fold(f64::INFINITY, f64::min);
            if patch.extent[axis] * (to - from) > PANEL * smallest && middle > from && middle < to {
                waiting.push((middle, to));
                waiting.push((from, middle));
            } else {
                panels.push((from, to));
            }
        }
        if !of_corners || panels.is_empty() {
            return panels;
        }
        // Where the panel of a corner ends: others make way, or it would not be as long as that on the other side.
        let most = if both { 0.5 * MOST_FROM_CORNER } else { MOST_FROM_CORNER } * (part.to - part.from);
        let length = |end: f64| {
            let spacing = (self.spacing)(&patch.at(at(end)).at);
            (FROM_CORNER * spacing / patch.extent[axis]).min(most)
        };
        if part.corners[1] {
            let cut = part.to - length(part.to);
            while panels.last().is_some_and(|last| last.0 >= cut) {
                panels.pop();
            }
            panels.last_mut().into_iter().for_each(|last| last.1 = cut);
            panels.push((part.to, cut));
        }
        if part.corners[0] {
            let cut = part.from + length(part.from);
            let covered = panels.iter().take_while(|panel| panel.0.max(panel.1) <= cut).count();
            panels.drain(..covered);
            panels.first_mut().into_iter().for_each(|first| first.0 = cut);
            panels.insert(0, (part.from, cut));
        }
        panels
    }
}
