//! The known name that was probably meant.

/// The candidate nearest to `name`, if it is near enough to be a slip of the pen.
///
/// The distance is that of optimal string alignment (insertions, deletions, substitutions and swaps of
/// neighbours, regardless of case); at most one edit per three characters, and at least one, is allowed.
/// Among equally near candidates one of the same length is preferred, then the first.
///
/// ```
/// assert_eq!(meshless_expr::nearest_name("sprt", ["exp", "sqrt"]), Some("sqrt"));
/// assert_eq!(meshless_expr::nearest_name("voltage", ["exp", "sqrt"]), None);
/// ```
pub fn nearest_name<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    /// Names longer than this are not worth the quadratic comparison.
    const LONGEST: usize = 64;
    let name: Vec<char> = name.to_lowercase().chars().take(LONGEST + 1).collect();
    if name.len() > LONGEST {
        return None;
    }
    let allowed = (name.len() / 3).max(1);
    let near = candidates.into_iter().filter_map(|candidate| {
        let letters: Vec<char> = candidate.to_lowercase().chars().collect();
        let edits = distance(&name, &letters);
        // A name that shares no character with the candidate is no misspelling of it.
        let plausible = edits <= allowed && edits < name.len().max(letters.len());
        plausible.then_some((edits, name.len().abs_diff(letters.len()), candidate))
    });
    near.min_by_key(|&(edits, longer, _)| (edits, longer)).map(|(_, _, candidate)| candidate)
}

/// Optimal string alignment distance: three rows of the dynamic programme are kept.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let substitution = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = substitution.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before_last[j - 2] + 1);
            }
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips_of_the_pen() {
        assert_eq!(nearest_name("Sin", ["cos", "sin"]), Some("sin"));
        assert_eq!(nearest_name("difusivity", ["source", "diffusivity"]), Some("diffusivity"));
        assert_eq!(nearest_name("tahn", ["tan", "tanh"]), Some("tanh"));
    }

    #[test]
    fn leaves_strangers_alone() {
        assert_eq!(nearest_name("q", ["x", "y"]), None);
        assert_eq!(nearest_name("", ["x", "y"]), None);
        assert_eq!(nearest_name("temperature", ["source", "exact"]), None);
    }
}
