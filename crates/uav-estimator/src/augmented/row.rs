//! The expected value of an output.

use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

use super::{Output, Reference};
use crate::kalman_filter::{UNITS, power_of_two};

/// Index of V among the states.
pub(super) const AIRSPEED: usize = 2;

/// Linear interpolation: a ← a + share (b − a).
#[inline(always)]
pub(super) fn blend<T: Scalar>(a: &mut [T], b: &[T], share: T) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += (*b - *a) * share;
    }
}

/// The unit of an output inside a filter: a power of two.
pub(super) fn unit_of(output: &Output) -> f64 {
    power_of_two(output.row.iter().zip(UNITS).map(|(part, it)| (part * it).abs()).sum())
}

/// An output's dependence on the states, in the filter's units.
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
pub(super) struct Row<T: Scalar, const N: usize> {
    pub(super) parts: SVector<T, N>,
    pub(super) direct: SVector<T, 2>,
    pub(super) variance: T,
    /// y₀ and 1/V₀ of an output proportional to the dynamic pressure.
    pub(super) pressure: Option<(T, T)>,
}

impl<T: Scalar, const N: usize> Row<T, N> {
    pub(super) const fn new() -> Self {
        let zero = [T::ZERO; N];
        Self {
            parts: SVector::from_array_storage(nalgebra::ArrayStorage([zero])),
            direct: SVector::from_array_storage(nalgebra::ArrayStorage([[T::ZERO; 2]])),
            variance: T::ZERO,
            pressure: None,
        }
    }

    /// Creates the row of an output with these coefficients of the states (in their units), in the output's unit.
    pub(super) fn of(output: &Output, mut parts: [f64; N], unit: f64) -> Self {
        let sigma = output.sigma / unit;
        let mut pressure = None;
        if let Reference::Pressure { steady, airspeed } = output.reference {
            let [_, _, unit_of_airspeed, _] = UNITS;
            let relative = unit_of_airspeed / airspeed;
            if let Some(part) = parts.get_mut(AIRSPEED) {
                *part -= 2.0 * steady * relative;
            }
            pressure = Some((T::from_f64(steady / unit), T::from_f64(relative)));
        }
        Self {
            parts: SVector::from(parts.map(|part| T::from_f64(part / unit))),
            direct: SVector::from(output.direct.map(|part| T::from_f64(part / unit))),
            variance: T::from_f64(sigma * sigma),
            pressure,
        }
    }

    /// Interpolates towards another row; `share` is from 0 to 1.
    #[inline(always)]
    pub(super) fn blend(&mut self, other: &Self, share: T) {
        blend(self.parts.as_array_mut(), other.parts.as_array(), share);
        blend(self.direct.as_array_mut(), other.direct.as_array(), share);
        self.variance += (other.variance - self.variance) * share;
        // Both have the origin's V₀.
        if let (Some((steady, _)), Some((others, _))) = (&mut self.pressure, other.pressure) {
            *steady += (others - *steady) * share;
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let (steady, relative) = self.pressure.unwrap_or((T::ZERO, T::ZERO));
        T::all_finite(self.parts.as_array())
            && T::all_finite(self.direct.as_array())
            && T::all_finite(&[self.variance, steady, relative])
    }

    /// The expected output for these states, and its derivatives with respect to them.
    #[inline(always)]
    pub(super) fn linearised<const K: usize>(
        &self,
        mean: &[T; N],
        input: &SVector<T, 2>,
    ) -> (T, [T; N]) {
        let parts = self.parts.as_array();
        let mut of_the_air = T::accumulator();
        let mut beside = T::accumulator();
        for state in 0..K.min(N) {
            of_the_air = T::mac(of_the_air, parts[state], mean[state]);
        }
        for state in K..N {
            beside = T::mac(beside, parts[state], mean[state]);
        }
        let [direct, throttle] = *self.direct.as_array();
        let [elevator_now, throttle_now] = *input.as_array();
        of_the_air = T::mac(of_the_air, direct, elevator_now);
        let of_the_air = T::finish(T::mac(of_the_air, throttle, throttle_now));
        let beside = T::finish(beside);
        let Some((steady, relative)) = self.pressure else {
            return (of_the_air + beside, *parts);
        };
        let ratio = T::ONE + mean.get(AIRSPEED).copied().unwrap_or(T::ZERO) * relative;
        let square = ratio * ratio;
        let whole = steady + of_the_air;
        let mut derivatives = *parts;
        for part in derivatives.iter_mut().take(K) {
            *part *= square;
        }
        if let Some(part) = derivatives.get_mut(AIRSPEED) {
            *part += T::TWO * ratio * relative * whole;
        }
        (square * whole - steady + beside, derivatives)
    }
}
