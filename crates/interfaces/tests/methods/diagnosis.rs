//! Figures about nodes against what the methods themselves find.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::gfdm::{GfdmParams, StrongParams};
use meshless_interfaces::{NodeDiagnosis, RowKind, diagnose_nodes};

use crate::support::{Setup, unit};

fn setup() -> Setup<2> {
    let disc = Shape::ball([0.5; 2], 0.3).unwrap();
    Setup::generated(unit(), Layout::Irregular, 0.05, 3).regions(vec![Some(disc), None], &[1e6, 1.0])
}

#[test]
fn the_dominance_error_is_that_by_which_nodes_are_selected() {
    let setup = setup();
    let classical = GfdmParams {
        strong: StrongParams { smoothing: 0, ..GfdmParams::hybrid().strong },
        ..GfdmParams::classical()
    };
    let rows = setup.discretize(classical);
    let figures = diagnose_nodes(&setup.problem(), &rows, 2);
    let over = |i: &usize| {
        rows.kinds[*i] == RowKind::Strong && figures[*i].dominance_error > GfdmParams::SELECTION_TOLERANCE
    };
    let selected = setup.discretize(GfdmParams::positive());
    let expected: Vec<usize> =
        (0..rows.kinds.len()).filter(|&i| selected.kinds[i] == RowKind::Conservative).collect();
    assert!(!expected.is_empty());
    assert_eq!((0..rows.kinds.len()).filter(over).collect::<Vec<_>>(), expected);
}

#[test]
fn sound_stencils_reproduce_polynomials_and_other_rows_have_no_stencil() {
    let setup = setup();
    let rows = setup.discretize(GfdmParams::hybrid());
    for (figures, kind) in diagnose_nodes(&setup.problem(), &rows, 2).iter().zip(&rows.kinds) {
        match kind {
            RowKind::Dirichlet => assert_eq!(*figures, NodeDiagnosis::default()),
            RowKind::Conservative => {
                assert_eq!((figures.condition, figures.residual), (0.0, 0.0));
                assert!(figures.wrong_sign == 0.0 && figures.dominance_error < 1e-12, "{figures:?}");
            }
            _ => assert!((1.0..1e4).contains(&figures.condition) && figures.residual < 1e-13, "{figures:?}"),
        }
    }
    let poor = diagnose_nodes(&setup.problem(), &rows, 7);
    assert!(poor.iter().any(|d| d.condition == f64::INFINITY), "27 neighbours determine no degree of 7");
}
