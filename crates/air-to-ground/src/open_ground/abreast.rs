//! Measurements as seen under several suppositions at a time.

use kestirim_scalar::Scalar;

use super::Supposition;
use super::added::added;
use super::lanes::Lanes;
use super::sight::Row;

/// Degrees of freedom of Student's t-distribution, whose tails represent antenna nulls and buildings.
pub(super) const FREEDOM: f64 = 4.0;
/// Scale of the fluctuations of a receiver's floor and of its readings, dB.
pub(super) const WAVERING_DB: f64 = 1.7;

/// Suppositions side by side, each in a lane of its own.
pub(super) struct Abreast<T, const W: usize> {
    /// The lowest number where there is no floor: a signal adds nothing to it but itself.
    floor: Lanes<T, W>,
    /// The largest number where there is no ceiling.
    ceiling: Lanes<T, W>,
    scale: Lanes<T, W>,
    has_floor: bool,
}

/// A measurement as seen under suppositions.
pub(super) struct Seen<T, const W: usize> {
    /// The residual, dB.
    pub(super) error: Lanes<T, W>,
    /// Derivative of the level with respect to the signal: from zero in the floor to one above it.
    pub(super) share: Lanes<T, W>,
    /// The same, by the weight of the residual: that of Student's distribution, and the noise's.
    pub(super) weighted: Lanes<T, W>,
    /// Square of the noise scale, dB².
    variance: Lanes<T, W>,
    /// Square of the residual in units of the variance.
    square: Lanes<T, W>,
}

impl<T: Scalar, const W: usize> Abreast<T, W> {
    #[inline(always)]
    pub(super) fn new(suppositions: &[Supposition<T>; W]) -> Self {
        Self {
            floor: Lanes(suppositions.each_ref().map(|it| it.floor.unwrap_or(T::MIN))),
            ceiling: Lanes(suppositions.each_ref().map(|it| it.ceiling.unwrap_or(T::MAX))),
            scale: Lanes(suppositions.each_ref().map(|it| it.scale)),
            has_floor: suppositions.iter().any(|it| it.floor.is_some()),
        }
    }

    /// The levels that a receiver shows for signals, and their derivatives with respect to the signals: from zero in the
    /// floor to one above it.
    #[inline(always)]
    pub(super) fn received(&self, signal: Lanes<T, W>) -> [Lanes<T, W>; 2] {
        let (mut level, mut share) = (signal, Lanes::all(T::ONE));
        if self.has_floor {
            for lane in 0..W {
                (level.0[lane], share.0[lane]) = added(self.floor.0[lane], signal.0[lane]);
            }
        }
        for lane in 0..W {
            let ceiling = self.ceiling.0[lane];
            let is_saturated = level.0[lane] > ceiling;
            level.0[lane] = if is_saturated { ceiling } else { level.0[lane] };
            share.0[lane] = if is_saturated { T::ZERO } else { share.0[lane] };
        }
        [level, share]
    }

    #[inline(always)]
    pub(super) fn seen<const P: usize>(
        &self,
        row: &Row<T, P>,
        parameters: &[Lanes<T, W>; P],
        used: usize,
        power: T,
    ) -> Seen<T, W> {
        let mut signal = Lanes::all(row.expected);
        for (slope, parameter) in row.slopes.iter().zip(parameters).take(used) {
            signal += *parameter * *slope;
        }
        let [level, share] = self.received(signal);
        let far = T::from_f64(150.0);
        let error = level.map(|level| (row.level - level).clamp(-far, far));
        let scale = share * self.scale;
        let variance = (scale * scale).map(|it| it + T::from_f64(WAVERING_DB * WAVERING_DB));
        let divisor = variance.0.map(T::divisor);
        let by_variance = |mut values: Lanes<T, W>| {
            for (value, divisor) in values.0.iter_mut().zip(divisor) {
                *value = value.divided_by(divisor);
            }
            values
        };
        let square = by_variance(error) * error;
        let freedom = T::from_f64(FREEDOM);
        let weight = square.map(|square| power * (freedom + T::ONE) / (freedom + square));
        let weighted = by_variance(weight) * share;
        Seen { error, share, weighted, variance, square }
    }
}

impl<T: Scalar, const W: usize> Seen<T, W> {
    /// The log-densities up to a constant.
    #[inline(always)]
    pub(super) fn log_density(&self) -> Lanes<T, W> {
        let freedom = T::from_f64(FREEDOM);
        let tail = |square: T| (T::ONE + square / freedom).ln() * (freedom + T::ONE);
        (self.variance.map(T::ln) + self.square.map(tail)).map(|it| -it * T::HALF)
    }
}
