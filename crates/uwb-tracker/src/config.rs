use crate::Anchor;
use kestirim_adaptive_kalman::Learning;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{Huber, Room};
use nalgebra::SVector;

/// Settings of a tracker: its radio, and what carries the tag.
///
/// Lengths are those of an office, with no more than 6 m from the anchors to their centre on average. Among anchors farther
/// apart a tracker lets the deviations, the variances that may be learnt and the density of the acceleration grow in
/// proportion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config<T> {
    /// Standard deviation of a range to begin with, m.
    pub range_sigma: T,
    /// Learning of each anchor's variance (m²), if any.
    pub learning: Option<Learning<T>>,
    /// Thresholds of the robust weights of ranges, if any.
    pub huber: Option<Huber<T>>,
    /// The NIS above which a range is left out, if any is.
    pub gate: Option<T>,
    /// Power spectral density of the acceleration, m²/s³.
    pub acceleration_density: T,
    /// Time constant with which a velocity decays, s; none: it does not.
    pub decay_time: Option<T>,
    /// Standard deviation of the bias common to all ranges, m, for trackers that estimate it.
    pub common_bias_sigma: T,
    /// Standard deviation of the constant error that each anchor's ranges keep, m. It is considered, not estimated
    /// (Schmidt 1966): the filter takes ranges' errors for noise, which an average makes small, so
    /// [`Health::position_sigma`](crate::Health::position_sigma) adds what these do to the position. Where the tag stands,
    /// each link is given as much again.
    pub bias_sigma: T,
    /// Height of the tag in two dimensions, m.
    pub height: T,
    /// Bounds of the position.
    pub room: Option<Room<T>>,
}

/// From the centre of an office to its anchors, m.
const OFFICE: f64 = 6.0;

/// How much larger the anchors' place is than an office: 1 up to 6 m from their centre to each, on average.
///
/// A radio's excess grows with the distance, and so does what it leaves uncertain: the constants that are lengths are
/// those of an office, and grow with this.
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
    // Of anchors that are refused anyway it may be anything.
    (reach * T::from_f64(1.0 / OFFICE)).clamp(T::ONE, T::from_f64(30.0))
}

/// How the common bias depends on the distance: 1 in an office; and of what a place of this [`size`] is beyond it, in
/// proportion (1/m).
pub(crate) fn bias_shape<T: Scalar>(size: T) -> [T; 2] {
    let constant = size.recip();
    [constant, (T::ONE - constant) * constant * T::from_f64(1.0 / OFFICE)]
}

/// Excess in 10 m by common bias: of an office 6 m wide, both are the same …
const EXCESS_BY_BIAS: f64 = 10.0 / OFFICE;
/// … but there they cannot be told apart, and so hardly any is expected: a share of that.
const LEAST_EXCESS: f64 = 0.1;

/// Standard deviations of what all ranges are too long by, of that in an office, and of by what more in 10 m of distance,
/// which makes what a place of this [`size`] is beyond that, m.
pub(crate) fn common_sigmas<T: Scalar>(bias: T, size: T) -> [T; 2] {
    let beyond = (T::ONE - size.recip()).max(T::from_f64(LEAST_EXCESS));
    [bias, bias * T::from_f64(EXCESS_BY_BIAS) * beyond]
}

impl<T: Scalar> Config<T> {
    /// What a tracker makes of it among these anchors: lengths in proportion to those of an office.
    #[must_use]
    pub fn of_place(self, anchors: &[Anchor<T>]) -> Self {
        self.scaled(size(anchors))
    }

    /// Standard deviations, among these anchors, of what all ranges are too long by, m, and of by what more in 10 m of
    /// distance, m.
    pub fn common_sigmas(&self, anchors: &[Anchor<T>]) -> [T; 2] {
        common_sigmas(self.common_bias_sigma, size(anchors))
    }

    /// The same for anchors of this [`size`].
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

    /// For anchors whose biases are known: a variance may fall to (5 cm)².
    #[inline]
    pub fn calibrated(height: T) -> Self {
        Self::robust(height, 0.05)
    }

    /// For anchors as they come, with biases of a decimetre or two: no variance falls below (10 cm)².
    #[inline]
    pub fn uncalibrated(height: T) -> Self {
        Self::robust(height, 0.1)
    }

    /// The textbook's extended Kalman filter: all ranges have the same variance and are taken in.
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

    /// Constants for real rooms. They are physical, and broad in their effect: the book has the
    /// table of what half and twice of each does to every recording.
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
