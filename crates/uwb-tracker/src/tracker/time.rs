//! The time of the estimate, and standstills of the tag.

use super::{LOST_US, Place, Tracker};
use crate::health::{count_heard, heard_lately};
use crate::measurement::{Speed, Standstill};
use crate::mirror::{self, Mirror};
use crate::{Error, OdometrySample, motion};
use kestirim_kalman::Gaussian;
use kestirim_scalar::Scalar;

/// A saved state: estimate, its time, number of anchors heard, end of the doubt and standstill, and mirror.
pub(crate) type Timed<T, const D: usize, const N: usize> =
    (Option<Gaussian<T, N>>, u64, u8, (u64, bool), Option<Mirror<D>>);

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Age beyond which odometry is not used (µs).
    const WHEELS_US: u64 = 500_000;
    /// Mean NIS of ranges above which a standstill is doubted.
    const NIS_OF_MOTION: f64 = 4.0;
    /// Time for which standstills are then ignored, µs.
    const DOUBT_US: u64 = 30_000_000;
    /// Time for which standstills are ignored after the ranges certainly showed motion while the IMU showed none, µs:
    /// this robot moves without shaking.
    const CALM_US: u64 = 300_000_000;
    /// Variance that is then added to each component of the velocity, (m/s)², as at the start.
    const DOUBTED_VARIANCE: f64 = 0.25;
    /// Turn rate above which a robot changes its direction noticeably between two ranges, rad/s.
    const TURNING: f64 = 0.3;

    /// The fields that [`Tracker::advance`] changes.
    #[inline]
    pub(crate) fn timed(&self) -> Timed<T, D, N> {
        let standing = (self.doubted_until_us, self.stands);
        (self.estimate().copied(), self.time_us, self.heard, standing, self.mirror)
    }

    #[inline]
    pub(crate) fn restore(&mut self, before: Timed<T, D, N>) {
        let (estimate, standing);
        (estimate, self.time_us, self.heard, standing, self.mirror) = before;
        (self.doubted_until_us, self.stands) = standing;
        if let Some(estimate) = estimate {
            self.place = Place::Known(estimate);
        }
    }

    /// Predicts the estimate to `time_us`; gives it up if it has become useless.
    #[inline]
    pub(crate) fn advance(&mut self, time_us: u64, push: Option<[T; D]>) -> Result<(), Error> {
        let elapsed = time_us.saturating_sub(self.time_us);
        if elapsed == 0 {
            return Ok(());
        }
        if elapsed > LOST_US {
            self.give_up();
        }
        if self.counters.nis > T::from_f64(Self::NIS_OF_MOTION) {
            self.doubt_standing();
        }
        if let Some(mut estimate) = self.estimate().copied() {
            if time_us < self.doubted_until_us {
                self.go_on_doubting(time_us, &estimate);
            }
            self.stands = self.is_still(time_us);
            let still = self.stands && Standstill::agrees::<T, D, N>(&estimate);
            let interval = T::from_micro(elapsed.min(LOST_US) as i32);
            motion::advance(&mut estimate, &self.config, interval, still, push)?;
            if still {
                Standstill::correct::<T, D, N>(&mut estimate)?;
            } else if let Some(wheels) = self.fresh_wheels(time_us)
                && wheels.turn_rate.abs() < T::from_f64(Self::TURNING)
            {
                Speed::<T, D> { measured: wheels.speed }.correct(&mut estimate)?;
            }
            if self.is_known(&estimate) {
                self.place = Place::Known(estimate);
            } else {
                self.give_up();
            }
        }
        self.time_us = time_us;
        self.heard = self.count_heard(time_us);
        Ok(())
    }

    /// Whether an estimate still says where the tag is.
    #[inline]
    pub(super) fn is_known(&self, estimate: &Gaussian<T, N>) -> bool {
        let most = self.lost_sigma * self.lost_sigma;
        estimate.covariance.variances().iter().take(D).all(|&variance| variance <= most)
    }

    /// Records whether the tag is so near the line through the only anchors heard that it may cross it unnoticed.
    #[inline(never)] // Rare.
    pub(super) fn look_behind(&mut self) {
        let Place::Known(estimate) = &self.place else { return };
        let heard = heard_lately(&self.links, &self.pace, self.time_us);
        let heard = heard.map(|(anchor, link)| (anchor, link.last()));
        self.mirror = mirror::reached(estimate, &self.config, &self.links, heard);
    }

    #[inline]
    pub(super) fn count_heard(&self, time_us: u64) -> u8 {
        count_heard(&self.links, &self.pace, time_us)
    }

    #[inline]
    pub(super) fn fresh_wheels(&self, time_us: u64) -> Option<&OdometrySample<T>> {
        let fresh =
            |wheels: &&OdometrySample<T>| time_us.saturating_sub(wheels.time_us) <= Self::WHEELS_US;
        self.wheels.as_ref().filter(fresh)
    }

    /// Whether the IMU or the wheels indicate a standstill that is not in doubt.
    #[inline]
    pub(super) fn is_still(&self, time_us: u64) -> bool {
        time_us >= self.doubted_until_us && self.is_calm(time_us)
    }

    /// Whether the IMU or the wheels indicate a standstill.
    #[inline]
    fn is_calm(&self, time_us: u64) -> bool {
        let wheels_stand =
            |wheels: &OdometrySample<T>| wheels.speed == T::ZERO && wheels.turn_rate == T::ZERO;
        self.stillness.is_still(time_us) || self.fresh_wheels(time_us).is_some_and(wheels_stand)
    }

    /// Extends the doubt if the IMU shows none of the motion that the ranges certainly show.
    #[inline(never)] // Rare.
    fn go_on_doubting(&mut self, time_us: u64, estimate: &Gaussian<T, N>) {
        if self.stillness.is_still(time_us) && Standstill::is_refuted::<T, D, N>(estimate) {
            self.doubted_until_us = time_us.saturating_add(Self::CALM_US);
        }
    }

    /// Doubts standstills when ranges fit this badly on average while the tag is said to stand: a trolley on a smooth
    /// floor does not shake, and an IMU may have failed.
    #[inline(never)] // Rare.
    pub(super) fn doubt_standing(&mut self) {
        if !self.is_still(self.time_us) {
            return;
        }
        self.doubted_until_us = self.time_us.saturating_add(Self::DOUBT_US);
        if let Place::Known(estimate) = &mut self.place {
            for index in D..2 * D {
                // This fails only if the variance is out of range already, in which case it is large enough.
                let _ = estimate.add_variance_at(index, T::from_f64(Self::DOUBTED_VARIANCE));
            }
        }
    }
}
