//! Every `meshless` command that `README.md` shows is run, and prints what the README says.

use std::path::Path;
use std::process::Command;

/// What a number may differ by from the printed one, relative: clouds differ by round-off between machines.
const TOLERANCE: f64 = 0.02;

/// Lines whose numbers are times or round-off, and differ from run to run.
const VARYING: [&str; 4] = ["seconds", "solver", "predicted", "balance"];

fn readme() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md")).expect("README.md")
}

fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let mut parts = text.split("```");
    parts.next();
    parts.step_by(2).filter_map(|b| b.strip_prefix(language)?.strip_prefix('\n')).collect()
}

/// Whether two lines say the same, numbers up to the tolerance.
fn alike(shown: &str, printed: &str) -> bool {
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
    if first(shown).is_some_and(|word| VARYING.contains(&word.as_str())) {
        return first(shown) == first(printed);
    }
    let words =
        |line: &str| line.split([' ', ',', '(', ')', '[', ']', ':']).map(str::to_owned).collect::<Vec<_>>();
    let (a, b) = (words(shown), words(printed));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= TOLERANCE * x.abs().max(y.abs()),
            _ => a == b,
        })
}

#[test]
fn commands_print_what_the_readme_shows() {
    let text = readme();
    let scene = blocks(&text, "toml")[0];
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plate.toml"), scene).unwrap();
    let mistake = scene.replace("\"1 + x/2\"", "\"1 + sinn(x)\"");
    assert_ne!(mistake, scene, "the README describes a mistake in a line that is not there");
    std::fs::write(folder.path().join("mistake.toml"), mistake).unwrap();
    let consoles = blocks(&text, "console");
    assert!(consoles.len() >= 3);
    for console in consoles {
        let (command, shown) = console.split_once('\n').unwrap();
        let arguments: Vec<&str> = command.strip_prefix("$ meshless ").unwrap().split_whitespace().collect();
        let output = Command::new(env!("CARGO_BIN_EXE_meshless"))
            .args(&arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let printed = if output.status.success() { output.stdout } else { output.stderr };
        let printed = String::from_utf8(printed).unwrap();
        assert_eq!(shown.lines().count(), printed.lines().count(), "`{command}` prints\n{printed}");
        for (shown, printed) in shown.lines().zip(printed.lines()) {
            assert!(alike(shown, printed), "`{command}`\nREADME: {shown}\nprints: {printed}");
        }
    }
    assert!(folder.path().join("meshless-out/plate.svg").is_file());
}

#[test]
fn commands_without_a_shown_answer_run_from_the_root() {
    let text = readme();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let commands: Vec<&str> = blocks(&text, "sh")
        .into_iter()
        .flat_map(str::lines)
        .filter_map(|line| line.strip_prefix("meshless "))
        .collect();
    assert!(!commands.is_empty());
    for command in commands {
        let folder = tempfile::tempdir().unwrap();
        let mut arguments: Vec<&str> = command.split_whitespace().collect();
        arguments.extend(["--out", folder.path().to_str().unwrap()]);
        let output = Command::new(env!("CARGO_BIN_EXE_meshless"))
            .args(&arguments)
            .current_dir(&root)
            .output()
            .unwrap();
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(std::fs::read_dir(folder.path()).unwrap().count() > 0, "{command} writes nothing");
    }
}
