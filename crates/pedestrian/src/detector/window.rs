use kestirim_scalar::Scalar;

/// Capacity of a window in samples: 50 ms at up to 640 Hz; of a faster stream it holds the newest.
const CAPACITY: usize = 32;

/// Means of `K` features over the last stretch of time, O(1) a sample.
///
/// Taking the oldest sample off a running sum leaves a float's rounding behind for ever, so each time the
/// ring comes round the sum is made anew.
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
    /// 1/count, kept because a division is expensive and the count seldom changes.
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

    /// Index of the sample of this age, the newest being of age 0.
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
