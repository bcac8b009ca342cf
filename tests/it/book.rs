//! The documentation: every link and path leads somewhere, every page is in the book, and generated
//! pages are up to date.
//!
//! To regenerate pages: `JAMGRIP_UPDATE=1 cargo test --release --test it book`, then read the diff.

use std::{
    fs,
    path::{Path, PathBuf},
};

use jamgrip::{
    scene::{self, reference},
    wire::topics::{NODE, topics},
};

/// Markdown files whose links are checked.
fn documents() -> Vec<PathBuf> {
    let mut found = markdown_files(".");
    for folder in ["docs", "bags", "msgs/interfaces"] {
        found.extend(markdown_files(folder));
    }
    assert!(10 < found.len(), "the documentation is there: {found:?}");
    found
}

fn markdown_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> =
        entries.filter(|path| path.extension().is_some_and(|it| it == "md")).collect();
    files.sort();
    files
}

/// The text outside code: blocks between fences, indented blocks and spans in backticks are left out.
fn prose(text: &str) -> String {
    let mut is_fenced = false;
    let mut kept = String::new();
    for line in text.lines() {
        let is_fence = line.trim_start().starts_with("```");
        is_fenced ^= is_fence;
        if !is_fenced && !is_fence && !line.starts_with("    ") {
            kept.extend(line.split('`').step_by(2));
            kept.push('\n');
        }
    }
    kept
}

/// Targets of `[text](target)` and `![text](target)`.
fn links(text: &str) -> Vec<String> {
    let prose = prose(text);
    let targets = prose.split("](").skip(1);
    targets.filter_map(|it| Some(it.split_once(')')?.0.to_owned())).collect()
}

/// Anchors of the headings of a page, as mdBook and GitHub name them.
fn anchors(text: &str) -> Vec<String> {
    let is_kept = |it: char| it.is_alphanumeric() || "_- ".contains(it);
    let mut is_fenced = false;
    let mut found = Vec::new();
    for line in text.lines() {
        is_fenced ^= line.starts_with("```");
        let title = line.trim_start_matches('#');
        if !is_fenced && title.len() < line.len() && title.starts_with(' ') {
            let title: String =
                title.trim().to_lowercase().chars().filter(|&it| is_kept(it)).collect();
            found.push(title.replace(' ', "-"));
        }
    }
    found
}

/// Oracle: the files and headings that are there.
#[test]
fn every_relative_link_leads_to_a_file_and_a_heading() {
    let mut broken = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for link in links(&text) {
            if link.contains("://") || link.starts_with("mailto:") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = match path {
                "" => document.clone(),
                _ => document.parent().unwrap().join(path),
            };
            let is_there = match fs::read_to_string(&target) {
                Ok(page) => anchor.is_empty() || anchors(&page).iter().any(|it| it == anchor),
                // A picture or a folder.
                Err(_) => target.exists() && anchor.is_empty(),
            };
            if !is_there {
                broken.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

/// Oracle: the files that are there.
#[test]
fn every_path_in_backticks_exists() {
    const FOLDERS: [&str; 8] =
        ["src/", "tests/", "benches/", "launch_configs/", "msgs/", "examples/", "bags/", "docs/"];
    let mut missing = Vec::new();
    // The changelog names files of older versions too.
    for document in documents().iter().filter(|it| !it.ends_with("CHANGELOG.md")) {
        let text = fs::read_to_string(document).unwrap();
        let spans = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
        for span in spans.filter(|it| FOLDERS.iter().any(|folder| it.starts_with(folder))) {
            if !span.contains([' ', '<', '*']) && span != RUN_FOLDER && !Path::new(span).exists() {
                missing.push(format!("{}: `{span}`", document.display()));
            }
        }
    }
    assert!(missing.is_empty(), "missing files:\n{}", missing.join("\n"));
}

/// The folder of a recording, as the pages write it.
const RUN_FOLDER: &str = "bags/SCENE_TIME";

/// Oracle: the files in `docs`.
#[test]
fn the_summary_lists_every_page_once() {
    let mut listed = links(&fs::read_to_string("docs/SUMMARY.md").unwrap());
    listed.sort();
    let pages = markdown_files("docs").into_iter();
    let names = pages.map(|it| it.file_name().unwrap().to_string_lossy().into_owned());
    let expected: Vec<String> = names.filter(|it| it != "SUMMARY.md").collect();
    assert_eq!(listed, expected);
}

/// The README is a front page; the reference is in the book.
#[test]
fn the_readme_is_short() {
    let n_lines = fs::read_to_string("README.md").unwrap().lines().count();
    assert!(n_lines <= 130, "{n_lines} lines");
}

/// Oracle: the list of topics in the code.
#[test]
fn every_topic_is_described() {
    let scene = scene::load(Path::new("launch_configs/pick_and_lift.yaml"), &[]).unwrap();
    let page = fs::read_to_string("docs/ros.md").unwrap();
    let object = format!("/{}/", scene.objects[0].name);
    for topic in topics(&scene) {
        let name = topic.name.replace(NODE, "~").replace(&object, "/<name>/");
        assert!(page.contains(&format!("`{name}`")), "docs/ros.md does not describe {name}");
    }
}

/// Oracle: the schema that reads scenes.
#[test]
fn the_scene_reference_is_made_from_the_schema() {
    let pages = [
        ("docs/scene_keys.md", reference::markdown()),
        ("launch_configs/scene.schema.json", reference::json_schema()),
    ];
    for (file, expected) in pages {
        if std::env::var_os("JAMGRIP_UPDATE").is_some() {
            fs::write(Path::new(file), &expected).unwrap();
        }
        let found = fs::read_to_string(file).unwrap_or_default();
        assert!(found == expected, "{file} is not what the schema says: regenerate it");
    }
}
