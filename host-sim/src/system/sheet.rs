//! Tables beside the figures of a page.

use serde_json::{Value, json};

/// A table shown beside the figures of a page.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The identifier on the page: lower case, with hyphens.
    pub id: &'static str,
    /// The title: what the table lists, in a few words.
    pub title: String,
    /// The caption: what to see in the table.
    pub caption: String,
    /// The heading of each column: a quantity and its unit.
    pub header: Vec<String>,
    /// The rows, with a formatted cell per column.
    pub rows: Vec<Vec<String>>,
    /// The time of each row in seconds of the figures' clock, ascending; the row at the page's cursor is marked.
    pub times_s: Option<Vec<f64>>,
}

impl Sheet {
    /// A table without rows.
    pub fn new(id: &'static str, title: impl Into<String>, header: &[&str]) -> Self {
        let header = header.iter().map(|&name| name.to_owned()).collect();
        let (title, caption, rows) = (title.into(), String::new(), Vec::new());
        Self { id, title, caption, header, rows, times_s: None }
    }

    /// Sets the caption, a sentence on what to see.
    pub fn caption(self, caption: impl Into<String>) -> Self {
        Self { caption: caption.into(), ..self }
    }

    /// Sets the rows.
    pub fn with(self, rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        Self { rows: rows.into_iter().collect(), ..self }
    }

    /// Sets the time of each row, in seconds, ascending.
    pub fn timed(self, times_s: impl IntoIterator<Item = f64>) -> Self {
        Self { times_s: Some(times_s.into_iter().collect()), ..self }
    }

    /// The first rows, at most `most`, of a time window in seconds, or of all time.
    pub fn excerpt(&self, window_s: Option<[f64; 2]>, most: usize) -> Excerpt<'_> {
        let times = self.times_s.as_deref();
        let [from, to] = match (times, window_s) {
            (Some(times), Some([low, high])) => {
                [times.partition_point(|t| *t < low), times.partition_point(|t| *t <= high)]
            }
            _ => [0, self.rows.len()],
        };
        let end = to.min(from.saturating_add(most));
        let said = (end < to).then(|| {
            let of = if times.is_some() { " of this stretch of time" } else { "" };
            format!("These are the first {most} of the {} rows{of}.", to - from)
        });
        Excerpt {
            sheet: self,
            rows: self.rows.get(from..end).unwrap_or_default(),
            times_s: times.and_then(|times| times.get(from..end)),
            said,
        }
    }
}

/// The rows of a [`Sheet`] that are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Excerpt<'a> {
    sheet: &'a Sheet,
    /// The rows of the excerpt.
    pub rows: &'a [Vec<String>],
    /// The times of the rows in seconds; `None` if they are not known.
    pub times_s: Option<&'a [f64]>,
    /// A sentence that says that there are more rows, if there are.
    said: Option<String>,
}

impl Excerpt<'_> {
    /// The caption of the sheet, and the number of rows if not all are shown.
    pub fn caption(&self) -> String {
        let caption = [Some(self.sheet.caption.as_str()), self.said.as_deref()];
        caption.into_iter().flatten().filter(|it| !it.is_empty()).collect::<Vec<_>>().join(" ")
    }

    /// The excerpt in the form that the page reads.
    pub fn to_json(&self) -> Value {
        let Sheet { id, title, header, .. } = self.sheet;
        json!({
            "id": id,
            "title": title,
            "caption": self.caption(),
            "header": header,
            "rows": self.rows,
            "times": self.times_s,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds() -> Sheet {
        let rows = (0..10).map(|i| vec![i.to_string()]);
        Sheet::new("seconds", "Seconds", &["t, s"]).caption("They pass.").with(rows)
    }

    #[test]
    fn rows_of_a_stretch_of_time_are_shown_and_the_others_counted() {
        let sheet = seconds().timed((0..10).map(f64::from));
        let few = sheet.excerpt(Some([2.5, 7.0]), 3);
        assert_eq!(few.rows, [["3"], ["4"], ["5"]]);
        assert_eq!(few.times_s, Some(&[3.0, 4.0, 5.0][..]));
        let caption = "They pass. These are the first 3 of the 5 rows of this stretch of time.";
        assert_eq!(few.to_json()["caption"], caption);
        let none = sheet.excerpt(Some([20.0, 30.0]), 3);
        assert_eq!((none.rows.len(), none.caption()), (0, "They pass.".to_owned()));
    }

    #[test]
    fn without_times_a_stretch_of_time_leaves_nothing_out() {
        let sheet = seconds();
        assert_eq!(sheet.excerpt(Some([2.5, 7.0]), 10).rows.len(), 10);
        assert!(sheet.excerpt(None, 9).caption().ends_with("the first 9 of the 10 rows."));
    }
}
