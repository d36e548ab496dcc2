//! A simulated flight, of which everything can be changed.

use nalgebra::SMatrix;

use super::super::accuracy::settled;
use super::super::catching::caught;
use super::super::design::Kind;
use super::super::plant::{Outputs, Plant, STATE_UNITS, STATES, with_outputs};
use super::super::report::{shown, times};
use super::super::scenario::{INTERVAL_S, Inputs, NEAR, Noise, SAMPLES, START};
use super::super::trip::{Moment, Trip};
use super::controls::{self, estimators};
use super::figures::{self, KALMAN, LUENBERGER, Line, State, in_bands};
use super::poles;
use crate::Error;
use crate::system::ScalarKind;
use crate::explore::{Answer, Control, Explorer, Settings};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::rms;

/// Standard deviation that a filter believes where there is no noise.
const LEAST_SIGMA: f64 = 1e-3;
/// Factors of the sweep, of Q/R and of the poles: from a tenth to ten, four steps a half.
const FACTORS: std::ops::RangeInclusive<i32> = -4..=4;

/// A flight with constant or sine inputs at first.
#[derive(Debug)]
pub(super) struct Synthetic {
    /// Which at first.
    pub(super) sine: bool,
}

/// What the settings ask for.
struct Asked {
    trip: Trip,
    filter: Kind,
    observer: Kind,
    scalar: ScalarKind,
    seed: u64,
    /// What the filter takes the noise for, at its own Q/R.
    assumed: Noise,
    ratio: f64,
    poles: [f64; 4],
}

impl Explorer for Synthetic {
    fn controls(&self) -> Vec<Control> {
        let inputs = [("constant", "constant (thesis)"), ("sine", "sine")];
        let inputs = if self.sine { [inputs[1], inputs[0]] } else { inputs };
        let mut controls = vec![
            controls::plant(),
            Control::choice(
                "outputs",
                "measured",
                &[("all", "all states (thesis)"), ("qVtheta", "q, V, θ"), ("Vtheta", "V, θ")],
            ),
            Control::choice("inputs", "inputs", &inputs),
        ];
        controls.extend(estimators());
        controls.extend([
            Control::choice(
                "gain",
                "the filter's gain",
                &[
                    ("steady", "steady (thesis)"),
                    ("varying", "time-varying, knows how wrong it starts"),
                ],
            ),
            Control::choice(
                "noise",
                "noise",
                &[
                    ("equal", "of equal size (thesis)"),
                    ("sensors", "of real sensors: 0.5°, 0.5 m/s"),
                    ("none", "none"),
                ],
            ),
            Control::decades("sigma", "σ of noise of equal size", "", [1e-4, 1.0], 0.01),
            Control::slider("wrong", "how wrong the start is", "× thesis", [0.0, 4.0, 0.1], 1.0),
            Control::slider("duration", "duration", "s", [1.0, 60.0, 1.0], 10.0),
            Control::choice(
                "scalar",
                "numbers",
                &[("f64", "f64"), ("f32", "f32"), ("fixed", "Q16.16")],
            ),
            Control::slider("seed", "seed", "", [0.0, 99.0, 1.0], 0.0),
        ]);
        controls
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let asked = Asked::of(settings);
        let mut answer = Answer::default();
        let mut run = |(name, kind): (&str, &Kind), trip: &Trip| {
            let moments = trip.follow(kind, asked.scalar, asked.seed);
            if let Err(problem) = &moments {
                answer.warnings.push(format!("no {name}: {problem}"));
            }
            moments.ok()
        };
        let kalman = run(("Kalman filter", &asked.filter), &asked.trip);
        let luenberger = run(("Luenberger observer", &asked.observer), &asked.trip);
        asked.tell(&mut answer, [&kalman, &luenberger]);
        let mut states = [(); 4].map(|()| State::default());
        let any = kalman.as_deref().or(luenberger.as_deref()).unwrap_or_default();
        for (number, state) in states.iter_mut().enumerate() {
            let first = 4 - asked.trip.outputs.count();
            if number >= first && asked.trip.noise != Noise::NONE {
                state.measured = line(any, |moment| moment.sample.y[number]);
            }
            state.truth = line(any, |moment| moment.sample.x[number]);
            let estimate = |moments: &Option<Vec<Moment>>| {
                line(moments.as_deref().unwrap_or_default(), |moment| moment.estimate[number])
            };
            (state.kalman, state.luenberger) = (estimate(&kalman), estimate(&luenberger));
        }
        let error = |moments: &Option<Vec<Moment>>| {
            line(moments.as_deref().unwrap_or_default(), |moment| {
                in_bands(moment.error().iter().map(|error| Some(*error)))
            })
        };
        answer.figures.extend(figures::states(states));
        let end = asked.trip.samples as f64 * INTERVAL_S;
        answer.figures.push(figures::error(error(&kalman), error(&luenberger), end));
        answer.figures.push(with_outputs!(asked.trip.outputs, poles_of, &asked));
        answer.figures.push(with_outputs!(asked.trip.outputs, against, &asked));
        Ok(answer)
    }
}

impl Asked {
    fn of(settings: &Settings) -> Self {
        let plant = match settings.choice("plant") {
            "P1" => Plant::P1,
            "P3" => Plant::P3,
            _ => Plant::P2,
        };
        let outputs = match settings.choice("outputs") {
            "qVtheta" => Outputs::RateAirspeedPitch,
            "Vtheta" => Outputs::AirspeedPitch,
            _ => Outputs::Full,
        };
        let inputs =
            if settings.choice("inputs") == "sine" { Inputs::Sine } else { Inputs::Constant };
        let equal = |sigma: f64| Noise { name: "equal", inputs: [sigma; 2], outputs: [sigma; 4] };
        let noise = match settings.choice("noise") {
            "sensors" => Noise::SENSORS,
            "none" => Noise::NONE,
            _ => equal(settings.number("sigma")),
        };
        let assumed = if noise == Noise::NONE { equal(LEAST_SIGMA) } else { noise };
        let ratio = settings.number("ratio");
        let believed = believed(&assumed, ratio);
        let wrong = settings.number("wrong");
        let start = std::array::from_fn(|i| START[i] + wrong * (NEAR[i] - START[i]));
        let samples = (settings.number("duration") / INTERVAL_S).round() as usize;
        let poles = controls::poles(settings);
        Self {
            trip: Trip { plant, outputs, inputs, noise, truth: START, start, samples },
            filter: if settings.choice("gain") == "varying" {
                Kind::TimeVarying(believed)
            } else {
                Kind::Matched(believed)
            },
            observer: Kind::Luenberger(poles),
            scalar: match settings.choice("scalar") {
                "f32" => ScalarKind::F32,
                "fixed" => ScalarKind::Fixed,
                _ => ScalarKind::F64,
            },
            seed: settings.number("seed") as u64,
            assumed,
            ratio,
            poles,
        }
    }

    /// Errors, and times to catch the plant were there no noise.
    fn tell(&self, answer: &mut Answer, [kalman, luenberger]: [&Option<Vec<Moment>>; 2]) {
        let quiet = Trip { noise: Noise::NONE, samples: SAMPLES, ..self.trip };
        for (name, kind, moments) in
            [(KALMAN.0, &self.filter, kalman), (LUENBERGER.0, &self.observer, luenberger)]
        {
            let Some(moments) = moments else { continue };
            let rmse = std::array::from_fn(|state| {
                rms(&moments.iter().map(|moment| moment.error()[state]).collect::<Vec<_>>())
            });
            let units = STATE_UNITS.join(", ");
            answer.fact(format!("{name}: RMSE of {} ({units})", STATES.join(", ")), shown(rmse));
            if let Ok(moments) = quiet.follow(kind, self.scalar, self.seed) {
                let errors: Vec<_> = moments.iter().map(Moment::error).collect();
                let caught = times(Some(caught(&errors)));
                answer.fact(format!("{name}: caught without noise after (s)"), caught);
            }
        }
    }
}

/// Noise that a filter takes for true, with so many times the variance on the inputs.
fn believed(noise: &Noise, ratio: f64) -> Noise {
    Noise { inputs: noise.inputs.map(|sigma| sigma * ratio.sqrt()), ..*noise }
}

fn line(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> Line {
    let times = (0..moments.len()).map(|sample| sample as f64 * INTERVAL_S).collect();
    (times, moments.iter().map(value).collect())
}

fn poles_of<const P: usize>(c: &SMatrix<f64, P, 4>, asked: &Asked) -> Figure {
    let plant = asked.trip.plant.discrete(INTERVAL_S);
    let of = |kind: &Kind| {
        let gain = kind.gain(&plant, c);
        gain.map(|gain| poles::of(&(plant.a - gain * c), INTERVAL_S)).unwrap_or_default()
    };
    figures::poles(&poles::of(&plant.a, INTERVAL_S), &of(&asked.filter), &of(&asked.observer))
}

/// Settled errors by Lyapunov's equation, were Q/R or the poles different.
fn against<const P: usize>(c: &SMatrix<f64, P, 4>, asked: &Asked) -> Figure {
    let plant = asked.trip.plant.discrete(INTERVAL_S);
    let worst = |kind: &Kind| -> Result<f64, kestirim_observer_design::Error> {
        let best = settled(c, &plant, &Kind::Matched(asked.assumed), &asked.assumed)?;
        let errors = settled(c, &plant, kind, &asked.assumed)?;
        Ok(errors.iter().zip(best).map(|(error, best)| error / best).fold(0.0, f64::max))
    };
    let sweep = |kind: &dyn Fn(f64) -> Kind| {
        let factors = FACTORS.map(|step| 10_f64.powf(f64::from(step) / 4.0));
        factors.filter_map(|factor| Some([factor, worst(&kind(factor)).ok()?])).collect::<Vec<_>>()
    };
    let filters = sweep(&|factor| Kind::Matched(believed(&asked.assumed, asked.ratio * factor)));
    let observers = sweep(&|factor| Kind::Luenberger(asked.poles.map(|pole| pole * factor)));
    let drawn = |points, (name, colour): (&str, Colour)| {
        Series::path(name, points).marked(Mark::LineAndPoints).coloured(colour)
    };
    let mut figure = Figure::new("against", "Poles and Q/R against error")
        .axes("times the poles, times Q/R", "worst state's settled RMSE / best possible")
        .caption(
            "Settled errors under the noise that the filter assumes at Q/R × 1; at 1 here are the settings \
             as they stand.",
        )
        .logarithmic()
        .with(drawn(observers, (LUENBERGER.0, LUENBERGER.1)))
        .with(drawn(filters, (KALMAN.0, KALMAN.1)));
    figure.x.logarithmic = true;
    figure
}
