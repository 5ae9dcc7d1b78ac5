//! What every stencil must satisfy, on random supports.

mod common;

use common::{Support, exact, reference, support, weighted_moments};
use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit, Monomials, StencilError};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn factored<const D: usize>(support: &Support<D>, degree: usize) -> (LocalFit<D>, FitScratch<D>) {
    let fit = LocalFit::<D>::new(FitParams { degree, ..FitParams::default() });
    let mut scratch = fit.scratch(0);
    let outcome = fit
        .factor(&support.offsets, &support.weights, support.radius, &mut scratch)
        .expect("a valid support");
    assert!(!outcome.pivoted && outcome.rank == fit.monomials().count(), "{outcome:?}");
    (fit, scratch)
}

fn stencil<const D: usize>(
    support: &Support<D>,
    degree: usize,
    functional: &Functional<D>,
) -> Result<Vec<f64>, StencilError> {
    let (fit, mut scratch) = factored(support, degree);
    let mut out = vec![0.0; support.offsets.len()];
    fit.coefficients(functional, &mut scratch, &mut out)?;
    Ok(out)
}

fn all_of_order<const D: usize>(degree: usize, radius: f64) -> Vec<Functional<D>> {
    let vector = std::array::from_fn(|k| 0.3 + k as f64);
    let gradient = vector.map(|v: f64| v / radius);
    let mut all = vec![Functional::Value, Functional::ValueAt(vector.map(|v| 0.1 * v * radius))];
    if degree >= 1 {
        all.extend([Functional::Partial(D - 1), Functional::Directional(vector)]);
    }
    if degree >= 2 {
        all.extend([
            Functional::Laplacian,
            Functional::Diffusion { eta: 2.5, gradient },
            Functional::Second(0, D - 1),
        ]);
    }
    all.push(Functional::Derivative(std::array::from_fn(|k| if k == 0 { degree as u8 } else { 0 })));
    all
}

/// Stencils applied to every monomial give the exact value.
fn reproduces<const D: usize>(support: &Support<D>, degree: usize) -> Result<(), TestCaseError> {
    for functional in all_of_order(degree, support.radius) {
        let c = stencil(support, degree, &functional).expect("a stencil");
        for exponents in Monomials::<D>::new(degree).exponents() {
            let monomial = |x: &[f64; D]| (0..D).map(|k| x[k].powi(i32::from(exponents[k]))).product::<f64>();
            let terms = || support.offsets.iter().zip(&c).map(|(x, c)| c * monomial(x));
            let value = exact(&functional, exponents);
            let scale = value.abs() + terms().map(f64::abs).sum::<f64>();
            prop_assert!(
                (terms().sum::<f64>() - value).abs() <= 1e-11 * scale,
                "{:?} {:?}",
                functional,
                exponents
            );
        }
    }
    Ok(())
}

/// Coefficients agree with the definition, to round-off times the condition of the support.
fn equals_reference<const D: usize>(support: &Support<D>, degree: usize) -> Result<(), TestCaseError> {
    for functional in all_of_order(degree, support.radius) {
        let c = stencil(support, degree, &functional).expect("a stencil");
        let (expected, condition) = reference(support, degree, &functional);
        let difference = (DVector::from_vec(c) - &expected).amax();
        prop_assert!(difference <= 1e-13 * condition * expected.amax(), "{:?}: {}", functional, difference);
    }
    Ok(())
}

/// Removes from v what the columns of a span.
fn out_of_span(a: &DMatrix<f64>, v: DVector<f64>) -> DVector<f64> {
    let q = a.clone().qr().q();
    // Twice is enough.
    let once = &v - &q * (q.transpose() * &v);
    &once - &q * (q.transpose() * &once)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn polynomials_are_reproduced_1d((degree, support) in (0..9_usize).prop_flat_map(|d| (Just(d), support::<1>(d, 1.5)))) {
        reproduces(&support, degree)?;
    }

    #[test]
    fn polynomials_are_reproduced_2d((degree, support) in (0..7_usize).prop_flat_map(|d| (Just(d), support::<2>(d, 1.5)))) {
        reproduces(&support, degree)?;
    }

    #[test]
    fn polynomials_are_reproduced_3d((degree, support) in (0..5_usize).prop_flat_map(|d| (Just(d), support::<3>(d, 1.5)))) {
        reproduces(&support, degree)?;
    }

    #[test]
    fn coefficients_equal_the_pseudo_inverse_1d((degree, support) in (0..6_usize).prop_flat_map(|d| (Just(d), support::<1>(d, 2.0)))) {
        equals_reference(&support, degree)?;
    }

    #[test]
    fn coefficients_equal_the_pseudo_inverse_2d((degree, support) in (0..5_usize).prop_flat_map(|d| (Just(d), support::<2>(d, 2.0)))) {
        equals_reference(&support, degree)?;
    }

    #[test]
    fn coefficients_equal_the_pseudo_inverse_3d((degree, support) in (0..4_usize).prop_flat_map(|d| (Just(d), support::<3>(d, 2.0)))) {
        equals_reference(&support, degree)?;
    }

    #[test]
    fn the_norm_is_least(support in support::<2>(2, 2.0), noise in prop::collection::vec(-1.0..1.0_f64, 15)) {
        let c = stencil(&support, 2, &Functional::Laplacian).unwrap();
        // In terms of y = c / w the norm is Euclidean; a change that keeps reproduction is normal to W K^T.
        let y = DVector::from_iterator(c.len(), c.iter().zip(&support.weights).map(|(c, w)| c / w));
        let change = out_of_span(&weighted_moments(&support, 2), DVector::from_vec(noise[..c.len()].to_vec()));
        prop_assume!(change.norm() > 1e-3);
        prop_assert!(y.dot(&change).abs() <= 1e-10 * y.norm() * change.norm());
        for step in [-1.0, 1e-2, 1.0] {
            let changed = &y + step * y.norm() / change.norm() * &change;
            prop_assert!(changed.norm() > y.norm());
        }
    }

    #[test]
    fn the_correction_is_the_least_of_its_kind(support in support::<2>(2, 2.0), centre in 0..10_usize, noise in prop::collection::vec(-1.0..1.0_f64, 15)) {
        let (fit, mut scratch) = factored(&support, 2);
        let n = support.offsets.len();
        let mut xi = vec![0.0; n];
        fit.correction(centre, &mut scratch, &mut xi).unwrap();
        prop_assert_eq!(xi[centre], 1.0);
        let a = weighted_moments(&support, 2);
        let y = DVector::from_iterator(n, xi.iter().zip(&support.weights).map(|(c, w)| c / w));
        prop_assert!((a.transpose() * &y).amax() <= 1e-12 * y.norm(), "in the null space of the test functions");
        // Changes within that space that leave the entry of the centre alone are normal to it.
        let mut with_centre = a.clone().insert_column(a.ncols(), 0.0);
        with_centre[(centre, a.ncols())] = 1.0;
        let change = out_of_span(&with_centre, DVector::from_vec(noise[..n].to_vec()));
        prop_assume!(change.norm() > 1e-3);
        prop_assert!(y.dot(&change).abs() <= 1e-9 * y.norm() * change.norm());
    }

    #[test]
    fn coefficients_do_not_depend_on_the_frame(support in support::<2>(3, 2.0), angle in 0.0..6.3_f64, scale in 0.1..10.0_f64) {
        let c = stencil(&support, 3, &Functional::Laplacian).unwrap();
        let (sin, cos) = angle.sin_cos();
        let mut moved = support.clone();
        moved.offsets.iter_mut().for_each(|x| *x = [scale * (cos * x[0] - sin * x[1]), scale * (sin * x[0] + cos * x[1])]);
        moved.radius *= scale;
        let of_moved = stencil(&moved, 3, &Functional::Laplacian).unwrap();
        let (_, condition) = reference(&support, 3, &Functional::Laplacian);
        let largest = c.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        for (c, d) in c.iter().zip(&of_moved) {
            prop_assert!((c - d * scale * scale).abs() <= 1e-13 * condition * largest);
        }
    }

    #[test]
    fn renumbering_points_renumbers_coefficients(
        (support, order) in support::<3>(2, 1.5).prop_flat_map(|s| {
            let order: Vec<usize> = (0..s.offsets.len()).collect();
            (Just(s), Just(order).prop_shuffle())
        }),
    ) {
        let c = stencil(&support, 2, &Functional::Laplacian).unwrap();
        let renumbered = Support {
            offsets: order.iter().map(|&j| support.offsets[j]).collect(),
            weights: order.iter().map(|&j| support.weights[j]).collect(),
            radius: support.radius,
        };
        let d = stencil(&renumbered, 2, &Functional::Laplacian).unwrap();
        let (_, condition) = reference(&support, 2, &Functional::Laplacian);
        let largest = c.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        for (new, &old) in order.iter().enumerate() {
            prop_assert!((d[new] - c[old]).abs() <= 1e-13 * condition * largest);
        }
    }

    #[test]
    fn the_diagnosis_sees_what_is_wrong(support in support::<2>(2, 1.5), entry in 1..9_usize) {
        let (fit, mut scratch) = factored(&support, 2);
        let mut c = vec![0.0; support.offsets.len()];
        fit.coefficients(&Functional::Laplacian, &mut scratch, &mut c).unwrap();
        let sound = fit.diagnose(&Functional::Laplacian, &support.offsets, 0, &c, &mut scratch).unwrap();
        prop_assert!(sound.residual < 1e-11);
        let largest = c.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        c[entry] += 1e-3 * largest;
        let wrong = fit.diagnose(&Functional::Laplacian, &support.offsets, 0, &c, &mut scratch).unwrap();
        prop_assert!(wrong.residual > 1e-6);
    }
}
