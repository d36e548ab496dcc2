//! Estimators at work, in any scalar.

use std::array::from_fn;

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use kestirim_luenberger::{self as luenberger, Plant, Predictor, PredictorGains};
use kestirim_observer_design::{self as design, Discrete};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

use super::design::Kind;
use super::scenario::Noise;

/// Why an estimator does not exist.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Impossible {
    /// There is no gain.
    #[error(transparent)]
    Design(#[from] design::Error),
    /// The scalar cannot hold it.
    #[error(transparent)]
    Observer(#[from] luenberger::Error),
}

/// An estimator of a plant's state; its estimate is what is expected of a sample before the sample is measured.
#[derive(Debug, Clone)]
pub enum Estimator<T: Scalar, const P: usize> {
    /// With a constant gain: a Luenberger observer or a steady-state Kalman filter.
    Observer(Box<Predictor<T, 4, 2, P>>),
    /// With the gain of a Kalman filter that starts from P₀.
    TimeVarying(Box<TimeVarying<T, P>>),
}

impl<T: Scalar, const P: usize> Estimator<T, P> {
    /// Starts at a state that is `off` from the truth; only a time-varying filter is told.
    ///
    /// # Errors
    /// Why it does not exist.
    pub fn new(
        kind: &Kind,
        plant: &Discrete<4, 2>,
        c: &SMatrix<f64, P, 4>,
        start: &SVector<f64, 4>,
        off: &SVector<f64, 4>,
    ) -> Result<Self, Impossible> {
        if let Kind::TimeVarying(noise) = kind {
            let filter = TimeVarying::new(noise, plant, c, start, off);
            return Ok(Self::TimeVarying(Box::new(filter)));
        }
        let gain = kind.gain(plant, c)?;
        let gains = PredictorGains::new(&Plant { a: plant.a, b: plant.b, c: *c }, &gain);
        Ok(Self::Observer(Box::new(Predictor::new(&gains, &start.map(T::from_f64))?)))
    }

    /// x̂.
    pub fn estimate(&self) -> SVector<f64, 4> {
        match self {
            Self::Observer(observer) => observer.estimate().map(T::to_f64),
            Self::TimeVarying(filter) => filter.estimate(),
        }
    }

    /// Moves on by a sample; whether it could.
    pub fn step(&mut self, input: &SVector<f64, 2>, measured: &SVector<f64, P>) -> bool {
        match self {
            Self::Observer(observer) => {
                observer.step(&input.map(T::from_f64), &measured.map(T::from_f64)).is_ok()
            }
            Self::TimeVarying(filter) => filter.step(input, measured).is_some(),
        }
    }
}

/// Units of the states in which fixed point can hold the smallest and the largest variance of a flight: powers of
/// two, so that floats do not notice.
const UNITS: [f64; 4] = [1.0 / 256.0, 1.0 / 256.0, 0.25, 1.0 / 256.0];

/// A Kalman filter whose gain is computed under way.
#[derive(Debug, Clone)]
pub struct TimeVarying<T: Scalar, const P: usize> {
    filter: Gaussian<T, 4>,
    a: SMatrix<T, 4, 4>,
    b: SMatrix<T, 4, 2>,
    q: Covariance<T, 4>,
    sensors: [Sensor<T>; P],
}

/// A row of C, in units.
#[derive(Debug, Clone, Copy)]
struct Sensor<T> {
    row: SparseRow<T, 4>,
    variance: T,
    /// Of what is measured.
    unit: f64,
}

impl<T: Scalar, const P: usize> TimeVarying<T, P> {
    fn new(
        noise: &Noise,
        plant: &Discrete<4, 2>,
        c: &SMatrix<f64, P, 4>,
        start: &SVector<f64, 4>,
        off: &SVector<f64, 4>,
    ) -> Self {
        let units = SMatrix::from_diagonal(&SVector::from(UNITS));
        let in_units = SMatrix::from_diagonal(&SVector::from(UNITS.map(f64::recip)));
        let q = in_units * noise.process(plant) * in_units;
        let known = (in_units * off).map(|off| T::from_f64(off * off));
        let r = noise.measurement(c);
        let sensor = |output: usize| {
            let seen = c.row(output) * units;
            let unit = seen.iter().fold(0.0, |sum, part| sum + part.abs());
            let entry = |state: usize| (state, T::from_f64(seen[state] / unit));
            Sensor {
                row: SparseRow::new(from_fn(entry)),
                variance: T::from_f64(r[(output, output)] / (unit * unit)),
                unit,
            }
        };
        Self {
            filter: Gaussian::new(
                (in_units * start).map(T::from_f64),
                Covariance::from_variances(&known.data.0[0]),
            ),
            a: (in_units * plant.a * units).map(T::from_f64),
            b: (in_units * plant.b).map(T::from_f64),
            q: Covariance::from_lower_triangle(&q.map(T::from_f64)),
            sensors: from_fn(sensor),
        }
    }

    fn estimate(&self) -> SVector<f64, 4> {
        SVector::from_fn(|i, _| self.filter.mean[i].to_f64() * UNITS[i])
    }

    /// All of it or nothing.
    fn step(&mut self, input: &SVector<f64, 2>, measured: &SVector<f64, P>) -> Option<()> {
        let mut next = self.filter;
        for (sensor, measured) in self.sensors.iter().zip(measured) {
            let expected = sensor.row.dot(&next.mean)?;
            let innovation = T::from_f64(measured / sensor.unit) - expected;
            next.update(&sensor.row, innovation, sensor.variance).ok()?;
        }
        next.predict(&self.a, &self.q).ok()?;
        let input = input.map(T::from_f64);
        for (row, mean) in next.mean.iter_mut().enumerate() {
            *mean += T::dot(&[self.b[(row, 0)], self.b[(row, 1)]], &input.data.0[0]);
        }
        self.filter = next;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::stream;
    use crate::systems::uav::plant::Plant;
    use crate::systems::uav::scenario::{INTERVAL_S, Inputs, START, fly};

    #[test]
    fn a_time_varying_filter_settles_at_the_steady_one() {
        let plant = Plant::P3.discrete(INTERVAL_S);
        let c = kestirim_uav_longitudinal::rate_airspeed_and_pitch();
        let (start, off) = (SVector::from(START), SVector::from([0.1, 0.1, 5.0, 0.1]));
        let new = |kind: Kind| Estimator::<f64, 3>::new(&kind, &plant, &c, &start, &off).unwrap();
        let mut varying = new(Kind::TimeVarying(Noise::SENSORS));
        let mut steady = new(Kind::Matched(Noise::SENSORS));
        let flight = fly(plant, START.into(), Inputs::Sine, Noise::SENSORS, stream(1, 0));
        for sample in flight.take(8000) {
            varying.step(&sample.u, &(c * sample.y));
            steady.step(&sample.u, &(c * sample.y));
        }
        assert!((varying.estimate() - steady.estimate()).amax() < 1e-8);
    }
}
