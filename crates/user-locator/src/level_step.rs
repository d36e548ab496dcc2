use kestirim_air_to_ground::Measurement;
use kestirim_health::{Health, Reason};
use kestirim_scalar::Scalar;

/// Least number of measurements on either side of a step.
const FEWEST: usize = 3;
/// A step must have at least one in this many of all measurements on either side.
const PART: usize = 10;
/// Least size of a step, dB: a smaller one may be shadowing. Of eight flights that were examined, none had one of
/// more than 4.4.
const LEAST_DB: f64 = 10.0;
/// The unit of residuals, dB, chosen so that fixed point holds their squares; a power of two, which does not affect
/// the rounding of floating-point numbers.
const UNIT_DB: f64 = 16.0;

/// A step in the levels of a flight: a change of gain, antenna or transmitter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LevelStep<T> {
    /// Index of the first measurement after the step.
    pub at: usize,
    /// Size of the step, dB: more than ten, up or down.
    pub by: T,
}

impl<T: Scalar> LevelStep<T> {
    /// Finds the step that explains most of the measurements' variance, as seen from a transmitter at `place` (m), if
    /// it explains more than half. There must be three measurements and a tenth of all on either side.
    ///
    /// Residuals are relative to free-space loss: a slightly wrong exponent causes a slope, not a step.
    pub fn find(measurements: &[Measurement<T>], place: [T; 2]) -> Option<Self> {
        let number = |count: usize| T::from_binary(count as i32, 0);
        let count = measurements.len();
        let margin = FEWEST.max(count / PART);
        let last = count.checked_sub(margin).filter(|last| *last >= margin)?;
        let first = residual(measurements.first()?, place);
        let residuals = || measurements.iter().map(|it| residual(it, place) - first);
        let mut mean = T::ZERO;
        for residual in residuals() {
            mean += residual;
        }
        mean /= number(count);
        let (mut squares, mut sum) = (T::ZERO, T::ZERO);
        let (mut found, mut most) = (None, T::ZERO);
        for (at, residual) in residuals().enumerate() {
            if (margin..=last).contains(&at) {
                let (before, after) = (number(at), number(count - at));
                // The residuals without their mean sum to zero: by how much the means before and after differ, …
                let by = -sum / after - sum / before;
                // … and the part of the sum of squares that this explains.
                let explained = (by * (before / number(count))) * (by * after);
                if explained > most {
                    (found, most) = (Some((at, by)), explained);
                }
            }
            let residual = residual - mean;
            sum += residual;
            squares += residual * residual;
        }
        let (at, by) = found?;
        let is_step = most > squares * T::HALF && by.abs() > T::from_f64(LEAST_DB / UNIT_DB);
        is_step.then(|| Self { at, by: by * T::from_f64(UNIT_DB) })
    }
}

/// The received level beyond the loss of free space, in units of [`UNIT_DB`].
fn residual<T: Scalar>(measurement: &Measurement<T>, place: [T; 2]) -> T {
    let horizontal = measurement.horizontal_distance(place);
    let distance = T::norm(&[horizontal, measurement.height()]).max(T::ONE);
    let loss = distance.ln() * T::from_f64(20.0 / core::f64::consts::LN_10 / UNIT_DB);
    // A received level is a negative loss.
    loss - measurement.loss() * T::from_f64(1.0 / UNIT_DB)
}

/// Whether a place found from these measurements is reliable: not if their levels show a step.
pub(crate) fn health<T: Scalar>(measurements: &[Measurement<T>], place: [T; 2]) -> Health {
    let is_step = LevelStep::find(measurements, place).is_some();
    Health::GOOD.with(Reason::Innovations, is_step)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use kestirim_scalar::Q16_16;
    use std::vec::Vec;

    /// A flight on a circle around the place, with a little noise and a step of `by` (dB).
    fn flight<T: Scalar>(by: f64) -> Vec<Measurement<T>> {
        let stop = |k: u32| {
            let angle = f64::from(k) * 0.2;
            let place = [300.0 * libm::cos(angle), 50.0 + 200.0 * libm::sin(angle)];
            let distance = libm::hypot(libm::hypot(place[0], place[1]), 40.0);
            let noise = f64::from(k * 7919 % 13) - 6.0;
            let step = if k < 20 { 0.0 } else { by };
            let loss = 20.0 * libm::log10(distance) + noise - step;
            let height = T::from_f64(40.0);
            Measurement::new(place.map(T::from_f64), height, T::from_f64(loss)).expect("finite")
        };
        (0..50).map(stop).collect()
    }

    fn check<T: Scalar>() {
        let here = [T::ZERO; 2];
        assert_eq!(LevelStep::find(&flight::<T>(0.0), here), None);
        assert_eq!(health(&flight::<T>(0.0), here), Health::GOOD);
        for by in [-20.0, 20.0] {
            let flight = flight::<T>(by);
            let step = LevelStep::find(&flight, here).expect("a step");
            assert!(step.at == 20 && (step.by.to_f64() - by).abs() < 2.0, "{step:?}");
            assert_eq!(health(&flight, here), Reason::Innovations.into());
            for few in 0..=5 {
                assert_eq!(LevelStep::find(&flight[..few], here), None);
            }
        }
    }

    #[test]
    fn a_step_is_found_where_it_is() {
        check::<f32>();
        check::<f64>();
        check::<Q16_16>();
    }
}
