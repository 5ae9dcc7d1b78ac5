//! Documents: every crate says what it is for, and nothing lies around unmentioned.

use std::fs;
use std::io;
use std::path::Path;

use super::{manifest, shown};
use crate::workspace;

/// Documents from which the others must be reachable by one link.
const ENTRANCES: [&str; 2] = ["README.md", "docs/architecture.md"];

pub(super) fn crates_are_complete(root: &Path) -> io::Result<Vec<String>> {
    let mut wrong = Vec::new();
    for package in manifest::all(root)? {
        if package.folder.starts_with(root.join("crates")) && !package.folder.join("README.md").is_file() {
            wrong.push(format!("{} has no README.md", package.name));
        }
        if !package.workspace_lints {
            wrong.push(format!("{} lacks `[lints] workspace = true`", package.name));
        }
    }
    Ok(wrong)
}

pub(super) fn documents_are_linked(root: &Path) -> io::Result<Vec<String>> {
    let mut wrong = missing_entrances(root);
    let entrances = entrances(root);
    let docs = root.join("docs");
    let documents = if docs.is_dir() { workspace::files(&docs, &["md"])? } else { Vec::new() };
    for document in documents {
        let path = shown(root, &document);
        if ENTRANCES.contains(&path.as_str()) {
            continue;
        }
        let below_docs = path.trim_start_matches("docs/");
        let linked = entrances.iter().any(|text| is_linked(text, &path) || is_linked(text, below_docs));
        if !linked {
            wrong.push(format!("{path} is linked from neither {} nor {}", ENTRANCES[0], ENTRANCES[1]));
        }
    }
    Ok(wrong)
}

fn missing_entrances(root: &Path) -> Vec<String> {
    ENTRANCES.iter().filter(|e| !root.join(e).is_file()).map(|e| format!("{e} is missing")).collect()
}

fn entrances(root: &Path) -> Vec<String> {
    ENTRANCES.iter().filter_map(|e| fs::read_to_string(root.join(e)).ok()).collect()
}

/// Whether a Markdown text has a link to `target`, with or without an anchor.
fn is_linked(text: &str, target: &str) -> bool {
    text.match_indices("](").any(|(at, _)| {
        let link = text[at + 2..].split(')').next().unwrap_or("");
        link.split('#').next().unwrap_or("").trim_start_matches("./") == target
    })
}

pub(super) fn examples_are_mentioned(root: &Path) -> io::Result<Vec<String>> {
    let folder = root.join("examples");
    if !folder.is_dir() {
        return Ok(vec!["there is no folder examples/".to_owned()]);
    }
    let mut texts = entrances(root);
    if root.join("docs").is_dir() {
        for document in workspace::files(&root.join("docs"), &["md"])? {
            texts.push(fs::read_to_string(document)?);
        }
    }
    if let Ok(text) = fs::read_to_string(folder.join("README.md")) {
        texts.push(text);
    }
    let name = |p: &Path| p.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(workspace::files(&folder, &["toml"])?
        .iter()
        .filter(|scene| !texts.iter().any(|text| text.contains(&name(scene))))
        .map(|scene| format!("{} is mentioned in no document", shown(root, scene)))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::is_linked;

    #[test]
    fn links_are_found_with_anchors_and_leading_dots() {
        let text = "See [the methods](docs/methods.md#gfdm) and [sparse](./sparse.md).";
        assert!(is_linked(text, "docs/methods.md"));
        assert!(is_linked(text, "sparse.md"));
        assert!(!is_linked(text, "methods.md"));
    }
}
