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
    use crate::systems::uav::design::MIDDLE;
    use crate::systems::uav::plant::Plant;
    use crate::systems::uav::scenario::{INTERVAL_S, Inputs, NEAR, START, fly};
    use kestirim_uav_longitudinal::full_state;

    /// Estimates after 1 s and 10 s without noise, computed with 60 digits elsewhere: observer and filter.
    const REFERENCE: [(Inputs, [[[f64; 4]; 2]; 2]); 2] = [
        (
            Inputs::Constant,
            [
                [
                    [
                        -0.159_955_309_351_041_63,
                        0.018_316_707_450_424_307,
                        40.726_919_303_070_52,
                        0.485_937_094_915_663_5,
                    ],
                    [
                        -0.164_063_155_636_359_5,
                        0.020_111_187_314_692_934,
                        36.888_465_881_750_34,
                        0.730_980_652_116_524_6,
                    ],
                ],
                [
                    [
                        -0.143_472_830_373_529_62,
                        0.007_757_479_430_240_206,
                        40.735_189_140_063_2,
                        0.425_172_375_607_661,
                    ],
                    [
                        -0.164_056_702_580_132_05,
                        0.020_108_868_387_172_896,
                        36.888_929_410_807_66,
                        0.730_950_120_170_441_9,
                    ],
                ],
            ],
        ),
        (
            Inputs::Sine,
            [
                [
                    [
                        -0.135_044_700_416_668_66,
                        0.098_768_571_316_836_42,
                        37.453_714_231_153_22,
                        0.517_885_597_182_464_3,
                    ],
                    [
                        0.124_122_170_947_818_66,
                        -0.096_021_404_834_634_28,
                        -38.411_038_208_008_64,
                        0.814_700_387_199_635_2,
                    ],
                ],
                [
                    [
                        -0.118_562_221_439_153_76,
                        0.088_209_343_296_652_24,
                        37.461_984_068_145_995,
                        0.457_120_877_874_462_7,
                    ],
                    [
                        0.124_128_624_004_046_23,
                        -0.096_023_723_762_154_37,
                        -38.410_574_678_951_23,
                        0.814_669_855_253_552_3,
                    ],
                ],
            ],
        ),
    ];

    #[test]
    fn reference_trajectories_are_reproduced() {
        let plant = Plant::P2.discrete(INTERVAL_S);
        let c = full_state();
        let start = SVector::from(NEAR);
        for (inputs, expected) in REFERENCE {
            let kinds = [Kind::Luenberger(MIDDLE), Kind::Matched(Noise::SENSORS)];
            for (kind, expected) in kinds.into_iter().zip(expected) {
                let off = SVector::from(START) - start;
                let mut estimator =
                    Estimator::<f64, 4>::new(&kind, &plant, &c, &start, &off).unwrap();
                let flight = fly(plant, START.into(), inputs, Noise::NONE, stream(0, 0));
                for (sample, now) in flight.take(1001).enumerate() {
                    let place = [100, 1000].iter().position(|&place| place == sample);
                    if let Some(place) = place {
                        let difference = estimator.estimate() - SVector::from(expected[place]);
                        assert!(difference.amax() < 1e-11, "{inputs:?} {kind:?} {difference}");
                    }
                    assert!(estimator.step(&now.u, &now.y));
                }
            }
        }
    }

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
