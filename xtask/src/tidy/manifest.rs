//! The few facts about a crate that `tidy` needs from its `Cargo.toml`, read line by line.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A package of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Manifest {
    /// Folder of the package.
    pub(super) folder: PathBuf,
    /// Name of the package.
    pub(super) name: String,
    /// Names under `[dependencies]`, `[build-dependencies]` and `[dev-dependencies]`, in any order.
    pub(super) dependencies: Vec<Dependency>,
    /// Whether it takes the lints of the workspace.
    pub(super) workspace_lints: bool,
}

/// A dependency on another package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Dependency {
    /// Its name.
    pub(super) name: String,
    /// Whether only tests and examples use it.
    pub(super) dev: bool,
}

impl Manifest {
    /// Reads the facts from the text of a manifest.
    pub(super) fn parse(folder: &Path, text: &str) -> Self {
        let mut manifest = Self {
            folder: folder.to_path_buf(),
            name: String::new(),
            dependencies: Vec::new(),
            workspace_lints: false,
        };
        let mut section = "";
        for line in text.lines().map(|l| l.split('#').next().unwrap_or("").trim()) {
            if let Some(header) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
                section = header.trim_matches(['[', ']']);
                if let Some((table, name)) = section.rsplit_once('.') {
                    manifest.note_dependency(table, name);
                }
                continue;
            }
            let Some((key, value)) = line.split_once('=') else { continue };
            let (key, value) = (key.trim(), value.trim());
            match (section, key) {
                ("package", "name") => manifest.name = value.trim_matches('"').to_owned(),
                ("lints", "workspace") | ("", "lints.workspace") => {
                    manifest.workspace_lints = value == "true";
                }
                _ => manifest.note_dependency(section, key.split('.').next().unwrap_or(key)),
            }
        }
        manifest
    }

    /// Notes `name` if `table` is a table of dependencies, also one of a target: `target.'cfg(unix)'.dependencies`.
    fn note_dependency(&mut self, table: &str, name: &str) {
        let kind = table.rsplit('.').next().unwrap_or(table);
        if matches!(kind, "dependencies" | "build-dependencies" | "dev-dependencies") {
            self.dependencies
                .push(Dependency { name: name.trim_matches('"').to_owned(), dev: kind.starts_with("dev") });
        }
    }
}

/// The packages of the workspace: those below `crates`, then `tests` and `xtask`.
pub(super) fn all(root: &Path) -> io::Result<Vec<Manifest>> {
    let mut folders = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        folders.push(entry?.path());
    }
    folders.sort();
    folders.extend([root.join("tests"), root.join("xtask")]);
    folders.iter().map(|f| Ok(Manifest::parse(f, &fs::read_to_string(f.join("Cargo.toml"))?))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Dependency, Manifest};
    use std::path::Path;

    fn dependency(name: &str, dev: bool) -> Dependency {
        Dependency { name: name.to_owned(), dev }
    }

    #[test]
    fn names_dependencies_and_lints_are_found() {
        let text = "[package]\nname = \"a-b\" # no = sign in here\nversion.workspace = true\n\n[lints]\nworkspace = true\n\
                    [dependencies]\nfaer.workspace = true\nserde = { version = \"1\", features = [\"derive\"] }\n\
                    [dependencies.rayon]\nversion = \"1\"\n[dev-dependencies]\nproptest = \"1\"\n\
                    [[bin]]\nname = \"other\"\n[target.'cfg(unix)'.dependencies]\nlibc = \"0.2\"\n";
        let manifest = Manifest::parse(Path::new("crates/a"), text);
        assert_eq!(manifest.name, "a-b");
        assert!(manifest.workspace_lints);
        let expected = [
            dependency("faer", false),
            dependency("serde", false),
            dependency("rayon", false),
            dependency("proptest", true),
            dependency("libc", false),
        ];
        assert_eq!(manifest.dependencies, expected);
    }

    #[test]
    fn a_manifest_without_lints_is_recognised() {
        assert!(
            !Manifest::parse(Path::new("a"), "[package]\nname = \"a\"\n[lints]\nworkspace = false\n")
                .workspace_lints
        );
        assert!(!Manifest::parse(Path::new("a"), "[package]\nname = \"a\"\n").workspace_lints);
    }
}
