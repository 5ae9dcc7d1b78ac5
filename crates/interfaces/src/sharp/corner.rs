//! Corners and edges of interfaces, where a jump of the flux has as many values as pieces of the interface meet.

use crate::Problem;

/// How far beside a corner its pieces are looked for, in spacings.
const BESIDE: f64 = 1e-5;

/// How far round a place beside a corner the normal has to stay the same, over the distance from the corner.
const ROUND: f64 = 0.02;

/// Least distance of such a place from the corner, over that of where it was looked for: what is nearer is the corner again.
const APART: f64 = 0.1;

/// How far feet are looked for, over how far beside the corner: the two sides of a foot are told apart at 1e-4 of that, so that they are
/// right down to APART beside the corner of a sector of a few degrees, and far more than the rounding of coordinates apart.
const REACH: f64 = 40.0;

/// Cosine of the angle between two normals from which on they belong to one smooth piece.
const SMOOTH: f64 = 0.999;

/// A place on an interface, and the unit normal there.
pub(super) type Foot<const D: usize> = ([f64; D], [f64; D]);

/// The interface between two regions near one of its points.
pub(super) struct Corner<'a, const D: usize> {
    pub(super) problem: &'a Problem<'a, D>,
    pub(super) labels: [u16; 2],
    pub(super) at: [f64; D],
    pub(super) normal: [f64; D],
    pub(super) spacing: f64,
}

impl<const D: usize> Corner<'_, D> {
    /// One place on every smooth piece of the interface that meets others in the point, right beside it; none where the interface
    /// is smooth.
    ///
    /// The normal of a corner is that of one of its pieces or one in between, and the jump of the flux that a scene gives for the
    /// point is that of one of them, too, but any.
    pub(super) fn pieces(&self) -> Vec<Foot<D>> {
        let step = BESIDE * self.spacing;
        let reach = REACH * step;
        let around = || directions(&self.normal).filter_map(|d| self.foot(&self.at, &d, step, reach));
        let mut pieces: Vec<Foot<D>> = Vec::new();
        if D == 1 || around().all(|(_, normal)| same(&normal, &self.normal)) {
            return pieces;
        }
        for (at, normal) in around() {
            let known = pieces.iter().any(|(_, other)| same(other, &normal));
            if !known
                && apart(&at, &self.at) > APART * step
                && self.is_smooth(&at, &normal, ROUND * step, reach)
            {
                pieces.push((at, normal));
            }
        }
        pieces
    }

    /// Whether the interface has one normal all round a point.
    fn is_smooth(&self, at: &[f64; D], normal: &[f64; D], step: f64, reach: f64) -> bool {
        directions(normal)
            .all(|d| self.foot(at, &d, step, reach).is_some_and(|(_, other)| same(&other, normal)))
    }

    /// The foot of a point beside another one, within a reach.
    fn foot(&self, at: &[f64; D], direction: &[f64; D], step: f64, reach: f64) -> Option<Foot<D>> {
        let x = std::array::from_fn(|k| at[k] + step * direction[k]);
        let [a, b] = self.labels;
        let foot = self.problem.regions.project_within(self.problem.domain, a, b, &x, reach).ok()?;
        Some((foot.point, foot.normal))
    }
}

fn same<const D: usize>(a: &[f64; D], b: &[f64; D]) -> bool {
    (0..D).map(|k| a[k] * b[k]).sum::<f64>() > SMOOTH
}

fn apart<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// All sums of a unit normal and of unit vectors normal to it and to each other, each added, left out or subtracted.
fn directions<const D: usize>(normal: &[f64; D]) -> impl Iterator<Item = [f64; D]> + use<D> {
    let frame = frame(normal);
    (0..3_usize.pow(D as u32)).map(move |code| {
        let mut sum = [0.0; D];
        let mut digits = code;
        for axis in &frame {
            let sign = (digits % 3) as f64 - 1.0;
            digits /= 3;
            (0..D).for_each(|k| sum[k] += sign * axis[k]);
        }
        sum
    })
}

/// An orthonormal frame that begins with a unit vector: the images of the axes in the reflection that exchanges the first one for it.
fn frame<const D: usize>(first: &[f64; D]) -> [[f64; D]; D] {
    let sign = if first[0] < 0.0 { 1.0 } else { -1.0 };
    let mut v = *first;
    v[0] -= sign;
    let square: f64 = v.iter().map(|x| x * x).sum();
    std::array::from_fn(|axis| {
        std::array::from_fn(|k| {
            let image = f64::from(u8::from(axis == k)) - 2.0 * v[axis] * v[k] / square;
            if axis == 0 { sign * image } else { image }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{directions, frame};

    #[test]
    fn frames_are_orthonormal_and_begin_with_the_normal() {
        for normal in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.6, -0.8], [-0.36, 0.48, 0.8]] {
            let frame = frame(&normal);
            for (i, a) in frame.iter().enumerate() {
                assert!((frame[0][i] - normal[i]).abs() < 1e-15);
                for (j, b) in frame.iter().enumerate() {
                    let product: f64 = (0..3).map(|k| a[k] * b[k]).sum();
                    assert!((product - f64::from(u8::from(i == j))).abs() < 1e-15, "{frame:?}");
                }
            }
        }
        assert_eq!(directions(&[0.6, 0.8]).count(), 9);
    }
}
