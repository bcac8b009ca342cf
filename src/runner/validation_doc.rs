//! Kept outcomes beside their sources, as Markdown: what `docs/validation.md` is made of.

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

What the experiments of jamgrip found, beside what their sources show. This file and its figures are
made by `jamgrip report tests/golden/validation docs` from the result files in that folder; nothing in
it is typed by hand, and a test fails when the two differ. A row that is red stays red: its reason says
what the most likely cause is and what was tried. Tolerances are never widened to make a row green.
";

/// Reads all result files of a folder, in the order of the experiments, quick before full.
///
/// # Errors
/// If a file cannot be read as a result.
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
    let place = |outcome: &Outcome| {
        let known = EXPERIMENTS.iter().position(|it| it.name() == outcome.experiment);
        (known.unwrap_or(usize::MAX), outcome.size == Size::Full)
    };
    outcomes.sort_by_key(place);
    Ok(outcomes)
}

/// All files of the document, with their texts: the document itself first, then its figures.
pub fn tell(outcomes: &[Outcome]) -> Vec<(String, String)> {
    let mut files = vec![("validation.md".to_owned(), markdown(outcomes))];
    for outcome in outcomes {
        let figures = outcome.plots.iter().enumerate();
        files.extend(figures.map(|(i, plot)| (figure(outcome, i), plot::picture(plot))));
    }
    files
}

/// Writes the document and its figures into `folder`.
///
/// # Errors
/// If a file cannot be written.
pub fn write(outcomes: &[Outcome], folder: &Path) -> Result<(), RunnerError> {
    let unwritable =
        |path: &Path, reason| RunnerError::Unwritable { path: path.to_owned(), reason };
    let figures = folder.join("figures");
    fs::create_dir_all(&figures).map_err(|reason| unwritable(&figures, reason))?;
    for (name, text) in tell(outcomes) {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|reason| unwritable(&path, reason))?;
    }
    Ok(())
}

/// The file of an outcome's figure.
fn figure(outcome: &Outcome, i: usize) -> String {
    format!("figures/{}_{}.svg", outcome.name(), i + 1)
}

fn markdown(outcomes: &[Outcome]) -> String {
    let mut text = HEAD.to_owned();
    text += "\n| experiment | size | rows | red | validity | time on one thread |\n";
    text += "|---|---|---|---|---|---|\n";
    for it in outcomes {
        let name = &it.experiment;
        let anchor = it.name();
        let (size, n_rows, n_red) = (size_name(it.size), it.rows.len(), it.n_red());
        let validity = if it.left_validity.is_empty() { "kept" } else { "left, see below" };
        let wall = duration(it.wall_s);
        line(
            &mut text,
            &format!("| [{name}](#{anchor}) | {size} | {n_rows} | {n_red} | {validity} | {wall} |"),
        );
    }
    for outcome in outcomes {
        section(&mut text, outcome);
    }
    text
}

fn section(text: &mut String, it: &Outcome) {
    let build = &it.build;
    line(text, &format!("\n## {}\n\n{}\n", it.name(), flat(&it.about)));
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
        line(
            text,
            "\n| verdict | row | the source shows | measured | apart |\n|---|---|---|---|---|",
        );
        it.rows.iter().for_each(|row| row_line(text, row));
        line(text, "\nWhy:\n");
        it.rows.iter().for_each(|row| {
            let mark = if row.pass { "" } else { "**red** " };
            line(text, &format!("- {mark}`{}`: {}", row.id, flat(&row.reason)));
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
        let (title, source) = (flat(&plot.title), flat(&plot.source_says));
        line(text, &format!("\n![{title}]({})\n", figure(it, i)));
        line(text, &format!("*{title}.* The source: {source}"));
    }
    list(text, "Left the validity of the model:", it.left_validity.iter().map(|fault| flat(fault)));
    let failed = it
        .cases
        .iter()
        .filter_map(|case| Some(format!("{}: {}", case.case, flat(case.fault.as_ref()?))));
    list(text, "Did not come to their end:", failed);
    list(text, "Notes:", it.notes.iter().map(|note| flat(note)));
}

fn row_line(text: &mut String, row: &Row) {
    let (oracle, tolerance) = table::expected(row);
    let expected = match tolerance.as_str() {
        table::BOUND => oracle,
        _ => format!("{oracle} {tolerance}"),
    };
    let unit = if row.unit == "1" { String::new() } else { format!(" {}", row.unit) };
    let verdict = if row.pass { "pass" } else { "**red**" };
    line(
        text,
        &format!(
            "| {verdict} | `{}`<br>{} | {}: {expected}{unit} | {}{unit} | {} |",
            row.id,
            cell(&row.quantity),
            cell(&row.oracle_source),
            number(row.measured),
            table::apart(row),
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
    writeln!(text, "{line}").expect("a String takes everything");
}

/// On one line, with nothing that would be taken for a tag.
fn flat(text: &str) -> String {
    format::flat(text).replace('<', "&lt;")
}

/// In a cell of a table.
fn cell(text: &str) -> String {
    flat(text).replace('|', "\\|")
}
