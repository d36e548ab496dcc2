//! The paper's table, showing the effect of the filters' start.

use kestirim_replay::robot::Trace;

use super::day::Day;
use crate::report::{Comparison, Headline, Value};
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

/// The names and rows of the fifteen points and of their mean.
fn rows(report: &Report) -> impl Iterator<Item = (String, &Row)> {
    let points = report.points.iter().enumerate().map(|(i, row)| (format!("P{}", i + 1), row));
    points.chain([("mean".to_owned(), &report.mean)])
}

/// Table 1, with the filters started at the first trilateration.
pub(super) fn table_1(report: &Report) -> Comparison {
    let table = Comparison::new(
        "robot-table-1",
        "Table 1: error of the mean of 50 positions, cm: trilateration / EKF / AEKF from an honest start; ours: the \
         default",
    );
    let add = |table: Comparison, (name, row): (String, &Row)| {
        let ours = format!("{:.2}, calibrated {:.2}", row.ours_cm, row.ours_calibrated_cm);
        let theirs = three(&row.honest_start);
        table.beside(&name, three(&row.published), theirs, ours, limits(row)).values(own(
            &name,
            row,
            report.trials,
        ))
    };
    let values = |named: (String, &Row)| {
        repeated(&named, "honest start", &named.1.honest_start, report.trials)
    };
    rows(report).fold(table, add).values(rows(report).flat_map(values)).note(
        "Filters begin at the first trilateration, as on a robot that does not know where it is. The paper does not \
         say where its points were. The limit is the Cramér–Rao bound without reflections.",
    )
}

/// Table 1 by the protocol that reproduces the published numbers.
pub(super) fn table_1_from_the_truth(report: &Report) -> Comparison {
    let table = Comparison::new(
        "robot-table-1-from-the-truth",
        "Table 1 by the paper's protocol, its filters started at the surveyed point, cm: trilateration / EKF / AEKF",
    );
    let add = |table: Comparison, (name, row): (String, &Row)| {
        table.repeated(name, three(&row.published), three(&row.from_the_truth), limits(row))
    };
    let values = |named: (String, &Row)| {
        repeated(&named, "started at the truth", &named.1.from_the_truth, report.trials)
    };
    rows(report).fold(table, add).values(rows(report).flat_map(values)).note(
        "The filters are below the limit because the answer was given: a small P₀ holds the filter at its start while eq. 18 \
         inflates R. Nothing here is our tracker.",
    )
}

/// The means of the table for each kind of start.
pub(super) fn starts(report: &Report) -> Comparison {
    let Row { published, from_the_truth, honest_start, .. } = &report.mean;
    let row = &report.mean;
    let cm = |value: f64| format!("{value:.2} cm");
    let limit = cm(row.limit_cm);
    Comparison::new("robot-starts", "Table 1, means: what the start is worth")
        .repeated("trilateration", cm(published.unfiltered_cm), cm(honest_start.unfiltered_cm), &limit)
        .repeated("EKF, started at the truth", cm(published.ekf_cm), cm(from_the_truth.ekf_cm), &limit)
        .repeated("EKF, honest start", "", cm(honest_start.ekf_cm), &limit)
        .repeated("AEKF, started at the truth", cm(published.aekf_cm), cm(from_the_truth.aekf_cm), &limit)
        .repeated("AEKF, started 10 cm beside it", "", cm(row.aekf_from_10_cm_beside_cm), &limit)
        .repeated("AEKF, honest start", "", cm(honest_start.aekf_cm), &limit)
        .row("our default", "", cm(row.ours_cm), &limit)
        .row("our default, anchors calibrated", "", cm(row.ours_calibrated_cm), cm(row.limit_calibrated_cm))
        .values([error("mean, started 10 cm beside the truth", "published AEKF")
            .is(row.aekf_from_10_cm_beside_cm)
            .of(report.trials, None)
            .limited(row.limit_cm)])
        .note(
            "The published numbers can only have come about by a start at the surveyed point; they stand in those rows. \
             Ten centimetres beside it, the same filter stays where it was put.",
        )
}

/// The table of the straight line.
pub(super) fn line(report: &Report) -> Comparison {
    let line = &report.line;
    let cm = |value: f64| format!("{value:.1} cm");
    Comparison::new("robot-line", "Figs 8 to 10: RMSE along the straight line")
        .repeated("trilateration", "", cm(line.unfiltered_cm), "")
        .repeated("the paper's EKF, honest start", "", cm(line.ekf_cm), "")
        .repeated("the paper's AEKF, honest start", "", cm(line.aekf_cm), "")
        .row("our default", "", cm(line.ours_cm), "")
        .row("our default, anchors calibrated", "", cm(line.ours_calibrated_cm), "")
        .values(
            [
                ("published trilateration", line.unfiltered_cm),
                ("published EKF", line.ekf_cm),
                ("published AEKF", line.aekf_cm),
                ("default", line.ours_cm),
                ("default, anchors calibrated", line.ours_calibrated_cm),
            ]
            .map(|(method, cm)| {
                rmse_along("the straight line", method, cm).of(report.trials, None)
            }),
        )
        .note("The paper prints no numbers of its line, only drawings.")
}

/// The table of the round among people.
pub(super) fn round(day: &Day) -> Comparison {
    let rmse = |traces: &[Trace]| {
        Accuracy::of_recording(&day.recording, traces).map(|accuracy| 100.0 * accuracy.rmse_m)
    };
    let text = |cm: Option<f64>| cm.map_or_else(String::new, |cm| format!("{cm:.1} cm"));
    let [ekf, aekf] = &day.honest;
    let title = "A round with somebody before each anchor in turn: RMSE";
    let table = Comparison::new("robot-round-rmse", title).note("One day; not in the paper.");
    let published = [
        ("trilateration", "published trilateration", rmse(&day.unfiltered)),
        ("the paper's EKF, honest start", "published EKF", rmse(ekf)),
        ("the paper's AEKF, honest start", "published AEKF", rmse(aekf)),
    ];
    let table = published.into_iter().fold(table, |table, (name, method, cm)| {
        let value = rmse_along("the round among people", method, cm);
        table.repeated(name, "", text(cm), "").values([value])
    });
    let ours = [
        ("our default", "default", rmse(&day.ours)),
        (
            "our default, anchors calibrated",
            "default, anchors calibrated",
            rmse(&day.calibrated.traces),
        ),
    ];
    ours.into_iter().fold(table, |table, (name, method, cm)| {
        let value = rmse_along("the round among people", method, cm);
        table.row(name, "", text(cm), "").values([value])
    })
}

fn rmse_along(way: &str, method: &str, cm: impl Into<Option<f64>>) -> Value {
    Value::new("RMSE of the position", "cm").under(way).by(method).is(cm)
}

fn error(condition: impl Into<String>, method: &str) -> Value {
    Value::new("error of the mean of 50 positions", "cm").under(condition).by(method)
}

/// The results of the paper's own methods at a point, for one kind of start.
fn repeated(
    (point, row): &(String, &Row),
    start: &str,
    here: &PositionErrors,
    trials: usize,
) -> [Value; 3] {
    let of = |method: &str, number: fn(&PositionErrors) -> f64| {
        let value = error(format!("{point}, {start}"), method).is(number(here));
        value.published(number(&row.published)).limited(row.limit_cm).of(trials, None)
    };
    [
        of("published trilateration", |it| it.unfiltered_cm),
        of("published EKF", |it| it.ekf_cm),
        of("published AEKF", |it| it.aekf_cm),
    ]
}

/// The results of the default at a point.
fn own(point: &str, row: &Row, trials: usize) -> [Value; 2] {
    [
        error(point, "default").is(row.ours_cm).limited(row.limit_cm),
        error(point, "default, anchors calibrated")
            .is(row.ours_calibrated_cm)
            .limited(row.limit_calibrated_cm),
    ]
    .map(|value| value.of(trials, None))
}

/// The most important results.
pub(super) fn headlines(report: &Report) -> Vec<Headline> {
    let row = &report.mean;
    let line = |quantity: &str| Headline {
        quantity: quantity.to_owned(),
        unit: "cm",
        published: None,
        theirs: None,
        ours: None,
        limit: Some(row.limit_cm),
    };
    vec![
        Headline {
            published: Some(row.published.aekf_cm),
            theirs: Some(row.from_the_truth.aekf_cm),
            limit: None,
            ..line("error of the mean of 50 positions, filter started at the true point")
        },
        Headline {
            theirs: Some(row.honest_start.aekf_cm),
            ours: Some(row.ours_cm),
            ..line("error of the mean of 50 positions, the true point not told")
        },
        Headline {
            ours: Some(row.ours_calibrated_cm),
            limit: Some(row.limit_calibrated_cm),
            ..line("error of the mean of 50 positions, anchors calibrated")
        },
    ]
}
