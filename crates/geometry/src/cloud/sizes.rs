//! Spacings that are asked for at some places and grow with the distance from them.

use crate::vector::{distance, distance_squared};

/// By how much the spacing grows on a way of length 1: half of what [`Spacing`](super::Spacing) allows.
const GROWTH: f64 = 0.25;

/// How far from a place its spacing is asked for, in units of it: what is asked for along a surface, at places as far apart as nodes
/// are, is asked for between them, too.
const FLAT: f64 = 1.0;

/// Places of a leaf at most.
const LEAF: usize = 4;

/// A spacing that is asked for at a place, and within a distance of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size<const D: usize> {
    /// Where.
    pub at: [f64; D],
    /// The spacing, positive.
    pub spacing: f64,
    /// How far round it the spacing does not grow yet.
    pub within: f64,
}

impl<const D: usize> Size<D> {
    /// At a place, and as far round it as nodes are apart.
    pub fn at(at: [f64; D], spacing: f64) -> Self {
        Self { at, spacing, within: FLAT * spacing }
    }

    /// What is asked for at a distance; it increases with that.
    fn grown(&self, distance: f64) -> f64 {
        grown(self.spacing, self.within, distance)
    }
}

/// The largest spacing that is nowhere larger than asked for and grows by [`GROWTH`]: boxes about places, halved at the median
/// along the longest side, each with the least spacing in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sizes<const D: usize> {
    places: Vec<Size<D>>,
    boxes: Vec<Node<D>>,
}

#[derive(Clone, Copy, Debug)]
struct Node<const D: usize> {
    min: [f64; D],
    max: [f64; D],
    /// The least spacing, and the largest distance within which one does not grow.
    least: f64,
    within: f64,
    /// Of a leaf the first of its places, of others their second child; the first one comes next.
    start: u32,
    /// Places of a leaf; 0 for others.
    count: u32,
}

impl<const D: usize> Sizes<D> {
    pub(crate) fn new(mut places: Vec<Size<D>>) -> Self {
        let mut boxes = Vec::new();
        if !places.is_empty() {
            divide(&mut boxes, &mut places, 0);
        }
        Self { places, boxes }
    }

    /// The spacing at `x`, at most `largest`.
    pub(crate) fn at(&self, x: &[f64; D], largest: f64) -> f64 {
        if self.boxes.is_empty() { largest } else { self.below(0, x, largest) }
    }

    fn below(&self, at: usize, x: &[f64; D], best: f64) -> f64 {
        let node = &self.boxes[at];
        if grown(node.least, node.within, node.squared(x).sqrt()) >= best {
            return best;
        }
        if node.count > 0 {
            let places = &self.places[node.start as usize..(node.start + node.count) as usize];
            return places.iter().fold(best, |best, size| best.min(size.grown(distance(x, &size.at))));
        }
        // The child that may ask for less first: then the other one seldom can.
        let mut children = [at + 1, node.start as usize].map(|child| {
            let node = &self.boxes[child];
            (grown(node.least, node.within, node.squared(x).sqrt()), child)
        });
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        children.iter().fold(
            best,
            |best, &(least, child)| {
                if least >= best { best } else { self.below(child, x, best) }
            },
        )
    }

    /// The nearest place and what is asked for there.
    pub(crate) fn nearest(&self, x: &[f64; D]) -> Option<Size<D>> {
        let mut best = (f64::INFINITY, None);
        if !self.boxes.is_empty() {
            self.nearer(0, x, &mut best);
        }
        best.1
    }

    fn nearer(&self, at: usize, x: &[f64; D], best: &mut (f64, Option<Size<D>>)) {
        let node = &self.boxes[at];
        if node.count > 0 {
            for place in &self.places[node.start as usize..(node.start + node.count) as usize] {
                let squared = distance_squared(x, &place.at);
                if squared < best.0 {
                    *best = (squared, Some(*place));
                }
            }
            return;
        }
        let mut children = [at + 1, node.start as usize].map(|c| (self.boxes[c].squared(x), c));
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (squared, child) in children {
            if squared < best.0 {
                self.nearer(child, x, best);
            }
        }
    }
}

impl<const D: usize> Node<D> {
    /// Square of the distance from the box.
    fn squared(&self, x: &[f64; D]) -> f64 {
        (0..D).map(|k| (self.min[k] - x[k]).max(x[k] - self.max[k]).max(0.0).powi(2)).sum()
    }
}

/// The spacing at a distance from where one is asked for.
fn grown(spacing: f64, within: f64, distance: f64) -> f64 {
    spacing + GROWTH * (distance - within).max(0.0)
}

fn divide<const D: usize>(boxes: &mut Vec<Node<D>>, places: &mut [Size<D>], first: u32) {
    let (mut min, mut max) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    let (mut least, mut within) = (f64::INFINITY, 0.0_f64);
    for size in places.iter() {
        for k in 0..D {
            min[k] = min[k].min(size.at[k]);
            max[k] = max[k].max(size.at[k]);
        }
        least = least.min(size.spacing);
        within = within.max(size.within);
    }
    let own = boxes.len();
    let count = if places.len() <= LEAF { places.len() as u32 } else { 0 };
    boxes.push(Node { min, max, least, within, start: first, count });
    if count > 0 {
        return;
    }
    let width = |k: usize| max[k] - min[k];
    let axis = (0..D).fold(0, |best, k| if width(k) > width(best) { k } else { best });
    let half = places.len() / 2;
    places.select_nth_unstable_by(half, |a, b| a.at[axis].total_cmp(&b.at[axis]));
    let (left, right) = places.split_at_mut(half);
    divide(boxes, left, first);
    boxes[own].start = boxes.len() as u32;
    divide(boxes, right, first + half as u32);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_least_of_all() {
        let mut random = Random::new(3);
        let mut point = || [random.symmetric(), random.symmetric()];
        let place = |k: u32| Size {
            within: 0.003 * f64::from(k % 13),
            ..Size::at(point(), 0.01 + 0.001 * f64::from(k % 17))
        };
        let places: Vec<Size<2>> = (0..200).map(place).collect();
        let sizes = Sizes::new(places.clone());
        for _ in 0..100 {
            let x = point();
            let all = places.iter().map(|size| size.grown(distance(&x, &size.at)));
            assert_eq!(sizes.at(&x, 0.05), all.fold(0.05, f64::min));
            let nearest = places.iter().map(|p| distance(&x, &p.at)).fold(f64::INFINITY, f64::min);
            assert_eq!(sizes.nearest(&x).map(|p| distance(&x, &p.at)), Some(nearest));
        }
        assert_eq!(Sizes::<2>::default().at(&[0.0, 0.0], 0.05), 0.05);
    }
}
