//! The report of an experiment as an HTML page: rows, plots, and how to repeat the run.
//!
//! The page is self-contained: styles and plots are inline, nothing is loaded from elsewhere.

use maud::{Markup, html};

use super::{
    outcome::{CaseFacts, Outcome, size_name},
    table,
};
use crate::experiments::{
    findings::{Quantity, Row},
    record::{INERTIAL_LIMIT, OVERLAP_LIMIT, UNBALANCED_LIMIT},
};
use crate::report::{
    format::{duration, number, with_unit},
    page::{plots, render},
};

/// The report as HTML.
pub fn page(outcome: &Outcome) -> String {
    let title = format!("{}, {}", outcome.experiment, size_name(outcome.size));
    let head = html! {
        p.kind { "jamgrip experiment" }
        h1 { (outcome.experiment) " " span.size { (size_name(outcome.size)) } }
        p.about { (outcome.about) }
        (badges(outcome))
    };
    let body = html! {
        (warnings(outcome))
        (rows("Rows that fail", outcome.rows.iter().filter(|row| !row.pass).collect()))
        (plots(&outcome.plots))
        (rows("Rows that pass", outcome.rows.iter().filter(|row| row.pass).collect()))
        (quantities(&outcome.quantities))
        (notes(&outcome.notes))
        (cases(outcome))
        (repeat(outcome))
    };
    render(&title, &head, &body)
}

fn badges(outcome: &Outcome) -> Markup {
    let (n, n_failed) = (outcome.rows.len(), outcome.n_failed());
    html! {
        ul.badges {
            @if n_failed == 0 {
                li.good { (n) " of " (n) " rows pass" }
            } @else {
                li.bad { (n_failed) " of " (n) " rows fail" }
            }
            @if outcome.left_validity.is_empty() {
                li.good { "within the model's validity" }
            } @else {
                li.bad { "outside the model's validity" }
            }
            li { (outcome.cases.len()) " cases" }
            li { (duration(outcome.wall_s)) " of processor time" }
        }
    }
}

fn warnings(outcome: &Outcome) -> Markup {
    let failed = outcome.cases.iter().filter_map(|case| Some((case, case.error.as_ref()?)));
    html! {
        @if !outcome.is_complete() || !outcome.left_validity.is_empty() {
            section.warning {
                h2 { "Read this first" }
                ul {
                    @for (case, error) in failed {
                        li { "Case " b { (case.case) } " failed: " (error) }
                    }
                    @for it in &outcome.left_validity { li { "Outside the model's validity: " (it) } }
                }
            }
        }
    }
}

fn rows(title: &str, rows: Vec<&Row>) -> Markup {
    html! {
        @if !rows.is_empty() {
            section { h2 { (title) } @for row in rows { (one_row(row)) } }
        }
    }
}

fn one_row(row: &Row) -> Markup {
    let (oracle, tolerance) = table::expected(row);
    let (class, verdict) = if row.pass { ("good", "pass") } else { ("bad", "fail") };
    html! {
        article.row.(class) id=(row.id) {
            div.verdict { (verdict) }
            div.what {
                h3 { (row.quantity) }
                p.id { (row.id) }
            }
            dl.numbers {
                div { dt { "measured" } dd { (with_unit(row.measured, &row.unit)) } }
                div {
                    dt { "expected" }
                    dd { (oracle) @if tolerance != table::BOUND { " " (tolerance) }
                         @if row.unit != "1" { " " (row.unit) } }
                }
                div { dt { "deviation" } dd { (table::deviation(row)) } }
            }
            p.why { b { (row.oracle_source) ". " } (row.reason) }
        }
    }
}

fn quantities(quantities: &[Quantity]) -> Markup {
    html! {
        @if !quantities.is_empty() {
            section {
                h2 { "Quantities" }
                div.wide { table {
                    thead { tr {
                        th { "name" } th.number { "value" } th.number { "deviation" }
                        th.number { "n" } th { "unit" } th { "meaning" }
                    } }
                    tbody {
                        @for it in quantities {
                            tr {
                                td.name { (it.name) }
                                td.number { (number(it.value)) }
                                td.number { @if let Some(d) = it.deviation { "± " (number(d)) } }
                                td.number { (it.n) }
                                td { @if it.unit != "1" { (it.unit) } }
                                td { (it.meaning) }
                            }
                        }
                    }
                } }
            }
        }
    }
}

fn notes(notes: &[String]) -> Markup {
    html! {
        @if !notes.is_empty() {
            section { h2 { "Notes" } ul { @for note in notes { li { (note) } } } }
        }
    }
}

fn cases(outcome: &Outcome) -> Markup {
    html! {
        section {
            h2 { "Cases and validity" }
            p { "Each case runs on one thread. Largest values, in red beyond their limits: "
                "overlap over diameter " (number(OVERLAP_LIMIT)) ", unbalanced force over contact "
                "force at rest " (number(UNBALANCED_LIMIT)) ", inertial number in stages that should "
                "be quasi-static " (number(INERTIAL_LIMIT)) "." }
            div.wide { table {
                thead { tr {
                    th { "case" } th.number { "seed" } th.number { "time" }
                    th.number { "substeps" } th.number { "overlap" } th.number { "unbalanced" }
                    th.number { "inertial" } th.number { "leaked" } th { "digest" }
                } }
                tbody { @for case in &outcome.cases { (one_case(case)) } }
            } }
        }
    }
}

fn one_case(case: &CaseFacts) -> Markup {
    let validity = &case.validity;
    let limited = [
        (validity.overlap_over_diameter_max, OVERLAP_LIMIT),
        (validity.unbalanced_force, UNBALANCED_LIMIT),
        (validity.inertial_number_max, INERTIAL_LIMIT),
    ];
    html! {
        tr {
            td.name.bad[case.error.is_some()] { (case.case) }
            td.number { (case.seed) }
            td.number { (duration(case.wall_s.values().sum())) }
            td.number { (case.n_substeps.values().sum::<u64>()) }
            @for (value, limit) in limited {
                td.number.bad[value > limit || value.is_nan()] { (number(value)) }
            }
            td.number.bad[0 < validity.n_leaked] { (validity.n_leaked) }
            td.digest { (case.digest) }
        }
    }
}

fn repeat(outcome: &Outcome) -> Markup {
    let build = &outcome.build;
    html! {
        section {
            h2 { "How to repeat the run" }
            pre { code { (table::command(outcome)) } }
            p { "The same scene, seeds and program give the same digests on one machine, for any "
                "number of threads. The joint digest of all cases is " code { (outcome.digest) }
                "." }
            dl.facts {
                dt { "scene" } dd { (outcome.scene.source) ", digest " code { (outcome.scene.digest) } }
                dt { "build" } dd { "jamgrip " (build.version) ", commit " (build.commit) ", "
                                    (build.target) }
                dt { "program" } dd { @for it in &build.programs { code { (it) } " " } }
                dt { "machine" } dd { (outcome.machine.cpu) ", " (outcome.machine.n_processors)
                                      " processors" }
                @if !outcome.curves.is_empty() {
                    dt { "curves" } dd { @for it in &outcome.curves {
                        a href={ "curves/" (it) ".csv" } { (it) ".csv" } " "
                    } }
                }
            }
        }
    }
}
