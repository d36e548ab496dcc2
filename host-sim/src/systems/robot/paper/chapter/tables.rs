//! The paper's table, with the start made visible.

use kestirim_replay::robot::Trace;

use super::day::Day;
use crate::report::Comparison;
use crate::systems::robot::account::accuracy::Accuracy;
use crate::systems::robot::paper::experiment::{Report, Row};
use crate::systems::robot::paper::published::PositionErrors;

fn three(errors: &PositionErrors) -> String {
    let PositionErrors { unfiltered_cm, ekf_cm, aekf_cm } = errors;
    format!("{unfiltered_cm:.2} / {ekf_cm:.2} / {aekf_cm:.2}")
}

fn limits(row: &Row) -> String {
    format!("{:.2}, calibrated {:.2}", row.limit_cm, row.limit_calibrated_cm)
}

/// Names and rows of the fifteen points and of their mean.
fn rows(report: &Report) -> impl Iterator<Item = (String, &Row)> {
    let points = report.points.iter().enumerate().map(|(i, row)| (format!("P{}", i + 1), row));
    points.chain([("mean".to_owned(), &report.mean)])
}

/// Table 1, from an honest start.
pub(super) fn table_1(report: &Report) -> Comparison {
    let table = Comparison::new(
        "robot-table-1",
        "Table 1: error of the mean of 50 positions, cm: trilateration / EKF / AEKF; ours from an honest start, \
         then our default",
    );
    let add = |table: Comparison, (name, row): (String, &Row)| {
        let honest = three(&row.honest_start);
        let ours =
            format!("{honest}; {:.2}, calibrated {:.2}", row.ours_cm, row.ours_calibrated_cm);
        table.row(name, three(&row.published), ours, limits(row))
    };
    rows(report).fold(table, add).note(
        "Filters begin at the first trilateration, as on a robot that does not know where it is. The paper does not \
         say where its points were. The limit is the Cramér–Rao bound without reflections.",
    )
}

/// Table 1, by the protocol that gives the published numbers.
pub(super) fn table_1_from_the_truth(report: &Report) -> Comparison {
    let table = Comparison::new(
        "robot-table-1-from-the-truth",
        "Table 1 by the paper's protocol, its filters started at the surveyed point, cm: trilateration / EKF / AEKF",
    );
    let add = |table: Comparison, (name, row): (String, &Row)| {
        table.row(name, three(&row.published), three(&row.from_the_truth), limits(row))
    };
    rows(report).fold(table, add).note(
        "The filters are below the limit because the answer was given: a small P₀ holds the filter at its start while eq. 18 \
         inflates R. Nothing here is our tracker.",
    )
}

/// The means of the table, start by start.
pub(super) fn starts(report: &Report) -> Comparison {
    let Row { published, from_the_truth, honest_start, .. } = &report.mean;
    let row = &report.mean;
    let cm = |value: f64| format!("{value:.2} cm");
    let limit = cm(row.limit_cm);
    Comparison::new("robot-starts", "Table 1, means: what the start is worth")
        .row("trilateration", cm(published.unfiltered_cm), cm(honest_start.unfiltered_cm), &limit)
        .row("EKF, started at the truth", cm(published.ekf_cm), cm(from_the_truth.ekf_cm), &limit)
        .row("EKF, honest start", "", cm(honest_start.ekf_cm), &limit)
        .row("AEKF, started at the truth", cm(published.aekf_cm), cm(from_the_truth.aekf_cm), &limit)
        .row("AEKF, started 10 cm beside it", "", cm(row.aekf_from_10_cm_beside_cm), &limit)
        .row("AEKF, honest start", "", cm(honest_start.aekf_cm), &limit)
        .row("our default", "", cm(row.ours_cm), &limit)
        .row("our default, anchors calibrated", "", cm(row.ours_calibrated_cm), cm(row.limit_calibrated_cm))
        .note(
            "The published numbers can only have come about by a start at the surveyed point; they stand in those rows. \
             Ten centimetres beside it, the same filter stays where it was put.",
        )
}

/// The straight line.
pub(super) fn line(report: &Report) -> Comparison {
    let line = &report.line;
    let cm = |value: f64| format!("{value:.1} cm");
    Comparison::new("robot-line", "Figs 8 to 10: RMSE along the straight line")
        .row("trilateration", "", cm(line.unfiltered_cm), "")
        .row("the paper's EKF, honest start", "", cm(line.ekf_cm), "")
        .row("the paper's AEKF, honest start", "", cm(line.aekf_cm), "")
        .row("our default", "", cm(line.ours_cm), "")
        .row("our default, anchors calibrated", "", cm(line.ours_calibrated_cm), "")
        .note("The paper prints no numbers of its line, only drawings.")
}

/// The round among people.
pub(super) fn round(day: &Day) -> Comparison {
    let rmse = |traces: &[Trace]| {
        let accuracy = Accuracy::of_recording(&day.recording, traces);
        accuracy.map_or_else(String::new, |accuracy| format!("{:.1} cm", 100.0 * accuracy.rmse_m))
    };
    let [ekf, aekf] = &day.honest;
    Comparison::new("robot-round-rmse", "A round with somebody before each anchor in turn: RMSE")
        .row("trilateration", "", rmse(&day.unfiltered), "")
        .row("the paper's EKF, honest start", "", rmse(ekf), "")
        .row("the paper's AEKF, honest start", "", rmse(aekf), "")
        .row("our default", "", rmse(&day.ours), "")
        .row("our default, anchors calibrated", "", rmse(&day.calibrated.traces), "")
        .note("One day; not in the paper.")
}
