use kestirim_scalar::Scalar;

/// The capacity of a window in samples: 50 ms at up to 640 Hz; of a faster stream it holds only the newest.
const CAPACITY: usize = 32;

/// Means of `K` features over a sliding time window, O(1) per sample.
///
/// Subtracting the oldest sample from a running sum leaves a float's rounding errors for ever, so the sum is computed
/// afresh each time the ring wraps round.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Copy + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct SlidingMean<T, const K: usize> {
    #[cfg_attr(feature = "serde", serde(with = "ring"))]
    ring: [(u32, [T; K]); CAPACITY],
    #[cfg_attr(
        feature = "serde",
        serde(deserialize_with = "kestirim_snapshot::arrays::index::<_, CAPACITY>")
    )]
    newest: usize,
    #[cfg_attr(
        feature = "serde",
        serde(deserialize_with = "kestirim_snapshot::arrays::count::<_, CAPACITY>")
    )]
    count: usize,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    sums: [T; K],
    span_us: u32,
    /// 1/count, cached because a division is expensive and the count seldom changes.
    reciprocal: T,
}

/// The samples of a window: serde has no arrays of generic length inside tuples.
#[cfg(feature = "serde")]
mod ring {
    use super::CAPACITY;
    use kestirim_scalar::Scalar;
    use kestirim_snapshot::arrays;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Clone, Copy, Serialize, Deserialize)]
    #[serde(bound(serialize = "T: Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
    struct Sample<T, const K: usize> {
        time_us: u32,
        #[serde(with = "kestirim_snapshot::arrays")]
        features: [T; K],
    }

    pub(super) fn serialize<S: Serializer, T: Serialize + Copy, const K: usize>(
        ring: &[(u32, [T; K]); CAPACITY],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        arrays::serialize(&ring.map(|(time_us, features)| Sample { time_us, features }), serializer)
    }

    pub(super) fn deserialize<'de, D, T, const K: usize>(
        deserializer: D,
    ) -> Result<[(u32, [T; K]); CAPACITY], D::Error>
    where
        D: Deserializer<'de>,
        T: Scalar + Deserialize<'de>,
    {
        let ring: [Sample<T, K>; CAPACITY] = arrays::deserialize(deserializer)?;
        Ok(ring.map(|sample| (sample.time_us, sample.features)))
    }
}

impl<T: Scalar, const K: usize> SlidingMean<T, K> {
    /// An empty window of `span_us` microseconds.
    pub(crate) fn new(span_us: u32) -> Self {
        Self {
            ring: [(0, [T::ZERO; K]); CAPACITY],
            newest: 0,
            count: 0,
            sums: [T::ZERO; K],
            span_us,
            reciprocal: T::ONE,
        }
    }

    /// Adds a sample's features and returns the means.
    #[inline]
    pub(crate) fn push(&mut self, time_us: u32, features: [T; K]) -> [T; K] {
        let before = self.count;
        while self.count > 0 {
            let (oldest_us, oldest) = self.ring[self.index(self.count - 1)];
            if self.count < CAPACITY && time_us.wrapping_sub(oldest_us) < self.span_us {
                break;
            }
            for k in 0..K {
                self.sums[k] -= oldest[k];
            }
            self.count -= 1;
        }
        self.newest = (self.newest + 1) % CAPACITY;
        self.ring[self.newest] = (time_us, features);
        self.count += 1;
        if self.newest == 0 {
            self.sum_anew();
        } else {
            for k in 0..K {
                self.sums[k] += features[k];
            }
        }
        if self.count != before {
            self.reciprocal = T::ONE / T::from_micro(self.count as i32 * 1_000_000);
        }
        self.sums.map(|sum| sum * self.reciprocal)
    }

    /// The index of the sample of this age, where the newest has age 0.
    #[inline]
    fn index(&self, age: usize) -> usize {
        self.newest.wrapping_sub(age) % CAPACITY
    }

    #[inline(never)]
    fn sum_anew(&mut self) {
        self.sums = [T::ZERO; K];
        for age in 0..self.count {
            let (_, features) = &self.ring[self.index(age)];
            for k in 0..K {
                self.sums[k] += features[k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that repeat after 101 samples.
    fn value(k: usize) -> f64 {
        (k * 37 % 101) as f64
    }

    /// Asserts that the means are those of the samples within the span (µs), one every interval (µs).
    fn are_means(span_us: u32, interval_us: u32) {
        let mut window = SlidingMean::<f64, 2>::new(span_us);
        // The clock wraps round on the way.
        let time_us = |k: usize| (u32::MAX - 100_000).wrapping_add(k as u32 * interval_us);
        for k in 0..300 {
            let means = window.push(time_us(k), [value(k), -value(k)]);
            let within = |&j: &usize| time_us(k).wrapping_sub(time_us(j)) < span_us;
            let kept = (0..=k).rev().take(CAPACITY).take_while(within);
            let (count, sum) =
                kept.fold((0.0, 0.0), |(count, sum), j| (count + 1.0, sum + value(j)));
            assert!((means[0] - sum / count).abs() < 1e-9, "{k}: {means:?}, {sum} / {count}");
            assert_eq!(means[1], -means[0]);
        }
    }

    #[test]
    fn means_are_those_of_the_last_stretch_of_time() {
        are_means(50_000, 10_000);
        are_means(47_500, 5_000);
        are_means(50_000, 60_000);
        // A fast stream, of which only the newest samples fit.
        are_means(50_000, 1_000);
    }

    #[test]
    fn rounding_does_not_stay_for_ever() {
        let mut window = SlidingMean::<f32, 1>::new(47_500);
        let mut mean = 0.0;
        for k in 0..CAPACITY as u32 + 10 {
            let [found] = window.push(k * 10_000, [if k == 3 { 1e9 } else { 0.3 }]);
            mean = found;
        }
        assert!((mean - 0.3).abs() < 1e-6, "{mean}");
    }
}
