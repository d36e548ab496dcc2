//! The effect of other values of Q/R on a recorded flight.

use kestirim_replay::uav::{Deviations, Followed, Options};
use rayon::prelude::*;

use super::innovations::{autocorrelation, late, normalised};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::{mean, rms};

/// The factors of the sweep, as exponents of √10.
const STEPS: [i32; 9] = [-4, -3, -2, -1, 0, 1, 2, 3, 4];
/// The factors of the sweep for a filter with further states, as exponents of √10.
const FEW_STEPS: [i32; 5] = [-4, -2, 0, 2, 4];
/// The number of lines from the start of the flight that are tracked with each factor: no more than a slider can wait
/// for.
const LINES: usize = 4000;
/// The number of lines that are tracked by a filter with further states.
const FEW_LINES: usize = 1000;
/// The limit to which outliers are clamped, in standard deviations.
const LARGEST: f64 = 3.2;

/// The results of a filter on a flight.
#[derive(Debug, Clone, PartialEq)]
struct Made {
    /// The mean normalised innovation squared.
    nis: f64,
    /// The largest |r(1)| of an output.
    lasting: f64,
    /// The root mean square innovation of each output.
    beyond: Vec<f64>,
    /// The root mean square errors of the states whose truth is known; empty without a truth.
    errors: Vec<f64>,
}

impl Made {
    /// The results over the second half of the flight.
    fn of(flight: &Deviations, followed: &Followed) -> Self {
        let outputs = normalised(followed);
        let lasting = |output: &Vec<Option<f64>>| {
            autocorrelation(late(output)).0.first().map_or(0.0, |first| first.abs())
        };
        let squares = outputs.iter().flat_map(|output| late(output)).flatten();
        let squares: Vec<f64> = squares.map(|it| it.clamp(-LARGEST, LARGEST).powi(2)).collect();
        let beyond = followed.innovations.iter().map(|output| {
            let known: Vec<f64> = late(output).iter().flatten().copied().collect();
            rms(&known)
        });
        let errors = flight.errors(late(&followed.estimates));
        let of_state = |state: usize| {
            let known: Vec<f64> = errors.iter().filter_map(|(_, it)| it[state]).collect();
            (!known.is_empty()).then(|| rms(&known))
        };
        Self {
            nis: mean(&squares),
            lasting: outputs.iter().map(lasting).fold(0.0, f64::max),
            beyond: beyond.collect(),
            errors: (0..4).filter_map(of_state).collect(),
        }
    }
}

/// Consistency, whiteness and size of the innovations, and errors if a truth is known, for other values of Q/R. Only
/// the errors need a truth: each estimate is judged by the next measurement (Mehra, IEEE Trans. Automatic Control 15
/// (1970)).
pub(super) fn of_log(flight: &Deviations, found: &Followed, options: &Options) -> Figure {
    let (steps, lines) = match flight.model.extended {
        Some(_) => (&FEW_STEPS[..], FEW_LINES),
        None => (&STEPS[..], LINES),
    };
    let part = flight.beginning(lines);
    let made = |step: &i32| {
        let factor = 10_f64.powf(f64::from(*step) / 2.0);
        let options = Options { ratio: options.ratio * factor, ..*options };
        Some((factor, Made::of(&part, &part.follow_as(found, &options).ok()?)))
    };
    let all: Vec<_> = steps.par_iter().filter_map(made).collect();
    let as_set = all.iter().find(|(factor, _)| (factor - 1.0).abs() < 1e-9).map(|(_, made)| made);
    let beside = |of: fn(&Made) -> &Vec<f64>| {
        let ratio = move |made: &Made| {
            let pairs = of(made).iter().zip(of(as_set?)).filter(|(_, set)| **set > 0.0);
            let ratios: Vec<f64> = pairs.map(|(found, set)| found / set).collect();
            (!ratios.is_empty()).then(|| mean(&ratios))
        };
        all.iter().filter_map(move |(factor, made)| Some([*factor, ratio(made)?]))
    };
    let told = |of: fn(&Made) -> f64| all.iter().map(move |(factor, made)| [*factor, of(made)]);
    let line = |name: &str, points: Vec<[f64; 2]>, colour| {
        Series::path(name, points).marked(Mark::LineAndPoints).coloured(colour)
    };
    let errors = flight.truth.is_some().then(|| {
        let errors = beside(|made| &made.errors).collect();
        line("RMSE / that at × 1, mean of the states", errors, Colour::Ours)
    });
    let aim =
        [steps[0], steps[steps.len() - 1]].map(|step| [10_f64.powf(f64::from(step) / 2.0), 1.0]);
    let mut figure = Figure::new("against", "Q/R against innovations and error")
        .axes("times Q/R", "as the legend says")
        .caption(format!(
            "Later half of the first {} lines, at 1 the settings as they stand. Noise is as assumed where NIS is 1 and innovations are \
             least correlated; innovations are least where the next measurement is predicted best.",
            part.log.samples.len()
        ))
        .logarithmic()
        .with(Series::path("aim of NIS", aim).marked(Mark::Dashes).coloured(Colour::Limit))
        .with(line("NIS a measurement", told(|made| made.nis).collect(), Colour::Other(1)))
        .with(line(
            "largest |autocorrelation| at one line's lag",
            told(|made| made.lasting.max(1e-3)).collect(),
            Colour::Other(3),
        ))
        .with(line(
            "innovations / those at × 1, mean of the outputs",
            beside(|made| &made.beyond).collect(),
            Colour::Other(4),
        ))
        .with_all(errors);
    figure.x.logarithmic = true;
    figure
}
