//! Values of a coarse mesh at the points of finer ones, where a shift in Fourier space finds them.

use crate::mesh::Mesh;

/// Where the points of the meshes `fine` lie in the cells of `coarse`, in its spacings from its points, in lists that are worth a solve each: all
/// places that differ in the first directions, where they are cheap, and agree in the third.
pub(super) fn places<const D: usize>(coarse: &Mesh<D>, fine: &[&Mesh<D>]) -> Vec<Vec<[f64; D]>> {
    let mut lists = vec![vec![[0.0; D]]];
    for axis in 0..D {
        let along = along(coarse, fine, axis);
        if axis == 2 {
            let list = lists.concat();
            let at = |shift: &f64| list.iter().map(|place| with(*place, axis, *shift)).collect();
            lists = along.iter().map(at).collect();
        } else {
            let list = lists.concat();
            lists =
                vec![along.iter().flat_map(|s| list.iter().map(|place| with(*place, axis, *s))).collect()];
        }
    }
    lists
}

fn with<const D: usize>(mut place: [f64; D], axis: usize, shift: f64) -> [f64; D] {
    place[axis] = shift;
    place
}

/// The different shifts in a direction.
fn along<const D: usize>(coarse: &Mesh<D>, fine: &[&Mesh<D>], axis: usize) -> Vec<f64> {
    let mut shifts: Vec<f64> = Vec::new();
    for mesh in fine {
        let at = mesh.places_in(coarse);
        for i in 0..mesh.points()[axis] {
            let (_, shift) = split(at(axis, i));
            if !shifts.iter().any(|known| alike(*known, shift)) {
                shifts.push(shift);
            }
        }
    }
    shifts
}

/// The nearest point, and how far beyond it; a half is nearer to the point above it.
fn split(place: f64) -> (usize, f64) {
    let near = (place + 0.5).floor();
    (near.max(0.0) as usize, place - near)
}

/// Round-off must not make two shifts of one.
fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// The points of a fine mesh that lie alike in the cells of a coarse one.
pub(super) struct Shifted<const D: usize> {
    /// Indices of such points in each direction, and those of the nearest points of the coarse mesh.
    pairs: [Vec<(usize, usize)>; D],
    coarse: Mesh<D>,
    fine: Mesh<D>,
}

impl<const D: usize> Shifted<D> {
    /// The points that are `shift` spacings of `coarse` beyond its points.
    pub(super) fn new(coarse: &Mesh<D>, fine: &Mesh<D>, shift: [f64; D]) -> Self {
        let at = fine.places_in(coarse);
        let pairs = std::array::from_fn(|axis| {
            let all = (0..fine.points()[axis]).map(|i| (i, split(at(axis, i))));
            let these = all.filter(|(_, (_, s))| alike(*s, shift[axis]));
            these.map(|(i, (near, _))| (i, near)).collect()
        });
        Self { pairs, coarse: *coarse, fine: *fine }
    }

    /// Adds what was found with this shift at the points of the coarse mesh.
    pub(super) fn add(&self, field: &[f64], total: &mut [f64]) {
        let rows: usize = self.pairs[1..].iter().map(Vec::len).product();
        for row in 0..rows {
            let (mut rest, mut from, mut to) = (row, [0; D], [0; D]);
            for axis in 1..D {
                let pairs = &self.pairs[axis];
                (to[axis], from[axis]) = pairs[rest % pairs.len()];
                rest /= pairs.len();
            }
            let (from, to) = (self.coarse.index(from), self.fine.index(to));
            self.pairs[0].iter().for_each(|(i, near)| total[to + i] += field[from + near]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Shifted, places};
    use crate::mesh::{Centring, Mesh};

    #[test]
    fn every_point_lies_at_one_of_the_places() -> Result<(), crate::error::FreeSpaceError> {
        for centring in [Centring::Cell, Centring::Node] {
            for ratio in [2, 3, 4, 6, 9] {
                let coarse = Mesh::new([0.3; 3], [0.1, 0.2, 0.3], [7, 8, 9], centring)?;
                let h = coarse.spacing();
                let min = std::array::from_fn(|a| coarse.min()[a] + (2.0 + 1.0 / ratio as f64) * h[a]);
                let fine = Mesh::new(min, h.map(|h| h / ratio as f64), [8, 7, 10], centring)?;
                let lists = places(&coarse, &[&fine]);
                assert!(lists.len() <= ratio && lists.concat().len() <= ratio.pow(3));
                // A linear field, moved by a shift, is known at every point.
                let linear = |p: [f64; 3]| p[0] + 2.0 * p[1] - 0.5 * p[2];
                let mut total = vec![0.0; fine.len()];
                for place in lists.concat() {
                    let moved = |p: [f64; 3]| linear(std::array::from_fn(|a| p[a] + place[a] * h[a]));
                    Shifted::new(&coarse, &fine, place).add(&coarse.sample(moved), &mut total);
                }
                let exact = fine.sample(linear);
                assert!(total.iter().zip(&exact).all(|(t, e)| (t - e).abs() < 1e-9), "{ratio}");
            }
        }
        Ok(())
    }
}
