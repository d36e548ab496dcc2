//! Positions from simultaneous ranges, without memory: the paper's "unfiltered".

use crate::pace::Pace;
use crate::{Anchor, Error, RangeSample};
use heapless::Vec;
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{Error as NoPosition, Observation, Solver, trilaterate};
use nalgebra::SVector;

/// Method by which simultaneous ranges are converted to a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EpochMethod {
    /// Linear trilateration (the paper's eqs 3–7); only the solver's height is used.
    Trilateration,
    /// Nonlinear least squares, with equal weights.
    LeastSquares,
}

/// Stores the latest range of each of up to A anchors, and computes the position from them alone.
///
/// Positions are in the room frame in which the anchors are given, right-handed with z up, m.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EpochSolver<T: Scalar, const A: usize> {
    method: EpochMethod,
    solver: Solver<T>,
    anchors: Vec<Anchor<T>, A>,
    /// Time of the last range of each anchor (µs), and the range without its bias, m.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    last: [Option<(u64, T)>; A],
    pace: Pace,
}

impl<T: Scalar, const A: usize> EpochSolver<T, A> {
    /// Variance of a range, m², equal for all: it only serves to distinguish consistent ranges from inconsistent ones.
    const VARIANCE: f64 = 0.01;

    /// Creates a solver for these anchors, without any range.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`] or [`Error::NotFinite`].
    pub fn new(
        method: EpochMethod,
        solver: Solver<T>,
        anchors: &[Anchor<T>],
    ) -> Result<Self, Error> {
        for anchor in anchors {
            anchor.check()?;
        }
        let anchors = Vec::from_slice(anchors).map_err(|_| Error::TooManyAnchors)?;
        let pace = Pace::new(anchors.len());
        Ok(Self { method, solver, anchors, last: [None; A], pace })
    }

    /// Height of the tag, m, for a position in two dimensions.
    pub fn height(&self) -> T {
        self.solver.height
    }

    /// Sets the height of the tag, m, for a position in two dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the height is unchanged.
    pub fn set_height(&mut self, height: T) -> Result<(), Error> {
        if !height.is_finite() {
            return Err(Error::NotFinite);
        }
        self.solver.height = height;
        Ok(())
    }

    /// Stores a range as its anchor's latest.
    ///
    /// # Errors
    /// [`Error::NoSuchAnchor`], [`Error::NotFinite`], [`Error::ImplausibleRange`], [`Error::Duplicate`] or
    /// [`Error::OutOfOrder`]; the anchor's last range is unchanged.
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<(), Error> {
        let anchor = self.anchors.get(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let last = self.last.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        sample.check()?;
        match last {
            Some((heard_us, _)) if *heard_us == sample.time_us => Err(Error::Duplicate),
            Some((heard_us, _)) if *heard_us > sample.time_us => Err(Error::OutOfOrder),
            _ => {
                *last = Some((sample.time_us, sample.range - anchor.bias));
                self.pace.hear(sample.time_us);
                Ok(())
            }
        }
    }

    /// The position (m) from the ranges of at most one second before `time_us`, or of two rounds of the anchors if
    /// those take longer. Of two places that fit alike, least squares takes the one near `start`, if it is given.
    ///
    /// # Errors
    /// [`kestirim_uwb_ranging::Error`] if these ranges do not determine a position.
    pub fn position<const D: usize>(
        &self,
        time_us: u64,
        start: Option<SVector<T, D>>,
    ) -> Result<SVector<T, D>, NoPosition> {
        let mut observations = Vec::<Observation<T>, A>::new();
        for (anchor, last) in self.anchors.iter().zip(&self.last) {
            let Some((heard_us, range)) = *last else { continue };
            if time_us.saturating_sub(heard_us) > self.pace.fresh_us() {
                continue;
            }
            let variance = T::from_f64(Self::VARIANCE);
            // There are no more anchors than the capacity.
            let _ = observations.push(Observation { anchor: anchor.position, range, variance });
        }
        match self.method {
            EpochMethod::Trilateration => trilaterate(&observations, self.solver.height),
            EpochMethod::LeastSquares => {
                self.solver.solve(&observations, start).map(|fix| fix.position)
            }
        }
    }

    /// The anchors with the last range of each, without its bias, m.
    pub(crate) fn heard(&self) -> impl Iterator<Item = (&Anchor<T>, Option<T>)> {
        self.anchors.iter().zip(self.last.iter().map(|last| last.map(|(_, range)| range)))
    }
}
