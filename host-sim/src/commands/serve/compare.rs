//! Comparison of two answers.

use serde::{Deserialize, Serialize};

use super::question::Asked;
use crate::figure::Figure;
use crate::system::{Answer, Setting, Settings};

/// How the two answers are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum How {
    /// Both in the same figure.
    Over,
    /// The later minus the earlier.
    Difference,
}

/// The names of the two answers.
const NAMES: [&str; 2] = ["A", "B"];

/// The combined figures, for those that both answers have.
pub(super) fn figures(a: &Answer, b: &Answer, how: How) -> Vec<Figure> {
    let pairs = b.figures.iter().filter_map(|ours| {
        let theirs = a.figures.iter().find(|theirs| theirs.id == ours.id)?;
        match how {
            How::Over => Some(ours.clone().before(theirs, NAMES)),
            How::Difference => ours.less(theirs),
        }
    });
    pairs.collect()
}

/// A row of the table of changes: the name, and the value in each answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Row(String, String, String);

/// The settings and results in which the two differ.
pub(super) fn changed(a: &Asked, b: &Asked) -> Vec<Row> {
    rows((&a.settings, &a.answer), (&b.settings, &b.answer))
}

fn rows(a: (&Settings, &Answer), b: (&Settings, &Answer)) -> Vec<Row> {
    let value = |settings: &Settings, setting: &Setting| {
        let only = settings.without(|name| name != setting.name);
        let arguments = only.arguments();
        if arguments.is_empty() { "default".to_owned() } else { arguments.join(" ") }
    };
    let settings =
        b.0.table()
            .iter()
            .map(|setting| Row(setting.help.to_owned(), value(a.0, setting), value(b.0, setting)));
    // Several facts may share a name: each is identified by the number of those before it.
    let numbered = |answer: &Answer| -> Vec<((String, usize), String)> {
        let before = |place: usize, name: &str| {
            answer.facts[..place].iter().filter(|(known, _)| known == name).count()
        };
        let facts = answer.facts.iter().enumerate();
        facts
            .map(|(place, (name, value))| ((name.clone(), before(place, name)), value.clone()))
            .collect()
    };
    let [of_a, of_b] = [numbered(a.1), numbered(b.1)];
    let fact = |facts: &[((String, usize), String)], name: &(String, usize)| {
        let found = facts.iter().find(|(known, _)| known == name);
        found.map_or_else(|| "–".to_owned(), |(_, value)| value.clone())
    };
    let only_a = of_a.iter().filter(|(name, _)| !of_b.iter().any(|(known, _)| known == name));
    let names = of_b.iter().chain(only_a).map(|(name, _)| name);
    let facts = names.map(|name| Row(name.0.clone(), fact(&of_a, name), fact(&of_b, name)));
    settings.chain(facts).filter(|Row(_, a, b)| a != b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_told_and_nothing_else() {
        let table = vec![
            Setting::number("rate", "rate", "Hz", [1.0, 9.0, 1.0], 5.0),
            Setting::switch("causal", "look only backwards", false),
        ];
        let settings = |sent: serde_json::Value| {
            Settings::sent(table.clone(), sent.as_object().expect("an object")).expect("settings")
        };
        let answer = |facts: &[[&str; 2]]| Answer {
            facts: facts.iter().map(|[a, b]| ((*a).to_owned(), (*b).to_owned())).collect(),
            ..Answer::default()
        };
        let a = (settings(serde_json::json!({})), answer(&[["error", "5 cm"], ["rows", "9"]]));
        let b = (
            settings(serde_json::json!({ "rate": 7, "causal": false })),
            answer(&[["error", "4 cm"], ["rows", "9"], ["lost", "1"]]),
        );
        let rows = rows((&a.0, &a.1), (&b.0, &b.1));
        let row = |a: &str, b: &str, c: &str| Row(a.to_owned(), b.to_owned(), c.to_owned());
        let expected = [
            row("rate", "default", "--rate 7"),
            row("error", "5 cm", "4 cm"),
            row("lost", "–", "1"),
        ];
        assert_eq!(rows, expected);
    }
}
