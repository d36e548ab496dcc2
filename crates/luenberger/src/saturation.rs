use crate::Error;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The limits of M actuators, in the units of the inputs.
///
/// An observer that is given a command which the actuators apply only in part errs by B times the difference in each
/// step, and a disturbance observer learns a disturbance that does not exist. Pass it what was applied:
/// `observer.step(&limits.applied(&command), &measured)`.
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
pub struct Saturation<T: Scalar, const M: usize> {
    low: SVector<T, M>,
    high: SVector<T, M>,
}

impl<T: Scalar, const M: usize> Saturation<T, M> {
    /// Limits of each input; use [`Scalar::MIN`] and [`Scalar::MAX`] for an input without limits.
    ///
    /// # Errors
    /// [`Error::WrongLimits`].
    pub fn new(low: &SVector<T, M>, high: &SVector<T, M>) -> Result<Self, Error> {
        let (lows, highs) = (low.as_array(), high.as_array());
        if lows.iter().zip(highs).all(|(low, high)| low <= high) {
            Ok(Self { low: *low, high: *high })
        } else {
            Err(Error::WrongLimits)
        }
    }

    /// The command as limited by the actuators; NaN stays NaN, so that the observer refuses it.
    #[inline]
    pub fn applied(&self, command: &SVector<T, M>) -> SVector<T, M> {
        let mut applied = *command;
        let limits = self.low.as_array().iter().zip(self.high.as_array());
        for (input, (&low, &high)) in applied.as_array_mut().iter_mut().zip(limits) {
            *input = input.clamp(low, high);
        }
        applied
    }
}
