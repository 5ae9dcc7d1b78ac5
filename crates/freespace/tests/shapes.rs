//! Boxes that are almost cubes, thin or large, and what cannot be.

use std::f64::consts::{PI, SQRT_2};

use meshless_freespace::{Centring, Kernel, Mesh, Plan};

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
