//! Format of source files: a doc line first, at most 500 lines, units of numbers, a reason for every crate.

use std::path::Path;

use regex::Regex;

use crate::{
    assert_none, files_in, read,
    rules::{DATA_FILES, GENERATED},
};

const LINES_MAX: usize = 500;
/// File names that do not describe the contents.
const EMPTY_NAMES: &[&str] = &["utils", "util", "helpers", "common", "misc", "manager", "types"];
/// One of these words marks a number without a dimension.
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
/// A unit in square brackets or parentheses: `[m/s]`, `(N m)`, `(1)`.
const UNIT: &str =
    r"\[[^\]]+\]|\((1|([-·/ ]?(1/)?[µmkMG]?(m|s|g|N|Pa|Hz|rad|J|W|K|iB|%)[²³⁴]?)+( gauge)?)\)";

#[test]
fn every_file_opens_with_a_doc_line_and_stays_short() {
    let mut violations = Vec::new();
    let folders = ["src", "tests", "benches", "examples"];
    for file in folders.into_iter().flat_map(|it| files_in(it, &["rs"])) {
        let (text, place) = (read(&file), file.display());
        if !text.starts_with("//!") {
            violations.push(format!("{place}: the first line must be a `//!` comment"));
        }
        let n_lines = text.lines().count();
        let is_generated = GENERATED.iter().any(|it| file == Path::new(it));
        if LINES_MAX < n_lines && !is_generated {
            violations.push(format!("{place}: {n_lines} lines, at most {LINES_MAX}"));
        }
        let stem = file.file_stem().unwrap().to_str().unwrap();
        if EMPTY_NAMES.contains(&stem) {
            violations.push(format!("{place}: `{stem}` does not describe the contents"));
        }
    }
    assert_none(&violations);
}

#[test]
fn every_number_that_others_read_has_a_unit() {
    let violations = DATA_FILES.iter().flat_map(|file| without_unit(file, &read(Path::new(file))));
    assert_none(&violations.collect::<Vec<_>>());
}

#[test]
fn numbers_without_a_unit_are_found() {
    let find = |doc: &str, field: &str| {
        let text = format!("pub struct A {{\n    /// {doc}\n    pub a: {field},\n}}\n");
        without_unit("a.rs", &text)
    };
    for (doc, field) in [
        ("Length.", "f64"),
        ("Length.", "Vec<Real>"),
        ("Place (of the first grain).", "Vec3"),
        ("Length (as a guess).", "Option<f64>"),
    ] {
        assert_eq!(find(doc, field).len(), 1, "{doc} {field}");
    }
    for (doc, field) in [
        ("Length [m].", "f64"),
        ("Length (m).", "Vec<Vec3>"),
        ("Stiffness (N/m).", "f64"),
        ("Torque (N m) about the center.", "Vec3"),
        ("Density (kg/m³).", "Real"),
        ("Pressure (Pa gauge).", "Real"),
        ("Rate (1/s).", "Real"),
        ("Poisson's ratio.", "f64"),
        ("How many.", "usize"),
    ] {
        assert_eq!(find(doc, field), Vec::<String>::new(), "{doc} {field}");
    }
}

fn without_unit(file: &str, text: &str) -> Vec<String> {
    let unit = Regex::new(UNIT).unwrap();
    let (mut doc, mut violations) = (String::new(), Vec::new());
    for (number, line) in text.lines().map(str::trim).enumerate() {
        if let Some(rest) = line.strip_prefix("///") {
            doc.push_str(rest);
            continue;
        }
        let is_number = line.starts_with("pub ")
            && line.ends_with(',')
            && [": Real", ": f64", "Vec3", "<Real>", "<f64>"].iter().any(|it| line.contains(it));
        let lower = doc.to_lowercase();
        let has_unit = unit.is_match(&doc) || DIMENSIONLESS.iter().any(|it| lower.contains(it));
        if is_number && !has_unit {
            violations.push(format!("{file}:{}: unit missing, such as (m): {line}", number + 1));
        }
        doc.clear();
    }
    violations
}

#[test]
fn every_dependency_says_what_it_is_for() {
    let manifest = read(Path::new("Cargo.toml"));
    let (mut section, mut violations) = (String::new(), Vec::new());
    for (number, line) in manifest.lines().enumerate() {
        if line.starts_with('[') {
            section = line.to_owned();
        }
        let is_dependency = section.ends_with("dependencies]") && line.contains(" = ");
        if is_dependency && !line.contains(" # ") {
            violations.push(format!("Cargo.toml:{}: the purpose is missing: {line}", number + 1));
        }
    }
    assert_none(&violations);
}
