//! What `README.md` shows is true: its scenes solve, what it links to exists. Its Rust blocks are doctests of this
//! package, its commands are run by the tests of the package `meshless-cli`.

use std::path::{Path, PathBuf};

use meshless::plan::Plan;
use meshless::scene::Scene;
use meshless::{Silent, execute};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn readme() -> String {
    std::fs::read_to_string(root().join("README.md")).expect("README.md")
}

/// The contents of the blocks in a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let mut parts = text.split("```");
    parts.next();
    parts.step_by(2).filter_map(|b| b.strip_prefix(language)?.strip_prefix('\n').map(str::to_owned)).collect()
}

#[test]
fn every_scene_in_it_solves() {
    let scenes = blocks(&readme(), "toml");
    assert!(!scenes.is_empty());
    for text in scenes {
        let scene = Scene::parse(&text, "README.md").unwrap_or_else(|error| panic!("{error}"));
        let solution = execute(&scene, &Plan::new(&scene).unwrap(), &mut Silent).unwrap();
        assert!(solution.report.estimate.l2.is_some_and(|e| e < 0.05), "{:?}", solution.report.estimate);
    }
}

#[test]
fn every_file_that_it_links_to_exists() {
    let text = readme();
    let links: Vec<&str> = text
        .match_indices("](")
        .map(|(at, _)| text[at + 2..].split([')', '#']).next().unwrap())
        .filter(|link| !link.contains("://"))
        .collect();
    assert!(links.len() >= 5, "{links:?}");
    for link in links {
        assert!(root().join(link).exists(), "{link}");
    }
}

#[test]
fn every_example_that_it_names_exists() {
    let text = readme();
    let own = ["plate.toml", "mistake.toml"];
    let names = text.split(|c: char| c.is_whitespace() || "`()".contains(c)).filter(|w| w.ends_with(".toml"));
    for name in names.filter(|name| !own.contains(name)) {
        let file = name.rsplit('/').next().unwrap();
        assert!(root().join("examples").join(file).is_file(), "{name}");
    }
}

#[test]
fn every_cargo_command_names_what_there_is() {
    let text = readme();
    let commands: Vec<String> =
        blocks(&text, "sh").iter().flat_map(|b| b.lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    assert!(commands.len() >= 3, "{commands:?}");
    for command in commands {
        let words: Vec<&str> = command.split_whitespace().collect();
        match words[..] {
            ["cargo", "xtask", task, ..] => assert!(["verify", "bench", "tidy"].contains(&task), "{command}"),
            ["cargo", "test", "--workspace"] => {}
            ["cargo", "install", "--path", path] => {
                assert!(root().join(path).join("Cargo.toml").is_file(), "{command}");
            }
            // Run by the tests of the command.
            ["meshless", ..] => {}
            _ => panic!("no test knows the command `{command}`"),
        }
    }
}

#[test]
fn its_pictures_are_small() {
    let text = readme();
    let pictures: Vec<&str> =
        text.split(['(', ')']).filter(|part| part.starts_with("docs/images/")).collect();
    assert!(pictures.len() >= 3, "{pictures:?}");
    for picture in pictures {
        let size = std::fs::metadata(root().join(picture)).unwrap().len();
        assert!(size < 160_000, "{picture}: {size} bytes");
    }
}
