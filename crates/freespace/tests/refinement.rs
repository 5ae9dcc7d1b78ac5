//! Patches against uniform fine meshes.

use meshless_freespace::{
    Centring, FreeSpaceError, Kernel, Mesh, Output, Patch, Plan, RefineParams, RefinedPlan, Superposition,
    Workspace, suggest,
};
use proptest::prelude::*;

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(f64::MIN_POSITIVE, |s, v| s.max(v.abs()));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}

/// phi and its gradient on all meshes.
fn solve<const D: usize>(
    plan: &RefinedPlan<D>,
    source: impl Fn([f64; D]) -> f64 + Copy,
    wanted: &[Output],
) -> Vec<Vec<Vec<f64>>> {
    let sources: Vec<Vec<Vec<f64>>> =
        (0..plan.len()).map(|i| vec![plan.source_mesh(i).sample(source)]).collect();
    plan.solve(&sources, wanted).expect("fields")
}

/// The same on one fine mesh, at the points of another.
fn uniform<const D: usize>(
    fine: &Mesh<D>,
    at: &Mesh<D>,
    order: usize,
    source: impl Fn([f64; D]) -> f64,
    wanted: &[Output],
) -> Vec<Vec<f64>> {
    let plan = Plan::new(fine, Kernel::Gaussian { order, smoothing: Some(2.0) }).expect("a plan");
    on_mesh(&plan, at, source, wanted)
}

/// Fields of a plan at points of its mesh.
fn on_mesh<const D: usize>(
    plan: &Plan<D>,
    at: &Mesh<D>,
    source: impl Fn([f64; D]) -> f64,
    wanted: &[Output],
) -> Vec<Vec<f64>> {
    let fine = plan.mesh();
    let mut out = Vec::new();
    plan.solve(&[&fine.sample(source)], wanted, &mut Workspace::default(), &mut out).expect("fields");
    let place = |p: [f64; D], a: usize| ((p[a] - fine.coordinate(a, 0)) / fine.spacing()[a]).round() as usize;
    out.iter()
        .map(|field| {
            (0..at.len()).map(|i| field[fine.index(std::array::from_fn(|a| place(at.point(i), a)))]).collect()
        })
        .collect()
}

/// Smooth to round-off on the meshes below.
fn blob<const D: usize>(p: [f64; D]) -> f64 {
    let square: f64 = p.iter().enumerate().map(|(a, x)| (x - 0.05 * a as f64).powi(2)).sum();
    (-square / (2.0 * 0.11 * 0.11)).exp()
}

fn wanted(axis: usize) -> [Output; 2] {
    [Output::Potential { source: 0 }, Output::Gradient { source: 0, axis }]
}

fn params(superposition: Superposition) -> RefineParams {
    RefineParams { order: 6, superposition, ..RefineParams::default() }
}

/// Whether the patches of `plan` have the uniform solution, up to `limit`.
fn check<const D: usize>(plan: &RefinedPlan<D>, cells: [usize; D], limit: f64) {
    for axis in 0..D {
        let found = solve(plan, blob, &wanted(axis));
        for index in 1..plan.len() {
            let base = plan.mesh(0);
            let ratio = (base.spacing()[0] / plan.mesh(index).spacing()[0]).round() as usize;
            let fine = Mesh::of_box(base.min(), base.max(), cells.map(|n| n * ratio), base.centring())
                .expect("a mesh");
            let expected = uniform(&fine, plan.mesh(index), 6, blob, &wanted(axis));
            for (found, expected) in found[index].iter().zip(&expected) {
                let error = difference(found, expected);
                assert!(error < limit, "mesh {index} axis {axis}: {error:e}");
            }
        }
    }
}

/// The base mesh holds the source to 1e-14, so that what the two meshes disagree on is round-off.
#[test]
fn a_patch_is_the_uniform_fine_mesh() {
    for centring in [Centring::Cell, Centring::Node] {
        let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], centring).expect("a mesh");
        for ratio in [2, 3, 4] {
            let patch = Patch::covering(&base, [-0.5; 2], [0.5, 0.25], ratio);
            let plan = RefinedPlan::new(&base, &[patch], params(Superposition::Shift)).expect("a plan");
            check(&plan, [64; 2], 1e-12);
        }
    }
}

#[test]
fn patches_in_space_and_bordering_patches() {
    let base = Mesh::of_box([-0.9; 3], [0.9; 3], [40; 3], Centring::Cell).expect("a mesh");
    let halves = [
        Patch::covering(&base, [-0.3, -0.3, -0.3], [0.0, 0.3, 0.3], 2),
        Patch::covering(&base, [0.0, -0.3, -0.3], [0.3, 0.3, 0.3], 2),
    ];
    let shift = RefineParams { tolerance: 1e-13, ..params(Superposition::Shift) };
    check(&RefinedPlan::new(&base, &halves, shift).expect("a plan"), [40; 3], 1e-10);
}

#[test]
fn nested_patches_and_interpolation() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let outer = Patch::covering(&base, [-0.6; 2], [0.6; 2], 2);
    let inner = Patch { parent: Some(0), first: [20, 24], cells: [36, 30], ratio: 2 };
    for (superposition, limit) in [
        (Superposition::Shift, 1e-11),
        (Superposition::Lagrange(14), 1e-6),
        (Superposition::Lagrange(8), 1e-4),
        (Superposition::M6Star, 1e-3),
    ] {
        let plan = RefinedPlan::new(&base, &[outer, inner], params(superposition)).expect("a plan");
        assert_eq!(plan.patches_of(1).collect::<Vec<_>>(), [2]);
        check(&plan, [64; 2], limit);
    }
}

/// Cells of three different sides, points at corners, a ratio of 3: all ways of superposition in space.
#[test]
fn patches_in_space_with_unequal_cells() {
    for (centring, ratio) in [(Centring::Node, 2), (Centring::Cell, 3)] {
        let base = Mesh::of_box([-0.75; 3], [0.75; 3], [36, 32, 30], centring).expect("a mesh");
        let patch = Patch::covering(&base, [-0.2, -0.15, -0.2], [0.15, 0.2, 0.15], ratio);
        for (superposition, limit) in
            [(Superposition::Shift, 1e-4), (Superposition::Lagrange(10), 1e-4), (Superposition::M6Star, 3e-3)]
        {
            let params = RefineParams { order: 4, tolerance: 1e-5, smoothing: Some(1.6), superposition };
            let plan = RefinedPlan::new(&base, &[patch], params).expect("a plan");
            let wanted = wanted(1);
            let found = solve(&plan, blob, &wanted);
            let fine = Mesh::of_box(base.min(), base.max(), base.cells().map(|n| n * ratio), centring);
            let fine = fine.expect("a mesh");
            let kernel = Kernel::Gaussian { order: 4, smoothing: Some(1.6) };
            let expected = on_mesh(&Plan::new(&fine, kernel).expect("a plan"), plan.mesh(1), blob, &wanted);
            for (found, expected) in found[1].iter().zip(&expected) {
                let error = difference(found, expected);
                assert!(error < limit, "{centring:?} {superposition:?}: {error:e}");
            }
        }
    }
}

/// Three meshes that end at the same corner: each is grown by what the next one is interpolated from.
#[test]
fn patches_may_end_where_their_parents_do() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let patches = [
        Patch { parent: None, first: [0, 0], cells: [40, 36], ratio: 2 },
        Patch { parent: Some(0), first: [0, 0], cells: [24, 20], ratio: 2 },
    ];
    for (superposition, limit) in [(Superposition::Shift, 1e-11), (Superposition::Lagrange(14), 1e-6)] {
        let plan = RefinedPlan::new(&base, &patches, params(superposition)).expect("a plan");
        assert_eq!(plan.mesh(0).cells(), [64; 2]);
        check(&plan, [64; 2], limit);
    }
}

#[test]
fn patches_may_overlap() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let patches = [
        Patch::covering(&base, [-0.5, -0.5], [0.25, 0.5], 2),
        Patch::covering(&base, [-0.25, -0.25], [0.5, 0.5], 2),
        Patch { parent: Some(0), first: [20, 30], cells: [20, 24], ratio: 2 },
    ];
    let plan = RefinedPlan::new(&base, &patches, params(Superposition::Shift)).expect("a plan");
    check(&plan, [64; 2], 1e-11);
}

/// The estimate of a solve tells where to refine, and where not: what is left is below the tolerance everywhere.
#[test]
fn the_estimate_chooses_patches_to_a_tolerance() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [96; 2], Centring::Cell).expect("a mesh");
    let order = 4;
    let plan: Plan<2> = Plan::new(&base, Kernel::Gaussian { order, smoothing: Some(2.0) }).expect("a plan");
    let asked = [Output::Potential { source: 0 }, Output::PotentialError { source: 0 }];
    let estimated = on_mesh(&plan, &base, blob, &asked);
    let exact = |mesh: &Mesh<2>, cells: usize| {
        let fine = Mesh::of_box([-1.0; 2], [1.0; 2], [cells; 2], Centring::Cell).expect("a mesh");
        on_mesh(&Plan::new(&fine, Kernel::Spectral).expect("a plan"), mesh, blob, &asked[..1]).remove(0)
    };
    let largest = estimated[0].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let tolerance = 0.1 * estimated[1].iter().fold(0.0_f64, |m, v| m.max(v.abs())) / largest;
    let patches = suggest(&base, &estimated[1], &estimated[0], tolerance, 2).expect("patches");
    let covered: usize = patches.iter().map(|p| p.cells.iter().product::<usize>()).sum();
    assert!(!patches.is_empty() && covered < base.len() / 4, "{covered} of {} cells", base.len());
    let refined = RefinedPlan::new(&base, &patches, RefineParams { order, ..RefineParams::default() });
    let refined = refined.expect("a plan");
    let fields = solve(&refined, blob, &asked[..1]);
    let inside = |p: [f64; 2], mesh: &Mesh<2>| (0..2).all(|a| p[a] > mesh.min()[a] && p[a] < mesh.max()[a]);
    for (index, field) in fields.iter().enumerate() {
        let mesh = refined.mesh(index);
        let exact = exact(mesh, if index == 0 { 96 } else { 192 });
        for (point, (value, exact)) in field[0].iter().zip(&exact).enumerate() {
            let finer = refined.patches_of(index).any(|i| inside(mesh.point(point), refined.mesh(i)));
            let error = (value - exact).abs() / largest;
            // The estimate is within some tenths of the error.
            assert!(finer || error < 1.3 * tolerance, "mesh {index}: {error:e} for {tolerance:e}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// A source inside of one patch, wherever the patch is.
    #[test]
    fn a_source_inside_of_a_patch(first in [18_usize..22, 18_usize..22], cells in [20_usize..24, 20_usize..24]) {
        let base = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
        let patch = Patch { parent: None, first, cells, ratio: 2 };
        let plan = RefinedPlan::new(&base, &[patch], params(Superposition::Shift)).expect("a plan");
        check(&plan, [64; 2], 1e-12);
    }
}

#[test]
fn patches_that_cannot_be_are_refused() {
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [16; 2], Centring::Cell).expect("a mesh");
    let said = |patches: &[Patch<2>]| match RefinedPlan::new(&base, patches, RefineParams::default()) {
        Err(FreeSpaceError::Patch { what, .. }) => what,
        other => panic!("{other:?}"),
    };
    let good = Patch { parent: None, first: [6; 2], cells: [4; 2], ratio: 2 };
    assert!(said(&[Patch { ratio: 1, ..good }]).contains("ratio is 1"));
    let huge = RefinedPlan::new(&base, &[Patch { ratio: usize::MAX, ..good }], RefineParams::default());
    assert!(matches!(huge, Err(FreeSpaceError::Memory { .. })), "{huge:?}");
    assert!(said(&[Patch { first: [6, 14], ..good }]).contains("direction 1, which has 16"));
    assert!(said(&[Patch { parent: Some(0), ..good }]).contains("does not come before"));
    assert!(said(&[Patch { cells: [0, 4], ..good }]).contains("covers"));
}
