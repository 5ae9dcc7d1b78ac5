//! Scenes that were mangled at random: an answer, never a panic.

use proptest::prelude::*;

use super::PLATE;
use crate::scene::Scene;

/// Texts that are likely to reach the less travelled paths.
const FRAGMENTS: [&str; 24] = [
    "nan",
    "-1",
    "0",
    "1e999",
    "\"",
    "'''",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\n",
    "[domain]",
    "[[regions]]",
    "true",
    "[]",
    "\"x/0\"",
    "union = [{}, {}]",
    "é",
    "\u{0}",
    "\t",
    ".",
    "18446744073709551616",
    "stl = 1",
];

/// Cuts at character boundaries.
fn spliced(text: &str, from: usize, length: usize, insert: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let from = from % (characters.len() + 1);
    let to = (from + length).min(characters.len());
    characters[..from].iter().copied().chain(insert.chars()).chain(characters[to..].iter().copied()).collect()
}

fn answer(text: &str) -> Result<(), TestCaseError> {
    if let Err(error) = Scene::parse(text, "scene.toml") {
        prop_assert!(!error.message.is_empty());
        prop_assert!(error.line >= 1 && error.line <= text.lines().count() + 1, "{}", error);
        let place = format!("scene.toml:{}:{}: ", error.line, error.column);
        prop_assert!(error.to_string().starts_with(&place), "{}", error);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn splices_are_answered(
        splices in prop::collection::vec((0usize..2000, 0usize..12, prop::sample::select(&FRAGMENTS[..])), 1..4),
    ) {
        let text = splices.iter().fold(PLATE.to_owned(), |text, (at, n, insert)| spliced(&text, *at, *n, insert));
        answer(&text)?;
    }

    /// Whole lines lost, doubled or moved: the syntax stays right, the meaning does not.
    #[test]
    fn shuffled_lines_are_answered(moves in prop::collection::vec((0usize..100, 0usize..100, any::<bool>()), 1..5)) {
        let mut lines: Vec<&str> = PLATE.lines().collect();
        for (from, to, keep) in moves {
            let from = from % lines.len();
            let line = if keep { lines[from] } else { lines.remove(from) };
            lines.insert(to % (lines.len() + 1), line);
        }
        answer(&lines.join("\n"))?;
    }

    /// Each value replaced by a value of another type.
    #[test]
    fn swapped_values_are_answered(line in 0usize..100, value in prop::sample::select(&[
        "1", "-0.5", "\"x\"", "true", "[1, 2]", "[[1, 2], [3, 4], [5, 6]]", "{ min = [0, 0] }", "{}", "1979-05-27", "\"left\"",
    ][..])) {
        let lines = PLATE.lines().enumerate().map(|(index, text)| match text.split_once(" = ") {
            Some((key, _)) if index == line => format!("{key} = {value}"),
            _ => text.to_owned(),
        });
        answer(&lines.collect::<Vec<_>>().join("\n"))?;
    }

    #[test]
    fn any_text_is_answered(text in "\\PC{0,60}") {
        answer(&text)?;
    }
}

#[test]
fn deep_nesting_is_answered() {
    for text in [
        format!("a = {}", "[".repeat(100_000)),
        format!("a{} = 1", ".a".repeat(100_000)),
        format!("[{}a]", "a.".repeat(100_000)),
        PLATE.replace("box = {", &format!("{}box = {{", "union = [{ ".repeat(50_000))),
    ] {
        assert!(Scene::parse(&text, "scene.toml").is_err());
    }
}
