use crate::descent::{Care, Descent, Noise, Step};
use crate::{Error, Room, Search};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

/// A range from a place that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Observation<T: Scalar> {
    /// The anchor's place in the room, m.
    pub anchor: SVector<T, 3>,
    /// The measured distance, m.
    pub range: T,
    /// Variance of the range, m².
    pub variance: T,
}

/// From how many standard deviations on a residual counts less (Huber 1964), for each sign.
///
/// An obstacle can only lengthen a range: what is too long is doubted sooner than what is too short.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Huber<T> {
    /// Threshold of residuals that say "too long".
    pub long: T,
    /// Threshold of residuals that say "too short".
    pub short: T,
}

impl<T: Scalar> Huber<T> {
    /// The threshold of a residual of this sign.
    #[inline]
    pub fn threshold(&self, residual: T) -> T {
        if residual > T::ZERO { self.long } else { self.short }
    }
}

/// A position from ranges taken at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Fix<T: Scalar, const D: usize> {
    /// Position of the tag, m, in the frame of the anchors.
    pub position: SVector<T, D>,
    /// Covariance of the position, m².
    pub covariance: SMatrix<T, D, D>,
    /// Bias common to all ranges, m; 0 unless it was asked for.
    pub common_bias: T,
    /// Variance of the common bias, m².
    pub common_bias_variance: T,
    /// The weighted squares (Huber's beyond his threshold) that are left: as many as there are ranges
    /// beyond the unknowns, on average.
    pub cost: T,
    /// Whether another place explains the ranges nearly as well: three anchors, or nearly a line.
    pub ambiguous: bool,
}

/// Weighted nonlinear least squares over ranges: Gauss and Newton's steps from several starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solver<T> {
    /// The tag's height in two dimensions, m.
    pub height: T,
    /// Bounds of the position.
    pub room: Option<Room<T>>,
    /// The standard deviation that a bias common to all ranges may have, m: it is estimated if there are
    /// ranges enough.
    pub common_bias: Option<T>,
    /// Thresholds of the robust weights, if any.
    pub huber: Option<Huber<T>>,
}

impl<T: Scalar> Solver<T> {
    /// A plain solver for a tag at `height`.
    pub const fn new(height: T) -> Self {
        Self { height, room: None, common_bias: None, huber: None }
    }

    /// The position that fits best, of those in the room if there is one. [`Search`] looks for it a few steps at a time.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`], [`Error::NotFinite`] or [`Error::NotPositive`] for what was given;
    /// [`Error::DegenerateGeometry`] or [`Error::NotConverged`] if no start leads anywhere.
    pub fn solve<const D: usize>(
        &self,
        observations: &[Observation<T>],
        start: Option<SVector<T, D>>,
    ) -> Result<Fix<T, D>, Error> {
        let mut search = Search::exact(start);
        search.advance(self, observations, usize::MAX)?.copied().ok_or(Error::NotConverged)
    }

    /// Minimum that the steps from one start reach, with weights relative to the variance `scale`.
    pub(crate) fn descend<const D: usize>(
        &self,
        observations: &[Observation<T>],
        start: &SVector<T, D>,
        scale: T,
    ) -> Result<Fix<T, D>, Error> {
        let (mut descent, noise) = (Descent::from(*start), Noise::new(scale));
        loop {
            if let Step::Settled(fix) = descent.step(self, observations, &noise, &Care::exact())? {
                return Ok(fix);
            }
        }
    }
}

/// The smallest variance, to which all weights are relative.
pub(crate) fn least_variance<T: Scalar, const D: usize>(
    observations: &[Observation<T>],
) -> Result<T, Error> {
    if observations.len() <= D {
        return Err(Error::TooFewRanges);
    }
    let mut least = T::MAX;
    for observation in observations {
        let numbers = observation.anchor.iter().chain([&observation.range]);
        if !(numbers.copied().all(T::is_finite) && observation.variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        if observation.variance <= T::ZERO {
            return Err(Error::NotPositive);
        }
        least = least.min(observation.variance);
    }
    Ok(least)
}
