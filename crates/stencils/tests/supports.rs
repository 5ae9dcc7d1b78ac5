//! Particular supports: lattices, lines, too few points; the order of accuracy; stencils of a whole cloud.

use meshless_stencils::{
    FitParams, FitScratch, Functional, LocalFit, StencilError, StencilSet, Weight, build_stencils,
};

fn lattice(reach: i32) -> Vec<[f64; 2]> {
    let side = 2 * reach + 1;
    (0..side * side).map(|i| [f64::from(i % side - reach), f64::from(i / side - reach)]).collect()
}

fn fit<const D: usize>(degree: usize, offsets: &[[f64; D]]) -> (LocalFit<D>, FitScratch<D>) {
    let fit = LocalFit::new(FitParams { degree, ..FitParams::default() });
    let mut scratch = fit.scratch(offsets.len());
    fit.factor(offsets, &vec![1.0; offsets.len()], 1.0, &mut scratch).expect("a valid support");
    (fit, scratch)
}

fn applied<const D: usize>(c: &[f64], offsets: &[[f64; D]], f: impl Fn(&[f64; D]) -> f64) -> f64 {
    c.iter().zip(offsets).map(|(c, x)| c * f(x)).sum()
}

/// Numbers in [-1, 1), the same on every machine.
fn noise(i: usize) -> f64 {
    let mut x = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[test]
fn few_points_give_the_classical_stencils() {
    let (line, mut scratch) = fit(2, &[[0.0], [-0.5], [0.5]]);
    let mut c = [0.0; 3];
    line.coefficients(&Functional::Laplacian, &mut scratch, &mut c).unwrap();
    assert!(c.iter().zip([-8.0, 4.0, 4.0]).all(|(c, d)| (c - d).abs() < 1e-13));
    line.coefficients(&Functional::Partial(0), &mut scratch, &mut c).unwrap();
    assert!(c.iter().zip([0.0, -1.0, 1.0]).all(|(c, d)| (c - d).abs() < 1e-14));
    // As many monomials as points: no room for a correction.
    let error = line.correction(0, &mut scratch, &mut c).unwrap_err();
    assert!(matches!(error, StencilError::Unresolvable { points: 3, monomials: 3, .. }));
}

#[test]
fn a_lattice_that_cannot_tell_cubics_from_lines_still_has_a_laplacian() {
    // x^3 = x on {-1, 0, 1}.
    let offsets = lattice(1);
    let fit = LocalFit::<2>::new(FitParams { degree: 3, ..FitParams::default() });
    let mut scratch = fit.scratch(9);
    let diagnosis = fit.factor(&offsets, &[1.0; 9], 1.0, &mut scratch).unwrap();
    assert_eq!((diagnosis.rank, diagnosis.pivoted), (8, true));
    let mut c = [0.0; 9];
    fit.coefficients(&Functional::Laplacian, &mut scratch, &mut c).unwrap();
    for (i, x) in fit.monomials().exponents().iter().enumerate() {
        let value = applied(&c, &offsets, |z| z[0].powi(i32::from(x[0])) * z[1].powi(i32::from(x[1])));
        let exact = if *x == [2, 0] || *x == [0, 2] { 2.0 } else { 0.0 };
        assert!((value - exact).abs() < 1e-13, "monomial {i}");
    }
    let error = fit.coefficients(&Functional::Partial(0), &mut scratch, &mut c).unwrap_err();
    let StencilError::Unresolvable { points: 9, monomials: 10, rank: 8, remainder } = error else {
        panic!("{error}")
    };
    // To satisfy both x' = 1 and (x^3)' = 0 is impossible where x^3 = x.
    assert!((remainder - 1.0).abs() < 1e-12);
}

#[test]
fn points_on_a_line_have_derivatives_along_it_only() {
    let offsets: Vec<[f64; 2]> = (-3..4).map(|i| [0.1 * f64::from(i), 0.2 * f64::from(i)]).collect();
    let (fit, mut scratch) = fit(2, &offsets);
    let mut c = [0.0; 7];
    fit.coefficients(&Functional::Directional([1.0, 2.0]), &mut scratch, &mut c).unwrap();
    assert!((applied(&c, &offsets, |x| 3.0 + x[0] - x[1] + x[0] * x[1]) + 1.0).abs() < 1e-12);
    for functional in [Functional::Laplacian, Functional::Partial(0), Functional::Second(1, 1)] {
        let error = fit.coefficients(&functional, &mut scratch, &mut c).unwrap_err();
        assert!(matches!(error, StencilError::Unresolvable { points: 7, rank: 3, .. }), "{error}");
    }
}

#[test]
fn too_few_points_are_an_error_that_says_so() {
    let (fit, mut scratch) = fit(2, &[[0.0, 0.0], [1.0, 0.3], [0.2, 1.0], [-0.7, 0.4]]);
    let mut c = [0.0; 4];
    let error = fit.coefficients(&Functional::Laplacian, &mut scratch, &mut c).unwrap_err();
    assert!(matches!(error, StencilError::Unresolvable { points: 4, monomials: 6, rank: 4, .. }), "{error}");
    assert!(error.to_string().contains("enlarge the support"));
    fit.coefficients(&Functional::Value, &mut scratch, &mut c).unwrap();
}

#[test]
fn values_that_make_no_sense_are_refused() {
    let fit = LocalFit::<2>::new(FitParams { degree: 1, ..FitParams::default() });
    let mut scratch = fit.scratch(3);
    let offsets = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let factor = |offsets: &[[f64; 2]], weights: &[f64], radius, scratch: &mut FitScratch<2>| {
        fit.factor(offsets, weights, radius, scratch).unwrap_err()
    };
    let nan = factor(&[[0.0, 0.0], [f64::NAN, 0.0]], &[1.0; 2], 1.0, &mut scratch);
    assert!(matches!(nan, StencilError::Invalid { what: "offset", entry: 1, .. }));
    let zero = StencilError::Invalid { what: "weight", entry: 2, value: 0.0 };
    assert_eq!(factor(&offsets, &[1.0, 1.0, 0.0], 1.0, &mut scratch), zero);
    let radius = StencilError::Invalid { what: "radius", entry: 0, value: -1.0 };
    assert_eq!(factor(&offsets, &[1.0; 3], -1.0, &mut scratch), radius);
    let short = StencilError::LengthMismatch { what: "weights", given: 2, expected: 3 };
    assert_eq!(factor(&offsets, &[1.0; 2], 1.0, &mut scratch), short);
    fit.factor(&offsets, &[1.0; 3], 1.0, &mut scratch).unwrap();
    let mut c = [0.0; 3];
    let error = fit.coefficients(&Functional::Laplacian, &mut scratch, &mut c).unwrap_err();
    assert!(matches!(error, StencilError::DegreeTooLow { order: 2, degree: 1, .. }));
    let error = fit.coefficients(&Functional::Partial(2), &mut scratch, &mut c).unwrap_err();
    assert!(matches!(error, StencilError::NoSuchAxis { dimension: 2, .. }));
    assert!(fit.coefficients(&Functional::Value, &mut scratch, &mut c[..2]).is_err());
    assert!(fit.coefficients_for(&[1.0, 0.0], &mut scratch, &mut c).is_err());
    assert!(fit.correction(3, &mut scratch, &mut c).is_err());
}

/// Root mean square of the error of the Laplacian of `exp(0.7 x) sin(1.3 y + 0.4)` over 20 supports of size h.
fn laplacian_error(degree: usize, h: f64, support: impl Fn(usize) -> Vec<[f64; 2]>) -> f64 {
    let u = |x: &[f64; 2]| (0.7 * x[0]).exp() * (1.3 * x[1] + 0.4).sin();
    let exact = (0.49 - 1.69) * u(&[0.0, 0.0]);
    let fit = LocalFit::<2>::new(FitParams { degree, ..FitParams::default() });
    let squares = (0..20).map(|sample| {
        let offsets: Vec<[f64; 2]> = support(sample).iter().map(|x| x.map(|c| h * c)).collect();
        let length = |x: &[f64; 2]| x[0].hypot(x[1]);
        let radius = offsets.iter().map(length).fold(0.0, f64::max);
        let weights: Vec<f64> =
            offsets.iter().map(|x| Weight::Exponential.value(length(x), radius, radius)).collect();
        let mut scratch = fit.scratch(offsets.len());
        fit.factor(&offsets, &weights, radius, &mut scratch).expect("a valid support");
        let mut c = vec![0.0; offsets.len()];
        fit.coefficients(&Functional::Laplacian, &mut scratch, &mut c).expect("a stencil");
        (applied(&c, &offsets, u) - exact).powi(2)
    });
    (squares.sum::<f64>() / 20.0).sqrt()
}

fn observed_order(degree: usize, support: impl Fn(usize) -> Vec<[f64; 2]> + Copy) -> f64 {
    (laplacian_error(degree, 0.02, support) / laplacian_error(degree, 0.01, support)).log2()
}

#[test]
fn the_laplacian_converges_with_the_degree_minus_one_on_irregular_points() {
    let perturbed = |sample: usize| {
        let shift = |i: usize, k: usize| 0.3 * noise(1000 * sample + 2 * i + k);
        let point = |(i, x): (usize, &[f64; 2])| {
            if *x == [0.0, 0.0] { *x } else { [x[0] + shift(i, 0), x[1] + shift(i, 1)] }
        };
        lattice(2).iter().enumerate().map(point).collect()
    };
    for (degree, order) in [(2, 1.0), (3, 2.0), (4, 3.0)] {
        let observed = observed_order(degree, perturbed);
        assert!((observed - order).abs() < 0.1, "degree {degree}: {observed}");
    }
}

#[test]
fn symmetric_supports_gain_an_order_at_even_degrees() {
    for (degree, order) in [(2, 2.0), (3, 2.0)] {
        let observed = observed_order(degree, |_| lattice(2));
        assert!((observed - order).abs() < 0.1, "degree {degree}: {observed}");
    }
}

#[test]
fn weights_are_those_of_the_papers() {
    let e = std::f64::consts::E;
    assert!((Weight::Exponential.value(1.5, 1.0, 2.0) - 1.0 / e).abs() < 1e-16);
    assert!((Weight::Gaussian { decay: 4.0 }.value(0.5, 1.0, 9.0) - 1.0 / e).abs() < 1e-16);
    assert_eq!(Weight::Quartic.value(0.5, 1.0, 9.0), 0.0625);
    for weight in [Weight::Exponential, Weight::Gaussian { decay: 4.0 }, Weight::Quartic, Weight::Uniform] {
        assert_eq!(weight.value(0.0, 0.3, 0.2), 1.0);
        let values: Vec<f64> = (0..20).map(|i| weight.value(0.1 * f64::from(i), 1.0, 1.0)).collect();
        assert!(values.windows(2).all(|pair| pair[1] <= pair[0]) && values[19] > 0.0);
    }
}

/// A perturbed lattice of side 20 with the lists of all points within 3.2 spacings, compressed.
fn cloud() -> (Vec<[f64; 2]>, Vec<usize>, Vec<u32>) {
    let shift = |i: usize| 0.25 * noise(i);
    let points: Vec<[f64; 2]> =
        (0..400).map(|i| [(i % 20) as f64 + shift(2 * i), (i / 20) as f64 + shift(2 * i + 1)]).collect();
    let (mut offsets, mut indices) = (vec![0], Vec::new());
    for (i, x) in points.iter().enumerate() {
        let near = |j: &usize| *j != i && (points[*j][0] - x[0]).hypot(points[*j][1] - x[1]) <= 3.2;
        indices.extend((0..400).filter(near).map(|j| j as u32));
        offsets.push(indices.len());
    }
    (points, offsets, indices)
}

#[test]
fn stencils_of_a_cloud_do_not_depend_on_the_threads() {
    let (points, offsets, indices) = cloud();
    let functionals = [Functional::Partial(0), Functional::Laplacian];
    let on = |threads: usize| -> StencilSet {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (radii, params) = (vec![3.2; 400], FitParams::default());
        let build = || {
            build_stencils(&points, (&offsets, &indices), &radii, Weight::Exponential, params, &functionals)
        };
        pool.install(build).unwrap()
    };
    let set = on(1);
    assert_eq!(set, on(3));
    assert_eq!((set.len(), set.functionals()), (400, 2));
    let field: Vec<f64> =
        points.iter().map(|x| 1.0 + 3.0 * x[0] - x[1] + x[0] * x[0] + 0.5 * x[1] * x[1]).collect();
    for i in 0..400 {
        let neighbors = &indices[offsets[i]..offsets[i + 1]];
        assert_eq!(set.of(i, 1).len(), neighbors.len() + 1);
        assert_eq!(set.fit(i).rank, 6);
        assert!((set.apply(i, 0, neighbors, &field) - (3.0 + 2.0 * points[i][0])).abs() < 1e-9);
        assert!((set.apply(i, 1, neighbors, &field) - 3.0).abs() < 1e-9);
    }
}

#[test]
fn the_first_point_without_a_stencil_is_named() {
    let (points, mut offsets, mut indices) = cloud();
    let (from, to) = (offsets[7] + 2, offsets[8]);
    indices.drain(from..to);
    offsets[8..].iter_mut().for_each(|offset| *offset -= to - from);
    let build = |offsets: &[usize], indices: &[u32]| {
        let (radii, params) = (vec![3.2; 400], FitParams::default());
        build_stencils(&points, (offsets, indices), &radii, Weight::Uniform, params, &[Functional::Laplacian])
            .unwrap_err()
    };
    let error = build(&offsets, &indices);
    let StencilError::AtPoint { node: 7, position, source } = error else { panic!("{error}") };
    assert_eq!(position, points[7]);
    assert!(matches!(*source, StencilError::Unresolvable { points: 3, .. }));
    indices[offsets[5]] = 400;
    let error = build(&offsets, &indices);
    assert!(matches!(error, StencilError::InvalidSupports { node: 5, .. }), "{error}");
    assert!(matches!(build(&offsets[1..], &indices), StencilError::InvalidSupports { .. }));
}
