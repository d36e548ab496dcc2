use crate::{Estimate, ImuSample};
use kestirim_attitude::Orientation;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Estimates the rate at which a walk's heading drifts, from a magnetometer on the same foot, where it stands twice at
/// a place.
///
/// Indoors the field's direction differs by tens of degrees from one stride to the next, so a compass gives no heading
/// there. But where a foot returns to a place where it has stood, the field is the same again, whatever iron distorts
/// it: the difference between the two stands is the error of the heading. Stands are compared
/// - at the same place, as far as the path shows,
/// - with the sensor in the same attitude, so that its own iron, hard and soft, is the same in both,
/// - and with the same strength and dip of the field: otherwise the place is another.
///
/// A heading error no larger than the usual difference between two stands at the same place is ignored. To correct a
/// recorded path, turn each step of it back by [`MagneticHeading::rate`] times the time since the start.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MagneticHeading<T: Scalar> {
    stands: [Option<Stand<T>>; CAPACITY],
    now: Option<Stand<T>>,
    /// The sum Σ Δt² over all pairs (in units of ten minutes, squared).
    times: T,
    /// The sum Σ Δt·Δψ over all pairs (rad times ten minutes).
    turned: T,
}

/// The number of stands that are remembered.
const CAPACITY: usize = 8;

/// A stand of the foot.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Stand<T: Scalar> {
    begun_us: u64,
    ended_us: u64,
    /// The position (m, earth).
    position: SVector<T, 3>,
    /// The direction of up in the sensor's axes.
    up: SVector<T, 3>,
    /// The mean field in the sensor's axes.
    body: SVector<T, 3>,
    /// The mean field in the earth's axes.
    earth: SVector<T, 3>,
    /// The mean specific force (m/s², earth), which points up whatever tilt the tracker has.
    force: SVector<T, 3>,
    /// The number of field samples in the mean.
    count: u16,
}

impl<T: Scalar> Stand<T> {
    /// The shortest stand (µs): a stance in walking is shorter.
    const SHORTEST_US: u64 = 1_000_000;
    /// The largest relative difference of the field's strength.
    const STRENGTH: f64 = 0.02;
    /// The largest difference of the horizontal share of the field, 2° of dip.
    const DIP: f64 = 0.03;
    /// The smallest cosine between the attitudes, 20°.
    const ATTITUDE: f64 = 0.94;
    /// The smallest horizontal share of a field that gives a heading.
    const HORIZONTAL: f64 = 0.1;

    /// The stand with its field levelled by the force: at 70° of dip a tilt turns the field by three times itself.
    fn levelled(mut self) -> Option<Self> {
        self.earth = Orientation::from_specific_force(&self.force)?.to_earth(&self.earth);
        Some(self)
    }

    fn horizontal(&self) -> T {
        let [x, y, _] = *self.earth.as_array();
        x.hypot(y)
    }

    fn strength(&self) -> T {
        self.horizontal().hypot(self.earth.as_array()[2])
    }

    /// The heading error since another stand, if both are at the same place (rad).
    fn turned_since(&self, other: &Self, deviation: T) -> Option<T> {
        let ([x, y, _], [ox, oy, _]) = (*self.position.as_array(), *other.position.as_array());
        let [strength, before] = [self.strength(), other.strength()];
        let [share, share_before] = [self.horizontal() / strength, other.horizontal() / before];
        let cosine = |a: &SVector<T, 3>, b: &SVector<T, 3>| T::dot(a.as_array(), b.as_array());
        let attitude = T::from_f64(Self::ATTITUDE);
        let is_same = (x - ox).hypot(y - oy) < deviation * T::from_f64(3.0)
            && (strength - before).abs() < before * T::from_f64(Self::STRENGTH)
            && (share - share_before).abs() < T::from_f64(Self::DIP)
            && share > T::from_f64(Self::HORIZONTAL)
            && cosine(&self.up, &other.up) > attitude
            && cosine(&self.body, &other.body) > attitude * strength * before;
        let ([mx, my, _], [ox, oy, _]) = (*self.earth.as_array(), *other.earth.as_array());
        is_same.then(|| (ox * my - oy * mx).atan2(ox * mx + oy * my))
    }
}

impl<T: Scalar> Default for MagneticHeading<T> {
    fn default() -> Self {
        Self { stands: [None; CAPACITY], now: None, times: T::ZERO, turned: T::ZERO }
    }
}

impl<T: Scalar> MagneticHeading<T> {
    /// The standard deviation of the difference between two stands at the same place (rad): half a degree, on recorded
    /// walks.
    const REPEATABILITY: f64 = 0.0087;

    /// Processes a sample and the estimate that was made of it.
    ///
    /// `field` is the field at its time (body, in any unit in which its square is representable) if it was measured,
    /// and `deviation` the standard deviation of the position (m, [`PathUncertainty`](crate::PathUncertainty)).
    pub fn update(
        &mut self,
        sample: &ImuSample<T>,
        estimate: &Estimate<T>,
        field: Option<&SVector<T, 3>>,
        deviation: T,
    ) {
        if !estimate.stance {
            self.finish(deviation);
            return;
        }
        let stand = self.now.get_or_insert_with(|| Stand {
            begun_us: estimate.time_us,
            ended_us: estimate.time_us,
            position: estimate.position,
            up: estimate.orientation.up_in_body(),
            body: SVector::zeros(),
            earth: SVector::zeros(),
            force: SVector::zeros(),
            count: 0,
        });
        stand.ended_us = estimate.time_us;
        let is_number =
            |field: &&SVector<T, 3>| field.iter().all(|component| component.is_finite());
        if let Some(field) = field.filter(is_number) {
            stand.count = stand.count.saturating_add(1);
            let share = T::ONE / T::from_micro(i32::from(stand.count.min(2000)) * 1_000_000);
            let earth = estimate.orientation.to_earth(field);
            let force = estimate.orientation.to_earth(&sample.specific_force);
            stand.body += (field - stand.body) * share;
            stand.earth += (earth - stand.earth) * share;
            stand.force += (force - stand.force) * share;
        }
    }

    /// Ends the current stand.
    pub fn finish(&mut self, deviation: T) {
        let Some(stand) = self.now.take().and_then(Stand::levelled) else { return };
        let lasted_us = stand.ended_us.saturating_sub(stand.begun_us);
        if stand.count == 0 || lasted_us < Stand::<T>::SHORTEST_US {
            return;
        }
        for before in self.stands.iter().flatten() {
            if let Some(turned) = stand.turned_since(before, deviation) {
                let time = tens_of_minutes::<T>(stand.begun_us.saturating_sub(before.ended_us));
                let (times, turned) = (self.times + time * time, self.turned + time * turned);
                // In fixed point, what would reach a rail is left out of both sums.
                if times < T::MAX && turned.abs() < T::MAX {
                    (self.times, self.turned) = (times, turned);
                }
            }
        }
        if let Some(free) = self.stands.iter_mut().find(|stand| stand.is_none()) {
            *free = Some(stand);
        }
    }

    /// The rate at which the heading drifts (rad/s, anticlockwise from above), if it is significant. See
    /// [`SensorClass::drifts_by`](crate::SensorClass::drifts_by).
    pub fn rate(&self) -> Option<T> {
        let least = T::from_f64(2.0 * Self::REPEATABILITY) * self.times.sqrt();
        (self.times > T::ZERO && self.turned.abs() > least)
            .then(|| self.turned / self.times * T::from_f64(1.0 / 600.0))
    }
}

/// Converts microseconds to tens of minutes, of which fixed point has room for squares.
fn tens_of_minutes<T: Scalar>(us: u64) -> T {
    T::from_micro((us / 600).min(i32::MAX as u64) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_attitude::Orientation;
    use kestirim_scalar::Q12_20;
    use nalgebra::Vector3;

    /// The second of two stands.
    #[derive(Clone, Copy)]
    struct Second {
        /// The error of the heading (rad).
        error: f64,
        /// The distance from the first stand (m).
        distance: f64,
        field: Vector3<f64>,
        /// The beginning of the second stand (s).
        begin: u64,
        /// The duration of both (hundredths of a second).
        samples: u64,
        /// The rotation of the sensor between the stands (rad).
        turned: f64,
    }

    const FIELD: Vector3<f64> = Vector3::new(0.15, 0.05, -0.45);
    const SAME: Second =
        Second { error: 0.05, distance: 0.3, field: FIELD, begin: 60, samples: 200, turned: 0.0 };

    fn rate<T: Scalar>(second: Second) -> Option<f64> {
        // The sensor's own iron, the same in both.
        let iron = Vector3::new(0.05, -0.02, 0.03);
        let mut heading = MagneticHeading::<T>::default();
        let first =
            Second { error: 0.0, distance: 0.0, field: FIELD, begin: 0, turned: 0.0, ..second };
        let about_up =
            |angle| Orientation::identity().turned_in_earth(&Vector3::new(0.0, 0.0, angle));
        // The sensor's noise has the opposite sign in the second stand.
        for (Second { error, distance, field, begin, samples, turned }, sign) in
            [(first, 1.0), (second, -1.0)]
        {
            for k in 0..samples {
                let noise = if k % 2 == 0 { sign } else { -sign };
                let believed = about_up(error + turned);
                let estimate = Estimate {
                    time_us: begin * 1_000_000 + k * 10_000,
                    position: Vector3::new(4.0 + distance, -3.0, 0.0).map(T::from_f64),
                    velocity: SVector::zeros(),
                    orientation: Orientation::from_quaternion(
                        believed.quaternion().map(T::from_f64),
                    )
                    .expect("an orientation"),
                    stance: true,
                    stride: None,
                };
                let wild = Vector3::new(0.02, -0.03, 0.01) * noise;
                let measured = about_up(turned).to_body(&field) + iron + wild;
                let force = Vector3::new(0.0, 0.0, 9.8) + Vector3::new(0.4, 0.3, 0.2) * noise;
                let sample = ImuSample {
                    time_us: estimate.time_us,
                    specific_force: force.map(T::from_f64),
                    angular_rate: SVector::zeros(),
                };
                let field = measured.map(T::from_f64);
                heading.update(&sample, &estimate, Some(&field), T::from_f64(0.2));
            }
            heading.finish(T::from_f64(0.2));
        }
        heading.rate().map(T::to_f64)
    }

    #[test]
    fn a_foot_that_comes_back_shows_the_drift_of_its_heading() {
        for rate in [rate::<f64>(SAME), rate::<Q12_20>(SAME)] {
            let rate = rate.expect("a rate");
            assert!((rate * 58.0 / 0.05 - 1.0).abs() < 0.05, "{rate}");
        }
        assert!(rate::<f64>(Second { samples: 102, ..SAME }).is_some());
    }

    #[test]
    fn hours_apart_fixed_point_shows_the_same_drift() {
        for begin in [600, 7_000, 20_000, 40_000] {
            let late = Second { begin, error: 0.7, ..SAME };
            let (rate, fixed) = (rate::<f64>(late).expect("a rate"), rate::<Q12_20>(late));
            // Pairs that fixed point has no room for show nothing.
            assert!(fixed.is_none_or(|fixed| (fixed / rate - 1.0).abs() < 0.05), "{begin}");
            assert!(fixed.is_some() || begin > 20_000, "{begin}");
        }
    }

    #[test]
    fn what_may_be_another_place_shows_nothing() {
        let nothing = |second, why| assert_eq!(rate::<f64>(second), None, "{why}");
        nothing(Second { distance: 0.7, ..SAME }, "too far away");
        nothing(Second { field: FIELD * 1.1, ..SAME }, "a stronger field");
        nothing(Second { field: Vector3::new(0.2, 0.05, -0.43), ..SAME }, "another dip");
        nothing(Second { error: 0.01, ..SAME }, "no more than two stands differ by");
        nothing(Second { error: 0.01, begin: 240, ..SAME }, "nor after minutes");
        nothing(Second { turned: 1.6, ..SAME }, "the sensor's own iron is elsewhere");
        nothing(Second { samples: 98, ..SAME }, "a stance of walking");
    }
}
