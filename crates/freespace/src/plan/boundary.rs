//! What the faces of the box are: open to free space, mirrors, or joined to each other.

use crate::mesh::Centring;

use super::axis::fast_length;

/// What is at a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Free space goes on.
    Open,
    /// A mirror: phi is even, its normal derivative vanishes.
    Even,
    /// A mirror with the opposite sign: phi is odd and vanishes.
    Odd,
}

/// What holds in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boundary {
    /// The faces are joined. With nodes at the faces, the last ones are the first ones again, and their values are not
    /// looked at.
    Periodic,
    /// Each face on its own.
    Faces {
        /// At the smaller coordinate.
        lower: Face,
        /// At the larger one.
        upper: Face,
    },
}

impl Boundary {
    /// Free space on both sides.
    pub const OPEN: Self = Self::Faces { lower: Face::Open, upper: Face::Open };
    /// Mirrors on both sides.
    pub const EVEN: Self = Self::Faces { lower: Face::Even, upper: Face::Even };
    /// Zero on both sides.
    pub const ODD: Self = Self::Faces { lower: Face::Odd, upper: Face::Odd };
}

/// How a line of values is continued before it is transformed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Continuation {
    /// Length of the transform.
    pub(super) len: usize,
    /// Values that are taken as they are.
    pub(super) own: usize,
    /// Images: place in the line, index of the value, sign. They come after the values themselves and may replace them.
    pub(super) images: Vec<(usize, usize, f64)>,
    /// Cells that source and images span where the direction is open; `None` where the line is a period.
    pub(super) open_span: Option<usize>,
}

impl Continuation {
    /// A direction that does not exist.
    pub(super) fn trivial() -> Self {
        Self { len: 1, own: 1, images: Vec::new(), open_span: None }
    }

    /// A direction of `n` points.
    pub(super) fn new(boundary: Boundary, n: usize, centring: Centring) -> Self {
        let (lower, upper) = match boundary {
            Boundary::Periodic => {
                let len = if centring == Centring::Node { n.max(2) - 1 } else { n };
                return Self { len, own: len, images: Vec::new(), open_span: None };
            }
            Boundary::Faces { lower, upper } => (lower, upper),
        };
        // Mirrored at the lower face, the value at i lies at `-i - gap`, at the upper one at `2 n - i - 2 + gap`.
        let gap = usize::from(centring == Centring::Cell);
        let (low, high) = (sign(lower), sign(upper));
        let span = 2 * (n - 1 + gap);
        let (len, open_span) = match (low, high) {
            (None, None) => (fast_length(2 * n), Some(n)),
            (Some(a), Some(b)) if a == b => (span.max(1), None),
            (Some(_), Some(_)) => ((2 * span).max(1), None),
            _ => (fast_length(4 * n), Some(2 * n)),
        };
        let mut images = Vec::new();
        let mirrored = if low.is_none() && high.is_none() { 0 } else { n };
        for i in 0..mirrored {
            let below = (2 * len - i - gap) % len;
            let above = (span - i) - gap;
            if let Some(sign) = low {
                images.push((below, i, sign));
            }
            if let Some(sign) = high {
                images.push((above % len, i, sign));
            }
            if let (Some(a), Some(b)) = (low, high)
                && a != b
            {
                images.push(((span + i) % len, i, a * b));
            }
        }
        if centring == Centring::Node {
            // Points on a mirror are their own images; where the field is odd, nothing can be there.
            images.retain(|&(place, i, _)| place != i);
            for (face, i) in [(low, 0), (high, n - 1)] {
                if face == Some(-1.0) {
                    images.retain(|image| image.1 != i);
                    images.push((i, i, 0.0));
                }
            }
        }
        Self { len, own: n, images, open_span }
    }

    /// How often each value counts in the line, images with their signs.
    pub(super) fn weights(&self, n: usize) -> Vec<f64> {
        let mut line = vec![None; self.len];
        (0..self.own).for_each(|i| line[i] = Some((i, 1.0)));
        self.images.iter().for_each(|&(place, i, sign)| line[place] = Some((i, sign)));
        let mut weights = vec![0.0; n];
        line.into_iter().flatten().for_each(|(i, sign): (usize, f64)| weights[i] += sign);
        weights
    }
}

/// The sign of the image in a mirror.
fn sign(face: Face) -> Option<f64> {
    match face {
        Face::Open => None,
        Face::Even => Some(1.0),
        Face::Odd => Some(-1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::{Boundary, Continuation, Face};
    use crate::mesh::Centring;

    /// The line that values 1, 2, 3 become.
    fn line(lower: Face, upper: Face, centring: Centring) -> Vec<f64> {
        let continuation = Continuation::new(Boundary::Faces { lower, upper }, 3, centring);
        let mut line = vec![0.0; continuation.len];
        line[..3].copy_from_slice(&[1.0, 2.0, 3.0]);
        continuation.images.iter().for_each(|&(place, i, sign)| line[place] = sign * [1.0, 2.0, 3.0][i]);
        line
    }

    #[test]
    fn mirrors_continue_lines() {
        use Face::{Even, Odd, Open};
        let cell = |lower, upper| line(lower, upper, Centring::Cell);
        assert_eq!(cell(Even, Even), [1., 2., 3., 3., 2., 1.]);
        assert_eq!(cell(Odd, Odd), [1., 2., 3., -3., -2., -1.]);
        assert_eq!(cell(Even, Odd), [1., 2., 3., -3., -2., -1., -1., -2., -3., 3., 2., 1.]);
        assert_eq!(cell(Open, Odd), [1., 2., 3., -3., -2., -1., 0., 0., 0., 0., 0., 0.]);
        assert_eq!(cell(Even, Open), [1., 2., 3., 0., 0., 0., 0., 0., 0., 3., 2., 1.]);
        let node = |lower, upper| line(lower, upper, Centring::Node);
        assert_eq!(node(Even, Even), [1., 2., 3., 2.]);
        assert_eq!(node(Odd, Odd), [0., 2., 0., -2.]);
        assert_eq!(node(Even, Odd), [1., 2., 0., -2., -1., -2., 0., 2.]);
        assert_eq!(node(Open, Even), [1., 2., 3., 2., 1., 0., 0., 0., 0., 0., 0., 0.]);
    }
}
