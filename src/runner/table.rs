//! What is left on the terminal: rows with their verdicts, for one experiment or for all.

use comfy_table::{ColumnConstraint, ContentArrangement, Table, Width};

use super::outcome::{Outcome, size_name};
use crate::experiments::{
    EXPERIMENTS,
    findings::{Relation, Row},
};
use crate::report::format::{self, number};

/// Width of the tables where the terminal does not tell its own.
const WIDTH: u16 = 118;
/// Of the width of a column, what stays empty.
const PADDING: u16 = 2;

/// How the tables look.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Characters across.
    pub width: u16,
}

impl Look {
    /// For a terminal of so many columns, or of an unknown number.
    pub fn new(columns: Option<u16>) -> Self {
        Self { width: columns.unwrap_or(WIDTH).clamp(90, 160) }
    }
}

/// All rows of all outcomes in one table, and below it what else must be known.
pub fn of_all(outcomes: &[Outcome], look: Look) -> String {
    let rows = outcomes.iter().flat_map(|outcome| &outcome.rows);
    let mut text = rows_table(rows, look);
    for outcome in outcomes {
        text += &faults(outcome);
    }
    let n_rows: usize = outcomes.iter().map(|outcome| outcome.rows.len()).sum();
    let n_red: usize = outcomes.iter().map(Outcome::n_red).sum();
    let wall_s: f64 = outcomes.iter().map(|outcome| outcome.wall_s).sum();
    let wall = format::duration(wall_s);
    for row in outcomes.iter().flat_map(|outcome| &outcome.rows).filter(|row| !row.pass) {
        let (oracle, tolerance) = expected(row);
        let tolerance = if tolerance == BOUND { String::new() } else { format!(" {tolerance}") };
        let (id, quantity, measured) = (&row.id, quantity(row), number(row.measured));
        text += &format!("RED {id}: {quantity} is {measured}, not {oracle}{tolerance}\n");
    }
    text + &format!("{} of {n_rows} rows pass; {wall} of one processor\n", n_rows - n_red)
}

/// One outcome: quantities, rows, and what else must be known.
pub fn of_one(outcome: &Outcome, look: Look) -> String {
    let mut text = format!("{}: {}\n", outcome.name(), outcome.about);
    if !outcome.quantities.is_empty() {
        text += &quantities_table(outcome, look);
        text += "\n";
    }
    text += &of_all(std::slice::from_ref(outcome), look);
    for note in &outcome.notes {
        text += &format!("note: {note}\n");
    }
    text + &format!("digest {}\n", outcome.digest)
}

/// What left validity.
fn faults(outcome: &Outcome) -> String {
    let left = outcome.left_validity.iter();
    let left = left.map(|it| format!("{} left validity: {it}\n", outcome.name()));
    left.collect()
}

/// Stands for a tolerance where the relation is a bound.
pub(super) const BOUND: &str = "bound";

/// Oracle and tolerance: `5` and `± 0.1`, `≥ 3` and `bound`.
pub fn expected(row: &Row) -> (String, String) {
    let oracle = number(row.oracle);
    match row.relation {
        Relation::Within => (oracle, format!("± {}", number(row.tolerance))),
        Relation::AtLeast => (format!("≥ {oracle}"), BOUND.to_owned()),
        Relation::AtMost => (format!("≤ {oracle}"), BOUND.to_owned()),
    }
}

/// How far the measured value lies from its oracle: `+2.1 %`, or in its unit where the oracle is 0.
pub fn apart(row: &Row) -> String {
    let distance = row.measured - row.oracle;
    if !distance.is_finite() {
        return "no number".to_owned();
    }
    let sign = if distance < 0.0 { "−" } else { "+" };
    if distance == 0.0 {
        return "0".to_owned();
    }
    if row.oracle == 0.0 {
        return format!("{sign}{}", format::with_unit(distance.abs(), &row.unit));
    }
    let percent = 1e2 * (distance / row.oracle).abs();
    match percent {
        it if it < 0.1 => format!("{sign}{} %", number(rounded(it))),
        it if it < 10.0 => format!("{sign}{it:.1} %"),
        it if it < 1e3 => format!("{sign}{it:.0} %"),
        _ => format!("{} times", number(row.measured / row.oracle)),
    }
}

/// To one digit.
fn rounded(value: f64) -> f64 {
    format!("{value:.0e}").parse().unwrap_or(value)
}

/// The command that runs it again.
pub fn command(outcome: &Outcome) -> String {
    let mut text =
        format!("jamgrip experiment {} --{}", outcome.experiment, size_name(outcome.size));
    for change in &outcome.scene.overrides {
        text += &format!(" --set '{change}'");
    }
    let is_shipped = EXPERIMENTS.iter().any(|it| it.scene().0 == outcome.scene.source);
    if !is_shipped {
        text += &format!(" --scene '{}'", outcome.scene.source);
    }
    text
}

/// A quantity with its unit in brackets; `1` is no unit.
pub fn quantity(row: &Row) -> String {
    if row.unit == "1" { row.quantity.clone() } else { format!("{} [{}]", row.quantity, row.unit) }
}

fn rows_table<'a>(rows: impl Iterator<Item = &'a Row>, look: Look) -> String {
    let mut table = blank(look);
    table.load_style(comfy_table::presets::UTF8_FULL);
    table.set_header(["id, quantity", "oracle", "measured", "verdict", "reason"]);
    // What is left goes to the reason.
    let widths = [look.width / 4, 17, 11, 9];
    for row in rows {
        let (oracle, tolerance) = expected(row);
        let id = broken(&row.id, usize::from(widths[0] - PADDING));
        table.add_row([
            format!("{id}\n{}", quantity(row)),
            if tolerance == BOUND { oracle } else { format!("{oracle} {tolerance}") },
            number(row.measured),
            (if row.pass { "pass" } else { "RED" }).to_owned(),
            reason(row),
        ]);
    }
    for (column, width) in table.column_iter_mut().zip(widths) {
        column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(width)));
    }
    format!("{table}\n")
}

/// Where the oracle comes from, and why the tolerance is what it is.
fn reason(row: &Row) -> String {
    format::flat(&format!("{}. {}", row.oracle_source.trim_end_matches('.'), row.reason))
}

fn quantities_table(outcome: &Outcome, look: Look) -> String {
    let mut table = blank(look);
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

fn blank(look: Look) -> Table {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::UTF8_FULL_CONDENSED);
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(look.width);
    table
}

/// A long name in lines of `width`, broken after dots and low lines.
fn broken(name: &str, width: usize) -> String {
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
    fn distances_are_told_in_percent_or_units() {
        let told = RowText { id: "", quantity: "", unit: "N", oracle: "", reason: "" };
        let apart = |oracle, measured| {
            super::apart(&Row::new(&told, Expected::within(oracle, 1.0), measured))
        };
        assert_eq!(apart(2.0, 2.0), "0");
        assert_eq!(apart(0.0, -0.25), "−0.25 N");
        assert_eq!(apart(1.0, 1.000_000_12), "+1e-5 %");
        assert_eq!(apart(200.0, 197.0), "−1.5 %");
        assert_eq!(apart(-2.0, -3.0), "−50 %");
        assert_eq!(apart(2.0, 100.0), "50 times");
        assert_eq!(apart(2.0, f64::NAN), "no number");
    }

    /// Oracle: written by hand.
    #[test]
    fn names_break_after_dots_and_low_lines() {
        assert_eq!(broken("C9.falls", 20), "C9.falls");
        assert_eq!(broken("C9.falls_with_modulus", 12), "C9.falls_\nwith_modulus");
        assert_eq!(broken("unbreakable", 4), "unbreakable");
    }
}
