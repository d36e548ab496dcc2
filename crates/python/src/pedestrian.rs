//! Where a foot walked.

mod heading;

use kestirim_health::{Health, Reason, State};
use kestirim_pedestrian::{
    Config, Ekf, Error, Estimate, ImuSample, Lite, Navigator, OfflineTracker, PathUncertainty,
    SensorClass, Stride, Tracker, Warnings,
};
use kestirim_scalar::{Q12_20, Scalar};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{
    Line, Results, ScalarKind, Table, code, doubles, microseconds, reasons, rows, values, vector,
};
use crate::error::{KestirimError, refused_at, unknown};

/// A walk.
#[pyfunction]
#[pyo3(signature = (t, accel, gyro, mag, sensor, causal, tracker, contact_height, scalar))]
pub(crate) fn pedestrian<'py>(
    py: Python<'py>,
    t: Line<'py>,
    accel: Table<'py>,
    gyro: Table<'py>,
    mag: Option<Table<'py>>,
    sensor: &str,
    causal: bool,
    tracker: &str,
    contact_height: Option<f64>,
    scalar: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let sensor = match sensor {
        "industrial" => SensorClass::Industrial,
        "consumer" => SensorClass::Consumer,
        _ => return Err(unknown("sensor", sensor, "'industrial' or 'consumer'")),
    };
    let log = Log { t: values(&t)?, accel: rows(&accel)?, gyro: rows(&gyro)? };
    let options = Options { sensor, causal, contact_height };
    let scalar = ScalarKind::named(scalar)?;
    let field = mag.as_ref().map(rows::<3>).transpose()?;
    // A heading is corrected afterwards, and that of the other trackers does not drift at a constant rate.
    let field = field.filter(|_| !causal && tracker == "ekf");
    let found = || match (tracker, scalar) {
        ("ekf", ScalarKind::F32) => walk::<f32, Ekf<f32>>(&log, options),
        ("ekf", ScalarKind::F64) => walk::<f64, Ekf<f64>>(&log, options),
        ("ekf", ScalarKind::Fixed) => walk::<Q12_20, Ekf<Q12_20>>(&log, options),
        ("lite", ScalarKind::F32) => walk::<f32, Lite<f32>>(&log, options),
        ("lite", ScalarKind::F64) => walk::<f64, Lite<f64>>(&log, options),
        ("lite", ScalarKind::Fixed) => walk::<Q12_20, Lite<Q12_20>>(&log, options),
        _ => Err(unknown("tracker", tracker, "'ekf' or 'lite'")),
    };
    let walk = py.detach(|| -> PyResult<Walk> {
        let mut walk = found()?;
        if let Some(rate) = field.and_then(|field| heading::rate(&log, field, options)) {
            walk.turn_back(rate);
        }
        Ok(walk)
    })?;
    walk.results(py)
}

/// What the sensor said.
struct Log<'a> {
    t: &'a [f64],
    accel: &'a [[f64; 3]],
    gyro: &'a [[f64; 3]],
}

impl Log<'_> {
    /// Refuses times that are none, and a walk of one sample.
    fn samples<T: Scalar>(&self) -> PyResult<Vec<ImuSample<T>>> {
        if self.t.len() < 2 {
            let found = self.t.len();
            let sentence = format!("expected a log of at least 2 samples, found {found}");
            return Err(KestirimError::new_err(sentence));
        }
        let rows = self.t.iter().zip(self.accel).zip(self.gyro).enumerate();
        let sample = |(index, ((&t, accel), gyro))| {
            if !(0.0..=1e12).contains(&t) {
                let sentence = format!("expected a time from 0 s on, found {t}");
                return Err(refused_at(index, sentence));
            }
            let time_us = microseconds(t) as u64;
            let (specific_force, angular_rate) = (vector(accel), vector(gyro));
            Ok(ImuSample { time_us, specific_force, angular_rate })
        };
        rows.map(sample).collect()
    }
}

#[derive(Clone, Copy)]
struct Options {
    sensor: SensorClass,
    causal: bool,
    contact_height: Option<f64>,
}

impl Options {
    fn config<T: Scalar>(self) -> Config<T> {
        let config = Config { sensor: self.sensor, ..Config::default() };
        let contact_height = self.contact_height.map_or(config.contact_height, T::from_f64);
        Config { contact_height, ..config }
    }
}

fn walk<T: Scalar, N: Navigator<T>>(log: &Log<'_>, options: Options) -> PyResult<Walk> {
    let config = options.config::<T>();
    let samples = log.samples::<T>()?;
    let mut walk = Walk::with_room_for(samples.len());
    if options.causal {
        let mut tracker = Tracker::<T, N>::new(config);
        for (index, sample) in samples.iter().enumerate() {
            let estimate = tracker.update(sample).map_err(|error| refused_at(index, error))?;
            walk.push(&estimate, tracker.warnings());
        }
        walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings(), config.sensor);
        return Ok(walk);
    }
    let mut memory = vec![T::ZERO; samples.len()];
    let mut tracker = OfflineTracker::<T, N>::new(config, &samples, &mut memory)
        .map_err(|(index, error): (usize, Error)| refused_at(index, error))?;
    while let Some(estimate) = tracker.next() {
        walk.push(&estimate, tracker.warnings());
    }
    walk.finish(tracker.finish(), tracker.path_length(), tracker.warnings(), config.sensor);
    Ok(walk)
}

/// What came of a walk, as arrays.
#[derive(Default)]
struct Walk {
    time_us: Vec<u64>,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    orientation: Vec<[f64; 4]>,
    stance: Vec<bool>,
    strides: Vec<Stride<f64>>,
    stride_sigma: Vec<[f64; 3]>,
    start_sigma: [f64; 3],
    health: Vec<u8>,
    doubts: Health,
    path_length: f64,
    /// At which the heading drifted, rad/s, as a magnetometer showed it.
    heading_rate: Option<f64>,
}

impl Walk {
    fn with_room_for(count: usize) -> Self {
        Self {
            time_us: Vec::with_capacity(count),
            position: Vec::with_capacity(count),
            velocity: Vec::with_capacity(count),
            orientation: Vec::with_capacity(count),
            stance: Vec::with_capacity(count),
            health: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    fn push<T: Scalar>(&mut self, estimate: &Estimate<T>, warnings: Warnings) {
        self.time_us.push(estimate.time_us);
        self.position.push(doubles(&estimate.position));
        self.velocity.push(doubles(&estimate.velocity));
        self.orientation.push(estimate.orientation.quaternion().map(T::to_f64));
        self.stance.push(estimate.stance);
        self.strides.extend(estimate.stride.as_ref().map(stride_of));
        // From here on the walk is no better than its warnings say; that it began without a standstill is told at
        // the end, when none came.
        let state = Warnings { never_still: false, ..warnings }.health().state();
        let before = self.health.last().copied().unwrap_or_default();
        self.health.push(code(state).max(before));
    }

    fn finish<T: Scalar>(
        &mut self,
        last: Option<Stride<T>>,
        path_length: T,
        warnings: Warnings,
        sensor: SensorClass,
    ) {
        self.strides.extend(last.as_ref().map(stride_of));
        let mut uncertainty = PathUncertainty::<f64>::new(sensor);
        self.start_sigma = doubles(&uncertainty.standard_deviation());
        for stride in &self.strides {
            uncertainty.add(stride);
            self.stride_sigma.push(doubles(&uncertainty.standard_deviation()));
        }
        self.path_length = path_length.to_f64();
        self.doubts = warnings.health();
        if self.doubts.has(Reason::NotObservable) {
            let least = code(Reason::NotObservable.state()).max(code(State::Good));
            self.health.iter_mut().for_each(|health| *health = least.max(*health));
        }
    }

    /// Standard deviations at every sample: those of the stride before.
    fn sigma(&self) -> Vec<[f64; 3]> {
        let mut now = self.start_sigma;
        let mut strides = self.strides.iter().zip(&self.stride_sigma).peekable();
        let at = self.time_us.iter().map(|time_us| {
            while let Some((_, sigma)) = strides.next_if(|(stride, _)| stride.time_us <= *time_us) {
                now = *sigma;
            }
            now
        });
        at.collect()
    }

    fn results(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let strides = &self.strides;
        let of = |number: fn(&Stride<f64>) -> f64| strides.iter().map(number).collect::<Vec<_>>();
        let (t, sigma) = (seconds(&self.time_us), self.sigma());
        let closure = self.position.last().map_or(0.0, |[x, y, _]| x.hypot(*y));
        let strides = Results::new(py)
            .line("t", of(|stride| stride.time_us as f64 / 1e6))?
            .table("position", strides.iter().map(|stride| doubles(&stride.position)).collect())?
            .line("length", of(|stride| stride.length))?
            .line("duration", of(|stride| stride.duration))?
            .line("heading_change", of(|stride| stride.heading_change))?
            .table("sigma", self.stride_sigma)?
            .done();
        Ok(Results::new(py)
            .line("t", t)?
            .table("position", self.position)?
            .table("velocity", self.velocity)?
            .table("orientation", self.orientation)?
            .line("stance", self.stance)?
            .table("sigma", sigma)?
            .line("health", self.health)?
            .with("strides", strides)?
            .with("path_length", self.path_length)?
            .with("closure", closure)?
            .with("heading_rate", self.heading_rate)?
            .with("reasons", reasons(self.doubts))?
            .done())
    }
}

fn seconds(times_us: &[u64]) -> Vec<f64> {
    times_us.iter().map(|time_us| *time_us as f64 / 1e6).collect()
}

fn stride_of<T: Scalar>(stride: &Stride<T>) -> Stride<f64> {
    Stride {
        time_us: stride.time_us,
        position: stride.position.map(T::to_f64),
        length: stride.length.to_f64(),
        duration: stride.duration.to_f64(),
        heading_change: stride.heading_change.to_f64(),
    }
}
