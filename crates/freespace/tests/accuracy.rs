//! Estimates of the error and choices that rest on them.

use meshless_freespace::{
    Centring, FreeSpaceError, Kernel, Mesh, Output, Plan, Spectrum, Workspace, default_smoothing,
};

/// A Gaussian source whose potential in three dimensions is erf(r / s sqrt 2) / 4 pi r times its total.
fn problem(cells: usize) -> (Mesh<3>, Vec<f64>, Vec<f64>) {
    let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], [cells; 3], Centring::Cell).expect("a mesh");
    let width = 0.13_f64;
    let square = |p: [f64; 3]| p.iter().map(|x| x * x).sum::<f64>();
    let source = mesh.sample(|p| (-square(p) / (2.0 * width * width)).exp());
    let total = (std::f64::consts::TAU.sqrt() * width).powi(3);
    let exact = mesh.sample(|p| {
        let r = square(p).sqrt();
        total * libm::erf(r / width / 2.0_f64.sqrt()) / (4.0 * std::f64::consts::PI * r)
    });
    (mesh, source, exact)
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|v| v * v).sum::<f64>().sqrt()
}

/// One smoothing radius for all orders.
fn wide(order: usize) -> Kernel {
    Kernel::Gaussian { order, smoothing: Some(2.0) }
}

#[test]
fn the_next_order_tells_the_error() {
    let (mesh, source, exact) = problem(40);
    for (order, margin) in [(2, 0.4), (4, 0.4), (6, 0.4), (8, 0.4)] {
        let plan: Plan<3> = Plan::new(&mesh, wide(order)).expect("a plan");
        let wanted = [Output::Potential { source: 0 }, Output::PotentialError { source: 0 }];
        let mut out = Vec::new();
        plan.solve(&[&source], &wanted, &mut Workspace::default(), &mut out).expect("fields");
        let error = norm(exact.iter().zip(&out[0]).map(|(e, v)| e - v));
        let unexplained = norm(exact.iter().zip(&out[0]).zip(&out[1]).map(|((e, v), d)| e - v - d));
        let estimate = norm(out[1].iter().copied());
        assert!((estimate / error - 1.0).abs() < margin, "order {order}: {estimate:e} for {error:e}");
        assert!(unexplained < margin * error, "order {order}: {unexplained:e} of {error:e} is left");
        // The estimate is what the next order adds.
        if order < 8 {
            let next: Plan<3> = Plan::new(&mesh, wide(order + 2)).expect("a plan");
            let next = next.potential(&source).expect("a potential");
            let difference = norm(next.iter().zip(&out[0]).zip(&out[1]).map(|((n, v), d)| n - v - d));
            assert!(difference < 1e-6 * estimate, "order {order}: {difference:e} of {estimate:e}");
        }
    }
    let spectral: Plan<3> = Plan::new(&mesh, Kernel::Spectral).expect("a plan");
    let wanted = [Output::PotentialError { source: 0 }];
    let refused = spectral.solve(&[&source], &wanted, &mut Workspace::default(), &mut Vec::new());
    assert!(matches!(refused, Err(FreeSpaceError::Kernel { .. })));
}

#[test]
fn the_default_radius_is_better_than_two_spacings_and_grows_with_the_order() {
    let ratios: Vec<f64> = (2..=20).step_by(2).map(|m| default_smoothing(m).expect("an order")).collect();
    assert!(ratios.windows(2).all(|w| w[0] < w[1]) && ratios[0] > 1.2 && ratios[9] < 1.8, "{ratios:?}");
    let (mesh, source, exact) = problem(40);
    let error = |smoothing| {
        let plan: Plan<3> = Plan::new(&mesh, Kernel::Gaussian { order: 10, smoothing }).expect("a plan");
        let phi = plan.potential(&source).expect("a potential");
        norm(exact.iter().zip(&phi).map(|(e, v)| e - v))
    };
    assert!(error(None) < 0.15 * error(Some(2.0)));
}

#[test]
fn the_spectrum_predicts_errors_and_finds_a_good_kernel() {
    let (mesh, source, exact) = problem(32);
    let spectrum = Spectrum::new(&mesh, &source).expect("a spectrum");
    let measured = |kernel: Kernel| {
        let plan: Plan<3> = Plan::new(&mesh, kernel).expect("a plan");
        let phi = plan.potential(&source).expect("a potential");
        norm(exact.iter().zip(&phi).map(|(e, v)| e - v)) / norm(exact.iter().copied())
    };
    for order in [2, 4, 8, 12] {
        for smoothing in [1.25, 2.0] {
            let kernel = Kernel::Gaussian { order, smoothing: Some(smoothing) };
            let ratio = spectrum.error(kernel) / measured(kernel);
            // The prediction knows periods only, and the worst direction.
            assert!((0.2..8.0).contains(&ratio), "order {order}, {smoothing}: {ratio}");
        }
    }
    let best = spectrum.best();
    let usual = measured(Kernel::Gaussian { order: 10, smoothing: Some(2.0) });
    assert!(measured(best.kernel) < 0.1 * usual, "{best:?}: {:e} for {usual:e}", measured(best.kernel));
    assert!(spectrum.best_for(1e-5).is_ok());
    // Where no smoothing is good enough, none is taken.
    let tolerance = spectrum.error(Kernel::Spectral);
    assert!(tolerance < 0.1 * best.error, "{tolerance:e} for {:e}", best.error);
    let sharp = spectrum.best_for(tolerance).expect("a kernel");
    assert!(sharp.kernel == Kernel::Spectral && measured(sharp.kernel) < tolerance);
    let long = Mesh::of_box([-1.0; 3], [1.0; 3], [32, 32, 40], Centring::Cell).expect("a mesh");
    let of = |p: [f64; 3]| (-p.iter().map(|x| x * x).sum::<f64>() / (2.0 * 0.13 * 0.13)).exp();
    let spectrum_of_long = Spectrum::new(&long, &long.sample(of)).expect("a spectrum");
    let tolerance = spectrum_of_long.error(Kernel::Truncated);
    assert_eq!(spectrum_of_long.best_for(tolerance).expect("a kernel").kernel, Kernel::Truncated);
    assert!(matches!(spectrum.best_for(1e-16), Err(FreeSpaceError::Tolerance { .. })));
}

/// A curl has nothing of a gradient, a gradient nothing else; of a blob along one direction a third of the squares is one, whatever its width.
#[test]
fn the_gradient_part_of_a_vector_field_is_known() {
    let blob = |p: [f64; 3]| (-p.iter().map(|x| x * x).sum::<f64>() / (2.0 * 0.13 * 0.13)).exp();
    for cells in [[32; 3], [33, 40, 36]] {
        let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], cells, Centring::Cell).expect("a mesh");
        let part = |field: &dyn Fn([f64; 3]) -> [f64; 3]| {
            let components: [Vec<f64>; 3] = std::array::from_fn(|a| mesh.sample(|p| field(p)[a]));
            let vector: [&[f64]; 3] = std::array::from_fn(|a| &components[a][..]);
            Spectrum::of_vector(&mesh, vector, &[]).expect("a spectrum").gradient_part().expect("a vector")
        };
        let curl = part(&|p| [-p[1] * blob(p), p[0] * blob(p), 0.0]);
        assert!(curl < 1e-9, "{cells:?}: {curl:e}");
        let gradient = part(&|p| p.map(|x| x * blob(p)));
        assert!((gradient - 1.0).abs() < 1e-9, "{cells:?}: {gradient}");
        let along = part(&|p| [0.0, 0.0, blob(p)]);
        assert!((along - (1.0_f64 / 3.0).sqrt()).abs() < 1e-3, "{cells:?}: {along}");
        assert!(part(&|_| [0.0; 3]) == 0.0);
        // What is added to a curl is found again.
        let little = part(&|p| [-p[1] * blob(p), p[0] * blob(p), 1e-4 * blob(p)]);
        assert!(little > 1e-5 && little < 1e-2, "{cells:?}: {little:e}");
    }
    let mesh = Mesh::of_box([-1.0; 2], [1.0; 2], [8; 2], Centring::Cell).expect("a mesh");
    let source = mesh.sample(|p| p[0]);
    assert_eq!(Spectrum::new(&mesh, &source).expect("a spectrum").gradient_part(), None);
    let both = Spectrum::of_vector(&mesh, [&source, &source], &[&source]).expect("a spectrum");
    let three = Spectrum::of_all(&mesh, &[&source[..]; 3]).expect("a spectrum");
    let kernel = Kernel::gaussian(6);
    assert!((both.error(kernel) / three.error(kernel) - 1.0).abs() < 1e-12);
    assert!(Spectrum::of_vector(&mesh, [&source, &[f64::NAN; 64]], &[]).is_err());
}
