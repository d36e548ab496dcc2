use crate::{ImuSample, SensorClass};
use kestirim_health::Reason;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Suspicious findings about a stream. A flag that was raised stays raised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
// A named flag for each finding is the most readable interface.
#[allow(clippy::struct_excessive_bools)]
pub struct Warnings {
    /// An axis of the accelerometer repeatedly showed the same large value three times in a row: its range is too
    /// small.
    pub accelerometer_saturated: bool,
    /// An axis of the gyroscope repeatedly showed the same large value three times in a row; or it reached an end of
    /// its range, whatever the noise there, and what it missed is bridged ([`MissedTurn`](crate::MissedTurn)).
    pub gyroscope_saturated: bool,
    /// The accelerometer at rest does not show 9.8 m/s²: its unit is wrong (g?) or it needs calibration.
    pub gravity_implausible: bool,
    /// The angular rates exceed those of any foot, as if °/s were taken for rad/s.
    pub rate_implausible: bool,
    /// Strides repeatedly end with a residual velocity of metres per second: axes are swapped or mirrored between the
    /// two sensors, or a unit is wrong.
    pub axes_inconsistent: bool,
    /// A swing ended with a residual velocity of metres per second: the tilt was lost through missing or wrong samples.
    /// It is levelled again ([`Config::levels`](crate::Config::levels)), but the turn at that moment is unknown.
    pub tilt_lost: bool,
    /// Stride after stride the residual velocity is too large: the gyroscope is clipped, its scale or zero has changed,
    /// it is delayed, or the clock runs wrong.
    ///
    /// Or the foot jumps by a quarter of its strides or more where they end: it shuffles, or climbs a ladder, and is
    /// assumed to stand while it moves.
    pub landings_implausible: bool,
    /// Samples are missing: more than 60 ms at once, or more than 40 ms and three times the preceding step.
    pub gaps: bool,
    /// The stream contained no standstill of half a second: the gyro bias is unknown.
    pub never_still: bool,
    /// The path is longer than the number type can represent (`Q12_20`: 2 km), or the foot farther away or faster: the
    /// numbers saturate there.
    pub out_of_range: bool,
}

impl Warnings {
    /// The reliability of the path in spite of the findings.
    pub fn health(&self) -> kestirim_health::Health {
        let saturated = self.accelerometer_saturated || self.gyroscope_saturated;
        kestirim_health::Health::GOOD
            .with(Reason::Saturated, saturated)
            .with(Reason::Dropout, self.gaps || self.tilt_lost)
            .with(Reason::NotObservable, self.never_still)
            .with(Reason::Units, self.gravity_implausible || self.rate_implausible)
            .with(Reason::Axes, self.axes_inconsistent)
            .with(Reason::Innovations, self.landings_implausible)
            .with(Reason::Range, self.out_of_range)
    }
}

/// Checks of a stream for faults that no filter can correct.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Health<T: Scalar> {
    warnings: Warnings,
    force: Repeats<T>,
    rate: Repeats<T>,
    bad_landings: u8,
    /// The number of strides whose end was moved by a large share of their length, minus the number of others.
    misplaced: u8,
    /// Smoothed residual speeds at the end of a swing: horizontal and vertical (m/s, earth).
    left_over: [T; 2],
    /// The smoothed residual velocity upwards (m/s, earth).
    rising: T,
}

/// The number of consecutive repetitions of each axis's value, and the number of runs of three.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Repeats<T: Scalar> {
    last: SVector<T, 3>,
    counts: [u8; 3],
    threes: u8,
}

impl<T: Scalar> Repeats<T> {
    /// The number of runs beyond chance: a coarse log repeats a value by chance once or twice in a walk; a range that
    /// is too small does so in every stride.
    const CHANCE: u8 = 5;

    /// Processes a value and returns whether an axis stays at the end of its range more often than by chance.
    #[inline(never)] // Few values are large.
    fn update(&mut self, value: &SVector<T, 3>, large: T) -> bool {
        for axis in 0..3 {
            let (new, old) = (value.as_array()[axis], self.last.as_array()[axis]);
            if new != old {
                self.last.as_array_mut()[axis] = new;
                self.counts[axis] = 0;
            } else if new.abs() > large {
                self.counts[axis] = self.counts[axis].saturating_add(1);
                if self.counts[axis] == 2 {
                    self.threes = self.threes.saturating_add(1);
                }
            }
        }
        self.threes > Self::CHANCE
    }
}

impl<T: Scalar> Health<T> {
    /// The largest plausible rate, beyond the widest range of a gyroscope, 2000 °/s (rad/s).
    const LARGEST_RATE: f64 = 45.0;
    /// A residual velocity (m/s) beyond which a stride was not measured by a healthy IMU, if it occurs often.
    const LANDING: f64 = 2.0;
    /// The number of such strides that is a fault.
    const LANDINGS: u8 = 4;
    /// The upper limit on the horizontal residual of one landing (m/s): a stumble is no fault.
    const MOST_SIDEWAYS: f64 = 2.0;
    /// The upper limit on the vertical residual of one landing (m/s).
    const MOST_UPWARDS: f64 = 0.5;
    /// The largest plausible mean of the residual velocity upwards (m/s): a foot lands downwards, and where a stance is found late,
    /// that is what remains. In 26 recorded walks at 200 to 400 Hz the mean of eight is 0.014 at most; a gyroscope that shows 5 % too
    /// little of the swing leaves 0.04 to 0.25.
    const RISING: f64 = 0.035;
    /// The same at lower sample rates, for each second of the interval (m/s²), since the foot is braked between two samples: 0.04 and
    /// 0.10 m/s at 100 and 50 Hz.
    const BRAKED: f64 = 7.0;
    /// The size up to which one landing counts in it, in limits: an odd one is no fault.
    const MOST_RISING: f64 = 4.0;

    /// The share of a stride's length beyond which its landing has displaced the foot. Medians of 43 recorded walks are
    /// 0.12 at most; that of a shuffling foot, which is assumed to stand while it moves, is 0.6.
    const MISPLACED_SHARE: f64 = 0.25;
    /// The excess of strides with such a jump over those without that is a fault: recorded walks reach 4, except for a
    /// foot on a ladder.
    const MISPLACED: u8 = 6;

    pub(crate) fn new() -> Self {
        let nothing = Repeats { last: SVector::zeros(), counts: [0; 3], threes: 0 };
        let warnings = Warnings { never_still: true, ..Warnings::default() };
        Self {
            warnings,
            force: nothing,
            rate: nothing,
            bad_landings: 0,
            misplaced: 0,
            left_over: [T::ZERO; 2],
            rising: T::ZERO,
        }
    }

    pub(crate) fn warnings(&self) -> Warnings {
        self.warnings
    }

    /// Processes a force that may be at the end of a range. (Smaller ones in between are not passed; a range that is
    /// reached three times at the very same value is reached, with a pause or without.)
    #[inline]
    pub(crate) fn large_force(&mut self, force: &SVector<T, 3>) {
        let large = T::from_f64(ImuSample::<T>::LARGE_FORCE);
        self.warnings.accelerometer_saturated |= self.force.update(force, large);
    }

    /// Processes an angular rate that may be at the end of a range.
    #[inline]
    pub(crate) fn large_rate(&mut self, rate: &SVector<T, 3>) {
        let large = T::from_f64(ImuSample::<T>::LARGE_RATE);
        self.warnings.gyroscope_saturated |= self.rate.update(rate, large);
        let limit = T::from_f64(Self::LARGEST_RATE);
        self.warnings.rate_implausible |= rate.as_array().iter().any(|rate| rate.abs() > limit);
    }

    /// Notes that the gyroscope was at an end of its range.
    pub(crate) fn clipped(&mut self) {
        self.warnings.gyroscope_saturated = true;
    }

    /// Notes that the numbers had no room for a swing.
    pub(crate) fn out_of_range(&mut self) {
        self.warnings.out_of_range = true;
    }

    /// Notes that samples are missing.
    pub(crate) fn gap(&mut self) {
        self.warnings.gaps = true;
    }

    /// Processes the gravity that a standstill showed (in units of standard gravity), and whether the gyro bias is known after
    /// it: a person who sways shows none.
    pub(crate) fn standstill(&mut self, gravity: T, knows_bias: bool, sensor: SensorClass) {
        self.warnings.never_still &= !knows_bias;
        // The zero of a bare chip is off by up to 80 mg per axis.
        let tolerance = match sensor {
            SensorClass::Industrial => 0.05,
            SensorClass::Consumer => 0.12,
        };
        self.warnings.gravity_implausible |= (gravity - T::ONE).abs() > T::from_f64(tolerance);
    }

    /// Processes the residual velocity (m/s, earth) at the end of a swing, and the interval between samples there (s); returns whether
    /// it is so large that the tilt must be lost.
    pub(crate) fn landing(
        &mut self,
        velocity: &SVector<T, 3>,
        interval: T,
        sensor: SensorClass,
    ) -> bool {
        let limit = T::from_f64(Self::RISING).max(interval * T::from_f64(Self::BRAKED));
        let most = limit * T::from_f64(Self::MOST_RISING);
        let rising = smoothed(&mut self.rising, velocity.as_array()[2].max(-most).min(most));
        self.warnings.landings_implausible |= rising > limit;
        let [x, y, z] = velocity.as_array().map(T::abs);
        let [sideways, upwards] = sensor.landing::<T>();
        let [horizontal, vertical] = &mut self.left_over;
        let horizontal = smoothed(horizontal, x.max(y).min(T::from_f64(Self::MOST_SIDEWAYS)));
        let vertical = smoothed(vertical, z.min(T::from_f64(Self::MOST_UPWARDS)));
        self.warnings.landings_implausible |= horizontal > sideways || vertical > upwards;
        let limit = T::from_f64(Self::LANDING);
        let is_bad = x.max(y).max(z) > limit;
        if is_bad {
            self.bad_landings = self.bad_landings.saturating_add(1);
        }
        self.warnings.tilt_lost |= is_bad;
        // A clipped gyroscope leaves as much, so this is no sign of wrong axes.
        self.warnings.axes_inconsistent |=
            self.bad_landings >= Self::LANDINGS && !self.warnings.gyroscope_saturated;
        is_bad
    }

    /// Processes a stride of this length whose landing moved the foot by `moved` (m).
    pub(crate) fn stride(&mut self, length: T, moved: T) {
        self.misplaced = if moved > length * T::from_f64(Self::MISPLACED_SHARE) {
            self.misplaced.saturating_add(1)
        } else {
            self.misplaced.saturating_sub(1)
        };
        self.warnings.landings_implausible |= self.misplaced >= Self::MISPLACED;
    }
}

/// Updates an average over eight landings.
#[inline]
fn smoothed<T: Scalar>(average: &mut T, size: T) -> T {
    *average += (size - *average) * T::from_f64(1.0 / 8.0);
    *average
}

#[cfg(test)]
mod tests;
