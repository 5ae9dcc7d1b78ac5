//! The command line of `cargo xtask verify`.

use std::iter;
use std::path::PathBuf;

use super::suite::{self, Suite};
use crate::workspace;

/// How far the ladders go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Effort {
    /// Under three minutes on two cores.
    Quick,
    /// Under fifteen minutes.
    Default,
    /// As fine as the papers go.
    Full,
}

/// What to run.
#[derive(Debug, Clone)]
pub(crate) struct Options {
    pub(crate) suites: Vec<&'static Suite>,
    /// The cases to run; all, where none is named.
    pub(crate) cases: Vec<String>,
    /// The methods to run; all, where none is named.
    pub(crate) methods: Vec<String>,
    pub(crate) effort: Effort,
    pub(crate) threads: Option<usize>,
    pub(crate) out: PathBuf,
}

impl Options {
    /// Reads the arguments; the error says what was expected.
    pub(crate) fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self {
            suites: Vec::new(),
            cases: Vec::new(),
            methods: Vec::new(),
            effort: Effort::Default,
            threads: None,
            out: workspace::root().join("target").join("verify"),
        };
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            let mut value = || rest.next().cloned().ok_or_else(|| format!("`{argument}` needs a value"));
            match argument.as_str() {
                "--case" => options.cases.push(value()?),
                "--method" => options.methods.push(value()?),
                "--threads" => options.threads = Some(positive(argument, &value()?)?),
                "--out" => options.out = PathBuf::from(value()?),
                "--quick" => options.set_effort(Effort::Quick)?,
                "--full" => options.set_effort(Effort::Full)?,
                flag if flag.starts_with('-') => {
                    return Err(format!(
                        "unknown option `{flag}`; there are --case, --method, --quick, --full, --threads, --out"
                    ));
                }
                name => options.suites.push(suite::find(name)?),
            }
        }
        if options.suites.is_empty() {
            options.suites = suite::built().collect();
        }
        options.check_names()?;
        Ok(options)
    }

    /// Whether rows are left out, so that claims may have nothing to rest on.
    pub(crate) fn is_filtered(&self) -> bool {
        !self.cases.is_empty() || !self.methods.is_empty()
    }

    /// Whether a run is asked for.
    pub(crate) fn wants(&self, case: &str, method: &str) -> bool {
        self.wants_case(case) && (self.methods.is_empty() || self.methods.iter().any(|m| m == method))
    }

    /// Whether a case is asked for.
    pub(crate) fn wants_case(&self, case: &str) -> bool {
        self.cases.is_empty() || self.cases.iter().any(|c| c == case)
    }

    fn set_effort(&mut self, effort: Effort) -> Result<(), String> {
        if self.effort != Effort::Default {
            return Err("--quick and --full exclude each other".to_owned());
        }
        self.effort = effort;
        Ok(())
    }

    fn check_names(&self) -> Result<(), String> {
        known("case", &self.cases, self.suites.iter().flat_map(|s| s.cases.iter().copied()))?;
        known("method", &self.methods, iter::once("auto").chain(meshless::METHODS.iter().map(|m| m.name)))
    }
}

fn positive(option: &str, text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err(format!("`{option}` needs a positive number, got `{text}`")),
    }
}

fn known<'a>(what: &str, given: &[String], names: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let names: Vec<&str> = names.collect();
    match given.iter().find(|name| !names.contains(&name.as_str())) {
        Some(name) => Err(format!("unknown {what} `{name}`; there are {}", names.join(", "))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Effort, Options};

    fn parse(line: &str) -> Result<Options, String> {
        Options::parse(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn options_and_suites_may_come_in_any_order() -> Result<(), String> {
        let options = parse("--quick gfdm --threads 2 --case interior")?;
        assert_eq!((options.effort, options.threads, options.suites.len()), (Effort::Quick, Some(2), 1));
        assert!(options.wants("interior", "gfdm-hybrid") && !options.wants("curved", "gfdm-hybrid"));
        Ok(())
    }

    #[test]
    fn cases_and_methods_may_be_given_several_times() -> Result<(), String> {
        let options = parse("hard --case contrast --case seeds --method auto")?;
        assert!(options.wants("contrast", "auto") && options.wants("seeds", "auto"));
        assert!(!options.wants("thin-gap", "auto") && !options.wants("seeds", "sharp"));
        Ok(())
    }

    #[test]
    fn mistakes_name_what_is_known() {
        let error = |line: &str| parse(line).err().unwrap_or_default();
        assert!(error("gdfm").contains("gfdm"));
        assert!(error("--case outerior").contains("interior"));
        assert!(error("gfdm --case interior --case torus").contains("`torus`"));
        assert!(error("--method none").contains("gfdm-hybrid"));
        assert!(error("--threads 0").contains("positive"));
        assert!(error("--quick --full").contains("exclude"));
        assert!(error("--fast").contains("unknown option"));
        assert!(error("--out").contains("needs a value"));
    }
}
