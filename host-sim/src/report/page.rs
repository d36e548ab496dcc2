//! The report as one page that needs nothing but itself.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value;

use super::{Chapter, Comparison, Content, Item, Row};
use crate::figure::{View, plotly};

const STYLE: &str = include_str!("../../assets/page.css");
const PLOTLY: &str = include_str!("../../assets/plotly/plotly-basic.min.js");
const FIGURES: &str = include_str!("../../assets/figures.js");
const SCRIPT: &str = include_str!("../../assets/report.js");

/// More than a screen has columns, so that there is something to zoom into.
const VIEW: View = View { most_points: 3000, window: None };

/// Nothing may be fetched from anywhere.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// The page.
pub(super) fn render(chapters: &[Chapter]) -> String {
    let figures = chapters.iter().flat_map(Chapter::figures);
    let drawn: serde_json::Map<String, Value> =
        figures.map(|figure| (figure.id.clone(), plotly::figure(figure, VIEW))).collect();
    // `</script>` in a text would end the element.
    let drawn = Value::from(drawn).to_string().replace("</", "<\\/");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "kestirim: published, ours, limit" }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
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
                script id="figures" type="application/json" { (PreEscaped(drawn)) }
                script { (PreEscaped(PLOTLY)) }
                script { (PreEscaped(FIGURES)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

fn header(chapters: &[Chapter]) -> Markup {
    html! {
        header {
            h1 { "kestirim: published, ours, limit" }
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
        section id=(chapter.system) {
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
        let own = page.replace(PLOTLY, "");
        for address in ["http:", "https:", "src=\"", "@import", "url("] {
            assert!(!own.contains(address), "{address}");
        }
    }
}
