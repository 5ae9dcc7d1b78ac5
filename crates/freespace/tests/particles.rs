//! Particles on meshes.

use meshless_freespace::{Centring, FreeSpaceError, Kernel, Mesh, Plan, Spread};
use proptest::prelude::*;

fn mesh(centring: Centring) -> Mesh<2> {
    Mesh::of_box([-1.0, 0.0], [1.0, 1.5], [20, 18], centring).expect("a mesh")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn moments_are_kept(
        particles in prop::collection::vec(((-0.6..0.6), (0.3..1.2), (-2.0..2.0)), 1..12), node: bool,
    ) {
        let mesh = mesh(if node { Centring::Node } else { Centring::Cell });
        let positions: Vec<[f64; 2]> = particles.iter().map(|p| [p.0, p.1]).collect();
        let strengths: Vec<f64> = particles.iter().map(|p| p.2).collect();
        for (spread, degree) in [(Spread::M4Prime, 2), (Spread::M6Star, 4)] {
            let density = spread.deposit(&mesh, &positions, &strengths).expect("a density");
            let scale = strengths.iter().map(|s| s.abs()).sum::<f64>();
            for i in 0..=degree {
                for j in 0..=degree - i {
                    let power = |p: [f64; 2]| p[0].powi(i) * p[1].powi(j);
                    let carried: f64 = positions.iter().zip(&strengths).map(|(p, s)| s * power(*p)).sum();
                    let spread: f64 = density.iter().enumerate().map(|(k, d)| d * power(mesh.point(k))).sum();
                    let difference = (carried - spread * mesh.cell_volume()).abs();
                    prop_assert!(difference < 1e-12 * scale * 1.5_f64.powi(4), "{i} {j}: {difference:e}");
                }
            }
        }
    }

    #[test]
    fn reading_is_the_transpose_of_depositing(x in -0.6..0.6, y in 0.3..1.2, seed in 1_u32..50) {
        let mesh = mesh(Centring::Cell);
        let field = mesh.sample(|p| (f64::from(seed) * p[0]).sin() + p[1]);
        for spread in [Spread::M4Prime, Spread::M6Star] {
            let density = spread.deposit(&mesh, &[[x, y]], &[1.0]).expect("a density");
            let there = density.iter().zip(&field).map(|(d, f)| d * f).sum::<f64>() * mesh.cell_volume();
            let back = spread.read(&mesh, &field, &[[x, y]]).expect("values")[0];
            prop_assert!((there - back).abs() < 1e-12);
        }
    }
}

#[test]
fn a_cloud_of_particles_has_the_field_of_its_density() {
    // Particles on a lattice that is no part of the mesh carry a smooth density.
    let mesh = Mesh::of_box([-1.0; 2], [1.0; 2], [64; 2], Centring::Cell).expect("a mesh");
    let density = |p: [f64; 2]| (-(p[0] * p[0] + p[1] * p[1]) / 0.05).exp();
    let lattice = Mesh::of_box([-0.9; 2], [0.9; 2], [80; 2], Centring::Cell).expect("a mesh");
    let positions: Vec<[f64; 2]> = (0..lattice.len()).map(|i| lattice.point(i)).collect();
    let strengths: Vec<f64> = positions.iter().map(|p| density(*p) * lattice.cell_volume()).collect();
    let plan: Plan<2> = Plan::new(&mesh, Kernel::gaussian(10)).expect("a plan");
    let smooth = plan.potential(&mesh.sample(density)).expect("a potential");
    let spread = Spread::M6Star;
    let phi = plan
        .potential(&spread.deposit(&mesh, &positions, &strengths).expect("a density"))
        .expect("a potential");
    let scale = smooth.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(phi.iter().zip(&smooth).all(|(a, b)| (a - b).abs() < 1e-4 * scale));
    let at = [[0.013, -0.21]];
    let there = spread.read(&mesh, &smooth, &at).expect("values")[0];
    let finer = Mesh::of_box([-1.0; 2], [1.0; 2], [128; 2], Centring::Cell).expect("a mesh");
    let fine: Plan<2> = Plan::new(&finer, Kernel::gaussian(10)).expect("a plan");
    let fine_phi = fine.potential(&finer.sample(density)).expect("a potential");
    assert!((there - spread.read(&finer, &fine_phi, &at).expect("values")[0]).abs() < 1e-5 * scale);
}

#[test]
fn particles_outside_are_refused() {
    let mesh = mesh(Centring::Cell);
    let error =
        Spread::M6Star.deposit(&mesh, &[[0.0, 0.7], [0.95, 0.7]], &[1.0, 1.0]).expect_err("too close");
    assert!(matches!(error, FreeSpaceError::Particle { particle: 1, axis: 0, .. }), "{error}");
    assert!(Spread::M4Prime.deposit(&mesh, &[[0.0, f64::NAN]], &[1.0]).is_err());
    assert!(Spread::M4Prime.deposit(&mesh, &[[0.0, 0.7]], &[1.0, 2.0]).is_err());
}
