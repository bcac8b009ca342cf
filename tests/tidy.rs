//! The rules of the house that no compiler checks. Run with every `cargo test`.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

use std::{
    fs,
    path::{Path, PathBuf},
};

const LINES_MAX: usize = 500;
/// Written by a program, not by people.
const GENERATED: &[&str] = &["src/wire/messages/generated.rs"];
const NO_SUCH_ROOM: &[&str] = &["utils", "util", "helpers", "common", "misc", "manager", "types"];
const PURE: &[&str] = &[
    "base",
    "physics",
    "measure",
    "cosim",
    "command",
    "session",
    "snapshot",
    "controller",
    "experiments",
];
const NOT_IN_PURE: &[&str] =
    &["std::fs", "std::net", "thread::sleep", "Instant", "SystemTime", "log::", "std::env"];
/// Files whose numbers are read by everyone: each says its unit.
const DATA_FILES: &[&str] = &[
    "src/scene/mod.rs",
    "src/snapshot/mod.rs",
    "src/physics/model.rs",
    "src/physics/state.rs",
    "src/physics/controls.rs",
    "src/physics/scratch.rs",
];
/// Numbers without a dimension say so by one of these words.
const DIMENSIONLESS: &[&str] = &[
    "number",
    "fraction",
    "share",
    "ratio",
    "friction",
    "normal",
    "strain",
    "factor",
    "damping",
    "overlap",
    "radius the bag",
    "over enclosed",
    "inverse",
    "weights",
    "coordination",
    "sliding",
    "rotation",
];

/// Each foreign crate enters by one door, or by the doors of both ends of one wire.
const DOORS: &[(&str, &[&str])] = &[
    (
        "rapier3d_f64",
        &[
            "cosim/rapier_world.rs",
            "cosim/volume.rs",
            "physics/boundary/polyhedron.rs",
            "physics/boundary/tests.rs",
        ],
    ),
    ("serde_saphyr", &["scene/yaml.rs"]),
    ("stl_io", &["scene/mesh_file.rs"]),
    ("tobj", &["scene/mesh_file.rs"]),
    ("urdf_rs", &["scene/urdf.rs"]),
    ("ros2_client", &["sinks/ros.rs", "sources/ros.rs", "services/listed.rs"]),
    (
        "rustdds",
        &[
            "sinks/ros.rs",
            "sources/ros.rs",
            "services/ros.rs",
            "services/client.rs",
            "services/listed.rs",
        ],
    ),
    ("iceoryx2", &["wire/rows.rs", "sinks/shm.rs"]),
    ("mcap", &["bag/writer.rs", "bag/reader.rs", "bag/index.rs", "bag/recover.rs", "bag/check.rs"]),
    ("zstd", &["bag/writer.rs", "bag/reader.rs"]),
    ("indicatif", &["node/progress.rs", "lab/board.rs"]),
    ("comfy_table", &["node/summary.rs", "lab/table.rs"]),
    ("plotters", &["lab/plot.rs", "lab/axis.rs"]),
    ("maud", &["lab/report.rs", "lab/bag_page.rs"]),
    ("csv", &["lab/folder.rs", "benchmarks/sheet.rs"]),
    ("ctrlc", &["node/shutdown.rs", "node/launch.rs"]),
    ("clap", &["src/cli.rs", "src/cli_bags.rs", "src/main.rs"]),
];

#[test]
fn imports_point_up_the_list_in_lib_rs() {
    let order = modules_in_reading_order();
    assert!(10 <= order.len(), "the list in src/lib.rs is read: {order:?}");
    let mut faults = Vec::new();
    for file in rust_files("src") {
        let Some(here) = order.iter().position(|module| *module == room(&file)) else { continue };
        for (number, line) in code_lines(&file) {
            for module in order.iter().skip(here + 1).filter(|module| mentions(&line, module)) {
                let here = &order[here];
                let place = file.display();
                faults.push(format!("{place}:{number}: `{here}` may not use `{module}`"));
            }
        }
    }
    assert_none(&faults);
}

#[test]
fn foreign_crates_enter_by_their_doors() {
    let mut faults = Vec::new();
    for file in rust_files("src") {
        for (number, line) in code_lines(&file) {
            for (foreign, doors) in DOORS {
                let is_inside = doors.iter().any(|door| file.ends_with(door));
                if !is_inside && names_crate(&line, foreign) {
                    let place = file.display();
                    faults.push(format!("{place}:{number}: `{foreign}` belongs in {doors:?}"));
                }
            }
        }
    }
    assert_none(&faults);
}

#[test]
fn every_file_opens_with_a_doc_line_and_stays_short() {
    let mut faults = Vec::new();
    for file in ["src", "tests", "benches", "examples"].into_iter().flat_map(rust_files) {
        let (text, place) = (read(&file), file.display());
        if !text.starts_with("//!") {
            faults.push(format!("{place}: first line must be `//! one idea`"));
        }
        let n_lines = text.lines().count();
        let is_generated = GENERATED.iter().any(|it| file == Path::new(it));
        if LINES_MAX < n_lines && !is_generated {
            faults.push(format!("{place}: {n_lines} lines, at most {LINES_MAX}"));
        }
        let stem = file.file_stem().unwrap().to_str().unwrap();
        if NO_SUCH_ROOM.contains(&stem) {
            faults.push(format!("{place}: name the idea, not `{stem}`"));
        }
    }
    assert_none(&faults);
}

#[test]
fn pure_modules_touch_nothing_outside() {
    let mut faults = Vec::new();
    for file in rust_files("src").iter().filter(|file| PURE.contains(&room(file).as_str())) {
        for (number, line) in code_lines(file) {
            for word in NOT_IN_PURE.iter().filter(|word| line.contains(**word)) {
                faults.push(format!("{}:{number}: no `{word}` in the core", file.display()));
            }
        }
    }
    assert_none(&faults);
}

#[test]
fn every_number_that_others_read_has_a_unit() {
    let mut faults = Vec::new();
    for file in DATA_FILES {
        let mut doc = String::new();
        for (number, line) in read(Path::new(file)).lines().map(str::trim).enumerate() {
            if let Some(rest) = line.strip_prefix("///") {
                doc.push_str(&rest.to_lowercase());
                continue;
            }
            let is_number = line.starts_with("pub ")
                && line.ends_with(',')
                && [": Real", ": f64", "Vec3", "<Real>", "<f64>"].iter().any(|t| line.contains(t));
            let is_told = doc.contains('[') || DIMENSIONLESS.iter().any(|it| doc.contains(it));
            if is_number && !is_told {
                faults.push(format!("{file}:{}: unit in [ ] missing: {line}", number + 1));
            }
            doc.clear();
        }
    }
    assert_none(&faults);
}

#[test]
fn every_dependency_says_what_it_is_for() {
    let manifest = read(Path::new("Cargo.toml"));
    let (mut section, mut faults) = (String::new(), Vec::new());
    for (number, line) in manifest.lines().enumerate() {
        if line.starts_with('[') {
            section = line.to_owned();
        }
        let is_dependency = section.ends_with("dependencies]") && line.contains(" = ");
        if is_dependency && !line.contains(" # ") {
            faults.push(format!("Cargo.toml:{}: say what for: {line}", number + 1));
        }
    }
    assert_none(&faults);
}

#[test]
fn paths_in_the_docs_exist() {
    let mut faults = Vec::new();
    for doc in ["README.md", "ARCHITECTURE.md", "bags/README.md"] {
        let Ok(text) = fs::read_to_string(doc) else { continue };
        for word in text.split('`').skip(1).step_by(2) {
            let is_ours =
                ["src/", "tests/", "benches/", "launch_configs/", "msgs/", "examples/", "bags/"]
                    .iter()
                    .any(|folder| word.starts_with(folder));
            if is_ours && !word.contains([' ', '<', '*']) && !Path::new(word).exists() {
                faults.push(format!("{doc}: `{word}` does not exist"));
            }
        }
    }
    assert_none(&faults);
}

fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// The `pub mod` lines of `src/lib.rs`, top to bottom.
fn modules_in_reading_order() -> Vec<String> {
    let name = |line: &str| Some(line.strip_prefix("pub mod ")?.split(';').next()?.to_owned());
    read(Path::new("src/lib.rs")).lines().filter_map(name).collect()
}

/// The top-level module a file lives in.
fn room(file: &Path) -> String {
    let inside = file.strip_prefix("src").unwrap_or(file);
    let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
    first.trim_end_matches(".rs").to_owned()
}

/// True for `crate::module…` and for `module` inside a `use crate::{…}` list.
fn mentions(line: &str, module: &str) -> bool {
    let path = format!("crate::{module}");
    let follows = |rest: &str| rest.is_empty() || rest.starts_with([':', ';', ',', '}', ' ']);
    let is_path = line.match_indices(&path).any(|(at, _)| follows(&line[at + path.len()..]));
    let is_listed = line.strip_prefix("    ").and_then(|it| it.strip_prefix(module));
    let is_listed = is_listed.is_some_and(|rest| rest.starts_with("::{") || rest == ",");
    is_path || is_listed
}

/// True for `name::` at the start of a path.
fn names_crate(line: &str, name: &str) -> bool {
    let path = format!("{name}::");
    let is_start =
        |at: usize| !line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    line.match_indices(&path).any(|(at, _)| is_start(at))
}

/// Lines with their numbers, comments removed.
fn code_lines(file: &Path) -> Vec<(usize, String)> {
    let strip = |line: &str| line.split("//").next().unwrap_or("").to_owned();
    read(file).lines().enumerate().map(|(i, line)| (i + 1, strip(line))).collect()
}

fn rust_files(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::from(folder)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|it| it == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}
