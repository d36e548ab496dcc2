use kestirim_kalman::Innovation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

use super::grid::Grid;
use super::{AugmentedFilter, AugmentedStep, LocalModel, ScheduledTransition};
use crate::Error;

/// An [`AugmentedFilter`] whose model is that of the airspeed it estimates: of G local models at rising airspeeds, the two
/// about the estimate are blended, with weights linear in the airspeed. Below the first and beyond the last of them it is
/// that one alone.
///
/// What is blended are steps over an interval and rows of outputs, so that a sample takes no matrix exponential. That many
/// linear models which overlap make one nonlinear one is the idea of Takagi and Sugeno (*Fuzzy identification of systems
/// and its applications to modeling and control*, IEEE Trans. SMC 15, 1985) and of Murray-Smith and Johansen (*Multiple Model Approaches to
/// Modelling and Control*, 1997). The covariance follows the blended model as if its weights were known.
///
/// Scalar and units of what goes in and comes out are those of the [`AugmentedFilter`]; all of it deviates from the common
/// origin of the [`LocalModel`]s.
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
    /// A filter that starts at the origin, with the standard deviations of the models. Two models of one airspeed count as
    /// one, so that a grid of fewer than G repeats its last.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is beyond what the scalar holds; [`Error::Grid`] if airspeeds fall, or the models have not the
    /// same states, outputs and origin.
    pub fn new(models: &[LocalModel<N, K, P>; G]) -> Result<Self, Error> {
        const { assert!(G > 0, "one model at least is blended") };
        let first = models.first().ok_or(Error::Grid)?;
        let mut filter = AugmentedFilter::new(&first.model)?;
        let grid = Grid::new(models, &mut filter)?;
        grid.prepare(&mut filter, &mut [None; P])?;
        Ok(Self { filter, grid })
    }

    /// The filter as it was at its start.
    pub fn begun_anew(&self) -> Self {
        Self { filter: self.filter.begun_anew(), ..*self }
    }

    /// The same steps, one a local model, converted once.
    pub fn transition(&self, steps: &[AugmentedStep<N>; G]) -> ScheduledTransition<T, N, K, G> {
        self.grid.transition(&self.filter, steps)
    }

    /// The filter with its estimate, uncertainty and units. Its outputs' rows are those of the airspeed at which the last were taken
    /// in.
    pub const fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        &self.filter
    }

    /// Moves on by a step with these inputs δe (rad) and δt, at the airspeed that is estimated before it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
    pub fn predict(
        &mut self,
        transition: &ScheduledTransition<T, N, K, G>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        self.grid.predict(&mut self.filter, transition, input)
    }

    /// Takes in the outputs that were measured while these inputs were applied, at the airspeed that is estimated before, and
    /// answers with what each said beyond what was expected of it, in the outputs' units.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
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

    /// Moves on by a step with the inputs that were held during it, then takes in the outputs that were measured with
    /// those of now.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was before both.
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
