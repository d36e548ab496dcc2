use heapless::Vec;
use kestirim_air_to_ground::{Heading, Measurement};
use kestirim_scalar::Scalar;

/// Initial distance within which measurements are merged, m: so close, they see much the same of a transmitter tens
/// of metres away.
const NEAR_M: f64 = 8.0;

/// The measurements of a flight, thinned by place: those taken close together are merged into their mean. None is
/// dropped.
///
/// A drone that hovers or returns measures the same shadowing and the same direction of its antenna again, which is
/// no independent evidence. Places within 8 m are merged; when M places are occupied, this distance is doubled, and
/// so on. 36·M bytes in single precision.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct ByPlace<T, const M: usize> {
    means: Vec<Measurement<T>, M>,
    /// The mean heading at each place.
    headings: Vec<Heading<T>, M>,
    /// The number of measurements merged at each place.
    counts: Vec<u32, M>,
    /// The distance within which places are merged, m.
    near: T,
}

impl<T: Scalar, const M: usize> ByPlace<T, M> {
    /// An empty collection.
    pub fn new() -> Self {
        const { assert!(M >= 2, "places that differ") };
        Self {
            means: Vec::new(),
            headings: Vec::new(),
            counts: Vec::new(),
            near: T::from_f64(NEAR_M),
        }
    }

    /// Adds a measurement with the drone's heading. O(M); O(M²) when places are merged.
    pub fn push(&mut self, measurement: &Measurement<T>, heading: &Heading<T>) {
        // 32 doublings span the whole range of numbers.
        for _ in 0..32 {
            if self.add(measurement, heading, 1) {
                return;
            }
            self.near += self.near;
            self.join();
        }
    }

    /// The mean measurements, in the order in which their places were first visited.
    #[inline]
    pub fn as_slice(&self) -> &[Measurement<T>] {
        &self.means
    }

    /// The mean heading at each place of [`ByPlace::as_slice`].
    #[inline]
    pub fn headings(&self) -> &[Heading<T>] {
        &self.headings
    }

    /// The distance within which places are merged, m.
    #[inline]
    pub fn near(&self) -> T {
        self.near
    }

    /// Merges the mean of `count` measurements into a near place or adds a new one; `false` if there is no room.
    fn add(&mut self, measurement: &Measurement<T>, heading: &Heading<T>, count: u32) -> bool {
        let mut nearest: Option<(usize, T)> = None;
        for (index, mean) in self.means.iter().enumerate() {
            let [x, y] = mean.place();
            let [east, north] = measurement.place();
            let apart = [east - x, north - y, measurement.height() - mean.height()];
            let distance = T::norm(&apart);
            if distance < nearest.map_or(self.near, |(_, least)| least) {
                nearest = Some((index, distance));
            }
        }
        let Some((index, _)) = nearest else {
            return self.means.push(*measurement).is_ok()
                && self.headings.push(*heading).is_ok()
                && self.counts.push(count).is_ok();
        };
        let place = (self.means.get_mut(index), self.headings.get_mut(index));
        if let ((Some(mean), Some(turn)), Some(all)) = (place, self.counts.get_mut(index)) {
            *all = all.saturating_add(count);
            let number = |count: u32| T::from_binary(count.min(1 << 24) as i32, -12);
            let share = number(count) / number(*all);
            *mean = between(mean, measurement, share);
            *turn = turn.mean(heading, share);
        }
        true
    }

    /// Merges places that have become near.
    fn join(&mut self) {
        let (means, counts) = (core::mem::take(&mut self.means), core::mem::take(&mut self.counts));
        let headings = core::mem::take(&mut self.headings);
        for ((mean, heading), count) in means.iter().zip(&headings).zip(&counts) {
            // There was room for all of them before.
            self.add(mean, heading, *count);
        }
    }
}

impl<T: Scalar, const M: usize> Default for ByPlace<T, M> {
    fn default() -> Self {
        Self::new()
    }
}

/// The weighted mean of two measurements; `share` is the weight of the second.
fn between<T: Scalar>(first: &Measurement<T>, second: &Measurement<T>, share: T) -> Measurement<T> {
    let mean = |first: T, second: T| first + share * (second - first);
    let ([x, y], [east, north]) = (first.place(), second.place());
    let height = mean(first.height(), second.height());
    let loss = mean(first.loss(), second.loss());
    // A mean of two plausible measurements is plausible.
    Measurement::new([mean(x, east), mean(y, north)], height, loss).unwrap_or(*first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_scalar::Q16_16;

    fn measurement<T: Scalar>(place: [f64; 2], loss: f64) -> Measurement<T> {
        Measurement::new(place.map(T::from_f64), T::from_f64(40.0), T::from_f64(loss))
            .expect("plausible")
    }

    fn check<T: Scalar>() {
        let mut flight = ByPlace::<T, 4>::new();
        let unknown = Heading::unknown();
        for k in 0..100 {
            flight.push(&measurement([3.0, 4.0], 60.0 + f64::from(k % 2)), &unknown);
        }
        let [hover] = flight.as_slice() else { panic!("{flight:?}") };
        assert!((hover.loss().to_f64() - 60.5).abs() < 0.02, "{hover:?}");
        flight.push(&measurement([10.0, 4.0], 60.5), &unknown);
        assert_eq!(flight.as_slice().len(), 1);
        // A hundredth of the distance.
        assert!((flight.as_slice()[0].place()[0].to_f64() - 3.07).abs() < 0.02);
        for k in 1..200 {
            flight.push(&measurement([3.0 + 20.0 * f64::from(k), 4.0], 60.0), &unknown);
            assert!(flight.as_slice().len() <= 4);
        }
        // However long the flight, the places kept cover all of it.
        assert!(flight.near() > T::from_f64(512.0) && flight.as_slice().len() >= 2, "{flight:?}");
        let mean = flight.counts.iter().sum::<u32>();
        assert_eq!(mean, 300, "none is dropped");
        let mut turning = ByPlace::<T, 4>::new();
        for radians in [1.0, 1.2] {
            let heading = Heading::new(T::from_f64(radians)).expect("finite");
            turning.push(&measurement([3.0, 4.0], 60.0), &heading);
        }
        let [heading] = turning.headings() else { panic!("{turning:?}") };
        let [one, other] = [1.0, 1.2].map(|it| Heading::new(T::from_f64(it)).expect("finite"));
        assert_eq!(*heading, one.mean(&other, T::HALF));
        assert_eq!(flight.headings(), &[unknown; 4][..flight.as_slice().len()]);
    }

    #[test]
    fn what_is_measured_at_a_place_is_one_and_a_long_flight_has_room() {
        check::<f32>();
        check::<f64>();
        check::<Q16_16>();
    }
}
