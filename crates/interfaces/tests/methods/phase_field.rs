//! Interfaces from labels alone.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::MethodError;
use meshless_interfaces::phase_field::{PhaseFieldParams, regions_from_labels};

use crate::support::{Setup, unit};

/// A disc, and a ring about it: three regions of which two touch the background.
fn labelled(layout: Layout, spacing: f64) -> Setup<2> {
    let ball = |radius| Some(Shape::ball([0.48, 0.5], radius).unwrap());
    Setup::<2>::generated(unit(), layout, spacing, 1)
        .with_support(2.9)
        .regions(vec![ball(0.2), ball(0.36), None], &[1.0; 3])
}

#[test]
fn the_interface_is_found_to_a_fraction_of_the_spacing() {
    // On clouds that are moved by half a spacing normals are off by up to 26 degrees.
    for layout in [Layout::Grid, Layout::Jittered] {
        let h = 0.02;
        let setup = labelled(layout, h);
        let problem = setup.problem();
        let (regions, infos) = regions_from_labels(
            &setup.cloud,
            problem.supports.lists,
            &setup.labels,
            3,
            &PhaseFieldParams::default(),
        )
        .unwrap();
        for info in &infos {
            let drift = PhaseFieldParams::default().drift;
            assert!(info.drift.abs() <= drift && info.steps >= 5 && info.defect < 0.5, "{infos:?}");
        }
        for (between, radius) in [([0, 1], 0.2), ([1, 2], 0.36)] {
            let (mut sum, mut count) = (0.0, 0.0);
            for k in 0..60 {
                let angle = std::f64::consts::TAU * f64::from(k) / 60.0;
                let n = [angle.cos(), angle.sin()];
                let x = [0.48 + (radius + h) * n[0], 0.5 + (radius + h) * n[1]];
                let foot = regions.project(between[0], between[1], &x, 6.0 * h).unwrap();
                let offset = [foot.point[0] - 0.48, foot.point[1] - 0.5];
                let found = offset[0].hypot(offset[1]);
                // The nearest point of a circle lies on the ray, whose direction is the normal.
                let along = (foot.normal[0] * n[0] + foot.normal[1] * n[1]).min(1.0);
                assert!(along > 0.9, "{layout:?} {between:?}: {along}");
                sum += (found - radius).powi(2);
                count += 1.0;
            }
            let rms = (sum / count).sqrt() / h;
            assert!(rms < 0.25, "{layout:?} {between:?}: {rms} spacings");
        }
        // Labels and level sets agree away from the interface.
        let wrong = (0..setup.cloud.len())
            .filter(|&i| regions.label(&setup.cloud.points()[i], h) != setup.labels[i])
            .filter(|&i| {
                let x = setup.cloud.points()[i];
                let r = (x[0] - 0.48).hypot(x[1] - 0.5);
                (r - 0.2).abs() > 0.5 * h && (r - 0.36).abs() > 0.5 * h
            })
            .map(|i| setup.cloud.points()[i])
            .collect::<Vec<_>>();
        assert!(wrong.is_empty(), "{layout:?}: {wrong:?}");
    }
}

/// Layers of a few spacings are beyond a phase field: averages of the labels find both of their sides to what labels know,
/// `1/sqrt(12)` spacings.
#[test]
fn thin_rings_are_found() {
    let h = 0.02;
    for layout in [Layout::Grid, Layout::Jittered, Layout::Irregular] {
        for thickness in [1.5, 2.0, 3.0, 4.0] {
            let outer = 0.2 + thickness * h;
            let setup = ring(layout, h, outer);
            let lists = setup.problem().supports.lists;
            let params = PhaseFieldParams::default();
            let (regions, _) = regions_from_labels(&setup.cloud, lists, &setup.labels, 3, &params).unwrap();
            for (between, radius) in [([0, 1], 0.2), ([1, 2], outer)] {
                let offset = |k: i32| {
                    let angle = std::f64::consts::TAU * f64::from(k) / 60.0;
                    let r = radius + 0.3 * h;
                    let x = [0.48 + r * angle.cos(), 0.5 + r * angle.sin()];
                    let foot = regions.project(between[0], between[1], &x, 6.0 * h).unwrap().point;
                    (foot[0] - 0.48).hypot(foot[1] - 0.5) - radius
                };
                let rms = ((0..60).map(|k| offset(k).powi(2)).sum::<f64>() / 60.0).sqrt() / h;
                assert!(rms < 12_f64.sqrt().recip(), "{layout:?}, {thickness}, {between:?}: {rms}");
            }
        }
    }
}

fn ring(layout: Layout, spacing: f64, outer: f64) -> Setup<2> {
    let ball = |radius| Some(Shape::ball([0.48, 0.5], radius).unwrap());
    Setup::<2>::generated(unit(), layout, spacing, 1)
        .with_support(2.9)
        .regions(vec![ball(0.2), ball(outer), None], &[1.0; 3])
}

/// A ring of half a spacing is single nodes: it has no sides.
#[test]
fn a_ring_that_is_too_thin_is_refused() {
    for layout in [Layout::Grid, Layout::Jittered, Layout::Irregular] {
        let setup = ring(layout, 0.02, 0.2 + 0.01);
        let lists = setup.problem().supports.lists;
        let found = regions_from_labels(&setup.cloud, lists, &setup.labels, 3, &PhaseFieldParams::default());
        assert!(matches!(found, Err(MethodError::LostRegion { region: 1, .. })), "{layout:?}");
    }
}

#[test]
fn labels_that_do_not_fit_are_refused() {
    let setup = labelled(Layout::Grid, 0.1);
    let problem = setup.problem();
    let from = |labels: &[u16], regions| {
        regions_from_labels(
            &setup.cloud,
            problem.supports.lists,
            labels,
            regions,
            &PhaseFieldParams::default(),
        )
    };
    assert!(from(&setup.labels[1..], 3).is_err());
    assert!(from(&setup.labels, 2).is_err());
    assert!(from(&setup.labels, 4).is_err());
}
