//! An orthonormal frame whose first axis is a given normal.

/// A reflection, or minus one, that swaps the first axis and a unit vector: orthonormal, symmetric, its own inverse.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<const D: usize> {
    /// Unit vector along the sum or the difference of the two, whichever is longer: the other may be round-off.
    mirror: [f64; D],
    sign: f64,
}

impl<const D: usize> Frame<D> {
    /// The frame of a unit normal.
    pub(super) fn new(normal: &[f64; D]) -> Self {
        let sign = if normal[0] > 0.0 { -1.0 } else { 1.0 };
        let mut mirror = *normal;
        mirror[0] -= sign;
        let length = mirror.iter().map(|m| m * m).sum::<f64>().sqrt();
        Self { mirror: mirror.map(|m| m / length), sign }
    }

    /// The components of a vector; and of components the vector.
    pub(super) fn turn(&self, v: &[f64; D]) -> [f64; D] {
        let along = 2.0 * (0..D).map(|k| self.mirror[k] * v[k]).sum::<f64>();
        std::array::from_fn(|k| self.sign * (v[k] - along * self.mirror[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::Frame;

    #[test]
    fn the_normal_becomes_the_first_axis_and_lengths_stay() {
        for normal in
            [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.48, -0.6, 0.64], [1.0, 1e-17, 0.0], [1e-17, 0.0, 1.0]]
        {
            let frame = Frame::new(&normal);
            let turned = frame.turn(&normal);
            assert!((turned[0] - 1.0).abs() < 1e-15 && turned[1].hypot(turned[2]) < 1e-15, "{turned:?}");
            let v = [0.3, -2.0, 1.1];
            let back = frame.turn(&frame.turn(&v));
            assert!(v.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-15));
        }
    }
}
