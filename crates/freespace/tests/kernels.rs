//! Kernels against references of 30 digits; `references/kernels.py` says how those were made.

use meshless_freespace::{BandPass, Gaussian, Radial, Spectral, Truncated};

/// Error relative to the value. Where a kernel passes through zero, which the logarithm and the kernels of one dimension
/// do, to the size of what is added there.
const TOLERANCE: f64 = 1e-14;

#[derive(Debug)]
struct Reference {
    kernel: String,
    dimension: usize,
    order: usize,
    r: f64,
    value: f64,
}

fn references() -> Vec<Reference> {
    let text = include_str!("references/kernels.csv");
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    rows.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        Reference {
            kernel: cells[0].to_owned(),
            dimension: cells[1].parse().expect("a dimension"),
            order: cells[2].parse().expect("an order"),
            r: cells[3].parse().expect("a radius"),
            value: cells[4].parse().expect("a value"),
        }
    })
    .collect()
}

/// A truncated kernel as a function of the wave number.
struct Transformed<const D: usize>(Truncated<D>);

impl<const D: usize> Radial for Transformed<D> {
    fn value(&self, k: f64) -> f64 {
        self.0.transform(k)
    }
}

fn kernel(reference: &Reference) -> Box<dyn Radial> {
    let Reference { kernel, dimension, order, .. } = reference;
    match (kernel.as_str(), dimension) {
        ("gaussian", 1) => Box::new(Gaussian::<1>::new(*order, 1.0).expect("an order")),
        ("gaussian", 2) => Box::new(Gaussian::<2>::new(*order, 1.0).expect("an order")),
        ("gaussian", 3) => Box::new(Gaussian::<3>::new(*order, 1.0).expect("an order")),
        ("spectral", 1) => Box::new(Spectral::<1>::new(1.0).expect("a radius")),
        ("spectral", 2) => Box::new(Spectral::<2>::new(1.0).expect("a radius")),
        ("spectral", 3) => Box::new(Spectral::<3>::new(1.0).expect("a radius")),
        ("truncated", 1) => Box::new(Transformed(Truncated::<1>::new(2.0).expect("a radius"))),
        ("truncated", 2) => Box::new(Transformed(Truncated::<2>::new(2.0).expect("a radius"))),
        ("truncated", 3) => Box::new(Transformed(Truncated::<3>::new(2.0).expect("a radius"))),
        ("band-pass", 2) => Box::new(BandPass::<2>::new(*order, 1.0, 2.0).expect("an order")),
        ("band-pass", 3) => Box::new(BandPass::<3>::new(*order, 1.0, 2.0).expect("an order")),
        other => panic!("no kernel {other:?}"),
    }
}

/// What the error is measured by: the value, and at least what the kernel is the sum of.
fn scale(reference: &Reference) -> f64 {
    let (r, value) = (reference.r, reference.value.abs());
    match (reference.kernel.as_str(), reference.dimension) {
        ("band-pass", dimension) => {
            // The envelope of the wider kernel: e^-y times its polynomials.
            let y = r * r / 8.0;
            let degree = reference.order as i32 / 2 - 1;
            let polynomial = (1..=degree).fold(1.0, |p, j| 1.0 + p * y / f64::from(j * j));
            let height = if dimension == 2 { 0.1 } else { 0.02 };
            value.max(height * (-y).exp() * polynomial)
        }
        // Terms that oscillate about others.
        ("truncated", dimension) if r > 1.0 => {
            let of_edge = [2.0, 2.0 * 2.0_f64.ln() / (std::f64::consts::PI * r).sqrt(), 0.0][dimension - 1];
            value.max(1.0 / (r * r) + of_edge / r)
        }
        ("truncated", _) => value.max(1.0),
        (_, 1) => value.max(0.1),
        (_, 2) => value.max(0.5 / std::f64::consts::TAU),
        _ => value,
    }
}

#[test]
fn kernels_agree_with_thirty_digits() {
    let references = references();
    assert_eq!(references.len(), 1368);
    let mut worst = (0.0, String::new());
    for reference in &references {
        let kernel = kernel(reference);
        let value = kernel.value(reference.r);
        let error = (value - reference.value).abs() / scale(reference);
        assert!(error <= TOLERANCE, "{reference:?}: {value} has the error {error:e}");
        // Many at a time, from squares of distances; steeper functions feel the rounding of those.
        if ["gaussian", "spectral"].contains(&reference.kernel.as_str()) {
            for unit in [1.0, 0.25] {
                let mut values = [(reference.r / unit).powi(2); 5];
                kernel.values(unit, &mut values);
                let error = (values[4] - reference.value).abs() / scale(reference);
                assert!(error <= TOLERANCE, "{reference:?}: {} has the error {error:e}", values[4]);
            }
        }
        if error > worst.0 {
            worst = (error, format!("{reference:?}"));
        }
    }
    println!("worst {:e} at {}", worst.0, worst.1);
}

#[test]
fn orders_that_do_not_exist_are_refused() {
    for order in [0, 1, 3, 22] {
        let error = Gaussian::<2>::new(order, 1.0).expect_err("no such order");
        assert!(error.to_string().contains(&format!("order {order}")));
    }
    assert!(Gaussian::<2>::new(4, f64::NAN).is_err());
    assert!(BandPass::<3>::new(4, 1.0, 1.0).is_err());
    assert!(Truncated::<3>::new(0.0).is_err());
}

#[test]
fn the_density_is_minus_the_laplacian() {
    // -(r^(D-1) G')' / r^(D-1) by central differences.
    fn check<const D: usize>(order: usize) {
        let kernel = Gaussian::<D>::new(order, 1.0).expect("an order");
        for r in [0.3, 0.9, 2.0, 4.0] {
            let h = 1e-3;
            let flux =
                |r: f64| r.powi(D as i32 - 1) * (kernel.value(r + h / 2.0) - kernel.value(r - h / 2.0)) / h;
            let laplacian = (flux(r + h / 2.0) - flux(r - h / 2.0)) / h / r.powi(D as i32 - 1);
            let density = kernel.density(r);
            // The difference quotient has an error of h^2 times fourth derivatives.
            assert!((laplacian + density).abs() < 3e-5, "{D} {order} {r}: {laplacian} {density}");
        }
    }
    for order in [2, 4, 10] {
        check::<1>(order);
        check::<2>(order);
        check::<3>(order);
    }
}

#[test]
fn the_reach_of_a_band_pass_follows_the_tolerance() {
    let kernel = BandPass::<2>::new(10, 1.0, 2.0).expect("an order");
    for tolerance in [1e-4, 1e-8, 1e-15] {
        let reach = kernel.reach(tolerance);
        let least = tolerance * kernel.value(0.0);
        assert!((0..200).all(|i| kernel.value(reach + 0.1 * f64::from(i)).abs() <= least));
        assert!(kernel.value(reach - 0.2).abs() > least);
    }
    // About 9.2 a sigma / h cells at 1e-15.
    assert!((15.0..20.0).contains(&kernel.reach(1e-15)));
}

#[test]
fn truncated_kernels_know_the_period_that_they_need() {
    let kernel = Truncated::<2>::new(1.5).expect("a radius");
    assert!(kernel.check_period([1.0, 1.0], [2.5, 2.5]).is_ok());
    let error = kernel.check_period([1.0, 1.0], [2.5, 2.4]).expect_err("too short");
    assert!(error.to_string().contains("direction 1"), "{error}");
    // The value at zero is the limit.
    for l in [0.5, 1.0, 3.0] {
        let (k, near) = (Truncated::<2>::new(l).expect("a radius"), 1e-5);
        assert!((k.transform(0.0) - k.transform(near)).abs() < 1e-9);
        let (k, near) = (Truncated::<3>::new(l).expect("a radius"), 1e-5);
        assert!((k.transform(0.0) - k.transform(near)).abs() < 1e-9);
    }
}

/// By the difference of sixth order with a step that balances its error with round-off.
#[test]
fn slopes_are_derivatives() {
    fn check<const D: usize>(value: &dyn Fn(f64) -> f64, slope: &dyn Fn(f64) -> f64, what: &str) {
        let step = 5e-3;
        for r in [0.02, 0.3, 0.99, 1.01, 2.0, 5.0, 12.0, 30.0] {
            let pair = |k: f64| value(r + k * step) - value(r - k * step);
            let difference = (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * step);
            let error = (slope(r) - difference).abs();
            assert!(error < 1e-12 * (1.0 + value(r).abs()), "{what} {D} {r}: {error:e}");
        }
        assert!(slope(0.0) == 0.0, "{what} {D}");
    }
    fn both<const D: usize>() {
        for order in [2, 4, 10, 20] {
            let kernel = Gaussian::<D>::new(order, 1.0).expect("an order");
            check::<D>(&|r| kernel.value(r.abs()), &|r| kernel.slope(r), "Gaussian");
        }
        let kernel = Spectral::<D>::new(1.0).expect("a radius");
        check::<D>(&|r| kernel.value(r.abs()), &|r| kernel.slope(r), "spectral");
    }
    both::<1>();
    both::<2>();
    both::<3>();
}

#[test]
fn what_is_no_distance_has_no_value() {
    for order in [2, 10] {
        assert!(Gaussian::<1>::new(order, 1.0).expect("an order").value(f64::NAN).is_nan());
        assert!(Gaussian::<2>::new(order, 1.0).expect("an order").value(f64::NAN).is_nan());
        assert!(Gaussian::<3>::new(order, 1.0).expect("an order").value(f64::NAN).is_nan());
    }
    assert!(Spectral::<2>::new(1.0).expect("a radius").value(f64::NAN).is_nan());
    assert!(Spectral::<3>::new(1.0).expect("a radius").value(f64::NAN).is_nan());
    assert!(Truncated::<2>::new(1.0).expect("a radius").transform(f64::NAN).is_nan());
}
