//! A recording and its results as one self-contained page.

use maud::{Markup, html};

use super::document::{Document, figures};
use crate::figure::{Figure, View};
use crate::system::{Answer, Sheet};

/// The detail of a figure: enough points that a tenth of the time still shows detail.
const VIEW: View = View { most_points: 20_000, window: None };
/// The maximum number of rows of a table: some hours at one every few seconds.
const MOST_ROWS: usize = 5000;

/// The contents of the page of a session.
#[derive(Debug, Clone, Copy)]
pub struct Session<'a> {
    /// What the system does.
    pub title: &'a str,
    /// The command that reproduces the result.
    pub command: &'a str,
    /// The results of the recording.
    pub answer: &'a Answer,
    /// The figures of the recording, or those of a comparison.
    pub figures: &'a [Figure],
    /// The time window that is shown, in seconds.
    pub window_s: Option<[f64; 2]>,
}

impl Session<'_> {
    /// Renders the page.
    pub fn page(&self) -> String {
        let Self { title, command, answer, figures: shown, window_s } = self;
        let title = format!("kestirim: {title}");
        let window = window_s.map(|[from, to]| format!("{from},{to}"));
        let body = html! {
            header {
                h1 { (title) }
                button #theme type="button" { "light / dark" }
            }
            main {
                section data-clock="one" data-window=[window] {
                    (facts(&answer.facts))
                    ul.warnings { @for warning in &answer.warnings { li { (warning) } } }
                    h2 { "The same again" }
                    p.made { code { (command) } }
                    div.figures { @for figure in *shown {
                        figure id=(figure.id) data-figure=(figure.id) {
                            h3 { (figure.title) }
                            figcaption { (figure.caption) }
                        }
                    } }
                    @for sheet in &answer.tables { (table(sheet)) }
                }
            }
        };
        Document { title: &title, body, figures: figures(*shown, VIEW) }.render()
    }
}

fn facts(facts: &[(String, String)]) -> Markup {
    html! { dl { @for (name, value) in facts { div { dt { (name) } dd { (value) } } } } }
}

fn table(sheet: &Sheet) -> Markup {
    let shown = sheet.excerpt(None, MOST_ROWS);
    let time = |row: usize| shown.times_s.and_then(|times| times.get(row)).copied();
    html! {
        details id={ "table-" (sheet.id) } {
            summary { (sheet.title) }
            p.soft { (shown.caption()) }
            div.scroll.rows tabindex="0" role="region" aria-label=(sheet.title) {
                table {
                    thead { tr { @for name in &sheet.header { th scope="col" { (name) } } } }
                    tbody { @for (number, row) in shown.rows.iter().enumerate() {
                        tr data-time=[time(number)] { @for cell in row { td { (cell) } } }
                    } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Series;
    use crate::report::document::tests::assert_fetches_nothing;

    #[test]
    fn everything_of_the_session_is_in_the_page() {
        let path = Series::line("ours", vec![0.0, 1.0], vec![0.0, 1.0]);
        let mut answer = Answer { warnings: vec!["beware of <b>".to_owned()], ..Answer::default() };
        answer.fact("length", "5 m");
        let rows = [vec!["1".to_owned(), "<i>".to_owned()]];
        answer.tables =
            vec![Sheet::new("stops", "Stops", &["number", "of"]).with(rows).timed([0.5])];
        let figures = [Figure::new("position", "Position").over_seconds("m").with(path)];
        let session = Session {
            figures: &figures,
            title: "A vehicle",
            command: "host-sim replay vehicle --log a.csv",
            answer: &answer,
            window_s: Some([0.25, 0.5]),
        };
        let page = session.page();
        for text in [
            "A vehicle",
            "beware of &lt;b&gt;",
            "5 m",
            "--log a.csv",
            r#"data-figure="position""#,
            r#"data-window="0.25,0.5""#,
            r#"<tr data-time="0.5"><td>1</td><td>&lt;i&gt;</td></tr>"#,
        ] {
            assert!(page.contains(text), "{text}");
        }
        assert_fetches_nothing(&page);
    }
}
