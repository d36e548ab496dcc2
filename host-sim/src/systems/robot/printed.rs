//! The paper's adaptive filter, equation by equation, with an epoch of all anchors at a time.

use kestirim_adaptive_kalman::PrintedAdaptiveKalman;
use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian};
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::expected_range;
use nalgebra::{SMatrix, SVector};

use super::each_epoch::EachEpoch;
use super::follow::{Follow, Reception, of_the_plane};
use super::motion::{Inertial, Wheels};
use super::options::Setup;
use crate::Error;

/// What the paper leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Variance of the first position, m².
    pub position: f64,
    /// Variance that each state gains a step.
    pub process: f64,
    /// Variance of a range to begin with, m².
    pub range: f64,
    /// Forgetting factor of eqs 18 and 19; 1 adapts nothing and leaves the plain filter.
    pub forgetting: f64,
}

impl Constants {
    /// With these the paper's table comes out of biased ranges, if the filter is started at the truth. With
    /// everyday ones eq. 18 makes R indefinite.
    pub const ADAPTIVE: Self = Self { position: 1e-4, process: 3e-5, range: 0.1, forgetting: 0.95 };
    /// The same without adaptation.
    pub const PLAIN: Self = Self { forgetting: 1.0, ..Self::ADAPTIVE };
}

/// How the filter begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beginning {
    /// Where; none begins at the first trilateration.
    pub start: Option<[f64; 2]>,
    /// With which constants.
    pub constants: Constants,
}

impl Beginning {
    /// As anyone has to: at the first trilateration.
    pub const HONEST: Self = Self { start: None, constants: Constants::ADAPTIVE };
}

/// The filter of N states in D dimensions for A anchors.
#[derive(Debug)]
pub struct Printed<T: Scalar, const D: usize, const N: usize, const A: usize = 4> {
    anchors: [SVector<T, 3>; A],
    biases: [f64; A],
    ranges: [Option<T>; A],
    height_m: f64,
    filter: Option<(u64, PrintedAdaptiveKalman<T, N, A>)>,
    /// Makes the first position.
    first: EachEpoch<T, D>,
    push: Option<[T; D]>,
    beginning: Beginning,
}

impl<T: Scalar, const D: usize, const N: usize> Printed<T, D, N> {
    /// The filter for as many anchors as there are.
    ///
    /// # Errors
    /// [`Error::Usage`] for fewer than three or more than eight.
    pub fn boxed(setup: &Setup, beginning: Beginning) -> Result<Box<dyn Follow>, Error> {
        macro_rules! first_of {
            ($($count:literal)*) => {
                match setup.anchors.len() {
                    $($count => Ok(Box::new(Printed::<T, D, N, $count>::new(setup, beginning)?)),)*
                    _ => Err(Error::Usage(
                        "the printed filter is built for 3 to 8 anchors".to_owned(),
                    )),
                }
            };
        }
        first_of!(3 4 5 6 7 8)
    }
}

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Printed<T, D, N, A> {
    fn new(setup: &Setup, beginning: Beginning) -> Result<Self, Error> {
        let places = <[[f64; 3]; A]>::try_from(setup.anchors.as_slice())
            .map_err(|_| Error::Usage(format!("expected {A} anchors")))?;
        Ok(Self {
            anchors: places.map(|place| SVector::from(place.map(T::from_f64))),
            biases: std::array::from_fn(|anchor| setup.bias(anchor)),
            ranges: [None; A],
            height_m: setup.height_m,
            filter: None,
            first: EachEpoch::new(setup, true),
            push: None,
            beginning,
        })
    }

    fn started(&self) -> Option<PrintedAdaptiveKalman<T, N, A>> {
        let Beginning { start, constants } = self.beginning;
        let position = start.map_or(self.first.position(), |[x, y]| Some([x, y, self.height_m]))?;
        let mut mean = SVector::<T, N>::zeros();
        let mut variances = [T::ZERO; N];
        for axis in 0..D {
            mean[axis] = T::from_f64(position[axis]);
            variances[axis] = T::from_f64(constants.position);
        }
        let forgetting = T::from_f64(constants.forgetting);
        PrintedAdaptiveKalman::new(
            Gaussian::new(mean, Covariance::from_variances(&variances)),
            Covariance::from_variances(&[T::from_f64(constants.process); N]),
            Covariance::from_variances(&[T::from_f64(constants.range); A]),
            forgetting,
            forgetting,
        )
        .ok()
    }

    /// Predicts and updates; what eq. 18 makes impossible is left out.
    fn step(&self, filter: &mut PrintedAdaptiveKalman<T, N, A>, seconds: T, ranges: [T; A]) {
        let motion = ConstantVelocity::<T, D>::new(seconds, T::ZERO);
        if filter.predict(&ConstantVelocity { acceleration: self.push, ..motion }).is_err() {
            return;
        }
        let mean = filter.estimate().mean;
        let position = SVector::<T, D>::from_fn(|axis, _| mean[axis]);
        let mut rows = SMatrix::<T, A, N>::zeros();
        let mut innovation = SVector::<T, A>::zeros();
        for (index, (anchor, range)) in self.anchors.iter().zip(ranges).enumerate() {
            let expected = expected_range(&position, T::from_f64(self.height_m), anchor);
            innovation[index] = range - expected.distance;
            for axis in 0..D {
                rows[(index, axis)] = expected.direction[axis];
            }
        }
        let _ = filter.update(&rows, &innovation);
    }
}

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Follow for Printed<T, D, N, A> {
    fn set_height(&mut self, height_m: f64) {
        self.height_m = height_m;
        self.first.set_height(height_m);
    }

    fn range(&mut self, time_us: u64, anchor: usize, range_m: f64) -> Reception {
        let (Some(range), Some(bias)) = (self.ranges.get_mut(anchor), self.biases.get(anchor))
        else {
            return Reception::unweighed(false);
        };
        let reception = self.first.range(time_us, anchor, range_m);
        if reception.taken {
            *range = Some(T::from_f64(range_m - bias));
        }
        reception
    }

    fn inertial(&mut self, _: u64, sample: &Inertial) {
        self.push = sample.push.map(|push| std::array::from_fn(|axis| T::from_f64(push[axis])));
    }

    fn wheels(&mut self, _: u64, _: &Wheels) {}

    fn end_epoch(&mut self, time_us: u64) {
        // An epoch is complete when every anchor was heard; until then it goes on.
        if !self.ranges.iter().all(Option::is_some) {
            return;
        }
        let ranges = std::mem::replace(&mut self.ranges, [None; A]).map(Option::unwrap_or_default);
        if let Some((last_us, mut filter)) = self.filter {
            let seconds = T::from_f64(time_us.saturating_sub(last_us) as f64 * 1e-6);
            self.step(&mut filter, seconds, ranges);
            self.filter = Some((time_us, filter));
        } else {
            self.first.end_epoch(time_us);
            self.filter = self.started().map(|filter| (time_us, filter));
        }
    }

    fn position(&self) -> Option<[f64; 3]> {
        let (_, filter) = self.filter.as_ref()?;
        let mean = filter.estimate().mean.map(T::to_f64);
        Some([mean[0], mean[1], if D > 2 { mean[2] } else { self.height_m }])
    }

    fn spread(&self) -> Option<[f64; 3]> {
        self.filter.as_ref().and_then(|(_, filter)| of_the_plane(&filter.estimate().covariance))
    }
}
