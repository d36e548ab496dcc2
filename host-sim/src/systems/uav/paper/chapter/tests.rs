use std::collections::HashSet;

use super::*;
use crate::system::{RunOptions, ScalarKind, Settings, experiment};
use crate::systems::uav::Uav;

#[test]
fn every_figure_of_the_thesis_is_there_once_and_has_lines() {
    let options = RunOptions { trials: Some(2), ..RunOptions::default() };
    let report = experiment::<Uav>(&options, &Settings::new([])).unwrap();
    let chapter = chapter(&report).unwrap();
    let figures: Vec<_> = chapter.figures().collect();
    for id in ["5-1", "5-2", "5-5", "6-1", "6-5", "6-22", "6-23", "6-27"] {
        for state in STATE_SLUGS {
            assert!(figures.iter().any(|figure| figure.id == format!("uav-fig-{id}-{state}")));
        }
    }
    let names: Vec<_> = figures.iter().map(|figure| &figure.id).collect();
    let tables: Vec<_> = chapter.comparisons().map(|table| &table.id).collect();
    let all: HashSet<_> = names.iter().chain(&tables).collect();
    assert_eq!(all.len(), names.len() + tables.len());
    for figure in figures {
        assert!(!figure.series.is_empty(), "{}", figure.id);
        for series in &figure.series {
            assert!(series.y.iter().any(|y| y.is_finite()), "{}: {}", figure.id, series.name);
        }
    }
    assert!(chapter.summary.rows.len() <= 10, "{}", chapter.summary);
    chapter.assert_complete();
    for stream in &chapter.streams {
        assert!(stream.rows.iter().all(|(_, values)| values.len() == stream.columns.len()));
    }
}

#[test]
fn the_command_names_what_was_chosen() {
    let options = RunOptions { seed: 7, trials: Some(1), scalar: Some(ScalarKind::F64) };
    let report = experiment::<Uav>(&options, &Settings::new([])).unwrap();
    let command = made(&report, "").command;
    assert!(command.ends_with("run uav --seed 7 --trials 1 --scalar f64"), "{command}");
}
