//! The robot's part of the report: the paper's table and figures beside ours.

mod day;
mod drawings;
mod tables;

use self::day::Day;
use super::experiment::Report;
use crate::Error;
use crate::report::{Chapter, Comparison, Made};
use crate::system::System;
use crate::systems::robot::Robot;
use crate::systems::robot::figures::streams::streams;
use crate::systems::robot::recording::{Driven, Recording};

/// The chapter of an experiment's report.
///
/// # Errors
/// No others than those of the experiment.
pub fn chapter(report: &Report) -> Result<Chapter, Error> {
    let Report { seed, trials, .. } = *report;
    let scalar = format!("{:?}", report.scalar).to_lowercase();
    let command = format!(
        "cargo run --release -p host-sim -- run robot --seed {seed} --trials {trials} --scalar {scalar}"
    );
    let made = |trials: String| Made { command: command.clone(), seed, trials };
    let [one, all] =
        [made("one day".to_owned()), made(format!("{trials} days × 15 points × 50 epochs"))];
    let lines = made(format!("{trials} days × 1 line"));
    let recordings = [Driven::Points, Driven::Line, Driven::CrowdedRound]
        .map(|driven| Recording::synthetic(driven, seed));
    let [points, line, round] = recordings.map(|recording| Day::follow(recording, report.scalar));
    let (points, line, round) = (points?, line?, round?);
    let mut items = vec![
        one.item(drawings::office(&points, &line)),
        all.item(tables::table_1(report)),
        all.item(tables::table_1_from_the_truth(report)),
        all.item(tables::starts(report)),
        all.item(drawings::table_1(report)),
    ];
    items.extend(drawings::points(&points).map(|figure| one.item(figure)));
    items.extend(drawings::lines(&line).map(|figure| one.item(figure)));
    items.push(lines.item(tables::line(report)));
    items.push(one.item(drawings::ours(&points, "robot-points", "The fifteen points, ours")));
    items.push(one.item(drawings::ours(&line, "robot-line-ours", "The straight line, ours")));
    items.push(one.item(drawings::ours(&round, "robot-round", "A round among people, ours")));
    items.push(one.item(drawings::round_ranges(&round)));
    items.push(one.item(drawings::round_errors(&round)));
    items.push(one.item(tables::round(&round)));
    Ok(Chapter {
        system: Robot::NAME,
        title: "Robot: ranges to ultra-wideband anchors",
        paper: Robot::PAPER,
        about: "The paper's recordings are not published: ours are days in an office of the same layout, whose \
                biases and noise are those of 90 recorded points. A standing tag's error is a bias of each link, \
                and no filter removes a bias: the published 2.52 cm come out only if the filter is started at the \
                surveyed point and holds on to it. The same filter with an honest start, our tracker, and what \
                nothing can be better than stand beside it."
            .to_owned(),
        summary: summary(report),
        headlines: tables::headlines(report),
        picture: "robot-round",
        items,
        streams: streams(&round.recording, &round.calibrated),
        recorded: None,
    })
}

fn summary(report: &Report) -> Comparison {
    let starts = tables::starts(report);
    let title = format!(
        "Robot: error of the mean of 50 positions, mean of 15 points, {} days",
        report.trials
    );
    Comparison { id: "robot".to_owned(), title, note: String::new(), ..starts }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{RunOptions, Settings, experiment};
    use crate::systems::robot::Robot;

    fn made() -> Chapter {
        let options = RunOptions { trials: Some(2), seed: 2, scalar: None };
        chapter(&experiment::<Robot>(&options, &Settings::new([])).unwrap()).unwrap()
    }

    #[test]
    fn every_table_and_figure_is_there_once_and_says_something() {
        let chapter = made();
        let mut ids: Vec<_> = chapter.comparisons().map(|table| table.id.clone()).collect();
        ids.extend(chapter.figures().map(|figure| figure.id.clone()));
        assert!(ids.contains(&"robot-table-1".to_owned()));
        for figure in [3, 5, 6, 7, 8, 9, 10] {
            assert!(ids.contains(&format!("robot-figure-{figure}")), "figure {figure}");
        }
        let count = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), count);
        for figure in chapter.figures() {
            assert!(!figure.caption.is_empty(), "{}", figure.id);
            for series in &figure.series {
                assert!(series.y.iter().any(|y| y.is_finite()), "{}: {}", figure.id, series.name);
            }
        }
        assert!(chapter.summary.rows.len() <= 10);
        chapter.assert_complete();
    }

    #[test]
    fn the_table_prints_what_the_paper_prints() {
        let chapter = made();
        let table = chapter.comparisons().find(|table| table.id == "robot-table-1").unwrap();
        assert_eq!(table.rows.len(), 16);
        assert_eq!(table.rows[0].published, "11.64 / 8.04 / 0.46");
        assert_eq!(table.rows[15].published, "15.40 / 6.75 / 2.52");
    }
}
