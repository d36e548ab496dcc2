use crate::descent::{Care, Descent, Noise, Step};
use crate::{Error, Room, Search};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

/// A range measured from a known position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Observation<T: Scalar> {
    /// Position of the anchor in the room, m.
    pub anchor: SVector<T, 3>,
    /// The measured distance, m.
    pub range: T,
    /// Variance of the range, m².
    pub variance: T,
}

/// Huber's thresholds (1964), in standard deviations, beyond which a residual is down-weighted, one for each sign.
///
/// An obstacle can only lengthen a range: ranges that are too long are doubted sooner than ranges that are too
/// short.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Huber<T> {
    /// Threshold of positive residuals: the range is too long.
    pub long: T,
    /// Threshold of negative residuals: the range is too short.
    pub short: T,
}

impl<T: Scalar> Huber<T> {
    /// The threshold that applies to a residual of this sign.
    #[inline]
    pub fn threshold(&self, residual: T) -> T {
        if residual > T::ZERO { self.long } else { self.short }
    }
}

/// A position from simultaneous ranges.
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
    /// Weighted sum of squared residuals (Huber's cost beyond the threshold): on average, the number of ranges in
    /// excess of the unknowns.
    pub cost: T,
    /// Whether another position explains the ranges nearly as well: with three anchors, or with nearly collinear
    /// ones.
    pub ambiguous: bool,
}

/// Weighted nonlinear least squares over ranges: Gauss-Newton iterations from several starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solver<T> {
    /// The tag's known height if the position has two dimensions, m.
    pub height: T,
    /// Bounds of the position, if any.
    pub room: Option<Room<T>>,
    /// Prior standard deviation of a bias common to all ranges, m; it is estimated if there are enough ranges.
    pub common_bias: Option<T>,
    /// Thresholds of the robust weights, if any.
    pub huber: Option<Huber<T>>,
}

impl<T: Scalar> Solver<T> {
    /// A plain solver for a tag at `height` (m): no room, no common bias, no robust weights.
    pub const fn new(height: T) -> Self {
        Self { height, room: None, common_bias: None, huber: None }
    }

    /// The best-fitting position, inside the room if one is set; where others fit alike, the one that the iterations from `start`
    /// (m) reach, if it is given. [`Search`] finds one a few steps at a time.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`], [`Error::NotFinite`] or [`Error::NotPositive`] for invalid observations;
    /// [`Error::DegenerateGeometry`] or [`Error::NotConverged`] if no start leads to a minimum.
    pub fn solve<const D: usize>(
        &self,
        observations: &[Observation<T>],
        start: Option<SVector<T, D>>,
    ) -> Result<Fix<T, D>, Error> {
        let mut search = Search::exact(start);
        search.advance(self, observations, usize::MAX)?.copied().ok_or(Error::NotConverged)
    }

    /// The minimum that the iterations from one start reach, with weights relative to the variance `scale` (m²).
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

/// The smallest variance, to which all weights are relative, after a check of the observations.
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
