//! How an aircraft flies: α, q, V, θ from some sensors.

use kestirim_health::{Health, Reason};
use kestirim_observer_design::{Complex, Discrete};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{Dynamics, Error, FlightFilter, FlightObserver, Noise, Sample};
use kestirim_uav_longitudinal::{self as aircraft, Airframe, StateSpace, SteadyFlight};
use nalgebra::{SMatrix, SVector};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Line, Results, ScalarKind, Table, code, microseconds, reasons, rows, values};
use crate::error::{KestirimError, refused, refused_at, unknown};

/// More outputs than states say nothing new.
const MOST_OUTPUTS: usize = 4;
/// Intervals of a log of which the steps are kept.
const KEPT: usize = 512;
/// Standard deviations of usual sensors: half a degree, half a metre a second; and of what reaches the inputs.
const HALF_A_DEGREE: f64 = 0.5 * std::f64::consts::PI / 180.0;
const SENSORS: [f64; 4] = [HALF_A_DEGREE, HALF_A_DEGREE, 0.5, HALF_A_DEGREE];
const INPUTS: [f64; 2] = [HALF_A_DEGREE, 0.02];
/// Intervals that differ by less than this share from the usual one are jitter, …
const JITTER: f64 = 0.1;
/// … and so many must be the usual one.
const REGULAR: f64 = 0.75;

/// A known aircraft's A, B, and the state and input of its steady flight if that is known.
#[pyfunction]
pub(crate) fn uav_model<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
    let (model, trim) = match name {
        "P1" => {
            let flight = SteadyFlight { airspeed: 40.0, climb_angle: 4.0_f64.to_radians() };
            let trim = Airframe::aerosonde().trim(&flight).map_err(refused)?;
            (aircraft::aerosonde().map_err(refused)?, Some((trim.state, trim.input)))
        }
        "P2" => (aircraft::thesis_like(), None),
        "P3" => (aircraft::navion(), None),
        _ => return Err(unknown("model", name, "'P1', 'P2', 'P3' or a UavModel")),
    };
    let of_rows = |row: usize| std::array::from_fn::<f64, 4, _>(|column| model.a[(row, column)]);
    let a = (0..4).map(of_rows).collect();
    let b = (0..4).map(|row| [model.b[(row, 0)], model.b[(row, 1)]]).collect();
    let trim = trim.map(|(state, input)| (<[f64; 4]>::from(state), <[f64; 2]>::from(input)));
    Ok(Results::new(py).table::<4>("a", a)?.table::<2>("b", b)?.with("trim", trim)?.done())
}

/// A flight. Values are deviations from the model's steady flight if there is no `trim`, which is taken from them.
#[pyfunction]
#[pyo3(signature = (t, inputs, measured, a, b, c, interval, trim, estimator, poles, input_noise, output_noise, ratio, scalar))]
pub(crate) fn uav<'py>(
    py: Python<'py>,
    t: Line<'py>,
    inputs: Table<'py>,
    measured: Table<'py>,
    a: Table<'py>,
    b: Table<'py>,
    c: Table<'py>,
    interval: Option<f64>,
    trim: Option<([f64; 4], [f64; 2])>,
    estimator: &str,
    poles: Vec<(f64, f64)>,
    input_noise: Option<[f64; 2]>,
    output_noise: Option<Line<'py>>,
    ratio: f64,
    scalar: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let scalar = ScalarKind::named(scalar)?;
    let c = rows::<4>(&c)?.to_vec();
    if c.is_empty() || c.len() > MOST_OUTPUTS {
        let sentence = format!("expected one to {MOST_OUTPUTS} outputs, found {}", c.len());
        return Err(KestirimError::new_err(sentence));
    }
    let output_noise = output_noise.as_ref().map(values).transpose()?.map(<[f64]>::to_vec);
    let usual = |row: &[f64; 4]| {
        row.iter().zip(&SENSORS).fold(0.0, |sum: f64, (part, sigma)| sum.hypot(part * sigma))
    };
    let noise = Assumed {
        inputs: input_noise.unwrap_or(INPUTS).map(|sigma| sigma * ratio.sqrt()),
        outputs: output_noise.unwrap_or_else(|| c.iter().map(usual).collect()),
    };
    let dynamics = dynamics(rows(&a)?, rows(&b)?, interval)?;
    let poles: Vec<_> = poles.into_iter().map(|(re, im)| Complex { re, im }).collect();
    let poles = <[Complex<f64>; 4]>::try_from(poles)
        .map_err(|poles| refused(format!("poles: expected 4, found {}", poles.len())))?;
    let origin = trim.unwrap_or_default();
    let model = Model { dynamics, c };
    let (times, inputs, measured) = (values(&t)?, rows(&inputs)?, values(&measured)?);
    let followed = py.detach(|| {
        let log = Log::new(times, inputs, measured, &model, origin)?;
        let kalman = |scalar| model.filtered(&log, &noise, scalar);
        match estimator {
            "kalman" => kalman(scalar),
            "luenberger" => {
                let mut followed = model.observed(&log, &poles, scalar)?;
                // Whether model and measurements agree does not depend on the observer: the filter beside it tells.
                if let Ok(judge) = kalman(ScalarKind::F64) {
                    for (health, judged) in followed.healths.iter_mut().zip(&judge.healths) {
                        for reason in [Reason::Innovations, Reason::Time] {
                            *health = health.with(reason, judged.has(reason));
                        }
                    }
                }
                Ok(followed)
            }
            _ => Err(unknown("estimator", estimator, "'kalman' or 'luenberger'")),
        }
    })?;
    followed.results(py, times, origin.0, model.c.len())
}

fn dynamics(a: &[[f64; 4]], b: &[[f64; 2]], interval: Option<f64>) -> PyResult<Dynamics> {
    let a = SMatrix::from_fn(|row, column| a[row][column]);
    let b = SMatrix::from_fn(|row, column| b[row][column]);
    match interval {
        None => Ok(Dynamics::Continuous(StateSpace { a, b })),
        Some(interval) if interval > 0.0 => {
            Ok(Dynamics::Discrete { step: Discrete { a, b }, interval })
        }
        Some(interval) => Err(KestirimError::new_err(format!(
            "interval: expected one above 0 s, found {interval}"
        ))),
    }
}

/// Standard deviations of white noise.
struct Assumed {
    inputs: [f64; 2],
    outputs: Vec<f64>,
}

struct Model {
    dynamics: Dynamics,
    /// What is measured: rows of C.
    c: Vec<[f64; 4]>,
}

/// A flight in deviations.
struct Log {
    samples: Vec<Sample<MOST_OUTPUTS>>,
    usual_s: f64,
}

impl Log {
    fn new(
        t: &[f64],
        inputs: &[[f64; 2]],
        measured: &[f64],
        model: &Model,
        (state, input): ([f64; 4], [f64; 2]),
    ) -> PyResult<Self> {
        let count = model.c.len();
        let part = |row: &[f64; 4]| row.iter().zip(&state).map(|(a, b)| a * b).sum::<f64>();
        let steady: Vec<f64> = model.c.iter().map(part).collect();
        let lines = t.iter().zip(inputs).zip(measured.chunks_exact(count));
        let samples = lines.map(|((t, given), measured)| Sample {
            time_us: microseconds(*t),
            input: SVector::from([given[0] - input[0], given[1] - input[1]]),
            measured: std::array::from_fn(|output| {
                let value = measured.get(output).copied().filter(|value| !value.is_nan());
                value.map(|value| value - steady[output])
            }),
        });
        let samples: Vec<_> = samples.collect();
        Ok(Self { usual_s: usual(&samples)?, samples })
    }
}

/// The usual interval, s.
fn usual(samples: &[Sample<MOST_OUTPUTS>]) -> PyResult<f64> {
    let step = |pair: &[Sample<MOST_OUTPUTS>]| (pair[1].time_us - pair[0].time_us) as f64 / 1e6;
    let mut steps: Vec<f64> = samples.windows(2).map(step).collect();
    if let Some(index) = steps.iter().position(|step| *step <= 0.0) {
        return Err(refused_at(index + 1, "expected a later time than that of the sample before"));
    }
    steps.sort_by(f64::total_cmp);
    let Some(&usual) = steps.get(steps.len() / 2) else {
        let found = samples.len();
        return Err(KestirimError::new_err(format!(
            "expected at least two samples, found {found}"
        )));
    };
    let near = steps.iter().filter(|step| (*step / usual - 1.0).abs() <= JITTER).count();
    if (near as f64) < REGULAR * steps.len() as f64 {
        let of = steps.len();
        return Err(KestirimError::new_err(format!(
            "expected samples at a regular interval, found {near} of {of} near {usual} s"
        )));
    }
    Ok(usual)
}

/// What came of a flight.
#[derive(Default)]
struct Followed {
    state: Vec<[f64; 4]>,
    sigma: Vec<[f64; 4]>,
    innovations: Vec<f64>,
    rejected: Vec<i64>,
    healths: Vec<Health>,
}

impl Model {
    fn filtered(&self, log: &Log, noise: &Assumed, scalar: ScalarKind) -> PyResult<Followed> {
        match scalar {
            ScalarKind::F32 => self.filtered_in::<f32>(log, noise),
            ScalarKind::F64 => self.filtered_in::<f64>(log, noise),
            ScalarKind::Fixed => self.filtered_in::<Q16_16>(log, noise),
        }
    }

    fn filtered_in<T: Scalar>(&self, log: &Log, noise: &Assumed) -> PyResult<Followed> {
        // Outputs that are never measured fill the rest.
        let noise = Noise {
            inputs: SVector::from(noise.inputs),
            outputs: SVector::from_fn(|row, _| noise.outputs.get(row).copied().unwrap_or(1.0)),
        };
        let c = self.rows::<MOST_OUTPUTS>();
        let filter =
            FlightFilter::<T, MOST_OUTPUTS, KEPT>::new(&self.dynamics, &c, &noise, log.usual_s);
        let mut filter = Box::new(filter.map_err(refused)?);
        let mut followed = Followed::default();
        for (index, sample) in log.samples.iter().enumerate() {
            let innovations = filter.take(sample).map_err(|error| refused_at(index, error))?;
            let now = filter.filter();
            followed.state.push(now.estimate().into());
            followed.sigma.push(now.sigma().into());
            let told = innovations.iter().take(self.c.len());
            followed.innovations.extend(told.map(|it| it.map_or(f64::NAN, |it| it.innovation)));
            followed.healths.push(filter.health());
        }
        followed.rejected = filter.rejected().iter().map(|count| i64::from(*count)).collect();
        Ok(followed)
    }

    fn observed(
        &self,
        log: &Log,
        poles: &[Complex<f64>; 4],
        scalar: ScalarKind,
    ) -> PyResult<Followed> {
        match scalar {
            ScalarKind::F32 => self.observed_in::<f32>(log, poles),
            ScalarKind::F64 => self.observed_in::<f64>(log, poles),
            ScalarKind::Fixed => self.observed_in::<Q16_16>(log, poles),
        }
    }

    fn observed_in<T: Scalar>(&self, log: &Log, poles: &[Complex<f64>; 4]) -> PyResult<Followed> {
        match self.c.len() {
            1 => self.observed_of::<T, 1>(log, poles),
            2 => self.observed_of::<T, 2>(log, poles),
            3 => self.observed_of::<T, 3>(log, poles),
            _ => self.observed_of::<T, 4>(log, poles),
        }
    }

    fn observed_of<T: Scalar, const P: usize>(
        &self,
        log: &Log,
        poles: &[Complex<f64>; 4],
    ) -> PyResult<Followed> {
        let poles = poles.map(|pole| {
            let size = (pole.re * log.usual_s).exp();
            let (sin, cos) = (pole.im * log.usual_s).sin_cos();
            Complex { re: size * cos, im: size * sin }
        });
        let c = self.rows::<P>();
        let observer: Result<_, Error> =
            FlightObserver::<T, P, KEPT>::new(&self.dynamics, &c, &poles, log.usual_s);
        let mut observer = Box::new(observer.map_err(refused)?);
        let mut followed = Followed::default();
        for (index, sample) in log.samples.iter().enumerate() {
            let sample = Sample {
                time_us: sample.time_us,
                input: sample.input,
                measured: std::array::from_fn(|output| sample.measured[output]),
            };
            let innovations = observer.take(&sample).map_err(|error| refused_at(index, error))?;
            followed.state.push(observer.estimate().into());
            followed.sigma.push([f64::NAN; 4]);
            followed.innovations.extend(innovations.map(|it| it.unwrap_or(f64::NAN)));
            followed.healths.push(observer.health());
        }
        followed.rejected = observer.rejected().iter().map(|count| i64::from(*count)).collect();
        Ok(followed)
    }

    /// Rows of C; zero beyond.
    fn rows<const P: usize>(&self) -> SMatrix<f64, P, 4> {
        let row = |output: usize| self.c.get(output).copied().unwrap_or_default();
        SMatrix::from_fn(|output, state| row(output)[state])
    }
}

impl Followed {
    fn results<'py>(
        mut self,
        py: Python<'py>,
        t: &[f64],
        origin: [f64; 4],
        outputs: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        for state in &mut self.state {
            *state = std::array::from_fn(|i| state[i] + origin[i]);
        }
        self.rejected.truncate(outputs);
        let seconds = t.iter().map(|t| microseconds(*t) as f64 / 1e6).collect();
        let health = self.healths.iter().map(|health| code(health.state())).collect();
        let told = [Reason::Innovations, Reason::Rejected, Reason::Time];
        let seen = |reason: &Reason| self.healths.iter().any(|health| health.has(*reason));
        let doubts: Health = told.into_iter().filter(seen).collect();
        let count = self.state.len();
        Ok(Results::new(py)
            .line("t", seconds)?
            .table("state", self.state)?
            .table("sigma", self.sigma)?
            .shaped("innovations", self.innovations, [count, outputs])?
            .line("rejected", self.rejected)?
            .line("health", health)?
            .with("reasons", reasons(doubts))?
            .done())
    }
}
