//! Chapter 6 of the thesis: estimators beside their plant.

use kestirim_replay::uav::{FAST, Noise, Plant, SLOW};

use super::{by_state, made};
use crate::Error;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::report::{Comparison, Item, Value, printed};
use crate::systems::uav::account::states::{BANDS, times};
use crate::systems::uav::paper::catching::{Chase, Row, THESIS, THESIS_LUENBERGER, THESIS_SINE};
use crate::systems::uav::paper::report::Report;
use crate::systems::uav::simulate::design::Kind;
use crate::systems::uav::simulate::flight::{Flight, Moment};
use crate::systems::uav::simulate::plant::{Outputs, STATES};
use crate::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, NEAR, SAMPLES, START};

/// The items in the thesis' order.
pub(super) fn items(report: &Report) -> Result<Vec<Item>, Error> {
    let once = made(report, "1 flight without noise");
    let noisy = made(report, "1 flight with σ = 0.01 on every input and output");
    let mut items = Vec::new();
    let quiet = [
        ("Kalman, Q/R = 0.01, from [0.2, 0.2, 20, 0.2]", Colour::Other(0), THESIS),
        (
            "Luenberger −2 −1.5 −8 −3.5, from [0.1, 0.1, 35, 0.4]",
            Colour::Other(1),
            THESIS_LUENBERGER,
        ),
    ];
    let figures = drawn(
        report,
        &quiet.map(|(name, colour, chase)| (name, colour, chase.kind, chase.flight())),
        ("uav-fig-6-1", "Figs 6.1–6.4, 6.13–6.17, without noise"),
        "Both catch the plant; the times are in the table below.",
    )?;
    items.extend(figures.map(|figure| once.item(figure)));
    let figures = drawn(
        report,
        &under_noise(Inputs::Constant),
        ("uav-fig-6-5", "Figs 6.5–6.12, 6.18–6.21, with noise"),
        "A fast observer follows every measurement; a filter that knows its start does not have to.",
    )?;
    items.extend(figures.map(|figure| noisy.item(figure)));
    let sine = [
        ("Kalman, Q/R = 0.01", Colour::Other(0), Chase { kind: THESIS.kind, ..THESIS_SINE }),
        ("Luenberger −12 −14 −16 −18", Colour::Other(1), THESIS_SINE),
    ];
    let figures = drawn(
        report,
        &sine.map(|(name, colour, chase)| (name, colour, chase.kind, chase.flight())),
        ("uav-fig-6-22", "Figs 6.22, 6.25, sine inputs without noise"),
        "The observer's poles were moved, and that alone makes it faster: the error does not depend on the inputs.",
    )?;
    items.extend(figures.map(|figure| once.item(figure)));
    let sine = under_noise(Inputs::Sine);
    let figures = drawn(
        report,
        &sine,
        ("uav-fig-6-23", "Figs 6.23, 6.24, 6.26, sine inputs with noise"),
        "The same errors as with constant inputs, about another flight.",
    )?;
    items.extend(figures.map(|figure| noisy.item(figure)));
    items.extend(errors(report, &sine)?.map(|figure| noisy.item(figure)));
    items.push(once.item(caught(report)));
    items.push(once.item(falling(report)?));
    Ok(items)
}

/// An estimator in a figure: name, colour, kind, and the flight that it follows.
type Drawn = (&'static str, Colour, Kind, Flight);

/// The filter that explains the thesis' figures, a fast observer, and the filter that knows its initial uncertainty.
fn under_noise(inputs: Inputs) -> [Drawn; 3] {
    let (noise, truth, start) = (Noise::EQUAL, START, NEAR);
    let (plant, outputs, samples) = (Plant::P2, Outputs::Full, SAMPLES);
    let flight = Flight { plant, outputs, inputs, noise, truth, start, samples };
    [
        ("Luenberger −12 −14 −16 −18", Colour::Other(1), Kind::Luenberger(FAST), flight),
        ("Kalman, Q/R = 0.01", Colour::Other(0), THESIS.kind, flight),
        ("Kalman, time-varying gain", Colour::Other(2), Kind::TimeVarying(noise), flight),
    ]
}

/// The sample times (s).
fn seconds(moments: &[Moment]) -> Vec<f64> {
    (0..moments.len()).map(|sample| sample as f64 * INTERVAL_S).collect()
}

/// A figure per state with the truth, the measurements if they are noisy, and the estimates.
fn drawn(
    report: &Report,
    all: &[Drawn],
    (id, title): (&str, &str),
    caption: &str,
) -> Result<[Figure; 4], Error> {
    let runs = runs(report, all)?;
    Ok(by_state(id, title, caption, |state, figure| {
        let Some((_, moments)) = runs.first() else { return figure };
        let values = |of: &dyn Fn(&Moment) -> f64| moments.iter().map(of).collect();
        let measured = all.iter().any(|(.., flight)| flight.noise != Noise::NONE).then(|| {
            let values = values(&|moment| moment.sample.y[state]);
            Series::new("measured", Mark::Dots, seconds(moments), values).coloured(Colour::Other(6))
        });
        let truth = values(&|moment| moment.sample.x[state]);
        let estimates = runs.iter().map(|((name, colour, ..), moments)| {
            let estimate = moments.iter().map(|moment| moment.estimate[state]).collect();
            Series::line(*name, seconds(moments), estimate).coloured(*colour)
        });
        figure
            .with_all(measured)
            .with(Series::line("plant", seconds(moments), truth).coloured(Colour::Truth))
            .with_all(estimates)
    }))
}

fn runs<'a>(report: &Report, all: &'a [Drawn]) -> Result<Vec<(&'a Drawn, Vec<Moment>)>, Error> {
    let run = |drawn: &'a Drawn| {
        let (name, _, kind, flight) = drawn;
        let moments = flight.follow(kind, report.scalar, report.seed);
        moments
            .map(|moments| (drawn, moments))
            .map_err(|problem| Error::Usage(format!("uav: there is no {name}: {problem}")))
    };
    all.iter().map(run).collect()
}

/// Fig. 6.27: the errors under noise.
fn errors(report: &Report, all: &[Drawn]) -> Result<[Figure; 4], Error> {
    let runs = runs(report, all)?;
    Ok(by_state(
        "uav-fig-6-27",
        "Fig. 6.27, errors under noise, sine inputs",
        "Once caught, the filters' errors are smaller; until then the time-varying gain's alone are.",
        |state, figure| {
            figure.with_all(runs.iter().map(|((name, colour, ..), moments)| {
                let errors = moments.iter().map(|moment| moment.error()[state]).collect();
                Series::line(*name, seconds(moments), errors).coloured(*colour)
            }))
        },
    ))
}

/// The thesis' times to catch, and ours with constant inputs.
fn caught(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-catching",
        "Figs 6.1–6.4, 6.13–6.17, 6.25: time to catch α, q, V, θ without noise, s (limit: the error recursion \
         alone, in double precision)",
    );
    report.catching.iter().filter(|row| row.published.is_some()).fold(empty, |table, row: &Row| {
        let published = row.published.map(|times| times.join(" ")).unwrap_or_default();
        let source = row.source.unwrap_or_default();
        let start = row.start.map(|number| number.to_string()).join(", ");
        let quantity = format!(
            "{}, {} inputs, from [{start}] ({source})",
            row.estimator,
            row.inputs.name()
        );
        let values: Vec<_> = (0..4)
            .map(|state| {
                let of = |times: Option<[Option<f64>; 4]>| times.and_then(|times| times[state]);
                Value::new(format!("time to catch {}", STATES[state]), "s")
                    .under(quantity.clone())
                    .by("published method")
                    .is(of(row.ours_s))
                    .published(row.published.and_then(|texts| printed(texts[state])))
                    .limited(of(row.limit_s))
            })
            .collect();
        table.repeated(quantity, published, times(row.ours_s), times(row.limit_s)).values(values)
    })
    .note(format!(
        "Caught: within {} of {} for good. The thesis prints no gains; these are the ones whose times are its \
         own, but for q of the Kalman filter, which it sees caught sooner than this gain has it.",
        BANDS.map(|band| band.to_string()).join(", "),
        STATES.join(", ")
    ))
}

/// The worst state's error relative to its band: one line per estimator, which has caught the plant where it stays
/// below one.
fn falling(report: &Report) -> Result<Figure, Error> {
    let kinds = [
        Kind::Ratio(1e-2),
        Kind::Luenberger(SLOW),
        Kind::TimeVarying(Noise::SENSORS),
        Kind::Luenberger(FAST),
    ];
    let mut figure = Figure::new("uav-catching-errors", "Largest error in bands, without noise")
        .over_seconds("largest |error| / band of the four states")
        .caption(
            "All states are caught where a line stays below 1: a gain that knows how wrong its start is \
             hardly needs time, a steady filter is held up by the plant's zeros.",
        )
        .logarithmic()
        .showing(Some([-0.1, 10.0]), Some([1e-3, 100.0]));
    for (number, kind) in kinds.into_iter().enumerate() {
        let chase = Chase { kind, ..THESIS_LUENBERGER };
        let name = kind.name();
        let errors = chase
            .errors(report.scalar)
            .map_err(|problem| Error::Usage(format!("uav: there is no {name}: {problem}")))?;
        let worst = errors.iter().enumerate().map(|(sample, error)| {
            let bands = error.iter().zip(BANDS).map(|(error, band)| error.abs() / band);
            [sample as f64 * INTERVAL_S, bands.fold(0.0, f64::max)]
        });
        figure = figure.with(Series::path(name, worst).coloured(Colour::Other(number)));
    }
    let band = Series::path("caught", [[0.0, 1.0], [10.0, 1.0]]);
    Ok(figure.with(band.marked(Mark::Dashes).coloured(Colour::Limit)))
}
