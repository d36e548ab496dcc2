use kestirim_kalman::Gaussian;
use kestirim_robust_kalman::{
    AnyFactor, AnyScale, Decision, Error, Igg3, Measurement, NoFactor, Robust, UnitScale,
    WeightFunction,
};

/// The weighting of an epoch's observations: any [`Robust`] update, its parts chosen at run time or as types.
pub trait Weighting {
    /// Updates a predicted estimate with the measurements of an epoch, with a decision about each.
    ///
    /// # Errors
    /// Those of [`Robust::update`]; the estimate is untouched.
    fn update<const N: usize>(
        &self,
        estimate: &mut Gaussian<f64, N>,
        measurements: &[Measurement<'_, f64>],
        decisions: &mut [Decision<f64>],
    ) -> Result<(), Error>;
}

impl<W: WeightFunction<f64>, S: AnyScale<f64>, A: AnyFactor<f64>> Weighting
    for Robust<f64, W, S, A>
{
    fn update<const N: usize>(
        &self,
        estimate: &mut Gaussian<f64, N>,
        measurements: &[Measurement<'_, f64>],
        decisions: &mut [Decision<f64>],
    ) -> Result<(), Error> {
        self.update(estimate, measurements, decisions).map(|_| ())
    }
}

/// IGG III with the configured variances and no adaptive factor, all of them types: the other choices of [`Robust`]
/// take no flash.
pub type Lean = Robust<f64, Igg3<f64>, UnitScale, NoFactor>;
