//! DC-PSE operators: the discrete moment conditions, the kernel of the paper, and orders.

use meshless_stencils::{DcPse, Monomials};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A support of `count` neighbours in the unit ball, of a radius that is a power of ten.
fn support<const D: usize>(count: usize) -> impl Strategy<Value = (Vec<[f64; D]>, f64)> {
    (prop::collection::vec(prop::array::uniform::<_, D>(-1.0..1.0_f64), count), -3.0..3.0_f64).prop_map(
        |(points, size)| {
            let radius = 10_f64.powf(size);
            (points.iter().map(|x| x.map(|c| radius * c)).collect(), radius)
        },
    )
}

fn coefficients<const D: usize>(
    orders: [u8; D],
    order: usize,
    offsets: &[[f64; D]],
    epsilon: f64,
) -> Vec<f64> {
    let operator = DcPse::<D>::derivative(orders, order);
    let mut out = vec![0.0; offsets.len() + 1];
    operator
        .stencil(offsets, epsilon, &mut operator.scratch(offsets.len()), &mut out)
        .expect("the support determines the operator");
    out
}

fn power<const D: usize>(x: &[f64; D], exponents: &[u8; D]) -> f64 {
    (0..D).map(|k| x[k].powi(i32::from(exponents[k]))).product()
}

/// `D x^alpha = beta! delta_alpha,beta` at 0 for all `|alpha| <= |beta| + m - 1`.
fn moments<const D: usize>(
    orders: [u8; D],
    order: usize,
    support: &(Vec<[f64; D]>, f64),
) -> Result<(), TestCaseError> {
    let (offsets, radius) = support;
    let c = coefficients(orders, order, offsets, 0.5 * radius);
    let total: u8 = orders.iter().sum();
    let factorial: f64 = orders.iter().flat_map(|&b| (1..=b).map(f64::from)).product();
    for alpha in Monomials::<D>::new(usize::from(total) + order - 1).exponents() {
        let scaled = |x: &[f64; D]| power(&x.map(|c| c / radius), alpha);
        let terms: Vec<f64> = (c[1..].iter().zip(offsets).map(|(c, x)| c * scaled(x)))
            .chain([c[0] * scaled(&[0.0; D])])
            .map(|t| t * radius.powi(i32::from(total)))
            .collect();
        let expected = if *alpha == orders { factorial } else { 0.0 };
        let scale = terms.iter().map(|t| t.abs()).sum::<f64>() + expected;
        let defect = (terms.iter().sum::<f64>() - expected).abs();
        prop_assert!(defect <= 1e-10 * scale, "{:?} of {:?}: {:e} of {:e}", alpha, orders, defect, scale);
    }
    Ok(())
}

/// (4.2) to (4.5) as they are written, the powers of eps apart that do not match: the Gram matrix is formed and solved.
fn by_the_kernel<const D: usize>(
    orders: [u8; D],
    order: usize,
    offsets: &[[f64; D]],
    epsilon: f64,
) -> (Vec<f64>, f64) {
    let total: u8 = orders.iter().sum();
    let even = total.is_multiple_of(2);
    let exponents: Vec<[u8; D]> = (Monomials::<D>::new(usize::from(total) + order - 1).exponents().iter())
        .copied()
        .filter(|e| !even || e.iter().any(|&c| c > 0))
        .collect();
    // z = (x - x_p) / eps; the particle itself takes part where the order is odd.
    let mut z: Vec<[f64; D]> = offsets.iter().map(|x| x.map(|c| -c / epsilon)).collect();
    if !even {
        z.insert(0, [0.0; D]);
    }
    let kernel = |z: &[f64; D]| (-z.iter().map(|c| c * c).sum::<f64>()).exp();
    let n = exponents.len();
    let gram = DMatrix::from_fn(n, n, |a, b| {
        z.iter().map(|z| power(z, &exponents[a]) * power(z, &exponents[b]) * kernel(z)).sum()
    });
    let sign = if even { 1.0 } else { -1.0 };
    let factorial: f64 = orders.iter().flat_map(|&b| (1..=b).map(f64::from)).product();
    let rhs = DVector::from_fn(n, |a, _| if exponents[a] == orders { sign * factorial } else { 0.0 });
    let singular = gram.singular_values();
    let condition = singular.max() / singular.min();
    let a = gram.lu().solve(&rhs).expect("a regular Gram matrix");
    let scale = epsilon.powi(-i32::from(total));
    let mut c: Vec<f64> = (z.iter())
        .map(|z| {
            scale * kernel(z) * exponents.iter().zip(a.iter()).map(|(e, a)| a * power(z, e)).sum::<f64>()
        })
        .collect();
    if even {
        c.insert(0, -c.iter().sum::<f64>());
    } else {
        // The point's own value is added in every term, and once as one of the neighbours.
        let sum: f64 = c.iter().sum();
        c[0] += sum;
    }
    (c, condition)
}

fn equals_the_kernel<const D: usize>(
    orders: [u8; D],
    order: usize,
    support: &(Vec<[f64; D]>, f64),
) -> Result<(), TestCaseError> {
    let epsilon = 0.5 * support.1;
    let c = coefficients(orders, order, &support.0, epsilon);
    let (expected, condition) = by_the_kernel(orders, order, &support.0, epsilon);
    let largest = expected.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    let difference = c.iter().zip(&expected).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    // Rounding of the reference: the Gram matrix has the square of the condition that the operator is computed with.
    prop_assert!(
        difference <= 1e-14 * condition * largest,
        "{:?}: {:e} of {:e}",
        orders,
        difference,
        largest
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn operators_fulfil_the_moment_conditions(
        one in support::<1>(12), two in support::<2>(80), three in support::<3>(150),
    ) {
        for order in [2, 4] {
            for orders in [[1], [2]] {
                moments(orders, order, &one)?;
            }
            for orders in [[1, 0], [0, 1], [2, 0], [1, 1], [0, 2]] {
                moments(orders, order, &two)?;
            }
            for orders in [[0, 0, 1], [2, 0, 0], [0, 1, 1]] {
                moments(orders, order, &three)?;
            }
        }
        moments([1, 1], 6, &two)?;
    }

    #[test]
    fn operators_are_those_of_the_kernel_of_the_paper(
        one in support::<1>(9), two in support::<2>(40), three in support::<3>(60),
    ) {
        for orders in [[1], [2]] {
            equals_the_kernel(orders, 2, &one)?;
        }
        for orders in [[1, 0], [2, 0], [1, 1]] {
            equals_the_kernel(orders, 2, &two)?;
        }
        for orders in [[0, 1, 0], [0, 2, 0], [1, 0, 1]] {
            equals_the_kernel(orders, 2, &three)?;
        }
    }
}
