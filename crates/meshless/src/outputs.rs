//! Files of a solved scene.

use std::path::{Path, PathBuf};

use meshless_interfaces::{NodeDiagnosis, RowKind};
use meshless_output::{VtuField, write_text_atomically, write_vtu};

use crate::Error;
use crate::execute::Solution;
use crate::plan::{Plan, Stage};

/// Writes what the plan says into `folder`, which must exist, as `stem.vtu` and `stem.svg`; returns the files.
///
/// Every file is complete or absent.
pub fn write_outputs(
    plan: &Plan,
    solution: &Solution,
    folder: &Path,
    stem: &str,
) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    if plan.runs(Stage::Vtu) {
        let path = folder.join(format!("{stem}.vtu"));
        vtu(solution, &path)?;
        files.push(path);
    }
    if let Some(picture) = &solution.picture {
        let path = folder.join(format!("{stem}.svg"));
        write_text_atomically(&path, &picture.svg)?;
        files.push(path);
    }
    Ok(files)
}

fn vtu(solution: &Solution, path: &Path) -> Result<(), Error> {
    let field = &solution.field;
    let mut fields = vec![
        VtuField::scalars("u", field.u.clone()),
        VtuField::scalars("eta", field.eta.clone()),
        VtuField::integers("region", field.region.iter().map(|&r| i64::from(r)).collect()),
        VtuField::integers("row_kind", field.kind.iter().map(|&k| row_code(k)).collect()),
    ];
    if let Some(gradient) = &field.gradient {
        fields.push(VtuField::vectors("gradient", gradient));
    }
    if let Some(diagnosis) = &field.diagnosis {
        let mut add = |name, of: fn(&NodeDiagnosis) -> f64| {
            fields.push(VtuField::scalars(name, diagnosis.iter().map(of).collect()));
        };
        add("stencil_condition", |d| d.condition);
        add("stencil_residual", |d| d.residual);
        add("wrong_sign", |d| d.wrong_sign);
        add("dominance_error", |d| d.dominance_error);
    }
    if let Some(exact) = &field.exact {
        fields.push(VtuField::scalars("error", field.u.iter().zip(exact).map(|(u, e)| u - e).collect()));
    }
    write_vtu(path, &field.points, &fields)?;
    Ok(())
}

/// How rows are coded in the field `row_kind`.
fn row_code(kind: RowKind) -> i64 {
    match kind {
        RowKind::Dirichlet => 0,
        RowKind::Strong => 1,
        RowKind::StrongBoundary => 2,
        RowKind::Conservative => 3,
        RowKind::Constrained => 4,
    }
}
