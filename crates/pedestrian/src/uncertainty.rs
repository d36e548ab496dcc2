use crate::{SensorClass, Stride};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The standard deviation of the position to which a tracker's strides lead.
///
/// It is separate from the tracker, and costs nothing unless used. Three things make a walked path wrong, each by a
/// constant of the sensor's class, fitted to walks with known truth ([the
/// book](https://github.com/kestirim/kestirim/blob/main/docs/src/reliability.md) has the table):
/// - a rate b at which the heading drifts: the error is b·Σ tₖ·J·Δpₖ, with J a quarter turn;
/// - a scale s of all strides: s times the distance from the start; half of the relative error of gravity at rest adds
///   to it, since that may be the accelerometer's scale or its zero;
/// - an independent error of each stride, of the footprint and of the height, and for the height one that is common to
///   all.
///
/// The unseen parts of a stride and its turns beyond the gyroscope's range are added: an uncertain heading from then
/// on, and the way itself. The heading at the start defines the frame, so it has no error. Other faults of the sensor
/// are not included: see [`Warnings`](crate::Warnings).
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
pub struct PathUncertainty<T: Scalar> {
    sensor: SensorClass,
    /// The position at the end of the last stride (m, earth).
    position: SVector<T, 3>,
    /// The standard deviation of the heading (rad).
    heading: T,
    /// The standard deviation of the unseen way (m, each axis).
    unseen: T,
    /// The displacement of the position by one standard deviation of the heading's rate (m, earth: x, y).
    turned: SVector<T, 2>,
    /// The standard deviation of the scale of all strides.
    scale: T,
    /// The number of strides: of type `T`, since a conversion would link double precision.
    strides: T,
}

impl<T: Scalar> PathUncertainty<T> {
    /// The standard deviation of a footprint in the plane, each axis (m).
    pub const FOOTPRINT: f64 = 0.028;
    /// The standard deviation of the height gained in a stride (m).
    pub const HEIGHT: f64 = 0.047;
    /// The standard deviation of the speed while the foot's motion is unknown, each axis (m/s).
    pub const UNSEEN_SPEED: f64 = 1.5;
    /// The standard deviation of the rate at which the heading is lost while the foot's motion is unknown (rad/s).
    pub const UNSEEN_RATE: f64 = 1.5;
    /// The standard deviation of the heading after a bridged turn beyond the gyroscope's range, as a share of the turn.
    pub const BRIDGED_SHARE: f64 = 0.02;
    /// The share of the error of gravity at rest that is attributed to the scale of all strides; the rest is a zero.
    pub const SCALE_SHARE: f64 = 0.5;
    /// The standard deviation of an arbitrary heading (rad).
    pub const LOST_HEADING: f64 = 1.8;

    /// The uncertainty at the start of a walk: only the exact position of the standing foot is uncertain.
    pub fn new(sensor: SensorClass) -> Self {
        let (position, turned) = (SVector::zeros(), SVector::zeros());
        let zero = T::ZERO;
        Self {
            sensor,
            position,
            heading: zero,
            unseen: zero,
            turned,
            scale: Self::scale(sensor, zero),
            strides: zero,
        }
    }

    /// The standard deviation of the scale of all strides for a relative error of gravity at rest
    /// ([`Stride::gravity_off`]).
    #[inline] // So that the constants fold: without that, double precision is linked.
    pub fn scale(sensor: SensorClass, gravity_off: T) -> T {
        sensor.stride_scale::<T>().hypot(gravity_off * T::from_f64(Self::SCALE_SHARE))
    }

    /// Adds the next stride.
    pub fn add(&mut self, stride: &Stride<T>) {
        let [dx, dy, _] = *(stride.position - self.position).as_array();
        let lost = T::from_f64(Self::LOST_HEADING);
        let unseen = stride.unseen * T::from_f64(Self::UNSEEN_RATE);
        let bridged = stride.bridged * T::from_f64(Self::BRIDGED_SHARE);
        let drifted = self.sensor.heading_rate::<T>() * stride.duration;
        self.heading = (self.heading + drifted + unseen + bridged).min(lost);
        self.unseen = self.unseen.hypot(stride.unseen * T::from_f64(Self::UNSEEN_SPEED));
        self.turned += SVector::from([-dy * self.heading, dx * self.heading]);
        self.position = stride.position;
        self.scale = Self::scale(self.sensor, stride.gravity_off);
        self.strides += T::ONE;
    }

    /// The standard deviations of x, y and z (m, earth), after the last stride and until the next.
    pub fn standard_deviation(&self) -> SVector<T, 3> {
        // The root of a sum is taken by `hypot`: the squares of hundreds of metres exceed a fixed-point number's range.
        let steps = (self.strides + T::ONE).sqrt();
        let (own, height) = (T::from_f64(Self::FOOTPRINT), T::from_f64(Self::HEIGHT));
        let ([x, y, _], [along, across]) = (*self.position.as_array(), *self.turned.as_array());
        let own = (own * steps).hypot(self.unseen);
        let of_axis = |position: T, turned: T| (position * self.scale).hypot(turned).hypot(own);
        let drifted = (self.strides * self.sensor.height_drift::<T>()).hypot(self.unseen);
        SVector::from([of_axis(x, along), of_axis(y, across), (height * steps).hypot(drifted)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_scalar::Q12_20;

    fn straight<T: Scalar>(strides: u32) -> SVector<f64, 3> {
        let mut uncertainty = PathUncertainty::<T>::new(SensorClass::Industrial);
        for k in 1..=strides {
            let position = SVector::from([T::from_f64(f64::from(k)), T::ZERO, T::ZERO]);
            let (length, duration) = (T::ONE, T::ONE);
            uncertainty.add(&Stride {
                time_us: u64::from(k) * 1_000_000,
                position,
                length,
                duration,
                heading_change: T::ZERO,
                unseen: T::ZERO,
                bridged: T::ZERO,
                gravity_off: T::ZERO,
            });
        }
        uncertainty.standard_deviation().map(T::to_f64)
    }

    #[test]
    fn a_straight_path_goes_astray_to_the_side() {
        let [x, y, z] = *straight::<f64>(100).as_array();
        // The sum of k seconds of drift over k metres: half of 100 · 101 strides.
        assert!((y - (0.00048_f64 * 5050.0).hypot(0.028 * 101_f64.sqrt())).abs() < 1e-9, "{y} m");
        assert!((x - (0.005_f64 * 100.0).hypot(0.028 * 101_f64.sqrt())).abs() < 1e-9, "{x} m");
        assert!((z - (0.047 * 101_f64.sqrt()).hypot(0.012 * 100.0)).abs() < 1e-9, "{z} m");
    }

    #[test]
    fn round_a_corner_each_stride_goes_astray_by_the_heading_of_its_time() {
        let mut uncertainty = PathUncertainty::<f64>::new(SensorClass::Consumer);
        let (mut position, mut astray) = ([0.0, 0.0], [0.0, 0.0]);
        for k in 1..=100_u32 {
            // Fifty strides of 1.5 s ahead, and fifty to the left.
            let axis = usize::from(k > 50);
            position[axis] += 0.5;
            astray[1 - axis] += 0.5 * 0.002 * 1.5 * f64::from(k);
            uncertainty.add(&Stride {
                time_us: 0,
                position: SVector::from([position[0], position[1], 0.0]),
                length: 0.5,
                duration: 1.5,
                heading_change: 0.0,
                unseen: 0.0,
                bridged: 0.0,
                gravity_off: 0.0,
            });
        }
        let found = uncertainty.standard_deviation();
        for axis in 0..2 {
            let expected = astray[axis].hypot(0.01 * position[axis]).hypot(0.028 * 101_f64.sqrt());
            assert!((found[axis] - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn what_was_not_seen_moves_all_that_follows() {
        let stride = |metres: f64, unseen: f64, bridged: f64| Stride {
            time_us: 0,
            position: SVector::from([metres, 0.0, 0.0]),
            length: 1.0,
            duration: 1.0,
            heading_change: 0.0,
            unseen,
            bridged,
            gravity_off: 0.0,
        };
        let after = |unseen: f64, bridged: f64| {
            let mut uncertainty = PathUncertainty::<f64>::new(SensorClass::Industrial);
            uncertainty.add(&stride(1.0, unseen, bridged));
            uncertainty.add(&stride(21.0, 0.0, 0.0));
            uncertainty.standard_deviation()
        };
        let [clean, gap, clipped] = [after(0.0, 0.0), after(0.2, 0.0), after(0.0, 3.0)];
        // 0.3 m each axis, and a heading of 0.3 rad over 20 m (and the metre of the stride itself) to the side.
        assert!(gap[0] > 0.3 && gap[0] < clean[0] + 0.3 && gap[2] > clean[2] + 0.2, "{gap}");
        assert!((gap[1] - (0.3_f64).hypot(0.3 * 21.0)).abs() < 0.05, "{gap}");
        assert!((clipped[1] - 0.06 * 21.0).abs() < 0.05 && clipped[0] == clean[0], "{clipped}");
        let lost = after(1000.0, 0.0);
        assert!((lost[1] - (1500.0_f64).hypot(1.8 * 21.0)).abs() < 0.1, "{lost}");
    }

    #[test]
    fn a_scale_that_gravity_shows_counts_by_half() {
        let mut uncertainty = PathUncertainty::<f64>::new(SensorClass::Industrial);
        uncertainty.add(&Stride {
            time_us: 0,
            position: SVector::from([100.0, 0.0, 0.0]),
            length: 100.0,
            duration: 1.0,
            heading_change: 0.0,
            unseen: 0.0,
            bridged: 0.0,
            gravity_off: 0.04,
        });
        let [x, ..] = *uncertainty.standard_deviation().as_array();
        assert!((x - (0.5_f64).hypot(2.0).hypot(0.028 * 2_f64.sqrt())).abs() < 1e-9, "{x} m");
    }

    #[test]
    fn every_number_says_the_same() {
        let double = straight::<f64>(500);
        for other in [straight::<f32>(500), straight::<Q12_20>(500)] {
            for (other, double) in other.iter().zip(double.iter()) {
                assert!((other / double - 1.0).abs() < 0.01, "{other} or {double} m");
            }
        }
    }
}
