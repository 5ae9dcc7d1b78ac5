//! Files of a solved scene.

use std::path::{Path, PathBuf};

use meshless_interfaces::{NodeDiagnosis, RowKind};
use meshless_output::{VtuField, write_text_atomically, write_vtu};

use crate::execute::Solution;
use crate::plan::{Plan, Stage};
use crate::{Error, NodalField, ParticleField};

/// Writes what the plan says into `folder`, which must exist, as `stem.vtu`, `stem.csv` and `stem.svg`, and the fields at particles
/// as `stem-particles.csv`; returns the files.
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
    if plan.runs(Stage::Csv) {
        let path = folder.join(format!("{stem}.csv"));
        write_text_atomically(&path, &nodes(&solution.field).text())?;
        files.push(path);
        files.extend(tables(solution, folder, stem)?);
        if let Some(particles) = &solution.particles {
            let path = folder.join(format!("{stem}-particles.csv"));
            write_text_atomically(&path, &carried(particles).text())?;
            files.push(path);
        }
    }
    if let Some(picture) = &solution.picture {
        let path = folder.join(format!("{stem}.svg"));
        write_text_atomically(&path, &picture.svg)?;
        files.push(path);
    }
    Ok(files)
}

/// The fields before the end as `stem-1.csv` and so on.
fn tables(solution: &Solution, folder: &Path, stem: &str) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for (k, frame) in (1..).zip(&solution.frames) {
        let field = &solution.field;
        let table = Lines {
            points: &field.points,
            dimension: field.dimension,
            scalars: vec![("u", &frame.u)],
            vectors: Vec::new(),
        };
        let path = folder.join(format!("{stem}-{k}.csv"));
        write_text_atomically(&path, &table.text())?;
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

/// A table with a line for each point.
struct Lines<'a> {
    points: &'a [[f64; 3]],
    dimension: usize,
    scalars: Vec<(&'static str, &'a [f64])>,
    vectors: Vec<(&'static str, &'a [[f64; 3]])>,
}

/// Coordinates, u, its gradient and the velocity, as far as there are any.
fn nodes(field: &NodalField) -> Lines<'_> {
    Lines {
        points: &field.points,
        dimension: field.dimension,
        scalars: vec![("u", &field.u)],
        vectors: vectors(&field.gradient, &field.velocity),
    }
}

/// The same of particles, with what they carry.
fn carried(field: &ParticleField) -> Lines<'_> {
    Lines {
        points: &field.positions,
        dimension: field.dimension,
        scalars: vec![("strength", &field.strengths), ("u", &field.u)],
        vectors: vectors(&field.gradient, &field.velocity),
    }
}

fn vectors<'a>(
    gradient: &'a Option<Vec<[f64; 3]>>,
    velocity: &'a Option<Vec<[f64; 3]>>,
) -> Vec<(&'static str, &'a [[f64; 3]])> {
    let named = [("gradient", gradient), ("velocity", velocity)];
    named.into_iter().filter_map(|(name, values)| values.as_deref().map(|v| (name, v))).collect()
}

impl Lines<'_> {
    /// Comma-separated, with a line of names. Numbers are read back as they are.
    fn text(&self) -> String {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let axes = &AXES[..self.dimension];
        let mut names: Vec<String> = axes.iter().map(|a| (*a).to_owned()).collect();
        names.extend(self.scalars.iter().map(|(name, _)| (*name).to_owned()));
        names.extend(
            self.vectors.iter().flat_map(|(name, _)| axes.iter().map(move |a| format!("{name}_{a}"))),
        );
        let mut text = names.join(",") + "\n";
        for (i, point) in self.points.iter().enumerate() {
            let own = point[..axes.len()].iter().chain(self.scalars.iter().map(|(_, values)| &values[i]));
            let all = own.chain(self.vectors.iter().flat_map(|(_, v)| &v[i][..axes.len()]));
            let line: Vec<String> = all.map(f64::to_string).collect();
            text += &line.join(",");
            text.push('\n');
        }
        text
    }
}

fn vtu(solution: &Solution, path: &Path) -> Result<(), Error> {
    let field = &solution.field;
    let mut fields = vec![
        VtuField::scalars("u", field.u.clone()),
        VtuField::scalars("eta", field.eta.clone()),
        VtuField::scalars("spacing", field.spacing.clone()),
        regions(solution),
    ];
    // In free space there are no rows.
    if !field.kind.is_empty() {
        fields.push(VtuField::integers("row_kind", field.kind.iter().map(|&k| row_code(k)).collect()));
    }
    if let Some(gradient) = &field.gradient {
        fields.push(VtuField::vectors("gradient", gradient));
    }
    if let Some(velocity) = &field.velocity {
        fields.push(VtuField::vectors("velocity", velocity));
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
    if let Some(indicator) = &field.indicator {
        fields.push(VtuField::scalars("indicator", indicator.clone()));
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
