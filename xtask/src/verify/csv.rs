//! Comma-separated values as of RFC 4180.

/// One line; fields with commas, quotes or line breaks are quoted.
pub(crate) fn line<S: AsRef<str>>(fields: &[S]) -> String {
    let mut line = fields.iter().map(|f| field(f.as_ref())).collect::<Vec<_>>().join(",");
    line.push('\n');
    line
}

fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A number with the digits that matter; empty where there is none.
pub(crate) fn number(value: Option<f64>) -> String {
    match value {
        Some(x) if x == 0.0 || (1e-3..1e5).contains(&x.abs()) => {
            format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        Some(x) => format!("{x:.6e}"),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{line, number};

    #[test]
    fn fields_are_quoted_only_where_they_must_be() {
        assert_eq!(line(&["a", "", "1e-3"]), "a,,1e-3\n");
        assert_eq!(line(&["a,b", "say \"no\"", "two\nlines"]), "\"a,b\",\"say \"\"no\"\"\",\"two\nlines\"\n");
    }

    #[test]
    fn numbers_are_short_and_absent_ones_empty() {
        assert_eq!(number(Some(0.05)), "0.05");
        assert_eq!(number(Some(100.0)), "100");
        assert_eq!(number(Some(0.0)), "0");
        assert_eq!(number(Some(6.2e-4)), "6.200000e-4");
        assert_eq!(number(Some(1e10)), "1.000000e10");
        assert_eq!(number(None), "");
    }
}
