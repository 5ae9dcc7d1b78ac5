//! What a stencil looks like: figures that tell good nodes from bad ones.

/// Figures about the row of an operator at a node, given off the diagonal; the diagonal is minus their sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StencilDiagnosis {
    /// Largest wrong-sign (negative) coefficient relative to the diagonal.
    pub wrong_sign: f64,
    /// The diagonal-dominance error (23) of Kraus et al. (2022); infinite where the diagonal has the wrong sign.
    pub dominance_error: f64,
}

/// Diagnoses the coefficients of a Laplacian-like operator on the neighbours of a node.
///
/// ```
/// let good = meshless_stencils::diagnose(&[1.0, 1.0, 1.0, 1.0]);
/// assert_eq!((good.wrong_sign, good.dominance_error), (0.0, 0.0));
/// assert!(meshless_stencils::diagnose(&[2.0, 2.0, -0.5]).dominance_error > 0.2);
/// ```
pub fn diagnose(row: &[f64]) -> StencilDiagnosis {
    let (mut sum, mut absolute, mut lowest) = (0.0, 0.0, 0.0_f64);
    for &c in row {
        sum += c;
        absolute += c.abs();
        lowest = lowest.min(c);
    }
    if sum <= 0.0 {
        return StencilDiagnosis { wrong_sign: f64::INFINITY, dominance_error: f64::INFINITY };
    }
    StencilDiagnosis { wrong_sign: -lowest / sum, dominance_error: (absolute / sum - 1.0).max(0.0) }
}
