//! The paper's adaptive filter, equation by equation, with one epoch of all anchors at a time.

use crate::{Anchor, EpochMethod, EpochSolver, Error, RangeSample};
use kestirim_adaptive_kalman::{Error as Refusal, PublishedAdaptiveKalman};
use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::{Error as NoPosition, Solver, expected_range};
use nalgebra::{SMatrix, SVector};

/// Settings that the paper leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PublishedConfig<T: Scalar, const D: usize> {
    /// The first position, m; if `None`, the filter starts from its first trilateration.
    pub start: Option<SVector<T, D>>,
    /// Height of the tag, m, for a position in two dimensions.
    pub height: T,
    /// Variance of the first position, m²; the first velocity is zero, with zero variance.
    pub position_variance: T,
    /// Process noise variance of each state per step, m² and (m/s)².
    pub process_variance: T,
    /// Initial variance of a range, m².
    pub range_variance: T,
    /// Forgetting factor of eqs 18 and 19; 1 disables adaptation and leaves the plain filter.
    pub forgetting: T,
}

impl<T: Scalar, const D: usize> PublishedConfig<T, D> {
    /// Settings with which biased ranges reproduce the paper's table, if the filter is started at the truth. With
    /// usual settings, eq. 18 makes R indefinite.
    pub fn adaptive(height: T) -> Self {
        Self {
            start: None,
            height,
            position_variance: T::from_f64(1e-4),
            process_variance: T::from_f64(3e-5),
            range_variance: T::from_f64(0.1),
            forgetting: T::from_f64(0.95),
        }
    }

    /// The settings of [`PublishedConfig::adaptive`] without adaptation.
    pub fn plain(height: T) -> Self {
        Self { forgetting: T::ONE, ..Self::adaptive(height) }
    }
}

/// The outcome of an epoch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PublishedOutcome {
    /// The epoch continues, as not every anchor has been heard.
    Incomplete,
    /// The ranges do not determine a first position.
    NoPosition(NoPosition),
    /// The epoch provided the first position.
    Started,
    /// The epoch was used.
    Taken,
    /// A step of the filter was refused, as when eq. 18 has made R indefinite: its ranges are discarded.
    Refused(Refusal),
}

/// The paper's filter with N states in D dimensions for A anchors. **Unsafe for navigation**: see
/// [`PublishedAdaptiveKalman`], and use [`Tracker`](crate::Tracker).
///
/// The states are D coordinates (m) in the room frame and their velocities (m/s): N = 2 D.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PublishedTracker<T: Scalar, const D: usize, const N: usize, const A: usize> {
    config: PublishedConfig<T, D>,
    /// The anchors' ranges, and the solver for the first position.
    ranges: EpochSolver<T, A>,
    /// Whether each anchor was heard in this epoch.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    heard: [bool; A],
    filter: Option<PublishedAdaptiveKalman<T, N, A>>,
    /// Time of the filter's estimate, µs.
    time_us: u64,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::optional"))]
    push: Option<[T; D]>,
}

impl<T: Scalar, const D: usize, const N: usize, const A: usize> PublishedTracker<T, D, N, A> {
    /// Creates a filter for these anchors, before its first position.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(config: PublishedConfig<T, D>, anchors: &[Anchor<T>; A]) -> Result<Self, Error> {
        const { assert!(N == 2 * D, "positions and velocities") };
        let solver = Solver::new(config.height);
        Ok(Self {
            config,
            ranges: EpochSolver::new(EpochMethod::Trilateration, solver, anchors)?,
            heard: [false; A],
            filter: None,
            time_us: 0,
            push: None,
        })
    }

    /// Sets the height of the tag, m, for a position in two dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the height is unchanged.
    pub fn set_height(&mut self, height: T) -> Result<(), Error> {
        self.ranges.set_height(height)
    }

    /// Stores a range for the epoch that [`PublishedTracker::end_epoch`] ends.
    ///
    /// # Errors
    /// Those of [`EpochSolver::range`].
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<(), Error> {
        let heard = self.heard.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        self.ranges.range(sample)?;
        *heard = true;
        Ok(())
    }

    /// Sets the acceleration without gravity in the room frame (m/s²) that drives the predictions from now on (the
    /// paper's eq. 9).
    pub fn push(&mut self, push: Option<[T; D]>) {
        self.push = push;
    }

    /// Ends the epoch at `time_us` (µs since the same epoch as the ranges): when every anchor was heard, the ranges
    /// determine the first position, or update the filter together.
    pub fn end_epoch(&mut self, time_us: u64) -> PublishedOutcome {
        if !self.heard.iter().all(|&heard| heard) {
            return PublishedOutcome::Incomplete;
        }
        self.heard = [false; A];
        let elapsed_us = time_us.saturating_sub(self.time_us);
        if let Some(mut filter) = self.filter {
            self.time_us = time_us;
            let taken = self.step(&mut filter, elapsed_us);
            self.filter = Some(filter);
            return taken.map_or_else(PublishedOutcome::Refused, |()| PublishedOutcome::Taken);
        }
        let position = match self.config.start {
            Some(start) => start,
            None => match self.ranges.position(time_us, None) {
                Ok(position) => position,
                Err(error) => return PublishedOutcome::NoPosition(error),
            },
        };
        match self.begin(&position) {
            Ok(filter) => {
                self.time_us = time_us;
                self.filter = Some(filter);
                PublishedOutcome::Started
            }
            Err(error) => PublishedOutcome::Refused(error),
        }
    }

    /// Position of the tag, m; `None` before the first one.
    pub fn position(&self) -> Option<SVector<T, D>> {
        let estimate = self.estimate()?;
        Some(SVector::from_fn(|axis, _| estimate.mean.as_array()[axis]))
    }

    /// Mean and covariance of all states; `None` before the first position.
    pub fn estimate(&self) -> Option<&Gaussian<T, N>> {
        self.filter.as_ref().map(PublishedAdaptiveKalman::estimate)
    }

    fn begin(&self, position: &SVector<T, D>) -> Result<PublishedAdaptiveKalman<T, N, A>, Refusal> {
        let config = &self.config;
        let mut mean = SVector::<T, N>::zeros();
        let mut variances = [T::ZERO; N];
        for axis in 0..D {
            mean.as_array_mut()[axis] = position.as_array()[axis];
            variances[axis] = config.position_variance;
        }
        PublishedAdaptiveKalman::new(
            Gaussian::new(mean, Covariance::from_variances(&variances)),
            Covariance::from_variances(&[config.process_variance; N]),
            Covariance::from_variances(&[config.range_variance; A]),
            config.forgetting,
            config.forgetting,
        )
    }

    /// Predicts over `elapsed_us` (µs) and updates with the ranges of all anchors; the prediction remains if the
    /// ranges are refused.
    fn step(
        &self,
        filter: &mut PublishedAdaptiveKalman<T, N, A>,
        elapsed_us: u64,
    ) -> Result<(), Refusal> {
        let interval = T::from_micro(elapsed_us.min(i32::MAX as u64) as i32);
        let motion = ConstantVelocity::<T, D>::new(interval, T::ZERO);
        filter.predict(&ConstantVelocity { acceleration: self.push, ..motion })?;
        let mean = filter.estimate().mean.as_array();
        let position = SVector::<T, D>::from_fn(|axis, _| mean[axis]);
        let mut rows = SMatrix::<T, A, N>::zeros();
        let mut innovation = SVector::<T, A>::zeros();
        let innovations = innovation.as_array_mut().iter_mut().enumerate();
        for ((index, innovation), (anchor, range)) in innovations.zip(self.ranges.heard()) {
            let expected = expected_range(&position, self.ranges.height(), &anchor.position);
            *innovation = range.unwrap_or(expected.distance) - expected.distance;
            for axis in 0..D {
                rows.as_columns_mut()[axis][index] = expected.direction[axis];
            }
        }
        filter.update(&rows, &innovation).map(|_| ())
    }
}
