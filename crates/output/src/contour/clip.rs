//! Clipping a convex polygon where a linear function is positive.

use super::Vertex;

/// Linear functions on a polygon's corners: the corner itself, or one with more values.
pub(super) trait Corner: Copy {
    /// Position, which decides from which end an edge is divided.
    fn at(&self) -> [f64; 2];
    /// The point a fraction `t` of the way to `other`.
    fn toward(&self, other: &Self, t: f64) -> Self;
}

impl Corner for Vertex {
    fn at(&self) -> [f64; 2] {
        self.at
    }

    fn toward(&self, other: &Self, t: f64) -> Self {
        Self { at: mix2(self.at, other.at, t), value: mix(self.value, other.value, t) }
    }
}

pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + t * (b - a)
}

pub(super) fn mix2(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [mix(a[0], b[0], t), mix(a[1], b[1], t)]
}

/// Which side corners of height zero belong to. What is left on both sides of a level adds up to the whole, even where
/// an edge lies at the level, if they belong to one of the two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Zero {
    Kept,
    Cut,
}

/// Keeps the part of `polygon` where `height`, linear on its edges, is negative.
pub(super) fn clip<C: Corner>(
    polygon: &mut Vec<C>,
    scratch: &mut Vec<C>,
    zero: Zero,
    height: impl Fn(&C) -> f64,
) {
    let kept = |h: f64| h < 0.0 || (h == 0.0 && zero == Zero::Kept);
    scratch.clear();
    for (k, corner) in polygon.iter().enumerate() {
        let after = &polygon[(k + 1) % polygon.len()];
        let (h, h_after) = (height(corner), height(after));
        if kept(h) {
            scratch.push(*corner);
        }
        if kept(h) != kept(h_after) {
            scratch.push(crossing(corner, after, h, h_after));
        }
    }
    std::mem::swap(polygon, scratch);
}

/// Where the height vanishes on an edge: the same point, bit by bit, whichever end comes first.
pub(super) fn crossing<C: Corner>(a: &C, b: &C, h_a: f64, h_b: f64) -> C {
    if h_a == 0.0 {
        return *a;
    }
    if h_b == 0.0 {
        return *b;
    }
    if a.at() < b.at() { a.toward(b, h_a / (h_a - h_b)) } else { b.toward(a, h_b / (h_b - h_a)) }
}
