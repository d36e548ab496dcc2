use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

use super::grid::Grid;
use super::{AugmentedFilter, AugmentedStep, LocalModel, ScheduledTransition};
use crate::Error;

/// An [`AugmentedFilter`] whose model depends on the estimated airspeed.
///
/// Of G local models at increasing airspeeds, the two around the estimate are interpolated linearly in the airspeed.
/// Below the first and above the last one, that one alone is used.
///
/// The steps over an interval and the output rows are interpolated, so that a sample needs no matrix exponential.
/// Combining overlapping linear models into a nonlinear one is the idea of Takagi and Sugeno (*Fuzzy identification
/// of systems and its applications to modeling and control*, IEEE Trans. SMC 15, 1985) and of Murray-Smith and
/// Johansen (*Multiple Model Approaches to Modelling and Control*, 1997). The covariance follows the interpolated
/// model as if its weights were known.
///
/// Scalar and units of inputs and results are those of the [`AugmentedFilter`]; all of them are deviations from the
/// common origin of the [`LocalModel`]s.
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
pub struct ScheduledFilter<
    T: Scalar,
    const N: usize,
    const K: usize,
    const P: usize,
    const G: usize,
> {
    pub(super) filter: AugmentedFilter<T, N, K, P>,
    pub(super) grid: Grid<T, N, P, G>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize, const G: usize>
    ScheduledFilter<T, N, K, P, G>
{
    /// Creates a filter that starts at the origin, with the initial standard deviations of the models. Models at the
    /// same airspeed count as one: a grid of fewer than G models repeats its last.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is out of range for the scalar; [`Error::Grid`] if airspeeds decrease, or the
    /// models differ in states, outputs or origin.
    pub fn new(models: &[LocalModel<N, K, P>; G]) -> Result<Self, Error> {
        const { assert!(G > 0, "one model at least is blended") };
        let first = models.first().ok_or(Error::Grid)?;
        let mut filter = AugmentedFilter::new(&first.model)?;
        let grid = Grid::new(models, &mut filter)?;
        grid.prepare(&mut filter, &mut [None; P])?;
        Ok(Self { filter, grid })
    }

    /// A copy of the filter, reset to its initial state.
    pub fn begun_anew(&self) -> Self {
        Self { filter: self.filter.begun_anew(), ..*self }
    }

    /// Converts the steps of the local models to the filter's scalar and units.
    pub fn transition(&self, steps: &[AugmentedStep<N>; G]) -> ScheduledTransition<T, N, K, G> {
        self.grid.transition(&self.filter, steps)
    }

    /// The underlying filter with its estimate, uncertainty and units. Its output rows are those at the airspeed of
    /// the last correction.
    pub const fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        &self.filter
    }

    /// Predicts over a step with these inputs δe (rad) and δt, at the airspeed estimated before it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn predict(
        &mut self,
        transition: &ScheduledTransition<T, N, K, G>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        self.grid.predict(&mut self.filter, transition, input)
    }

    /// Processes the outputs measured while these inputs were applied, at the airspeed estimated before, and returns
    /// their innovations, in the outputs' units.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn correct(
        &mut self,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let (mut next, mut measured) = (self.filter, *measured);
        self.grid.prepare(&mut next, &mut measured)?;
        let innovations = next.correct(&measured, input)?;
        self.filter = next;
        Ok(innovations)
    }

    /// Predicts over a step with the inputs held during it, then processes the outputs measured with the present
    /// inputs.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged, including by the prediction.
    pub fn step(
        &mut self,
        transition: &ScheduledTransition<T, N, K, G>,
        held: &SVector<T, 2>,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let (mut next, mut measured) = (self.filter, *measured);
        self.grid.predict(&mut next, transition, held)?;
        self.grid.prepare(&mut next, &mut measured)?;
        let innovations = next.correct(&measured, input)?;
        self.filter = next;
        Ok(innovations)
    }
}
