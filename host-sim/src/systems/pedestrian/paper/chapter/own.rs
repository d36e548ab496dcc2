//! Results beyond the paper: the distribution of errors, and a comparison of trackers and detectors.

use kestirim_replay::pedestrian::{DetectorKind, Options, TrackerKind, walk};
use rayon::prelude::*;

use super::super::experiment::{Report, error_percent, refused};
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::mean;
use crate::report::{Comparison, Value};
use crate::system::ScalarKind;
use crate::systems::pedestrian::recording::{Recording, Walked};

/// The number of walks on which methods are compared.
pub(super) const COMPARED: u64 = 20;

/// The cumulative distribution of the walks' errors.
pub(super) fn distribution(report: &Report) -> Figure {
    let mut figure = Figure::new("pedestrian-errors", "Errors of the path's length")
        .axes("error of the length, %", "share of walks below, %")
        .caption("Each step is a walk; ours lie far left of the published ones, at either rate.");
    figure.x.logarithmic = true;
    for (row, mark) in report.rows.iter().zip([Mark::Steps, Mark::Dashes]) {
        let rate = row.rate_hz;
        for (name, lengths_m, colour) in [
            ("published", &row.published.walks_m[..], Colour::Published),
            ("the paper's method, literally", &row.paper_method.lengths_m, Colour::Alarm),
            ("ours", &row.ours.lengths_m, Colour::Ours),
        ] {
            figure.series.push(
                cumulative(format!("{name}, {rate} Hz"), lengths_m).marked(mark).coloured(colour),
            );
        }
    }
    figure
}

fn cumulative(name: String, lengths_m: &[f64]) -> Series {
    let mut errors: Vec<_> = lengths_m.iter().copied().map(error_percent).collect();
    errors.sort_by(f64::total_cmp);
    let share = |i: usize| 100.0 * (i + 1) as f64 / errors.len() as f64;
    let shares = (0..errors.len()).map(share).collect();
    Series::line(name, errors, shares)
}

/// A comparison of all trackers and detectors on the same walks.
pub(super) fn methods(report: &Report) -> Result<Comparison, Error> {
    let default = Options { scalar: report.scalar, ..Options::default() };
    let with = |detector| Options { detector, ..default };
    let methods = [
        ("ekf, adaptive (ours)", default),
        ("lite, adaptive", Options { tracker: TrackerKind::Lite, ..default }),
        ("ekf, adaptive, causal", Options { causal: true, ..default }),
        ("ekf, adaptive, fixed point", Options { scalar: ScalarKind::Fixed, ..default }),
        ("ekf, SHOE", with(DetectorKind::Shoe(DetectorKind::SHOE_THRESHOLD))),
        (
            "ekf, angular rate",
            with(DetectorKind::AngularRate(DetectorKind::ANGULAR_RATE_THRESHOLD)),
        ),
        ("ekf, variance", with(DetectorKind::Variance(DetectorKind::VARIANCE_THRESHOLD))),
        ("ekf, magnitude", with(DetectorKind::Magnitude(DetectorKind::MAGNITUDE_THRESHOLD))),
    ];
    let mut table = Comparison::new(
        "pedestrian-methods",
        "Our trackers and detectors: mean relative error of the path's length, %",
    )
    .note(
        "The same walks for all. The synthetic foot neither rolls nor trembles in stance: SHOE and variance with a \
         fixed threshold do better on it than on recorded feet, where they lose whole walks (see the book).",
    );
    for row in &report.rows {
        let rate_hz = f64::from(row.rate_hz);
        let errors = (0..COMPARED).into_par_iter().map(|index| {
            let recording = Recording::synthetic(Walked::Route, rate_hz, report.seed, index)?;
            let error = |(_, options)| {
                walk(&recording.log.samples, &options)
                    .map(|walk| error_percent(walk.path_length_m))
                    .map_err(|error| refused(index, &error))
            };
            methods.into_iter().map(error).collect::<Result<Vec<_>, _>>()
        });
        let errors = errors.collect::<Result<Vec<_>, Error>>()?;
        for (i, (name, _)) in methods.iter().enumerate() {
            let of_method: Vec<_> = errors.iter().map(|walk| walk[i]).collect();
            let ours = format!("{:.2}", mean(&of_method));
            let value = Value::new("mean relative error of the length", "%")
                .under(format!("{} Hz", row.rate_hz))
                .by(if i == 0 { "default" } else { name })
                .is(mean(&of_method))
                .of(of_method.len(), None);
            table = table.row(format!("{} Hz, {name}", row.rate_hz), "", ours, "").values([value]);
        }
    }
    Ok(table)
}
