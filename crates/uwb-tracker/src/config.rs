use crate::Anchor;
use kestirim_adaptive_kalman::Learning;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{Huber, Room};
use nalgebra::SVector;

/// Settings of a tracker, which depend on its radio and on what carries the tag.
///
/// Lengths apply to an office, with a mean distance of at most 6 m from the anchors to their centre. Among anchors
/// farther apart, a tracker scales the standard deviations, the limits of learnt variances and the acceleration
/// density in proportion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config<T> {
    /// Initial standard deviation of a range, m.
    pub range_sigma: T,
    /// Learning of each anchor's variance (m²), if any.
    pub learning: Option<Learning<T>>,
    /// Thresholds of the robust weights of ranges, if any.
    pub huber: Option<Huber<T>>,
    /// NIS above which a range is rejected, if any.
    pub gate: Option<T>,
    /// Power spectral density of the acceleration, m²/s³, for a tag that moves at 1.2 m/s or less.
    pub acceleration_density: T,
    /// Time constant with which a velocity decays, s; `None` for no decay.
    pub decay_time: Option<T>,
    /// Standard deviation of the bias common to all ranges, m, for trackers that estimate it.
    pub common_bias_sigma: T,
    /// Standard deviation of the constant error of each anchor's ranges, m. It is considered, not estimated (Schmidt
    /// 1966): the filter treats range errors as noise, which averages out, so
    /// [`Health::position_sigma`](crate::Health::position_sigma) adds the effect of these constants on the position.
    /// While the tag stands, each link gets as much again.
    pub bias_sigma: T,
    /// Height of the tag, m, for a position in two dimensions.
    pub height: T,
    /// Bounds of the position.
    pub room: Option<Room<T>>,
}

/// Mean distance from the centre of an office to its anchors, m.
pub(crate) const OFFICE: f64 = 6.0;

/// Size of the anchors' area relative to an office: 1 for a mean distance of up to 6 m from the anchors to their
/// centre.
///
/// A radio's excess grows with the distance, and so does its uncertainty: constants that are lengths are given for an
/// office, and are multiplied by this.
pub(crate) fn size<T: Scalar>(anchors: &[Anchor<T>]) -> T {
    let share = T::from_micro(anchors.len().clamp(1, 2000) as i32 * 1_000_000).recip();
    let mut centre = SVector::<T, 3>::zeros();
    for anchor in anchors {
        centre += anchor.position * share;
    }
    let mut reach = T::ZERO;
    for anchor in anchors {
        reach += T::norm((anchor.position - centre).as_array()) * share;
    }
    // Irrelevant for anchors that are refused anyway.
    (reach * T::from_f64(1.0 / OFFICE)).clamp(T::ONE, T::from_f64(30.0))
}

/// The dependence of the common bias on the distance, as a constant and a slope (1/m): 1 in an office, and in an area
/// of a larger [`size`] proportional to the distance for the part beyond an office.
pub(crate) fn bias_shape<T: Scalar>(size: T) -> [T; 2] {
    let constant = size.recip();
    [constant, (T::ONE - constant) * constant * T::from_f64(1.0 / OFFICE)]
}

/// Ratio of the excess in 10 m to the common bias: in an office 6 m wide both are equal.
const EXCESS_BY_BIAS: f64 = 10.0 / OFFICE;
/// Smallest share of the excess that is expected: in an office, excess and common bias cannot be distinguished.
const LEAST_EXCESS: f64 = 0.1;

/// Standard deviations (m) of the common bias, which is `bias` in an office, and of the additional excess in 10 m of
/// distance, which accounts for the part of an area's [`size`] beyond an office.
pub(crate) fn common_sigmas<T: Scalar>(bias: T, size: T) -> [T; 2] {
    let beyond = (T::ONE - size.recip()).max(T::from_f64(LEAST_EXCESS));
    [bias, bias * T::from_f64(EXCESS_BY_BIAS) * beyond]
}

impl<T: Scalar> Config<T> {
    /// The configuration as a tracker scales it for these anchors: lengths in proportion to those of an office.
    #[must_use]
    pub fn of_place(self, anchors: &[Anchor<T>]) -> Self {
        self.scaled(size(anchors))
    }

    /// Standard deviations, among these anchors, of the common bias, m, and of the additional excess in 10 m of
    /// distance, m.
    pub fn common_sigmas(&self, anchors: &[Anchor<T>]) -> [T; 2] {
        common_sigmas(self.common_bias_sigma, size(anchors))
    }

    /// The configuration scaled for an area of this [`size`].
    pub(crate) fn scaled(self, size: T) -> Self {
        Self {
            range_sigma: self.range_sigma * size,
            learning: self.learning.map(|learning| learning.raised(size)),
            common_bias_sigma: self.common_bias_sigma * size,
            bias_sigma: self.bias_sigma * size,
            acceleration_density: self.acceleration_density * size,
            ..self
        }
    }

    /// For anchors with known biases: learnt variances may fall to (5 cm)².
    #[inline]
    pub fn calibrated(height: T) -> Self {
        Self::robust(height, 0.05)
    }

    /// For uncalibrated anchors, with biases of a decimetre or two: no learnt variance falls below (10 cm)².
    #[inline]
    pub fn uncalibrated(height: T) -> Self {
        Self::robust(height, 0.1)
    }

    /// The textbook's extended Kalman filter: all ranges have the same variance, and none is rejected.
    #[inline]
    pub fn plain(height: T) -> Self {
        Self {
            range_sigma: T::from_f64(0.1),
            learning: None,
            huber: None,
            gate: None,
            acceleration_density: T::from_f64(0.1),
            decay_time: None,
            common_bias_sigma: T::from_f64(0.3),
            bias_sigma: T::ZERO,
            height,
            room: None,
        }
    }

    /// Constants for real rooms. They are physical, and not critical: the book has a table of the effect of half and
    /// twice of each on every recording.
    #[inline(always)] // So that the constants fold.
    fn robust(height: T, least_sigma: f64) -> Self {
        let number = T::from_f64;
        // An anchor's variance averages over a hundred ranges. Behind a person it is metres.
        let learning = Learning::new(number(0.99), number(least_sigma * least_sigma), number(9.0));
        Self {
            learning: learning.ok(),
            huber: Some(Huber { long: T::HALF, short: number(2.5) }),
            gate: Some(number(25.0)),
            decay_time: Some(T::TWO),
            bias_sigma: number(least_sigma),
            ..Self::plain(height)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Anchors on the four sides of an area, at this distance from its centre, which is not the origin.
    fn place(reach: f64) -> [Anchor<f64>; 4] {
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|[x, y]| Anchor {
            position: SVector::from([50.0 + reach * x, -20.0 + reach * y, 2.0]),
            bias: 0.0,
        })
    }

    fn limits(config: &Config<f64>) -> [f64; 2] {
        [0.0, f64::MAX].map(|variance| config.learning.expect("it learns").limited(variance))
    }

    #[test]
    fn in_a_place_twice_as_large_as_an_office_lengths_are_twice_as_large() {
        let usual = Config::uncalibrated(1.0);
        assert_eq!(usual.of_place(&place(5.9)), usual);
        let large = usual.of_place(&place(12.0));
        for (large, usual) in [
            (large.range_sigma, usual.range_sigma),
            (large.common_bias_sigma, usual.common_bias_sigma),
            (large.bias_sigma, usual.bias_sigma),
            (large.acceleration_density, usual.acceleration_density),
            (limits(&large)[0], limits(&usual)[0]),
            (limits(&large)[1], limits(&usual)[1]),
        ] {
            assert!((large / usual - 2.0).abs() < 1e-6, "{large} of {usual}");
        }
        assert_eq!((large.huber, large.gate, large.height), (usual.huber, usual.gate, 1.0));
    }

    #[test]
    fn a_place_has_a_size_whatever_the_anchors() {
        assert_eq!(size::<f64>(&[]), 1.0);
        assert_eq!(size(&place(0.0)), 1.0);
        assert_eq!(size(&place(1e6)), 30.0);
        // One anchor is farther away, which moves the centre by half a metre.
        let mut anchors = place(6.0);
        anchors[0].position[0] += 2.0;
        let reach = (7.5 + 6.5 + 2.0 * 0.5_f64.hypot(6.0)) / 4.0;
        assert!((size(&anchors) - reach / 6.0).abs() < 1e-5, "{}", size(&anchors));
    }

    #[test]
    fn the_common_bias_is_that_of_a_range_from_the_centre_to_the_anchors() {
        for size in [1.0, 2.0, 5.0, 30.0] {
            let [constant, slope] = bias_shape(size);
            assert!((constant + slope * OFFICE * size - 1.0).abs() < 1e-6, "{size}");
            // Near an anchor, the bias is that of an office.
            assert!((constant * size - 1.0).abs() < 1e-6, "{size}");
        }
    }

    #[test]
    fn excess_is_what_a_place_is_beyond_an_office() {
        let config = Config::uncalibrated(1.0);
        // All of it, 30 cm in 6 m, would be 50 cm in 10 m: a tenth of that in an office, half in twice its size.
        for (reach, excess) in [(6.0, 0.05), (12.0, 0.25), (24.0, 0.375)] {
            let [common, found] = config.common_sigmas(&place(reach));
            assert!((common - 0.3).abs() < 1e-6, "{reach} m: {common}");
            assert!((found - excess).abs() < 1e-6, "{reach} m: {found}");
        }
    }

    #[test]
    fn no_range_is_believed_beyond_its_anchors_calibration() {
        for (config, sigma) in [(Config::calibrated(1.0), 0.05), (Config::uncalibrated(1.0), 0.1)] {
            assert!((limits(&config)[0].sqrt() - sigma).abs() < 1e-6, "{config:?}");
            assert!((config.bias_sigma - sigma).abs() < 1e-6, "{config:?}");
        }
    }

    #[test]
    fn the_textbooks_filter_doubts_and_forgets_nothing() {
        let [robust, plain] = [Config::uncalibrated(1.0), Config::plain(1.0)];
        let doubts = |config: &Config<f64>| {
            let (learning, huber) = (config.learning.is_some(), config.huber.is_some());
            [learning, huber, config.gate.is_some(), config.decay_time.is_some()]
        };
        assert_eq!((doubts(&robust), doubts(&plain)), ([true; 4], [false; 4]));
    }
}
