//! Figures of a flight: both estimators beside each other, and the effect of their poles and Q/R.

mod innovations;
mod modes;
mod poles;
pub mod streams;
mod sweep;
mod synthetic;
mod zeros;

use std::borrow::Cow;

use kestirim_replay::uav::{Estimate, EstimatorKind, Followed};
use nalgebra::SVector;

use super::account::accuracy::Accuracy;
use super::account::states::{BANDS, shown};
use super::recording::Recording;
use super::settings::{Simulation, options};
use super::simulate::plant::{STATE_NAMES, STATE_SLUGS, STATE_UNITS, STATES};
use super::track::Track;
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::system::{Answer, Settings};

/// The name and colour of the Kalman filter.
const KALMAN: (&str, Colour) = ("Kalman", Colour::Ours);
/// The name and colour of the Luenberger observer.
const LUENBERGER: (&str, Colour) = ("Luenberger", Colour::Published);

/// Times and values of a state, known or estimated.
type Line = (Vec<f64>, Vec<f64>);

/// Adds the page's figures, and facts about the other estimator with its default settings.
pub(super) fn draw(
    recording: &Recording,
    settings: &Settings,
    ours: &Track,
    answer: &mut Answer,
) -> Result<(), Error> {
    let (estimator, other, name) = match settings.chosen("estimator") {
        EstimatorKind::Kalman => {
            (EstimatorKind::Kalman, EstimatorKind::Luenberger, "Luenberger observer")
        }
        EstimatorKind::Luenberger => {
            (EstimatorKind::Luenberger, EstimatorKind::Kalman, "Kalman filter")
        }
    };
    let track = Track::by(recording, settings, other);
    if let Err(problem) = &track {
        answer.warnings.push(format!("no {name}: {problem}"));
    }
    let track = track.ok();
    let theirs = track.as_ref();
    let accuracy = theirs.and_then(Accuracy::of).and_then(|accuracy| {
        let [Some(a), Some(b), Some(c), Some(d)] = accuracy.rmse else { return None };
        Some([a, b, c, d])
    });
    if let Some(rmse) = accuracy {
        let units = STATE_UNITS.join(", ");
        let name = format!("{name}, RMSE of {} ({units})", STATES.join(", "));
        answer.fact(name, shown(rmse));
    }
    let (kalman, luenberger) = match estimator {
        EstimatorKind::Kalman => (Some(ours), theirs),
        EstimatorKind::Luenberger => (theirs, Some(ours)),
    };
    answer.figures.extend((0..4).map(|state| drawn(state, ours, [luenberger, kalman])));
    answer.figures.push(error(ours, [luenberger, kalman]));
    answer.figures.push(innovations::nis(kalman));
    answer.figures.push(innovations::whiteness(ours, kalman));
    let (flight, options) = (&ours.flight, options(settings));
    let plant = poles::of_model(flight)?;
    answer.figures.push(zeros::figure(&flight.model, &flight.log.outputs, &plant));
    answer.tables.push(modes::table(&plant));
    match recording {
        Recording::Logged(_) => {
            let found = kalman
                .map_or_else(|| Cow::Owned(Followed::default()), |it| Cow::Borrowed(&it.followed));
            answer.figures.push(poles::of_log(flight, &options, luenberger.is_some())?);
            answer.figures.push(sweep::of_log(flight, &found, &options));
        }
        Recording::Synthetic(inputs) => {
            synthetic::draw(&Simulation::of(settings, *inputs), &options, answer);
        }
    }
    Ok(())
}

/// The time since the log's first line (s).
fn seconds(track: &Track, t_us: i64) -> f64 {
    let begin = track.flight.log.samples.first().map_or(0, |sample| sample.t_us);
    (t_us - begin) as f64 / 1e6
}

fn line((x, y): Line, (name, colour): (&str, Colour)) -> Series {
    Series::line(name, x, y).coloured(colour)
}

/// A state as measured, as it truly was, and as the observer and the filter estimate it.
fn drawn(state: usize, ours: &Track, estimators: [Option<&Track>; 2]) -> Figure {
    let flight = &ours.flight;
    // Only an output that is a single state is drawn; a combination of states in a file's C has no axis here.
    let column = flight.log.outputs.iter().position(|&output| {
        let row = flight.model.outputs[output].1;
        row[state] == 1.0 && row.iter().filter(|part| **part != 0.0).count() == 1
    });
    let measured = column.map_or_else(Line::default, |column| {
        let rows = flight.measured();
        rows.filter_map(|(t_us, row)| Some((seconds(ours, t_us), row[column]?))).unzip()
    });
    let truth = flight.truth.iter().flatten();
    let truth = truth.filter_map(|(t_us, known)| Some((seconds(ours, *t_us), known[state]?)));
    let label = format!("{}, {}", STATES[state], STATE_UNITS[state]);
    let estimated = |track: Option<&Track>| -> Line {
        let Some(track) = track else { return Line::default() };
        let value = |estimate: &Estimate| -> SVector<f64, 4> { track.flight.absolute(estimate) };
        let estimates = track.followed.estimates.iter();
        estimates.map(|it| (seconds(track, it.t_us), value(it)[state])).unzip()
    };
    let [luenberger, kalman] = estimators.map(estimated);
    let (x, y) = measured;
    Figure::new(STATE_SLUGS[state], STATE_NAMES[state])
        .over_seconds(label)
        .caption(
            "An estimate is of its time before that time's measurement was seen, or after it in a log.",
        )
        .with(Series::new("measured", Mark::Dots, x, y).coloured(Colour::Other(6)))
        .with(line(truth.unzip(), ("truth", Colour::Truth)))
        .with(line(luenberger, LUENBERGER))
        .with(line(kalman, KALMAN))
}

/// The errors of both estimators: at each time that of the worst state, relative to its band.
fn error(ours: &Track, estimators: [Option<&Track>; 2]) -> Figure {
    let end = ours.flight.log.samples.last().map_or(0.0, |sample| seconds(ours, sample.t_us));
    let band = Series::path("caught", [[0.0, 1.0], [end, 1.0]]);
    let of = |track: Option<&Track>| -> Line {
        let Some(track) = track else { return Line::default() };
        let errors = track.flight.errors(&track.followed.estimates);
        errors.iter().map(|(t_us, errors)| (seconds(track, *t_us), in_bands(*errors))).unzip()
    };
    let [luenberger, kalman] = estimators.map(of);
    Figure::new("error", "Error")
        .over_seconds("largest |error| / band of the four states")
        .logarithmic()
        .caption(format!(
            "Bands: {} of {}. Nothing is shown where the truth is not known.",
            BANDS.map(|band| band.to_string()).join(", "),
            STATES.join(", ")
        ))
        .with(band.marked(Mark::Dashes).coloured(Colour::Limit))
        .with(line(luenberger, LUENBERGER))
        .with(line(kalman, KALMAN))
}

/// The largest error relative to its band.
fn in_bands(errors: [Option<f64>; 4]) -> f64 {
    let all = errors.into_iter().zip(BANDS);
    let worst = all.filter_map(|(error, band)| error.map(|error| error.abs() / band));
    // Zero cannot be shown on a logarithmic axis.
    worst.fold(1e-9, f64::max)
}
