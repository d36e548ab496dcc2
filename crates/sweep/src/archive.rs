//! Tables of the results of recordings, one line each.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value as Json;

use crate::table::{Tail, Writer};
use crate::{Column, Error, Value};

/// The greatest length of a list whose values become columns of their own; longer lists are left out.
const FEW: usize = 4;
/// The columns that every line has, before those of its report.
const FIRST: [&str; 5] = ["recording", "settings", "error", "health", "warnings"];
/// The columns that a shard has for each set of settings.
const OF_CONFIG: [&str; 4] = ["error", "health", "warnings", "report"];

/// The result of a recording with one set of settings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Line {
    /// The recording.
    pub recording: String,
    /// The settings, as options of the command line.
    pub settings: String,
    /// Why there is no result, in one sentence; empty if there is one.
    pub error: String,
    /// How far the result can be relied upon.
    pub health: String,
    /// Warnings for the user: sentences separated by a vertical bar.
    pub warnings: String,
    /// The machine-readable report.
    pub report: Json,
    /// The time it took, s, if that is to be reported.
    pub seconds: Option<f64>,
}

/// The number of lines in each state of health and of those that failed, in words.
pub fn counts(lines: &[Line]) -> String {
    let mut counts = BTreeMap::new();
    for line in lines {
        let state = line.health.split(':').next().unwrap_or_default();
        *counts.entry(if line.error.is_empty() { state } else { "failed" }).or_insert(0_usize) += 1;
    }
    let counts: Vec<_> = counts.iter().map(|(state, count)| format!("{count} {state}")).collect();
    format!("{} lines: {}", lines.len(), counts.join(", "))
}

/// The columns of a shard, which has one row per recording: the results with each of `configs` sets of settings. A
/// report is one text, since different recordings report different things.
pub fn columns(configs: usize) -> Vec<Column> {
    let of_config = |config: usize| {
        let name = move |name: &str| {
            if configs == 1 { name.to_owned() } else { format!("{config} {name}") }
        };
        OF_CONFIG.map(|it| Column::text(name(it)))
    };
    [Column::text("recording")].into_iter().chain((0..configs).flat_map(of_config)).collect()
}

/// The row of a recording in a shard.
pub fn row(lines: &[Line]) -> Vec<Value> {
    let recording = lines.first().map_or("", |line| &line.recording);
    let of_line = |line: &Line| {
        let report = if line.report.is_null() { String::new() } else { line.report.to_string() };
        [&line.error, &line.health, &line.warnings, &report].map(|text| Value::from(text.as_str()))
    };
    [Value::from(recording)].into_iter().chain(lines.iter().flat_map(of_line)).collect()
}

/// The lines that a row holds, given the settings in their order.
pub fn lines(row: &[Value], settings: &[String]) -> Vec<Line> {
    let text = |place: usize| row.get(place).map(ToString::to_string).unwrap_or_default();
    let line = |(config, settings): (usize, &String)| {
        let [error, health, warnings, report] =
            [1, 2, 3, 4].map(|place| text(OF_CONFIG.len() * config + place));
        let report = serde_json::from_str(&report).unwrap_or_default();
        let (recording, settings) = (text(0), settings.clone());
        Line { recording, settings, error, health, warnings, report, seconds: None }
    };
    settings.iter().enumerate().map(line).collect()
}

/// Writes a table: the columns that every line has, then one for each name in any of their reports.
///
/// # Errors
/// [`Error::Write`]; [`Error::File`] for an unknown file extension.
pub fn write(path: &Path, lines: &[Line], head: &impl Serialize, tail: &Tail) -> Result<(), Error> {
    let mut columns: Vec<_> = FIRST.map(Column::text).into();
    let flat: Vec<Vec<(String, Value)>> = lines.iter().map(flat).collect();
    for (name, value) in flat.iter().flatten() {
        match columns.iter_mut().skip(FIRST.len()).find(|column| column.name == *name) {
            // Numbers in one recording and a text in another make a column of texts.
            Some(column) if matches!(value, Value::Text(_)) => *column = Column::text(name),
            Some(_) => {}
            None if matches!(value, Value::Text(_)) => columns.push(Column::text(name)),
            None => columns.push(Column::number(name)),
        }
    }
    let mut file = Writer::create(path, &columns, head)?;
    for (line, values) in lines.iter().zip(flat) {
        let Line { recording, settings, error, health, warnings, .. } = line;
        let first = [recording, settings, error, health, warnings];
        let mut row: Vec<_> = first.map(|text| Value::from(text.as_str())).into();
        row.resize(columns.len(), Value::Missing);
        for (name, value) in values {
            let place = columns.iter().skip(FIRST.len()).position(|column| column.name == name);
            if let Some(place) = place {
                row[FIRST.len() + place] = value;
            }
        }
        file.write(&row)?;
    }
    file.finish(tail)
}

/// The numbers and texts of a report by name, such as `accuracy.rmse_m`. Warnings and health, which have columns of
/// their own, and long lists are left out.
fn flat(line: &Line) -> Vec<(String, Value)> {
    fn add(into: &mut Vec<(String, Value)>, name: &str, value: &Json) {
        let below =
            |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
        match value {
            Json::Bool(switch) => into.push((name.to_owned(), f64::from(*switch).into())),
            Json::Number(number) => {
                into.push((name.to_owned(), number.as_f64().map_or(Value::Missing, Value::from)));
            }
            Json::String(text) => into.push((name.to_owned(), text.as_str().into())),
            Json::Array(values) if values.len() <= FEW => {
                values
                    .iter()
                    .enumerate()
                    .for_each(|(place, it)| add(into, &below(&place.to_string()), it));
            }
            Json::Null | Json::Array(_) => {}
            Json::Object(fields) => fields.iter().for_each(|(key, it)| add(into, &below(key), it)),
        }
    }
    let seconds = line.seconds.map(|seconds| ("seconds".to_owned(), Value::from(seconds)));
    let mut all: Vec<_> = seconds.into_iter().collect();
    if let Json::Object(fields) = &line.report {
        let told = |key: &str| ["warnings", "health"].contains(&key);
        fields.iter().filter(|(key, _)| !told(key)).for_each(|(key, it)| add(&mut all, key, it));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_is_read_again() {
        let line = Line {
            recording: "a/one.csv".to_owned(),
            warnings: "first | second, \"quoted\"".to_owned(),
            report: json!({ "path_m": 12.5, "health": { "state": "good" } }),
            ..Line::default()
        };
        let other = Line {
            settings: "--fast".to_owned(),
            error: "too short".to_owned(),
            report: Json::Null,
            ..line.clone()
        };
        let both = [line, other];
        let settings = both.clone().map(|line| line.settings);
        for count in 1..=2 {
            let row = row(&both[..count]);
            assert_eq!(lines(&row, &settings[..count]), both[..count]);
            assert_eq!(row.len(), columns(count).len());
        }
    }

    #[test]
    fn what_any_recording_reports_is_a_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let of = |recording: &str, report| Line {
            recording: recording.to_owned(),
            health: "good".to_owned(),
            report,
            ..Line::default()
        };
        let lines = [
            of(
                "a",
                json!({ "path_m": 12.5, "end": [1, 2], "many": [1, 2, 3, 4, 5], "warnings": ["x"] }),
            ),
            Line { error: "a, line 3: expected a number".to_owned(), ..of("b", Json::Null) },
            of("c", json!({ "accuracy": { "rmse_m": 0.5 }, "closed": true })),
        ];
        write(&path, &lines, &json!({}), &Tail::default()).unwrap();
        assert_eq!(counts(&lines), "3 lines: 1 failed, 2 good");
        let text = std::fs::read_to_string(&path).unwrap();
        let expected = "# {}\n\
            recording,settings,error,health,warnings,path_m,end.0,end.1,accuracy.rmse_m,closed\n\
            a,,,good,,12.5,1,2,,\n\
            b,,\"a, line 3: expected a number\",good,,,,,,\n\
            c,,,good,,,,,0.5,1\n\
            # {\"rows\":3,\"inputs\":[],\"warnings\":[]}\n";
        assert_eq!(text, expected);
    }
}
