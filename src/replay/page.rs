//! A recording as a page for people: curves over time, what happened when, and how to run it again.

use std::path::Path;

use maud::{Markup, html};

use crate::bag::{OpenBagError, recording::Recording};
use crate::{replay::page_data::Course, report::page};

/// The page as HTML, complete in itself.
///
/// # Errors
/// If the path is no recording.
pub fn html(path: &Path) -> Result<String, OpenBagError> {
    let recording = Recording::open(path)?;
    let course = Course::read(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let plots = course.plots();
    let head = html! {
        p.kind { "jamgrip recording" }
        h1 { (name) }
        ul.badges {
            li { (course.n_messages) " messages" }
            @if course.damages.is_empty() { li.good { "whole" } }
            @else { li.bad { "damaged" } }
            @if recording.scene_text.is_some() { li.good { "can be run again" } }
        }
    };
    let body = html! {
        (damages(&course))
        (page::plots(&plots))
        @if plots.is_empty() {
            section { p { "None of its topics is one that this page draws." } }
        }
        (events(&course))
        (origin(path, &recording))
    };
    Ok(page::whole(&name, &head, &body))
}

fn damages(course: &Course) -> Markup {
    html! {
        @if !course.damages.is_empty() {
            section.warning {
                h2 { "Read this first" }
                ul { @for damage in &course.damages { li { (damage) } } }
            }
        }
    }
}

fn events(course: &Course) -> Markup {
    html! {
        @if !course.events.is_empty() {
            section {
                h2 { "Events" }
                div.wide { table {
                    thead { tr { th.number { "time [s]" } th { "what" } } }
                    tbody { @for (time_s, text) in &course.events {
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
            h2 { "Where it comes from" }
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
