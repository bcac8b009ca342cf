//! Prints the summary of a run.

use std::io::{self, Write};

use comfy_table::{Table, presets::UTF8_FULL_CONDENSED};
use jamgrip::node::summary::Summary;

/// Writes the summary to standard output: a table, or one line of JSON.
pub(crate) fn print(summary: &Summary, as_json: bool) -> io::Result<()> {
    let mut out = io::stdout().lock();
    if as_json {
        return writeln!(out, "{}", summary.to_json());
    }
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header([summary.scene.as_str(), ""]);
    table.add_rows(summary.rows());
    writeln!(out, "{table}")
}
