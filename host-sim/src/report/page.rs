//! The report as one self-contained page.

mod recorded;

use maud::{Markup, PreEscaped, html};

use super::document::{Document, figures};
use super::{Chapter, Comparison, Content, Headline, Item, Row, rounded};
use crate::figure::{Figure, View, svg};

/// The detail of a figure: more points than a screen has columns, so that zooming in reveals more.
const VIEW: View = View { most_points: 3000, window: None };
const TITLE: &str = "kestirim: published, ours, limit";

/// Renders the page.
pub(super) fn render(chapters: &[Chapter]) -> String {
    let body = html! {
        (header(chapters))
        main {
            (headlines(chapters))
            (pictures(chapters))
            @for chapter in chapters { (section(chapter)) (recorded::section(chapter)) }
        }
        footer {
            p.soft {
                "Made by host-sim " (env!("CARGO_PKG_VERSION"))
                ". Beside this page: every figure as SVG and CSV, every table in results.csv and "
                "results.json, and streams for Foxglove, PlotJuggler and Rerun as MCAP. "
                "Figures are drawn by Plotly.js (MIT)."
            }
        }
    };
    let figures = figures(chapters.iter().flat_map(Chapter::figures), VIEW);
    Document { title: TITLE, body, figures }.render()
}

fn header(chapters: &[Chapter]) -> Markup {
    let recorded = chapters.iter().any(|chapter| chapter.recorded.is_some());
    html! {
        header #top {
            h1 { (TITLE) }
            button #theme type="button" { "light / dark" }
            p {
                "Every table and figure of the five papers beside what this library makes of the same "
                "experiment, and beside what nothing can be better than, where that is known. "
                "On synthetic streams: the same command gives the same numbers."
                @if recorded { " Recordings stand behind each chapter." }
            }
            p.soft {
                "Drag in a figure to zoom, click twice to see everything; or focus it and use "
                "+, −, the arrows and 0. The buttons above a figure show and hide its series."
            }
            nav aria-label="contents" {
                ul {
                    @for chapter in chapters {
                        li {
                            a href={ "#" (chapter.system) } { (chapter.title) }
                            @if chapter.recorded.is_some() { " · " a href={ "#" (recorded::id(chapter)) } { "recorded" } }
                        }
                    }
                }
            }
        }
    }
}

fn section(chapter: &Chapter) -> Markup {
    let (of_the_paper, beyond): (Vec<_>, Vec<_>) =
        chapter.items.iter().partition(|item| is_of_the_paper(item));
    html! {
        section id=(chapter.system) data-clock {
            h2 { (chapter.title) }
            p.soft { (chapter.paper) " · " a href="#top" { "back to all systems" } }
            p { (chapter.about) }
            (table(&chapter.summary))
            @for (name, items) in [("The paper's tables and figures", of_the_paper), ("Beyond the paper", beyond)] {
                @if !items.is_empty() {
                    details {
                        summary { (name) " (" (items.len()) ")" }
                        @for item in items { (shown(item)) }
                    }
                }
            }
        }
    }
}

/// Whether the item is numbered like a table or figure of the paper.
fn is_of_the_paper(item: &Item) -> bool {
    let title = match &item.content {
        Content::Comparison(comparison) => &comparison.title,
        Content::Figure(figure) => &figure.title,
    };
    ["Table ", "Fig", "Chapter ", "Section"].iter().any(|begin| title.starts_with(begin))
}

/// The first table: a few quantities of every system, by each source.
fn headlines(chapters: &[Chapter]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="all systems" {
            table #all {
                caption { "All systems at a glance" }
                thead { tr {
                    th scope="col" {} th scope="col" { "published" } th scope="col" { "published method, run here" }
                    th scope="col" { "ours" } th scope="col" { "limit" }
                } }
                @for chapter in chapters {
                    tbody {
                        tr { th.system colspan="5" scope="rowgroup" { a href={ "#" (chapter.system) } { (chapter.title) } } }
                        @for line in &chapter.headlines { (headline(line)) }
                    }
                }
            }
        }
    }
}

fn headline(line: &Headline) -> Markup {
    let Headline { quantity, unit, published, theirs, ours, limit } = line;
    html! {
        tr {
            th scope="row" { (quantity) ", " (unit) }
            td { (cell(*published)) } td { (cell(*theirs)) } td.ours { (cell(*ours)) } td { (cell(*limit)) }
        }
    }
}

/// A number in a table; a dash if there is none.
fn cell(value: Option<f64>) -> String {
    value.map_or_else(|| "—".to_owned(), rounded)
}

/// A picture of each system, which links to its chapter.
fn pictures(chapters: &[Chapter]) -> Markup {
    html! {
        div.pictures {
            @for chapter in chapters {
                @if let Some(figure) = chapter.figures().find(|figure| figure.id == chapter.picture) {
                    a href={ "#" (chapter.system) } aria-label=(chapter.title) {
                        // Inline SVG needs no XML namespace.
                        (PreEscaped(svg::draw(figure).replace(r#" xmlns="http://www.w3.org/2000/svg""#, "")))
                        span { (figure.title) }
                    }
                }
            }
        }
    }
}

fn shown(item: &Item) -> Markup {
    let made = &item.made;
    html! {
        @match &item.content {
            Content::Comparison(comparison) => (table(comparison)),
            Content::Figure(figure) => (drawing(figure)),
        }
        p.made { code { (made.command) } " · seed " (made.seed) " · " (made.trials) }
    }
}

fn drawing(figure: &Figure) -> Markup {
    html! {
        figure id=(figure.id) data-figure=(figure.id) {
            h3 { (figure.title) }
            figcaption { (figure.caption) " (" a href={ (figure.id) ".svg" } { "SVG" } ", " a href={ (figure.id) ".csv" } { "CSV" } ")" }
        }
    }
}

fn table(comparison: &Comparison) -> Markup {
    let columns = comparison.columns().into_iter().zip(0..);
    let columns: Vec<_> = columns
        .filter(|((_, is_shown), _)| *is_shown)
        .map(|((name, _), place)| (name, place))
        .collect();
    html! {
        div.scroll id=(comparison.id) tabindex="0" role="region" aria-label=(comparison.title) {
            table {
                caption { (comparison.title) }
                thead { tr { th scope="col" {} @for (name, _) in &columns { th scope="col" { (name) } } } }
                tbody {
                    @for [quantity, cells @ ..] in comparison.rows.iter().map(Row::cells) {
                        tr {
                            th scope="row" { (quantity) }
                            @for (name, place) in &columns { td.ours[*name == "ours"] { (cells[*place]) } }
                        }
                    }
                }
            }
        }
        @if !comparison.note.is_empty() { p { (comparison.note) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Series;
    use crate::report::Made;
    use crate::report::document::tests::assert_fetches_nothing;

    #[test]
    fn the_page_shows_everything_and_fetches_nothing() {
        let made = Made {
            command: "host-sim run vehicle".to_owned(),
            seed: 7,
            trials: "200 days".to_owned(),
        };
        let table =
            Comparison::new("vehicle-table-1", "Table 1 <b>").row("mean, cm", "2.52", "13.0", "");
        let figure = Figure::new("vehicle-plan", "Plan </script>").with(Series::line(
            "ours",
            vec![0.0, 1.0],
            vec![0.0, 1.0],
        ));
        let chapter = Chapter {
            system: "vehicle",
            title: "A vehicle",
            paper: "Somebody, 2020",
            about: "It drives.".to_owned(),
            summary: Comparison::new("vehicle-summary", "In short"),
            items: vec![made.item(table), made.item(figure)],
            streams: vec![],
            headlines: vec![Headline {
                quantity: "mean error".to_owned(),
                unit: "cm",
                published: Some(2.52),
                theirs: Some(13.013),
                ours: Some(0.0447),
                limit: None,
            }],
            picture: "vehicle-plan",
            recorded: None,
        };
        let page = render(&[chapter]);
        for text in [
            "Table 1 &lt;b&gt;",
            "2.52",
            "13.0",
            "0.0447",
            "seed 7",
            "200 days",
            "host-sim run vehicle",
        ] {
            assert!(page.contains(text), "{text}");
        }
        assert!(page.contains(r#"data-figure="vehicle-plan""#));
        assert!(page.contains(r"Plan \u003c/script>"));
        assert_fetches_nothing(&page);
    }
}
