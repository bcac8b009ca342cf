//! An HTML page about a recording: plots over time, events, and how to simulate it again.

use std::path::Path;

use maud::{Markup, html};

use crate::bag::{OpenBagError, recording::Recording};
use crate::{replay::page_data::PageData, report::page};

/// The self-contained page as HTML.
///
/// # Errors
/// If the path is not a recording.
pub fn html(path: &Path) -> Result<String, OpenBagError> {
    let recording = Recording::open(path)?;
    let data = PageData::read(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let plots = data.plots();
    let head = html! {
        p.kind { "jamgrip recording" }
        h1 { (name) }
        ul.badges {
            li { (data.n_messages) " messages" }
            @if data.damages.is_empty() { li.good { "undamaged" } }
            @else { li.bad { "damaged" } }
            @if recording.scene_text.is_some() { li.good { "can be simulated again" } }
        }
    };
    let body = html! {
        (damages(&data))
        (page::plots(&plots))
        @if plots.is_empty() {
            section { p { "This page draws none of its topics." } }
        }
        (events(&data))
        (origin(path, &recording))
    };
    Ok(page::render(&name, &head, &body))
}

fn damages(data: &PageData) -> Markup {
    html! {
        @if !data.damages.is_empty() {
            section.warning {
                h2 { "Read this first" }
                ul { @for damage in &data.damages { li { (damage) } } }
            }
        }
    }
}

fn events(data: &PageData) -> Markup {
    html! {
        @if !data.events.is_empty() {
            section {
                h2 { "Events" }
                div.wide { table {
                    thead { tr { th.number { "time [s]" } th { "what" } } }
                    tbody { @for (time_s, text) in &data.events {
                        tr { td.number { (format!("{time_s:.3}")) } td { (text) } }
                    } }
                } }
            }
        }
    }
}

fn origin(path: &Path, recording: &Recording) -> Markup {
    html! {
        section {
            h2 { "Origin" }
            dl.facts {
                dt { "written by" } dd { (recording.library) }
                @for (key, value) in &recording.facts { dt { (key) } dd { (value) } }
                dt { "files" } dd { @for it in &recording.files {
                    code { (it.file_name().unwrap_or_default().to_string_lossy()) } " "
                } }
            }
            @if recording.scene_text.is_some() {
                pre { code { "jamgrip replay " (path.display()) " --verify" } }
            }
        }
    }
}
