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
        if let Some(time) = &solution.report.time {
            files.extend(series(solution, time.end, folder, stem)?);
        }
    }
    if let Some(picture) = &solution.picture {
        let path = folder.join(format!("{stem}.svg"));
        write_text_atomically(&path, &picture.svg)?;
        files.push(path);
    }
    Ok(files)
}

/// The fields before the end as `stem-1.vtu` and so on, and `stem.pvd`, by which ParaView knows their times.
fn series(solution: &Solution, end: f64, folder: &Path, stem: &str) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    let mut entries = String::new();
    let mut entry = |t: f64, file: &str| {
        // A name of a file may have what XML does not let stand in an attribute.
        let file = file.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
        entries += &format!("    <DataSet timestep=\"{t}\" file=\"{file}\"/>\n");
    };
    for (k, frame) in (1..).zip(&solution.frames) {
        let name = format!("{stem}-{k}.vtu");
        write_vtu(
            folder.join(&name),
            &solution.field.points,
            &[VtuField::scalars("u", frame.u.clone()), regions(solution)],
        )?;
        entry(frame.t, &name);
        files.push(folder.join(name));
    }
    entry(end, &format!("{stem}.vtu"));
    let path = folder.join(format!("{stem}.pvd"));
    let text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n{entries}  \
         </Collection>\n</VTKFile>\n"
    );
    write_text_atomically(&path, &text)?;
    files.push(path);
    Ok(files)
}

fn regions(solution: &Solution) -> VtuField {
    VtuField::integers("region", solution.field.region.iter().map(|&r| i64::from(r)).collect())
}

fn vtu(solution: &Solution, path: &Path) -> Result<(), Error> {
    let field = &solution.field;
    let mut fields = vec![
        VtuField::scalars("u", field.u.clone()),
        VtuField::scalars("eta", field.eta.clone()),
        regions(solution),
    ];
    // In free space there are no rows.
    if !field.kind.is_empty() {
        fields.push(VtuField::integers("row_kind", field.kind.iter().map(|&k| row_code(k)).collect()));
    }
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
    if let Some(estimate) = &field.estimate {
        fields.push(VtuField::scalars("estimated_error", estimate.clone()));
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
