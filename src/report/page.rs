//! The frame of HTML pages, and plots with their legends. A page is self-contained: styles and
//! plots are inline, nothing is loaded from elsewhere.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::plot;
use crate::experiments::findings::{Kind, Plot};

const STYLE: &str = include_str!("page.css");

/// Renders a self-contained page.
pub fn render(title: &str, head: &Markup, body: &Markup) -> String {
    let style = format!("{STYLE}{}", dark_colors());
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) " · jamgrip" }
                style { (PreEscaped(style)) }
            }
            body { header { (head) } main { (body) } }
        }
    };
    page.into_string()
}

/// Plots with their legends.
pub fn plots(plots: &[Plot]) -> Markup {
    html! {
        @if !plots.is_empty() {
            section {
                h2 { "Plots" }
                @for plot in plots {
                    figure {
                        h3 { (plot.title) }
                        (legend(plot))
                        (PreEscaped(plot::svg(plot)))
                        @if !plot.source_says.is_empty() {
                            figcaption { b { "The source: " } (plot.source_says) }
                        }
                    }
                }
            }
        }
    }
}

fn legend(plot: &Plot) -> Markup {
    html! {
        ul.legend {
            @for (series, color) in plot.series.iter().zip(plot::colors(plot)) {
                li { (legend_sample(series.kind, color)) (series.label) }
            }
        }
    }
}

/// A sample of how a series is drawn.
fn legend_sample(kind: Kind, color: &str) -> Markup {
    html! {
        svg viewBox="0 0 36 14" width="36" height="14" aria-hidden="true" {
            @match kind {
                Kind::Line => {
                    line x1="1" y1="7" x2="35" y2="7" stroke=(color) stroke-width="2.5";
                }
                Kind::Analytic => {
                    line x1="1" y1="7" x2="35" y2="7" stroke=(color) stroke-width="2.5"
                        stroke-dasharray="8 5";
                }
                Kind::Points => { circle cx="18" cy="7" r="4.5" fill=(color); }
                Kind::Source => {
                    circle cx="18" cy="7" r="5" fill="none" stroke=(color) stroke-width="2";
                }
            }
        }
    }
}

/// Lighter colors for dark pages, which replace the colors of the plots.
fn dark_colors() -> String {
    let replace = |from: &str, to: &str| {
        format!("svg [stroke=\"{from}\"]{{stroke:{to}}}svg [fill=\"{from}\"]{{fill:{to}}}\n")
    };
    let rules: String = plot::dark_colors().map(|(from, to)| replace(from, to)).collect();
    format!("@media (prefers-color-scheme: dark) {{\n{rules}}}\n")
}
