//! Source files: how long they are, and what must not be left in them.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::shown;
use crate::workspace;

/// What must not be left in code. Words in strings and comments do not count.
const UNDONE: &[&str] = &["todo!", "unimplemented!", "dbg!", "#[ignore"];

/// Libraries whose names must not spread beyond one file.
const REPLACEABLE: &[&str] = &["faer", "kiddo", "vtkio"];

/// The longest files are named in the summary, this many of them.
const NAMED: usize = 5;

fn sources(root: &Path) -> io::Result<Vec<(PathBuf, String)>> {
    let mut found = Vec::new();
    for folder in ["crates", "tests", "xtask"] {
        for path in workspace::files(&root.join(folder), &["rs"])? {
            let text = fs::read_to_string(&path)?;
            found.push((path, text));
        }
    }
    Ok(found)
}

/// How long the files are.
pub(super) fn summary(root: &Path) -> io::Result<String> {
    let mut lengths: Vec<(usize, String)> =
        sources(root)?.iter().map(|(path, text)| (text.lines().count(), shown(root, path))).collect();
    lengths.sort();
    let median = lengths.get(lengths.len() / 2).map_or(0, |l| l.0);
    let total: usize = lengths.iter().map(|l| l.0).sum();
    let mut text = format!("{} files, {total} lines, median {median}; the longest:", lengths.len());
    for (lines, path) in lengths.iter().rev().take(NAMED) {
        text += &format!("\n  {lines:4} {path}");
    }
    Ok(text)
}

pub(super) fn nothing_left_undone(root: &Path) -> io::Result<Vec<String>> {
    let mut wrong = Vec::new();
    for (path, text) in sources(root)? {
        for (number, line) in text.lines().enumerate() {
            let code = code_of(line);
            for word in UNDONE.iter().filter(|w| code.contains(**w)) {
                wrong.push(format!("{}:{} `{word}`", shown(root, &path), number + 1));
            }
        }
    }
    Ok(wrong)
}

pub(super) fn named_in_one_file(root: &Path) -> io::Result<Vec<String>> {
    let sources = sources(root)?;
    let mut wrong = Vec::new();
    for library in REPLACEABLE {
        let path = format!("{library}::");
        // Tests may compare with whatever they like.
        let names = |(file, text): &&(PathBuf, String)| {
            !shown(root, file).contains("tests/") && text.lines().any(|line| code_of(line).contains(&path))
        };
        let files: Vec<String> = sources.iter().filter(names).map(|(path, _)| shown(root, path)).collect();
        if files.len() > 1 {
            wrong.push(format!("{library} is named in {}", files.join(", ")));
        }
    }
    Ok(wrong)
}

pub(super) fn exceptions_have_reasons(root: &Path) -> io::Result<Vec<String>> {
    let mut wrong = Vec::new();
    for (path, text) in sources(root)? {
        for number in unexplained_exceptions(&text) {
            wrong
                .push(format!("{}:{number} an exception from a lint without its reason", shown(root, &path)));
        }
    }
    Ok(wrong)
}

/// Line numbers of `allow` and `expect` attributes that have neither `reason = ".."` nor a comment beside or above.
fn unexplained_exceptions(text: &str) -> Vec<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let is_exception = |line: &str| {
        let code = line.trim_start();
        ["#[allow(", "#![allow(", "#[expect(", "#![expect("].iter().any(|start| code.starts_with(start))
    };
    let explained = |at: usize| {
        let attribute_end =
            lines[at..].iter().position(|l| l.trim_end().ends_with(']')).map_or(at, |n| at + n);
        let with_reason =
            lines[at..=attribute_end].iter().any(|l| l.contains("reason =") || l.contains("//"));
        let comment_above = at > 0 && {
            let above = lines[at - 1].trim_start();
            above.starts_with("//") && !above.starts_with("///") && !above.starts_with("//!")
        };
        with_reason || comment_above
    };
    (0..lines.len()).filter(|&at| is_exception(lines[at]) && !explained(at)).map(|at| at + 1).collect()
}

/// A line without its strings and its comment.
fn code_of(line: &str) -> String {
    let mut code = String::with_capacity(line.len());
    let mut rest = line.chars().peekable();
    let mut quoted = false;
    while let Some(c) = rest.next() {
        match c {
            '\\' if quoted => {
                rest.next();
            }
            '"' => quoted = !quoted,
            _ if quoted => {}
            // A quotation mark as a character does not open a string.
            '\'' if rest.peek() == Some(&'"') => {
                rest.next();
            }
            '/' if rest.peek() == Some(&'/') => break,
            c => code.push(c),
        }
    }
    code
}

#[cfg(test)]
mod tests {
    use super::{code_of, unexplained_exceptions};

    #[test]
    fn strings_and_comments_are_no_code() {
        assert_eq!(code_of("let a = \"dbg!(\\\" x)\"; b() // todo!()"), "let a = ; b() ");
        assert_eq!(code_of("let quote = '\"'; todo!()"), "let quote = '; todo!()");
    }

    #[test]
    fn an_exception_needs_a_reason_beside_or_above() {
        let bad = "fn a() {}\n#[allow(dead_code)]\nfn b() {}\n";
        assert_eq!(unexplained_exceptions(bad), [2]);
        for good in [
            "#[allow(dead_code, reason = \"kept for the next method\")]\nfn b() {}",
            "#[allow(\n    dead_code,\n    reason = \"long\"\n)]\nfn b() {}",
            "// Used on other systems only.\n#[allow(dead_code)]\nfn b() {}",
            "#[allow(dead_code)] // used on other systems\nfn b() {}",
        ] {
            assert!(unexplained_exceptions(good).is_empty(), "{good}");
        }
    }

    #[test]
    fn documentation_above_is_no_reason() {
        assert_eq!(unexplained_exceptions("/// Does b.\n#[allow(dead_code)]\nfn b() {}\n"), [2]);
    }
}
