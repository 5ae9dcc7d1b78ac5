//! Boxes that are almost cubes, thin or large, and what cannot be.

use std::f64::consts::{PI, SQRT_2};

use meshless_freespace::{
    Boundary, Centring, FreeSpaceError, Kernel, Mesh, Output, Plan, PlanParams, Radial, Spectrum, Workspace,
};

/// A charge of width `2 h` with the total 1 in a box of these cells, and its potential.
fn charge(cells: [usize; 3]) -> (Mesh<3>, Vec<f64>, Vec<f64>) {
    let mesh = Mesh::new([0.0; 3], [0.1; 3], cells, Centring::Cell).expect("a mesh");
    let (width, centre) = (0.2, mesh.max().map(|x| 0.5 * x));
    let radius = |p: [f64; 3]| (0..3).map(|a| (p[a] - centre[a]).powi(2)).sum::<f64>().sqrt();
    let norm = (width * (2.0 * PI).sqrt()).powi(3);
    let source = mesh.sample(|p| (-0.5 * (radius(p) / width).powi(2)).exp() / norm);
    let exact = mesh.sample(|p| {
        let r = radius(p).max(1e-9);
        libm::erf(r / (width * SQRT_2)) / (4.0 * PI * r)
    });
    (mesh, source, exact)
}

/// Periods of truncated kernels are rounded up to fast lengths, which may be the same where numbers of points are not.
#[test]
fn truncated_kernels_on_boxes_that_are_almost_cubes() {
    for cells in
        [[27, 27, 27], [28, 27, 27], [27, 28, 27], [27, 27, 28], [28, 29, 27], [30, 27, 30], [29, 30, 30]]
    {
        let (mesh, source, exact) = charge(cells);
        let plan: Plan<3> = Plan::new(&mesh, Kernel::Truncated).expect("a plan");
        let phi = plan.potential(&source).expect("a potential");
        let error = phi.iter().zip(&exact).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        // What the mesh does not resolve: exp(-(2 pi)^2 / 2) of the source.
        assert!(error < 1e-7, "{cells:?}: {error:e}");
    }
}

/// Lines are transformed in pairs. Beside a line that there is not, the round-off of the source must not come back in the field, which is
/// smaller by the square of the spacing: in another unit of length the same numbers come out.
#[test]
fn results_are_those_of_any_unit_of_length() {
    fn check<const D: usize>(cells: [usize; D], kernel: Kernel) {
        let solve = |unit: f64| {
            let mesh = Mesh::new([0.0; D], [unit; D], cells, Centring::Cell).expect("a mesh");
            let source: Vec<f64> = (0..mesh.len()).map(|i| ((i * i * 7 + 3 * i) % 19) as f64 - 9.0).collect();
            let plan: Plan<D> = Plan::new(&mesh, kernel).expect("a plan");
            let mut fields = Vec::new();
            let wanted = [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis: 0 }];
            plan.solve(&[&source], &wanted, &mut Workspace::default(), &mut fields).expect("fields");
            let total = source.iter().sum::<f64>() * mesh.cell_volume();
            // In the plane the unit of the logarithm is one of length.
            let level = if D == 2 { total * unit.ln() / (2.0 * PI) } else { 0.0 };
            let potential = fields[0].iter().map(|v| (v + level) / (unit * unit));
            potential.chain(fields[1].iter().map(|v| v / unit)).collect::<Vec<f64>>()
        };
        let one = solve(1.0);
        let scale = one.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for unit in [1e-80, 1e-12, 1e12, 1e80] {
            let all = solve(unit);
            let error = all.iter().zip(&one).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / scale;
            assert!(error < 1e-10, "{cells:?} {kernel:?} {unit:e}: {error:e}");
        }
    }
    for kernel in [Kernel::gaussian(2), Kernel::gaussian(20), Kernel::Spectral, Kernel::Truncated] {
        check([7], kernel);
        check([13, 11], kernel);
        check([12, 13], kernel);
        check([6, 5, 7], kernel);
        check([5, 6, 4], kernel);
    }
}

#[test]
fn a_kernel_without_a_value_at_the_origin_is_refused() {
    struct Singular;
    impl Radial for Singular {
        fn value(&self, r: f64) -> f64 {
            1.0 / r
        }
    }
    let mesh = Mesh::new([0.0; 3], [1.0; 3], [6; 3], Centring::Cell).expect("a mesh");
    for plan in [Plan::<3>::with_radial(&mesh, &Singular), Plan::<3>::with_compact(&mesh, &Singular)] {
        assert!(plan.expect_err("a mistake").to_string().contains("at distance zero inf"));
    }
}

#[test]
fn spacings_beyond_single_precision_are_refused() {
    for unit in [1e-13, 1e13] {
        let mesh = Mesh::new([0.0; 2], [unit; 2], [6; 2], Centring::Cell).expect("a mesh");
        assert!(Plan::<2, f32>::new(&mesh, Kernel::gaussian(4)).is_err());
        assert!(Plan::<2>::new(&mesh, Kernel::gaussian(4)).is_ok());
    }
}

/// A mirror has as many images as there are points.
#[test]
fn what_no_memory_holds_is_refused_before_it_is_made() {
    let mesh = Mesh::new([0.0], [1.0], [1 << 42], Centring::Cell).expect("a mesh");
    for boundaries in [[Boundary::EVEN], [Boundary::OPEN], [Boundary::Periodic]] {
        let plan = Plan::<1>::new(&mesh, PlanParams { boundaries, ..PlanParams::default() });
        assert!(matches!(plan, Err(FreeSpaceError::Memory { .. })), "{boundaries:?}");
    }
}

/// Cells a billion times as long as wide have wave numbers as far apart.
#[test]
fn the_spectrum_on_long_cells() {
    let mesh = Mesh::new([-16e9, -16.0], [1e9, 1.0], [32, 32], Centring::Cell).expect("a mesh");
    let source = mesh.sample(|[x, y]| (-0.5 * ((x / 2.5e9).powi(2) + (y / 2.5).powi(2))).exp());
    let spectrum = Spectrum::new(&mesh, &source).expect("a spectrum");
    assert!(spectrum.error(Kernel::Truncated) < 1e-6, "{:e}", spectrum.error(Kernel::Truncated));
}

/// Neither the unit of length nor that of the source matters.
#[test]
fn the_spectrum_in_any_units() {
    let error = |unit: f64, height: f64| {
        let mesh = Mesh::new([-16.0 * unit; 2], [unit; 2], [32; 2], Centring::Cell).expect("a mesh");
        let source =
            mesh.sample(|[x, y]| height * (-0.5 * ((x / unit).powi(2) + (y / unit).powi(2)) / 3.0).exp());
        Spectrum::new(&mesh, &source).expect("a spectrum").best().error
    };
    let one = error(1.0, 1.0);
    for (unit, height) in [(1e-85, 1.0), (1e85, 1.0), (1.0, 1e-300), (1.0, 1e-312), (1.0, 1e300)] {
        assert!(
            (error(unit, height) / one - 1.0).abs() < 1e-3,
            "{unit:e} {height:e}: {:e}",
            error(unit, height)
        );
    }
}

/// A source that varies faster along the short side of the cells is resolved there: a truncated kernel does not smooth by the long one.
#[test]
fn a_tolerance_that_unequal_cells_allow_is_not_refused() {
    let mesh = Mesh::of_box([-1.0; 2], [1.0; 2], [128, 32], Centring::Cell).expect("a mesh");
    let source = mesh.sample(|[x, y]| (-0.5 * ((x / 0.04).powi(2) + (y / 0.14).powi(2))).exp());
    let choice = Spectrum::new(&mesh, &source).expect("a spectrum").best_for(1e-5).expect("a kernel");
    assert_eq!(choice.kernel, Kernel::Truncated);
    let solve = |cells: [usize; 2]| {
        let mesh = Mesh::of_box([-1.0; 2], [1.0; 2], cells, Centring::Node).expect("a mesh");
        let source = mesh.sample(|[x, y]| (-0.5 * ((x / 0.04).powi(2) + (y / 0.14).powi(2))).exp());
        let plan: Plan<2> = Plan::new(&mesh, Kernel::Truncated).expect("a plan");
        (mesh, plan.potential(&source).expect("a potential"))
    };
    let ((coarse, phi), (fine, exact)) = (solve([128, 32]), solve([256, 128]));
    let scale = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for point in 0..coarse.len() {
        let [i, j] = coarse.indices(point);
        assert!((phi[point] - exact[fine.index([2 * i, 4 * j])]).abs() < 1e-5 * scale, "{i} {j}");
    }
    let least = Spectrum::new(&mesh, &source).expect("a spectrum").best_for(1e-18);
    assert!(matches!(least, Err(FreeSpaceError::Tolerance { .. })));
}

/// Unresolved noise beside one open direction: a kernel that ends with a step would give it back multiplied by the width of the box.
#[test]
fn truncated_kernels_of_lines_end_without_a_step() {
    let solve = |unit: f64| {
        let mesh = Mesh::new([0.0], [unit], [15], Centring::Cell).expect("a mesh");
        let source: Vec<f64> = (0..15).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let plan: Plan<1> = Plan::new(&mesh, Kernel::Truncated).expect("a plan");
        plan.potential(&source).expect("a potential")
    };
    let direct = |i: usize| -> f64 {
        (0..15).map(|j: usize| if j.is_multiple_of(2) { -0.5 } else { 0.5 } * i.abs_diff(j) as f64).sum()
    };
    for (i, value) in solve(1.0).into_iter().enumerate() {
        assert!((value - direct(i)).abs() < 0.5, "{i}: {value} {}", direct(i));
    }
}
