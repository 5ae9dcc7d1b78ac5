//! Who may depend on whom.

use std::io;
use std::path::Path;

use super::manifest::{self, Manifest};

/// The crates that know nothing of each other.
const LEAVES: &[&str] = &[
    "meshless-cells",
    "meshless-expr",
    "meshless-freespace",
    "meshless-geometry",
    "meshless-neighbors",
    "meshless-output",
    "meshless-sparse",
    "meshless-stencils",
    "meshless-time",
];

/// What a package of the workspace may depend on within it.
enum May {
    /// These and no others.
    Only(&'static [&'static str]),
    /// The leaves and these.
    LeavesAnd(&'static [&'static str]),
}

/// Every package that is no leaf.
const ARROWS: &[(&str, May)] = &[
    (
        "meshless-interfaces",
        May::Only(&[
            "meshless-cells",
            "meshless-geometry",
            "meshless-neighbors",
            "meshless-sparse",
            "meshless-stencils",
        ]),
    ),
    ("meshless", May::LeavesAnd(&["meshless-interfaces"])),
    ("meshless-cli", May::Only(&["meshless"])),
    ("meshless-tests", May::LeavesAnd(&["meshless", "meshless-interfaces", "meshless-cli"])),
    ("xtask", May::LeavesAnd(&["meshless", "meshless-interfaces", "meshless-tests"])),
];

/// Libraries from outside that one crate wraps, so that they can be replaced by changing that crate alone.
const WRAPPED: &[(&str, &str)] = &[
    ("clap", "meshless-cli"),
    ("faer", "meshless-sparse"),
    ("indicatif", "meshless-cli"),
    ("kiddo", "meshless-neighbors"),
    ("plotters", "meshless-output"),
    ("rand_xoshiro", "meshless-geometry"),
    ("pulp", "meshless-freespace"),
    ("realfft", "meshless-freespace"),
    ("rustfft", "meshless-freespace"),
    ("sprs", "meshless-sparse"),
    ("toml", "meshless"),
    ("vtkio", "meshless-output"),
];

pub(super) fn between_crates(root: &Path) -> io::Result<Vec<String>> {
    let manifests = manifest::all(root)?;
    Ok(manifests.iter().flat_map(|m| wrong_arrows(m, &manifests)).collect())
}

fn wrong_arrows(of: &Manifest, all: &[Manifest]) -> Vec<String> {
    let name = of.name.as_str();
    let may = ARROWS.iter().find(|(n, _)| *n == name).map(|(_, may)| may);
    if may.is_none() && !LEAVES.contains(&name) {
        return vec![format!(
            "{name} is not in the table of xtask/src/tidy/arrows.rs: add it with what it may depend on"
        )];
    }
    let allowed = |target: &str| match may {
        None => false,
        Some(May::Only(these)) => these.contains(&target),
        Some(May::LeavesAnd(these)) => LEAVES.contains(&target) || these.contains(&target),
    };
    // The gallery of exact solutions may serve the tests of every crate.
    let gallery = |dependency: &manifest::Dependency| dependency.dev && dependency.name == "meshless-tests";
    of.dependencies
        .iter()
        .filter(|d| all.iter().any(|m| m.name == d.name) && !allowed(&d.name) && !gallery(d))
        .map(|d| format!("{name} must not depend on {}", d.name))
        .collect()
}

pub(super) fn to_the_outside(root: &Path) -> io::Result<Vec<String>> {
    let wrong = |m: &Manifest| -> Vec<String> {
        let foreign = |d: &&manifest::Dependency| {
            WRAPPED.iter().any(|(library, owner)| !d.dev && d.name == *library && m.name != *owner)
        };
        m.dependencies.iter().filter(foreign).map(|d| format!("{} names {}", m.name, d.name)).collect()
    };
    Ok(manifest::all(root)?.iter().flat_map(wrong).collect())
}

#[cfg(test)]
mod tests {
    use super::wrong_arrows;
    use crate::tidy::manifest::Manifest;
    use std::path::Path;

    fn package(name: &str, dependencies: &str) -> Manifest {
        Manifest::parse(
            Path::new(name),
            &format!("[package]\nname = \"{name}\"\n[dependencies]\n{dependencies}"),
        )
    }

    #[test]
    fn leaves_know_nothing_of_each_other() {
        let all = [
            package("meshless-sparse", "meshless-cells.workspace = true\nfaer = \"0\"\n"),
            package("meshless-cells", ""),
        ];
        assert_eq!(wrong_arrows(&all[0], &all), ["meshless-sparse must not depend on meshless-cells"]);
        assert!(wrong_arrows(&all[1], &all).is_empty());
    }

    #[test]
    fn the_facade_may_use_leaves_but_the_command_only_the_facade() {
        let uses = "meshless-cells = \"0\"\n";
        let all = [package("meshless", uses), package("meshless-cli", uses), package("meshless-cells", "")];
        assert!(wrong_arrows(&all[0], &all).is_empty());
        assert_eq!(wrong_arrows(&all[1], &all).len(), 1);
    }

    #[test]
    fn a_package_that_is_in_no_table_is_refused() {
        let all = [package("meshless-new", "")];
        assert_eq!(wrong_arrows(&all[0], &all).len(), 1);
    }
}
