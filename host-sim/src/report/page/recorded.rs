//! The recorded part of a chapter on the page.

use maud::{Markup, html};

use super::{cell, drawing, table};
use crate::report::{Chapter, Recorded, Replayed, Studied};

/// The section of a chapter's recordings: beside the chapter, not in it, as each recording has its own time axis.
pub(super) fn section(chapter: &Chapter) -> Markup {
    let Some(Recorded { folder, left_out, studies }) = &chapter.recorded else { return html! {} };
    html! {
        section id=(id(chapter)) {
            h2 { (chapter.title) " — recorded" }
            p.soft {
                "Recordings below " code { (folder) } " · "
                a href={ "#" (chapter.system) } { "the same system on synthetic streams" } " · "
                a href="#top" { "back to all systems" }
            }
            @if studies.is_empty() { p { "No recording that the results are told of is there." } }
            @if !left_out.is_empty() { ul.warnings { @for sentence in left_out { li { (sentence) } } } }
            @for study in studies { (studied(study)) }
        }
    }
}

/// The anchor of the section on the page.
pub(super) fn id(chapter: &Chapter) -> String {
    format!("{}-recorded", chapter.system)
}

fn studied(study: &Studied) -> Markup {
    let Studied { table: together, command, quantities, replays } = study;
    html! {
        (table(together))
        p.made { code { (command) } }
        details {
            summary { "Each recording (" (replays.len()) ")" }
            div.scroll tabindex="0" role="region" aria-label="each recording" {
                table {
                    caption { "Each recording" }
                    thead { tr {
                        th scope="col" {}
                        @for quantity in quantities { th scope="col" { (quantity) } }
                        th scope="col" { "health" }
                    } }
                    tbody { @for replay in replays { (row(replay)) } }
                }
            }
            @for replay in replays { (drawn(replay)) }
        }
    }
}

fn row(replay: &Replayed) -> Markup {
    html! {
        tr {
            th scope="row" { (replay.name) }
            @for value in &replay.values { td { (cell(value.value)) } }
            td { (replay.health) }
        }
    }
}

fn drawn(replay: &Replayed) -> Markup {
    html! {
        section data-clock="one" {
            @for figure in &replay.figures { (drawing(figure)) }
            p.made { @for command in &replay.commands { (replay.name) ": " code { (command) } br; } }
        }
    }
}
