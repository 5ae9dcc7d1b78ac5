//! A bounding volume hierarchy: which triangle is nearest.

use super::closest::{Part, closest};
use crate::vector::distance_squared;

/// Triangles of a leaf at most.
const LEAF: usize = 4;

/// Enough for any tree that halves its triangles: 2^32 of them.
const DEPTH: usize = 40;

/// Boxes about triangles, halved at the median of the centres along the longest side.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    min: [f64; 3],
    max: [f64; 3],
    /// Of a leaf the first of its triangles in `order`, of others their second child; the first one comes next.
    start: u32,
    /// Triangles of a leaf; 0 for others.
    count: u32,
}

/// What a search finds.
pub(super) struct Hit {
    pub(super) triangle: u32,
    pub(super) point: [f64; 3],
    pub(super) weights: [f64; 3],
    pub(super) part: Part,
    pub(super) squared: f64,
}

impl Tree {
    pub(super) fn new(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..triangles.len() as u32).collect() };
        let corners = |t: u32| triangles[t as usize].map(|v| vertices[v as usize]);
        let mut order = std::mem::take(&mut tree.order);
        tree.divide(&corners, &mut order, 0);
        tree.order = order;
        tree
    }

    fn divide(&mut self, corners: &impl Fn(u32) -> [[f64; 3]; 3], part: &mut [u32], first: u32) {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut low, mut high) = (min, max);
        let center = |t: u32, axis: usize| corners(t).iter().map(|v| v[axis]).sum::<f64>();
        for &t in part.iter() {
            for axis in 0..3 {
                for v in corners(t) {
                    min[axis] = min[axis].min(v[axis]);
                    max[axis] = max[axis].max(v[axis]);
                }
                low[axis] = low[axis].min(center(t, axis));
                high[axis] = high[axis].max(center(t, axis));
            }
        }
        let own = self.nodes.len();
        if part.len() <= LEAF {
            self.nodes.push(Node { min, max, start: first, count: part.len() as u32 });
            return;
        }
        let width = |axis: usize| high[axis] - low[axis];
        let axis = (0..3).fold(0, |best, axis| if width(axis) > width(best) { axis } else { best });
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&a, &b| {
            center(a, axis).total_cmp(&center(b, axis)).then(a.cmp(&b))
        });
        self.nodes.push(Node { min, max, start: 0, count: 0 });
        let (left, right) = part.split_at_mut(half);
        self.divide(corners, left, first);
        self.nodes[own].start = self.nodes.len() as u32;
        self.divide(corners, right, first + half as u32);
    }

    /// The nearest triangle; of several equally near ones always the same.
    pub(super) fn nearest(&self, vertices: &[[f64; 3]], triangles: &[[u32; 3]], x: &[f64; 3]) -> Hit {
        let mut best =
            Hit { triangle: 0, point: *x, weights: [0.0; 3], part: Part::Face, squared: f64::INFINITY };
        let mut stack = [(0_u32, 0.0_f64); DEPTH];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (at, least) = stack[waiting];
            if least >= best.squared {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                for &t in &self.order[node.start as usize..(node.start + node.count) as usize] {
                    let corners = triangles[t as usize].map(|v| &vertices[v as usize]);
                    let (point, weights, part) = closest(x, corners);
                    let squared = distance_squared(x, &point);
                    if squared < best.squared {
                        best = Hit { triangle: t, point, weights, part, squared };
                    }
                }
                continue;
            }
            let children = [at + 1, node.start].map(|c| (c, self.nodes[c as usize].squared(x)));
            let [near, far] =
                if children[1].1 < children[0].1 { [children[1], children[0]] } else { children };
            stack[waiting] = far;
            stack[waiting + 1] = near;
            waiting += 2;
        }
        best
    }
}

impl Node {
    /// Square of the distance from the box.
    fn squared(&self, x: &[f64; 3]) -> f64 {
        (0..3).map(|k| (self.min[k] - x[k]).max(x[k] - self.max[k]).max(0.0).powi(2)).sum()
    }
}
