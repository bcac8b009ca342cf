//! Tables on the terminal: rows with results, for one experiment or several.

use comfy_table::{ColumnConstraint, ContentArrangement, Table, Width};

use super::outcome::{Outcome, size_name};
use crate::experiments::{
    EXPERIMENTS,
    findings::{Relation, Row},
};
use crate::report::format::{self, number};

/// Width of the tables if the terminal width is unknown (characters).
const WIDTH: u16 = 118;
/// Padding of a column (characters).
const PADDING: u16 = 2;

/// The format of the tables.
#[derive(Clone, Copy, Debug)]
pub struct TableLayout {
    /// Width (characters).
    pub width: u16,
}

impl TableLayout {
    /// The format for a terminal with this many columns, if known.
    pub fn new(columns: Option<u16>) -> Self {
        Self { width: columns.unwrap_or(WIDTH).clamp(90, 160) }
    }
}

/// All rows of all outcomes in one table, followed by violations and failed rows.
pub fn of_all(outcomes: &[Outcome], layout: TableLayout) -> String {
    let rows = outcomes.iter().flat_map(|outcome| &outcome.rows);
    let mut text = rows_table(rows, layout);
    for outcome in outcomes {
        text += &violations(outcome);
    }
    let n_rows: usize = outcomes.iter().map(|outcome| outcome.rows.len()).sum();
    let n_failed: usize = outcomes.iter().map(Outcome::n_failed).sum();
    let wall_s: f64 = outcomes.iter().map(|outcome| outcome.wall_s).sum();
    let wall = format::duration(wall_s);
    for row in outcomes.iter().flat_map(|outcome| &outcome.rows).filter(|row| !row.pass) {
        let (oracle, tolerance) = expected(row);
        let tolerance = if tolerance == BOUND { String::new() } else { format!(" {tolerance}") };
        let (id, quantity, measured) = (&row.id, quantity(row), number(row.measured));
        text += &format!("FAIL {id}: {quantity} is {measured}, expected {oracle}{tolerance}\n");
    }
    text + &format!("{} of {n_rows} rows pass; {wall} of processor time\n", n_rows - n_failed)
}

/// One outcome: quantities, rows and notes.
pub fn of_one(outcome: &Outcome, layout: TableLayout) -> String {
    let mut text = format!("{}: {}\n", outcome.name(), outcome.about);
    if !outcome.quantities.is_empty() {
        text += &quantities_table(outcome, layout);
        text += "\n";
    }
    text += &of_all(std::slice::from_ref(outcome), layout);
    for note in &outcome.notes {
        text += &format!("note: {note}\n");
    }
    text + &format!("digest {}\n", outcome.digest)
}

/// Violations of the model's validity.
fn violations(outcome: &Outcome) -> String {
    let left = outcome.left_validity.iter();
    let left = left.map(|it| format!("{}: outside the model's validity: {it}\n", outcome.name()));
    left.collect()
}

/// Shown instead of a tolerance if the relation is a bound.
pub(super) const BOUND: &str = "bound";

/// Expected value and tolerance: `5` and `± 0.1`, `≥ 3` and `bound`.
pub fn expected(row: &Row) -> (String, String) {
    let oracle = number(row.oracle);
    match row.relation {
        Relation::Within => (oracle, format!("± {}", number(row.tolerance))),
        Relation::AtLeast => (format!("≥ {oracle}"), BOUND.to_owned()),
        Relation::AtMost => (format!("≤ {oracle}"), BOUND.to_owned()),
    }
}

/// The deviation of the measured from the expected value: `+2.1 %`, or in its unit if 0 is
/// expected.
pub fn deviation(row: &Row) -> String {
    let difference = row.measured - row.oracle;
    if !difference.is_finite() {
        return "no number".to_owned();
    }
    let sign = if difference < 0.0 { "−" } else { "+" };
    if difference == 0.0 {
        return "0".to_owned();
    }
    if row.oracle == 0.0 {
        return format!("{sign}{}", format::with_unit(difference.abs(), &row.unit));
    }
    let percent = 1e2 * (difference / row.oracle).abs();
    match percent {
        it if it < 0.1 => format!("{sign}{} %", number(rounded(it))),
        it if it < 10.0 => format!("{sign}{it:.1} %"),
        it if it < 1e3 => format!("{sign}{it:.0} %"),
        _ => format!("{} times", number(row.measured / row.oracle)),
    }
}

/// Rounds to one digit.
fn rounded(value: f64) -> f64 {
    format!("{value:.0e}").parse().unwrap_or(value)
}

/// The command that repeats the run.
pub fn command(outcome: &Outcome) -> String {
    let mut text =
        format!("jamgrip experiment {} --{}", outcome.experiment, size_name(outcome.size));
    for change in &outcome.scene.overrides {
        text += &format!(" --set '{change}'");
    }
    let is_built_in = EXPERIMENTS.iter().any(|it| it.scene().0 == outcome.scene.source);
    if !is_built_in {
        text += &format!(" --scene '{}'", outcome.scene.source);
    }
    text
}

/// A quantity with its unit in brackets; the unit `1` is left out.
pub fn quantity(row: &Row) -> String {
    if row.unit == "1" { row.quantity.clone() } else { format!("{} [{}]", row.quantity, row.unit) }
}

fn rows_table<'a>(rows: impl Iterator<Item = &'a Row>, layout: TableLayout) -> String {
    let mut table = new_table(layout);
    table.load_style(comfy_table::presets::UTF8_FULL);
    table.set_header(["id, quantity", "expected", "measured", "result", "reason"]);
    // The remaining width is used for the reason.
    let widths = [layout.width / 4, 17, 11, 9];
    for row in rows {
        let (oracle, tolerance) = expected(row);
        let id = broken_name(&row.id, usize::from(widths[0] - PADDING));
        table.add_row([
            format!("{id}\n{}", quantity(row)),
            if tolerance == BOUND { oracle } else { format!("{oracle} {tolerance}") },
            number(row.measured),
            (if row.pass { "pass" } else { "FAIL" }).to_owned(),
            reason(row),
        ]);
    }
    for (column, width) in table.column_iter_mut().zip(widths) {
        column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(width)));
    }
    format!("{table}\n")
}

/// The source of the expected value, and the reason for the tolerance.
fn reason(row: &Row) -> String {
    format::one_line(&format!("{}. {}", row.oracle_source.trim_end_matches('.'), row.reason))
}

fn quantities_table(outcome: &Outcome, layout: TableLayout) -> String {
    let mut table = new_table(layout);
    table.set_header(["quantity", "value", "± deviation", "n", "unit", "meaning"]);
    for it in &outcome.quantities {
        let deviation = it.deviation.map_or_else(String::new, number);
        table.add_row([
            it.name.clone(),
            number(it.value),
            deviation,
            it.n.to_string(),
            it.unit.clone(),
            it.meaning.clone(),
        ]);
    }
    format!("{table}\n")
}

fn new_table(layout: TableLayout) -> Table {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::UTF8_FULL_CONDENSED);
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(layout.width);
    table
}

/// Breaks a long name after dots and underscores into lines of `width`.
fn broken_name(name: &str, width: usize) -> String {
    let (mut text, mut n) = (String::new(), 0);
    for part in name.split_inclusive(['.', '_']) {
        if 0 < n && width < n + part.len() {
            text.push('\n');
            n = 0;
        }
        text += part;
        n += part.len();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::findings::{Expected, RowText};

    /// Oracle: written by hand.
    #[test]
    fn deviations_are_in_percent_or_units() {
        let report = RowText { id: "", quantity: "", unit: "N", oracle: "", reason: "" };
        let deviation = |oracle, measured| {
            super::deviation(&Row::new(&report, Expected::within(oracle, 1.0), measured))
        };
        assert_eq!(deviation(2.0, 2.0), "0");
        assert_eq!(deviation(0.0, -0.25), "−0.25 N");
        assert_eq!(deviation(1.0, 1.000_000_12), "+1e-5 %");
        assert_eq!(deviation(200.0, 197.0), "−1.5 %");
        assert_eq!(deviation(-2.0, -3.0), "−50 %");
        assert_eq!(deviation(2.0, 100.0), "50 times");
        assert_eq!(deviation(2.0, f64::NAN), "no number");
    }

    /// Oracle: written by hand.
    #[test]
    fn names_break_after_dots_and_underscores() {
        assert_eq!(broken_name("C9.falls", 20), "C9.falls");
        assert_eq!(broken_name("C9.falls_with_modulus", 12), "C9.falls_\nwith_modulus");
        assert_eq!(broken_name("unbreakable", 4), "unbreakable");
    }
}
