//! Paths and links in Markdown files and comments exist.

use std::path::{Path, PathBuf};

use crate::{assert_none, files_in, read};

/// Folders of the repository: a word in backticks that begins with one is a path.
const FOLDERS: &[&str] = &[
    "src/",
    "tests/",
    "benches/",
    "launch_configs/",
    "msgs/",
    "examples/",
    "bags/",
    "docs/",
    ".ci/",
    ".github/",
    ".cargo/",
];

#[test]
fn paths_in_documents_exist() {
    let mut violations = Vec::new();
    for file in documents() {
        let text = read(&file);
        let missing = paths(&text).into_iter().filter(|it| !Path::new(it).exists());
        violations.extend(missing.map(|it| format!("{}: `{it}` does not exist", file.display())));
        let folder = file.parent().unwrap();
        let missing = links(&text).into_iter().filter(|it| !folder.join(it).exists());
        violations.extend(missing.map(|it| format!("{}: link to {it} is broken", file.display())));
    }
    assert_none(&violations);
}

#[test]
fn paths_in_comments_exist() {
    let mut violations = Vec::new();
    for file in ["src", "tests", "benches", "examples"].iter().flat_map(|it| files_in(it, &["rs"]))
    {
        for (number, line) in read(&file).lines().enumerate() {
            let Some((_, comment)) = line.split_once("//") else { continue };
            for path in paths(comment).iter().filter(|it| !Path::new(it).exists()) {
                let place = file.display();
                violations.push(format!("{place}:{}: `{path}` does not exist", number + 1));
            }
        }
    }
    assert_none(&violations);
}

#[test]
fn paths_and_links_are_found() {
    let text = "See `src/lib.rs`, `cargo test src/x`, `src/*.rs`, `src/<name>.rs`, `bags/A_B` and `msgs/a:12`.\n\
                ```text\nsrc/not.rs\n```\n[a](docs/a.md#part) [b](https://example.org/x) [c](#here)\n\
                ![d](b.svg) ``";
    assert_eq!(paths(text), ["src/lib.rs", "msgs/a"]);
    assert_eq!(links(text), ["docs/a.md", "b.svg"]);
}

/// Every Markdown file except the changelog, which also names files of older versions.
fn documents() -> Vec<PathBuf> {
    let in_root =
        |it: &PathBuf| it.extension().is_some_and(|it| it == "md") && !it.ends_with("CHANGELOG.md");
    let root = std::fs::read_dir(".").unwrap().map(|it| it.unwrap().path()).filter(in_root);
    let folders = ["docs", "bags", "msgs", "examples", "launch_configs", "tests", ".github"];
    root.chain(folders.iter().flat_map(|it| files_in(it, &["md"]))).collect()
}

/// Words in backticks that are paths of the repository, without line numbers.
fn paths(text: &str) -> Vec<&str> {
    let words = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
    words
        .filter(|it| FOLDERS.iter().any(|folder| it.starts_with(folder)))
        .filter(|it| !it.contains([' ', '<', '*', '{', '…', '(', '$']))
        .map(|it| it.split(':').next().unwrap())
        .filter(|it| !it.split('/').any(is_placeholder))
        .collect()
}

/// True for a placeholder in a path, such as `NAME`.
fn is_placeholder(part: &str) -> bool {
    !part.is_empty() && part.chars().all(|it| it.is_ascii_uppercase() || it == '_')
}

/// Targets of links that are files, without the fragment.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|it| it.split([')', ' ']).next());
    targets
        .filter(|it| !it.contains("://") && !it.starts_with("mailto:"))
        .map(|it| it.split('#').next().unwrap())
        .filter(|it| !it.is_empty())
        .collect()
}
