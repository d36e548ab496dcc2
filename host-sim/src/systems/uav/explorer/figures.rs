//! Figures of a flight, recorded or not.

use super::super::catching::BANDS;
use super::super::plant::{STATE_NAMES, STATE_SLUGS, STATE_UNITS, STATES};
use crate::figure::{Colour, Figure, Mark, Series};

/// An estimator's name and colour.
pub(super) const KALMAN: (&str, Colour) = ("Kalman", Colour::Ours);
/// The other's.
pub(super) const LUENBERGER: (&str, Colour) = ("Luenberger", Colour::Published);

/// What is known of a state, or estimated: times and values.
pub(super) type Line = (Vec<f64>, Vec<f64>);

/// A state over time.
#[derive(Debug, Default)]
pub(super) struct State {
    /// As measured.
    pub(super) measured: Line,
    /// As it was.
    pub(super) truth: Line,
    /// By the filter.
    pub(super) kalman: Line,
    /// By the observer.
    pub(super) luenberger: Line,
}

/// One figure a state.
pub(super) fn states(states: [State; 4]) -> impl Iterator<Item = Figure> {
    states.into_iter().enumerate().map(|(state, lines)| {
        let label = format!("{}, {}", STATES[state], STATE_UNITS[state]);
        let line = |(x, y): Line, (name, colour)| Series::line(name, x, y).coloured(colour);
        let (x, y) = lines.measured;
        Figure::new(STATE_SLUGS[state], STATE_NAMES[state])
            .axes("t, s", label)
            .caption("An estimate is of its time before that time's measurement was seen, or after it in a log.")
            .with(Series::new("measured", Mark::Dots, x, y).coloured(Colour::Other(6)))
            .with(line(lines.truth, ("truth", Colour::Truth)))
            .with(line(lines.luenberger, LUENBERGER))
            .with(line(lines.kalman, KALMAN))
    })
}

/// Errors of both, of each time the worst state's in its band.
pub(super) fn error(kalman: Line, luenberger: Line, end: f64) -> Figure {
    let band = Series::path("caught", [[0.0, 1.0], [end, 1.0]]);
    let line = |(x, y): Line, (name, colour)| Series::line(name, x, y).coloured(colour);
    Figure::new("error", "Error")
        .axes("t, s", "largest |error| / band of the four states")
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

/// The worst of some errors in bands.
pub(super) fn in_bands(errors: impl IntoIterator<Item = Option<f64>>) -> f64 {
    let all = errors.into_iter().zip(BANDS);
    let worst = all.filter_map(|(error, band)| error.map(|error| error.abs() / band));
    // Zero has no place on a logarithmic axis.
    worst.fold(1e-9, f64::max)
}

/// Poles in the complex plane.
pub(super) fn poles(plant: &[[f64; 2]], kalman: &[[f64; 2]], luenberger: &[[f64; 2]]) -> Figure {
    let marks = |name: &str, poles: &[[f64; 2]], colour| {
        Series::points(name, poles.iter().copied()).coloured(colour)
    };
    Figure::new("poles", "Poles")
        .axes("real part, 1/s", "imaginary part, 1/s")
        .caption("The further to the left a pole, the sooner what it belongs to is over.")
        .with(marks("plant", plant, Colour::Truth).marked(Mark::Crosses))
        .with(marks(LUENBERGER.0, luenberger, LUENBERGER.1))
        .with(marks(KALMAN.0, kalman, KALMAN.1))
}
