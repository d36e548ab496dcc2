//! The report as one page that needs nothing but itself.

use maud::{Markup, html};

use super::document::{Document, figures};
use super::{Chapter, Comparison, Content, Item, Row};

const TITLE: &str = "kestirim: published, ours, limit";

/// The page.
pub(super) fn render(chapters: &[Chapter]) -> String {
    let body = html! {
        (header(chapters))
        main { @for chapter in chapters { (section(chapter)) } }
        footer {
            p.soft {
                "Made by host-sim " (env!("CARGO_PKG_VERSION"))
                ". Beside this page: every figure as SVG and CSV, every table in results.csv and "
                "results.json, and streams for Foxglove, PlotJuggler and Rerun as MCAP. "
                "Figures are drawn by Plotly.js (MIT)."
            }
        }
    };
    let figures = figures(chapters.iter().flat_map(Chapter::figures));
    Document { title: TITLE, body, figures }.render()
}

fn header(chapters: &[Chapter]) -> Markup {
    html! {
        header {
            h1 { (TITLE) }
            button #theme type="button" { "light / dark" }
            p {
                "Every table and figure of the five papers beside what this library makes of the same "
                "experiment, and beside what nothing can be better than, where that is known. "
                "All of it on synthetic streams: the same command gives the same numbers."
            }
            p.soft {
                "Drag in a figure to zoom, click twice to see everything; or focus it and use "
                "+, −, the arrows and 0. The buttons above a figure show and hide its series."
            }
            nav aria-label="systems" {
                ul {
                    @for chapter in chapters {
                        li { a href={ "#" (chapter.system) } { (chapter.title) } }
                    }
                }
            }
        }
    }
}

fn section(chapter: &Chapter) -> Markup {
    html! {
        section id=(chapter.system) data-clock {
            h2 { (chapter.title) }
            p.soft { (chapter.paper) }
            p { (chapter.about) }
            (table(&chapter.summary))
            @for item in &chapter.items { (shown(item)) }
        }
    }
}

fn shown(item: &Item) -> Markup {
    let made = &item.made;
    html! {
        @match &item.content {
            Content::Comparison(comparison) => (table(comparison)),
            Content::Figure(figure) => {
                figure id=(figure.id) data-figure=(figure.id) {
                    h3 { (figure.title) }
                    figcaption { (figure.caption) " (" a href={ (figure.id) ".svg" } { "SVG" } ", " a href={ (figure.id) ".csv" } { "CSV" } ")" }
                }
            }
        }
        p.made { code { (made.command) } " · seed " (made.seed) " · " (made.trials) }
    }
}

fn table(comparison: &Comparison) -> Markup {
    html! {
        div.scroll id=(comparison.id) tabindex="0" role="region" aria-label=(comparison.title) {
            table {
                caption { (comparison.title) }
                thead { tr { th scope="col" {} th scope="col" { "published" } th scope="col" { "ours" } th scope="col" { "limit" } } }
                tbody {
                    @for [quantity, published, ours, limit] in comparison.rows.iter().map(Row::cells) {
                        tr { th scope="row" { (quantity) } td { (published) } td { (ours) } td { (limit) } }
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
    use crate::figure::{Figure, Series};
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
        };
        let page = render(&[chapter]);
        for text in
            ["Table 1 &lt;b&gt;", "2.52", "13.0", "seed 7", "200 days", "host-sim run vehicle"]
        {
            assert!(page.contains(text), "{text}");
        }
        assert!(page.contains(r#"data-figure="vehicle-plan""#));
        assert!(page.contains(r"Plan <\/script>"));
        assert_fetches_nothing(&page);
    }
}
