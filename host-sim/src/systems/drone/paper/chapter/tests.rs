use std::collections::HashSet;

use super::*;
use crate::system::{RunOptions, Settings, experiment};
use crate::systems::drone::Drone;
use crate::systems::drone::settings::cell;

fn run(given: &[(&str, &str)]) -> Chapter {
    let mut cell = Settings::new(cell::table());
    for (name, text) in given {
        cell.set(name, text).unwrap();
    }
    let options = RunOptions { trials: Some(2), ..RunOptions::default() };
    chapter(&experiment::<Drone>(&options, &cell).unwrap()).unwrap()
}

#[test]
fn every_table_and_figure_of_the_thesis_is_there_once_and_has_lines() {
    let chapter = run(&[]);
    let figures: Vec<_> = chapter.figures().collect();
    let tables: Vec<_> = chapter.comparisons().map(|table| table.id.as_str()).collect();
    let names: Vec<_> = figures.iter().map(|figure| figure.id.as_str()).collect();
    let all: HashSet<_> = names.iter().chain(&tables).collect();
    assert_eq!(all.len(), names.len() + tables.len());
    for id in [
        "3-1",
        "3-2",
        "3-3",
        "3-4",
        "3-5",
        "3-6-hovering",
        "3-7-error",
        "3-8-energy",
        "3-9-lost",
        "3-11-error",
        "3-12-energy",
    ] {
        assert!(names.contains(&format!("drone-fig-{id}").as_str()), "{id}");
    }
    for figure in figures {
        for series in &figure.series {
            let finite = series.x.iter().zip(&series.y).filter(|(x, y)| (*x + *y).is_finite());
            assert!(finite.count() > 1, "{}: {}", figure.id, series.name);
        }
    }
    assert_eq!(chapter.summary.rows.len(), 8);
    chapter.assert_complete();
    let table = chapter.comparisons().find(|table| table.id == "drone-table-3-2").unwrap();
    assert_eq!(table.rows.len(), 21);
    assert!(table.rows.iter().all(|row| !row.published.is_empty() && !row.limit.is_empty()));
    for stream in &chapter.streams {
        assert!(stream.rows.iter().all(|(_, values)| values.len() == stream.columns.len()));
    }
}

#[test]
fn one_cell_makes_a_chapter_too() {
    let chapter = run(&[("height", "300")]);
    assert_eq!(chapter.summary.rows.len(), 1);
    assert!(chapter.comparisons().count() == 0);
}
