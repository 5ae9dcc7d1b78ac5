//! One run as one row of `results.csv`.

use super::csv::{self, number};

/// The columns, in the order of the contract.
pub(crate) const COLUMNS: [&str; 24] = [
    "suite",
    "case",
    "method",
    "params",
    "dimension",
    "unknowns",
    "spacing",
    "contrast",
    "seed",
    "err_l2",
    "err_linf",
    "err_grad_linf",
    "order_l2",
    "order_linf",
    "iterations",
    "residual",
    "t_points",
    "t_neighbors",
    "t_stencils",
    "t_assembly",
    "t_solve",
    "t_total",
    "peak_memory_mb",
    "threads",
];

/// One run; `None` where a column has no meaning.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Row {
    pub(crate) suite: &'static str,
    pub(crate) case: &'static str,
    pub(crate) method: &'static str,
    pub(crate) params: String,
    pub(crate) dimension: usize,
    pub(crate) unknowns: usize,
    pub(crate) spacing: f64,
    pub(crate) contrast: f64,
    pub(crate) seed: u64,
    pub(crate) err_l2: Option<f64>,
    pub(crate) err_linf: Option<f64>,
    pub(crate) err_grad_linf: Option<f64>,
    pub(crate) order_l2: Option<f64>,
    pub(crate) order_linf: Option<f64>,
    pub(crate) iterations: usize,
    pub(crate) residual: f64,
    pub(crate) t_points: f64,
    pub(crate) t_neighbors: f64,
    pub(crate) t_stencils: f64,
    pub(crate) t_assembly: f64,
    pub(crate) t_solve: f64,
    pub(crate) t_total: f64,
    pub(crate) peak_memory_mb: f64,
    pub(crate) threads: usize,
}

impl Row {
    /// The row as a line of the file.
    pub(crate) fn line(&self) -> String {
        let fields: [String; COLUMNS.len()] = [
            self.suite.to_owned(),
            self.case.to_owned(),
            self.method.to_owned(),
            self.params.clone(),
            self.dimension.to_string(),
            self.unknowns.to_string(),
            number(Some(self.spacing)),
            number(Some(self.contrast)),
            self.seed.to_string(),
            number(self.err_l2),
            number(self.err_linf),
            number(self.err_grad_linf),
            number(self.order_l2),
            number(self.order_linf),
            self.iterations.to_string(),
            number(Some(self.residual)),
            number(Some(self.t_points)),
            number(Some(self.t_neighbors)),
            number(Some(self.t_stencils)),
            number(Some(self.t_assembly)),
            number(Some(self.t_solve)),
            number(Some(self.t_total)),
            number(Some(self.peak_memory_mb)),
            self.threads.to_string(),
        ];
        csv::line(&fields)
    }
}

/// The whole file.
pub(crate) fn file<'a>(rows: impl Iterator<Item = &'a Row>) -> String {
    rows.fold(csv::line(&COLUMNS), |text, row| text + &row.line())
}

#[cfg(test)]
mod tests {
    use super::{Row, file};

    #[test]
    fn the_header_is_the_contract() {
        let contract = "suite,case,method,params,dimension,unknowns,spacing,contrast,seed,err_l2,err_linf,err_grad_linf,\
                        order_l2,order_linf,iterations,residual,t_points,t_neighbors,t_stencils,t_assembly,t_solve,\
                        t_total,peak_memory_mb,threads\n";
        assert_eq!(file([].iter()), contract);
    }

    #[test]
    fn values_stand_under_their_columns() {
        let row = Row {
            suite: "gfdm",
            case: "interior",
            method: "gfdm-hybrid",
            params: "jump=1e10; seed, too".to_owned(),
            dimension: 2,
            unknowns: 932,
            spacing: 0.05,
            err_l2: Some(1e-3),
            threads: 2,
            ..Row::default()
        };
        let text = file([row].iter());
        let line = text.lines().nth(1).unwrap_or_default();
        assert_eq!(
            line,
            "gfdm,interior,gfdm-hybrid,\"jump=1e10; seed, too\",2,932,0.05,0,0,0.001,,,,,0,0,0,0,0,0,0,0,0,2"
        );
    }
}
