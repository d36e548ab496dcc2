//! The figures of the paper, from one day, and our own.

use kestirim_replay::robot::Trace;

use super::day::Day;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::systems::robot::figures::{self, Shown, plan};
use crate::systems::robot::paper::experiment::{Report, Row};
use crate::systems::robot::recording::{Recording, Truth};

/// Fig. 3: the office.
pub(super) fn office(points: &Day, line: &Day) -> Figure {
    let mut figure = plan::room("robot-figure-3", &points.recording);
    let paths = line.recording.parts.iter().filter_map(|part| match &part.truth {
        Some(Truth::Course(course)) => Some(course.rows().iter().map(|(_, place)| *place)),
        _ => None,
    });
    figure.series.extend(paths.map(|path| {
        Series::path("straight line", path).marked(Mark::Dashes).coloured(Colour::Other(4))
    }));
    titled(
        figure,
        "Fig. 3: the office",
        "Anchors in the corners of 4.8 m × 6.4 m; the paper's furniture is missing, its points are ours.",
    )
}

/// A figure of Table 1.
pub(super) fn table_1(report: &Report) -> Figure {
    let numbers: Vec<f64> = (1..=report.points.len()).map(|number| number as f64).collect();
    let of = |name: &str, mark, colour, value: fn(&Row) -> f64| {
        let values = report.points.iter().map(value).collect();
        Series::new(name, mark, numbers.clone(), values).coloured(colour)
    };
    Figure::new("robot-table-1-drawn", "Table 1, drawn")
        .axes("point", "error of the mean of 50 positions, cm")
        .caption("Only a filter that was started at the truth is below the limit, as published; honestly started it is above.")
        .with(of("AEKF, published", Mark::LineAndPoints, Colour::Published, |r| r.published.aekf_cm))
        .with(of("AEKF, started at the truth", Mark::LineAndPoints, Colour::Alarm, |r| {
            r.from_the_truth.aekf_cm
        }))
        .with(of("AEKF, honest start", Mark::LineAndPoints, Colour::Other(3), |r| {
            r.honest_start.aekf_cm
        }))
        .with(of("our default", Mark::LineAndPoints, Colour::Ours, |r| r.ours_cm))
        .with(of("our default, calibrated", Mark::LineAndPoints, Colour::Other(4), |r| {
            r.ours_calibrated_cm
        }))
        .with(of("limit", Mark::Dashes, Colour::Limit, |r| r.limit_cm))
        .with(of("limit, calibrated", Mark::Dashes, Colour::Limit, |r| r.limit_calibrated_cm).hidden())
}

/// Figs 5 to 7: the points, unfiltered and by both filters.
pub(super) fn points(day: &Day) -> [Figure; 3] {
    three(
        day,
        ["robot-figure-5", "robot-figure-6", "robot-figure-7"],
        ["Fig. 5", "Fig. 6", "Fig. 7"],
        "fixed points",
    )
}

/// Figs 8 to 10: the line, unfiltered and by both filters.
pub(super) fn lines(day: &Day) -> [Figure; 3] {
    three(
        day,
        ["robot-figure-8", "robot-figure-9", "robot-figure-10"],
        ["Fig. 8", "Fig. 9", "Fig. 10"],
        "straight line",
    )
}

fn three(day: &Day, ids: [&str; 3], numbers: [&str; 3], what: &str) -> [Figure; 3] {
    let [ekf, aekf] = &day.honest;
    let [true_ekf, true_aekf] = &day.from_the_truth;
    let mark = if day.recording.parts.len() > 1 { Mark::Dots } else { Mark::Line };
    let of = |name: &str, traces: &[Trace], colour| {
        Shown::new(&day.recording, traces).track(name, mark).coloured(colour)
    };
    let honest = |traces| of("honest start", traces, Colour::Other(3));
    let told = |traces| of("started at the truth", traces, Colour::Alarm);
    let figure = |i: usize, by: &str, series: Vec<Series>, caption: &str| {
        let figure = plan::room(ids[i], &day.recording).with_all(series);
        // A filter that diverges must not shrink the office to a dot.
        titled(within(figure, &day.recording), &format!("{}: {what}, {by}", numbers[i]), caption)
    };
    [
        figure(
            0,
            "unfiltered",
            vec![of("trilateration", &day.unfiltered, Colour::Published)],
            "Each link's bias moves the positions off the truth; reflections and people scatter them.",
        ),
        figure(
            1,
            "EKF",
            vec![honest(ekf), told(true_ekf)],
            "The paper's filter, from an honest start and started at the truth: it smooths, but the bias stays.",
        ),
        figure(
            2,
            "AEKF as published",
            vec![honest(aekf), told(true_aekf)],
            "Started at the truth it hardly leaves the place of a standing tag; from an honest start it is as far off as the EKF. A \
             moving tag it does not follow.",
        ),
    ]
}

/// Our tracker, uncalibrated and calibrated, with its ellipses.
pub(super) fn ours(day: &Day, id: &str, title: &str) -> Figure {
    let raw = Shown::new(&day.recording, &day.unfiltered);
    let uncalibrated = Shown::new(&day.recording, &day.ours);
    let mut others = vec![
        raw.track("trilateration", Mark::Dots).coloured(Colour::Published),
        uncalibrated.track("uncalibrated", Mark::Line).coloured(Colour::Other(4)),
    ];
    let mut caption =
        "The default tracker with its anchors calibrated, with 95 % ellipses, without calibration, and trilateration"
            .to_owned();
    if let Some(smoothed) = day.calibrated.smoothed_traces() {
        let smoothed = Shown::new(&day.recording, &smoothed);
        let track = smoothed.track("smoothed, calibrated", smoothed.line());
        others.push(track.coloured(Colour::Other(5)));
        caption.push_str("; and the calibrated one smoothed, from what came before and after");
    }
    let figure = Shown::new(&day.recording, &day.calibrated.traces).plan(id, others);
    titled(within(figure, &day.recording), title, &format!("{caption}."))
}

/// The ranges of the round, with those rejected.
pub(super) fn round_ranges(day: &Day) -> Figure {
    let ranges = Shown::new(&day.recording, &day.calibrated.traces).ranges("robot-round-ranges");
    titled(
        ranges,
        "A round among people: ranges",
        "Somebody before an anchor lengthens its ranges by decimetres; crosses are what the tracker left out.",
    )
}

/// The errors over time on the round.
pub(super) fn round_errors(day: &Day) -> Figure {
    let of = |name: &str, traces: &[Trace], colour| {
        Shown::new(&day.recording, traces).error(name).coloured(colour)
    };
    let [ekf, _] = &day.honest;
    let errors = figures::errors(
        "robot-round-errors",
        [
            of("trilateration", &day.unfiltered, Colour::Published),
            of("the paper's EKF, honest start", ekf, Colour::Other(3)),
            of("our default", &day.ours, Colour::Other(4)),
            of("our default, calibrated", &day.calibrated.traces, Colour::Ours),
        ],
    );
    titled(
        errors,
        "A round among people: error",
        "Who stands before an anchor moves trilateration by decimetres, and a tracker that learns each anchor's noise by less.",
    )
}

/// Limits a figure to the office and a metre around it.
fn within(figure: Figure, recording: &Recording) -> Figure {
    let [x0, y0, x1, y1] = recording.anchors.rectangle();
    figure.showing(Some([x0 - 1.0, x1 + 1.0]), Some([y0 - 1.0, y1 + 1.0]))
}

fn titled(figure: Figure, title: &str, caption: &str) -> Figure {
    Figure { title: title.to_owned(), ..figure.caption(caption) }
}
