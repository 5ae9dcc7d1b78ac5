//! What a stencil is made of: the nearest nodes regardless of side, the parts they belong to, the points of the
//! interfaces between these.

use meshless_neighbors::CellList;

use super::interface::InterfacePoints;
use super::unknowns::Unknowns;
use super::vertex::Vertices;

/// Points of an interface that are looked at where none is within the stencil.
const POINTS_ASKED: usize = 24;

/// Which values a fit hears, and how loudly. Rows in time that answer to a source by the wrong sign do so by values beyond
/// the interface, or by the interface itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Heard {
    /// All of them alike.
    #[default]
    All,
    /// Misfits in units of the energy: a node of a soft part that almost lies on a stiff one follows that, and is not carried
    /// on from its own side.
    UnitsOfEnergy,
    /// Those of the own part alone, without interfaces.
    OwnPart,
}

impl Heard {
    /// What is tried in time, in this order.
    pub(super) const IN_TIME: [Self; 3] = [Self::All, Self::UnitsOfEnergy, Self::OwnPart];
}

/// A stencil.
#[derive(Debug, Clone)]
pub(super) struct Stencil<const D: usize> {
    /// The node, or whatever point it is round.
    pub(super) center: [f64; D],
    /// Distance of the farthest node.
    pub(super) radius: f64,
    /// Nodes by distance; round a node, that one comes first.
    pub(super) nodes: Vec<u32>,
    /// Place in `parts` of every node.
    pub(super) part_of: Vec<usize>,
    /// Connected parts of regions, that of the center first.
    pub(super) parts: Vec<u32>,
    /// What is heard of the nodes.
    pub(super) heard: Heard,
    /// The vertex whose functions serve it in place of polynomials; the nodes are then those that nothing but its rays is between.
    pub(super) vertex: Option<usize>,
    /// Points of interfaces between these parts, and the places of the parts of both sides.
    pub(super) points: Vec<(u32, [usize; 2])>,
    linked: Vec<bool>,
    found: Vec<(f64, u32)>,
    near: Vec<u32>,
}

impl<const D: usize> Default for Stencil<D> {
    fn default() -> Self {
        Self {
            center: [0.0; D],
            radius: 0.0,
            nodes: Vec::new(),
            part_of: Vec::new(),
            parts: Vec::new(),
            heard: Heard::All,
            vertex: None,
            points: Vec::new(),
            linked: Vec::new(),
            found: Vec::new(),
            near: Vec::new(),
        }
    }
}

impl<const D: usize> Stencil<D> {
    /// Gathers the stencil of `count` nodes round `center`, which lies in the part `own`.
    pub(super) fn gather(
        &mut self,
        (center, own, heard): (&[f64; D], u32, Heard),
        count: usize,
        nodes: &CellList<'_, D>,
        unknowns: &Unknowns,
        interfaces: (&InterfacePoints<D>, &CellList<'_, D>),
        vertices: &Vertices,
    ) {
        (self.center, self.heard) = (*center, heard);
        self.vertex = vertices.near(center);
        if self.vertex.is_none() {
            self.nearest(center, count, nodes);
            self.vertex = vertices.within(center, self.radius);
        }
        if let Some(vertex) = self.vertex {
            // Twice as many are asked as are wanted: some lie beyond what the functions are of.
            self.nearest(center, 2 * count, nodes);
            let points = nodes.points();
            let vertex = vertices.get(vertex);
            self.nodes.retain(|&j| vertex.reaches(&points[j as usize], unknowns.part[j as usize]));
            self.nodes.truncate(count);
            let farthest = self.nodes.last().map(|&j| &points[j as usize]);
            self.radius =
                farthest.map_or(0.0, |x| (0..D).map(|k| (x[k] - center[k]).powi(2)).sum::<f64>().sqrt());
        }
        if heard == Heard::OwnPart {
            self.nodes.retain(|&j| unknowns.part[j as usize] == own);
        }
        self.parts.clear();
        self.parts.push(own);
        self.part_of.clear();
        self.points.clear();
        for &j in &self.nodes {
            let part = unknowns.part[j as usize];
            let place = self.parts.iter().position(|&p| p == part).unwrap_or_else(|| {
                self.parts.push(part);
                self.parts.len() - 1
            });
            self.part_of.push(place);
        }
        if self.parts.len() > 1 && self.vertex.is_none() {
            self.gather_points(center, interfaces);
        }
    }

    fn nearest(&mut self, center: &[f64; D], count: usize, nodes: &CellList<'_, D>) {
        self.nodes.clear();
        self.nodes.extend(nodes.nearest(center, count, &mut self.found));
        self.radius = self.found.last().map_or(0.0, |last| last.0.sqrt());
    }

    fn gather_points(
        &mut self,
        center: &[f64; D],
        (interfaces, index): (&InterfacePoints<D>, &CellList<'_, D>),
    ) {
        self.near.clear();
        index.within(center, self.radius, &mut self.near);
        for k in 0..self.near.len() {
            let point = self.near[k];
            if let Some(places) = self.places(interfaces, point) {
                self.points.push((point, places));
            }
        }
        self.linked.clear();
        self.linked.resize(self.parts.len(), false);
        self.linked[0] = true;
        self.spread();
        if self.linked.contains(&false) {
            // No point within the stencil joins a part to the rest: the nearest one outside does.
            self.near.clear();
            self.near.extend(index.nearest(center, POINTS_ASKED, &mut self.found));
            for k in 0..self.near.len() {
                let point = self.near[k];
                if let Some([a, b]) = self.places(interfaces, point)
                    && self.linked[a] != self.linked[b]
                {
                    self.points.push((point, [a, b]));
                    self.spread();
                }
            }
        }
        if self.linked.contains(&false) {
            self.drop_unlinked();
        }
    }

    /// The places of the parts on both sides of a point, where both are in the stencil.
    fn places(&self, interfaces: &InterfacePoints<D>, point: u32) -> Option<[usize; 2]> {
        let sides = &interfaces.points[point as usize].sides;
        let place = |part: u32| self.parts.iter().position(|&p| p == part);
        Some([place(sides[0].part)?, place(sides[1].part)?])
    }

    /// Marks what is joined to what is marked.
    fn spread(&mut self) {
        let mut grown = true;
        while grown {
            grown = false;
            for &(_, [a, b]) in &self.points {
                if self.linked[a] != self.linked[b] {
                    (self.linked[a], self.linked[b]) = (true, true);
                    grown = true;
                }
            }
        }
    }

    /// Leaves out parts that no point of an interface joins to the node's own: they say nothing about it.
    fn drop_unlinked(&mut self) {
        let mut renumbered = vec![usize::MAX; self.parts.len()];
        let mut parts = Vec::with_capacity(self.parts.len());
        for (place, &part) in self.parts.iter().enumerate().filter(|(place, _)| self.linked[*place]) {
            renumbered[place] = parts.len();
            parts.push(part);
        }
        let kept = |&(_, place): &(u32, usize)| renumbered[place] != usize::MAX;
        let pairs: Vec<(u32, usize)> =
            self.nodes.iter().copied().zip(self.part_of.iter().copied()).filter(kept).collect();
        (self.nodes, self.part_of) = pairs.into_iter().map(|(j, place)| (j, renumbered[place])).unzip();
        self.points.retain(|&(_, [a, b])| renumbered[a] != usize::MAX && renumbered[b] != usize::MAX);
        self.points.iter_mut().for_each(|(_, sides)| *sides = sides.map(|place| renumbered[place]));
        self.parts = parts;
    }
}
