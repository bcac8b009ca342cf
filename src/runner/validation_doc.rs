//! The validation document `docs/validation.md`: stored outcomes compared with their sources, as
//! Markdown.

use std::{fmt::Write, fs, path::Path};

use super::{
    outcome::{Outcome, size_name},
    table,
};
use crate::experiments::{EXPERIMENTS, Size, findings::Row};
use crate::{
    report::{
        format::{self, duration, number, with_unit},
        plot,
    },
    runner::error::RunnerError,
};

const HEAD: &str = "\
# Validation

This document compares the results of jamgrip's experiments with their sources. The command
`jamgrip report tests/golden/validation docs` generates it and its figures from the result files in
that folder. A test fails if it is out of date. Rows that fail are kept: the reason of such a row states
its most likely cause and what was tried. Tolerances are never widened to make a row pass.
";

/// Reads all result files of a folder, sorted by experiment and size.
///
/// # Errors
/// If a file is not a result.
pub fn read(folder: &Path) -> Result<Vec<Outcome>, RunnerError> {
    let unreadable =
        |path: &Path, reason: String| RunnerError::Unreadable { path: path.to_owned(), reason };
    let entries = fs::read_dir(folder).map_err(|it| unreadable(folder, it.to_string()))?;
    let mut files: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|it| it == "json"));
    files.sort();
    let read = |file: &std::path::PathBuf| {
        let text = fs::read_to_string(file).map_err(|it| unreadable(file, it.to_string()))?;
        Outcome::from_text(&text).map_err(|it| unreadable(file, it.to_string()))
    };
    let mut outcomes = files.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let rank = |outcome: &Outcome| {
        let known = EXPERIMENTS.iter().position(|it| it.name() == outcome.experiment);
        (known.unwrap_or(usize::MAX), outcome.size == Size::Full)
    };
    outcomes.sort_by_key(rank);
    Ok(outcomes)
}

/// All files of the document: the document first, then its figures.
pub fn files(outcomes: &[Outcome]) -> Vec<(String, String)> {
    let mut files = vec![("validation.md".to_owned(), markdown(outcomes))];
    for outcome in outcomes {
        let figures = outcome.plots.iter().enumerate();
        files.extend(figures.map(|(i, plot)| (figure(outcome, i), plot::standalone_svg(plot))));
    }
    files
}

/// Writes the document and its figures to `folder`.
///
/// # Errors
/// If a file cannot be written.
pub fn write(outcomes: &[Outcome], folder: &Path) -> Result<(), RunnerError> {
    let unwritable =
        |path: &Path, reason| RunnerError::Unwritable { path: path.to_owned(), reason };
    let figures = folder.join("figures");
    fs::create_dir_all(&figures).map_err(|reason| unwritable(&figures, reason))?;
    for (name, text) in files(outcomes) {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|reason| unwritable(&path, reason))?;
    }
    Ok(())
}

/// The file of a figure of an outcome.
fn figure(outcome: &Outcome, i: usize) -> String {
    format!("figures/{}_{}.svg", outcome.name(), i + 1)
}

fn markdown(outcomes: &[Outcome]) -> String {
    let mut text = HEAD.to_owned();
    text += "\n| experiment | size | rows | failed | validity | time on one thread |\n";
    text += "|---|---|---|---|---|---|\n";
    for it in outcomes {
        let name = &it.experiment;
        let anchor = it.name();
        let (size, n_rows, n_failed) = (size_name(it.size), it.rows.len(), it.n_failed());
        let validity =
            if it.left_validity.is_empty() { "within limits" } else { "violated, see below" };
        let wall = duration(it.wall_s);
        line(
            &mut text,
            &format!(
                "| [{name}](#{anchor}) | {size} | {n_rows} | {n_failed} | {validity} | {wall} |"
            ),
        );
    }
    for outcome in outcomes {
        section(&mut text, outcome);
    }
    text
}

fn section(text: &mut String, it: &Outcome) {
    let build = &it.build;
    line(text, &format!("\n## {}\n\n{}\n", it.name(), escaped(&it.about)));
    line(text, &format!("    {}\n", table::command(it)));
    line(
        text,
        &format!(
            "{} cases, {} on one thread of {}; scene `{}`; jamgrip {}, commit {}, {}; digest `{}`.",
            it.cases.len(),
            duration(it.wall_s),
            it.machine.cpu,
            it.scene.source,
            build.version,
            build.commit,
            build.target,
            it.digest,
        ),
    );
    if !it.rows.is_empty() {
        line(text, "\n| result | row | expected | measured | deviation |\n|---|---|---|---|---|");
        it.rows.iter().for_each(|row| row_line(text, row));
        line(text, "\nReasons for the tolerances:\n");
        it.rows.iter().for_each(|row| {
            let mark = if row.pass { "" } else { "**fail** " };
            line(text, &format!("- {mark}`{}`: {}", row.id, escaped(&row.reason)));
        });
    }
    if !it.quantities.is_empty() {
        line(text, "\n| quantity | value | deviation | n | meaning |\n|---|---|---|---|---|");
        for q in &it.quantities {
            let deviation = q.deviation.map_or_else(String::new, |it| format!("± {}", number(it)));
            let (name, value, n) = (&q.name, with_unit(q.value, &q.unit), q.n);
            line(
                text,
                &format!("| `{name}` | {value} | {deviation} | {n} | {} |", cell(&q.meaning)),
            );
        }
    }
    for (i, plot) in it.plots.iter().enumerate() {
        let (title, source) = (escaped(&plot.title), escaped(&plot.source_says));
        line(text, &format!("\n![{title}]({})\n", figure(it, i)));
        line(text, &format!("*{title}.* Source: {source}"));
    }
    list(
        text,
        "Violations of the model's validity:",
        it.left_validity.iter().map(|it| escaped(it)),
    );
    let failed = it
        .cases
        .iter()
        .filter_map(|case| Some(format!("{}: {}", case.case, escaped(case.error.as_ref()?))));
    list(text, "Failed cases:", failed);
    list(text, "Notes:", it.notes.iter().map(|note| escaped(note)));
}

fn row_line(text: &mut String, row: &Row) {
    let (oracle, tolerance) = table::expected(row);
    let expected = match tolerance.as_str() {
        table::BOUND => oracle,
        _ => format!("{oracle} {tolerance}"),
    };
    let unit = if row.unit == "1" { String::new() } else { format!(" {}", row.unit) };
    let verdict = if row.pass { "pass" } else { "**fail**" };
    line(
        text,
        &format!(
            "| {verdict} | `{}`<br>{} | {}: {expected}{unit} | {}{unit} | {} |",
            row.id,
            cell(&row.quantity),
            cell(&row.oracle_source),
            number(row.measured),
            table::deviation(row),
        ),
    );
}

fn list(text: &mut String, head: &str, items: impl Iterator<Item = String>) {
    let items: Vec<String> = items.collect();
    if !items.is_empty() {
        line(text, &format!("\n{head}\n"));
        items.iter().for_each(|item| line(text, &format!("- {item}")));
    }
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("writing to a String cannot fail");
}

/// A text on one line, without characters that start a tag.
fn escaped(text: &str) -> String {
    format::one_line(text).replace('<', "&lt;")
}

/// A text for a cell of a table.
fn cell(text: &str) -> String {
    escaped(text).replace('|', "\\|")
}
