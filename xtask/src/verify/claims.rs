//! Claims: what a paper or we ourselves say, and what was measured. A claim is checked in code or it is not in the table.

use super::csv;

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is as was said.
    Holds,
    /// We measure otherwise, within the band that the claim names, and know why.
    Explained(&'static str),
    /// It is not as was said, or could not be measured.
    Fails,
}

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Claim {
    pub(crate) suite: &'static str,
    pub(crate) case: &'static str,
    pub(crate) claim: String,
    pub(crate) expected: String,
    pub(crate) measured: String,
    pub(crate) verdict: Verdict,
}

/// The columns, in the order of the contract.
const COLUMNS: [&str; 6] = ["suite", "case", "claim", "expected", "measured", "holds"];

impl Claim {
    /// The entry of the last column.
    pub(crate) fn holds(&self) -> &'static str {
        match self.verdict {
            Verdict::Holds => "yes",
            Verdict::Explained(_) => "explained",
            Verdict::Fails => "no",
        }
    }

    fn line(&self) -> String {
        let measured = match self.verdict {
            Verdict::Explained(why) => format!("{}: {why}", self.measured),
            _ => self.measured.clone(),
        };
        csv::line(&[self.suite, self.case, &self.claim, &self.expected, &measured, self.holds()])
    }
}

/// The whole file.
pub(crate) fn file<'a>(claims: impl Iterator<Item = &'a Claim>) -> String {
    claims.fold(csv::line(&COLUMNS), |text, claim| text + &claim.line())
}

/// The table while it is being filled.
///
/// A measurement of `None` fails the claim, unless runs were left out on the command line: then the claim is left out.
#[derive(Debug)]
pub(crate) struct Claims {
    suite: &'static str,
    partial: bool,
    list: Vec<Claim>,
}

impl Claims {
    pub(crate) fn new(suite: &'static str, partial: bool) -> Self {
        Self { suite, partial, list: Vec::new() }
    }

    /// Measured at most `limit`.
    pub(crate) fn at_most(
        &mut self,
        case: &'static str,
        claim: impl Into<String>,
        measured: Option<f64>,
        limit: f64,
    ) {
        self.judge(case, claim.into(), format!("≤ {}", short(limit)), measured, |m| m <= limit, None);
    }

    /// Measured at least `limit`.
    pub(crate) fn at_least(
        &mut self,
        case: &'static str,
        claim: impl Into<String>,
        measured: Option<f64>,
        limit: f64,
    ) {
        self.judge(case, claim.into(), format!("≥ {}", short(limit)), measured, |m| m >= limit, None);
    }

    /// Measured between two bounds, both included.
    pub(crate) fn within(
        &mut self,
        case: &'static str,
        claim: impl Into<String>,
        measured: Option<f64>,
        band: [f64; 2],
    ) {
        self.judge(case, claim.into(), range(band), measured, |m| (band[0]..=band[1]).contains(&m), None);
    }

    /// A claim of a paper that we may measure otherwise: it holds within `paper`; else it counts as explained by `why`
    /// as long as our figure stays within `ours`, so that the row can still fail.
    pub(crate) fn explained(
        &mut self,
        case: &'static str,
        claim: impl Into<String>,
        measured: Option<f64>,
        paper: [f64; 2],
        ours: [f64; 2],
        why: &'static str,
    ) {
        let within = |band: [f64; 2]| measured.is_some_and(|m| (band[0]..=band[1]).contains(&m));
        if within(paper) {
            return self.judge(case, claim.into(), range(paper), measured, |_| true, None);
        }
        let expected = format!("{}; here {}", range(paper), range(ours));
        self.judge(case, claim.into(), expected, measured, |_| within(ours), Some(why));
    }

    /// The rows in the order of the cases, those about no single case last.
    pub(crate) fn by_case(mut self, cases: &[&str]) -> Vec<Claim> {
        let place = |claim: &Claim| cases.iter().position(|c| *c == claim.case).unwrap_or(cases.len());
        self.list.sort_by_key(place);
        self.list
    }

    fn judge(
        &mut self,
        case: &'static str,
        claim: String,
        expected: String,
        measured: Option<f64>,
        test: impl Fn(f64) -> bool,
        why: Option<&'static str>,
    ) {
        if measured.is_none() && self.partial {
            return;
        }
        let verdict = match (measured.is_some_and(test), why) {
            (true, None) => Verdict::Holds,
            (true, Some(why)) => Verdict::Explained(why),
            (false, _) => Verdict::Fails,
        };
        let measured = measured.map_or_else(|| "not measured".to_owned(), short);
        self.list.push(Claim { suite: self.suite, case, claim, expected, measured, verdict });
    }
}

/// A band in words; infinite ends are left out.
fn range([low, high]: [f64; 2]) -> String {
    match (low.is_finite(), high.is_finite()) {
        (true, false) => format!("≥ {}", short(low)),
        (false, true) => format!("≤ {}", short(high)),
        _ => format!("{} … {}", short(low), short(high)),
    }
}

/// A number as it is read in a table.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || x.fract() == 0.0 && x.abs() < 1e4 {
        format!("{x}")
    } else if (0.01..1e4).contains(&x.abs()) {
        format!("{x:.3}")
    } else {
        format!("{x:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::{Claims, Verdict, file};

    #[test]
    fn a_claim_that_cannot_be_measured_fails_unless_runs_were_left_out() {
        let mut all = Claims::new("s", false);
        all.at_most("c", "small", None, 1.0);
        assert_eq!(all.list[0].verdict, Verdict::Fails);
        let mut some = Claims::new("s", true);
        some.at_most("c", "small", None, 1.0);
        assert!(some.list.is_empty());
    }

    #[test]
    fn an_explained_claim_may_hold_and_can_fail() {
        let mut claims = Claims::new("s", false);
        for order in [1.0, 0.5, 0.3, f64::NAN] {
            claims.explained(
                "c",
                "order",
                Some(order),
                [0.9, f64::INFINITY],
                [0.4, 0.9],
                "the cloud differs",
            );
        }
        let verdicts: Vec<Verdict> = claims.list.iter().map(|c| c.verdict).collect();
        let expected =
            [Verdict::Holds, Verdict::Explained("the cloud differs"), Verdict::Fails, Verdict::Fails];
        assert_eq!(verdicts, expected);
        assert_eq!(claims.list[0].expected, "≥ 0.900");
    }

    #[test]
    fn not_a_number_fails() {
        let mut claims = Claims::new("s", false);
        claims.at_most("c", "small", Some(f64::NAN), 1.0);
        claims.at_least("c", "large", Some(f64::NAN), 1.0);
        claims.within("c", "between", Some(f64::NAN), [0.0, 1.0]);
        assert!(claims.list.iter().all(|c| c.verdict == Verdict::Fails));
    }

    #[test]
    fn the_file_has_the_columns_of_the_contract() {
        let mut claims = Claims::new("s", false);
        claims.at_most("c", "error, relative", Some(0.5), 1.0);
        assert_eq!(
            file(claims.list.iter()),
            "suite,case,claim,expected,measured,holds\ns,c,\"error, relative\",≤ 1,0.500,yes\n"
        );
    }
}
