//! Interfaces from labels alone.

use meshless_geometry::{Layout, Shape};
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
