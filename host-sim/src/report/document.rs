//! A self-contained page with figures.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::{Map, Value};

use crate::figure::{Figure, View, plotly};

const STYLE: &str = include_str!("../../assets/page.css");
const PLOTLY: &str = include_str!("../../assets/plotly/plotly-basic.min.js");
const ELEMENTS: &str = include_str!("../../assets/elements.js");
const CLOCK: &str = include_str!("../../assets/clock.js");
const FIGURES: &str = include_str!("../../assets/figures.js");
const SCRIPT: &str = include_str!("../../assets/report.js");

/// The content security policy of the page: nothing may be fetched from anywhere.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// A page with its title, body and figures.
pub(super) struct Document<'a> {
    pub(super) title: &'a str,
    pub(super) body: Markup,
    /// The figures by id; each is drawn where `data-figure` is its id.
    pub(super) figures: Map<String, Value>,
}

/// The figures by id, in the form that the page draws.
pub(super) fn figures<'a>(
    figures: impl IntoIterator<Item = &'a Figure>,
    view: View,
) -> Map<String, Value> {
    let drawn = figures.into_iter();
    drawn.map(|figure| (figure.id.clone(), plotly::figure(figure, view))).collect()
}

impl Document<'_> {
    pub(super) fn render(self) -> String {
        let Self { title, body, figures } = self;
        // Unescaped, `</script>` would end the element, and `<!--` change how it ends.
        let figures = Value::from(figures).to_string().replace('<', "\\u003c");
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (title) }
                    link rel="icon" href="data:,";
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    (body)
                    script id="figures" type="application/json" { (PreEscaped(figures)) }
                    @for script in [PLOTLY, ELEMENTS, CLOCK, FIGURES, SCRIPT] { script { (PreEscaped(script)) } }
                }
            }
        };
        page.into_string()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::PLOTLY;

    /// Fails if a page would fetch anything.
    pub(in crate::report) fn assert_fetches_nothing(page: &str) {
        let own = page.replace(PLOTLY, "");
        for address in ["http:", "https:", "src=\"", "@import", "url("] {
            assert!(!own.contains(address), "{address}");
        }
    }
}
