use heapless::Vec;

/// Evenly spaced values of a stream of unknown length: up to M of them, including the last one.
///
/// Measurements of a flight that are close together carry much the same information: of a long flight, a few suffice
/// to locate the user. When the room is full, every other value is dropped, and from then on half as many are kept.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Thinned<V, const M: usize> {
    /// One value in `stride`, and the last one of all, whether or not it is one of these.
    kept: Vec<V, M>,
    /// Whether the last value is replaced by the next.
    is_passing: bool,
    /// The spacing of the values kept: a power of two.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "power_of_two"))]
    stride: u64,
    /// Number of values so far.
    count: u64,
}

/// Deserialises a stride, which must be a power of two.
#[cfg(feature = "serde")]
fn power_of_two<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    let stride = <u64 as serde::Deserialize>::deserialize(deserializer)?;
    if stride.is_power_of_two() {
        Ok(stride)
    } else {
        Err(serde::de::Error::custom("a stride that is no power of two"))
    }
}

impl<V: Copy, const M: usize> Thinned<V, M> {
    /// An empty collection.
    #[inline]
    pub const fn new() -> Self {
        const { assert!(M >= 3, "two that stay, and the last") };
        Self { kept: Vec::new(), is_passing: false, stride: 1, count: 0 }
    }

    /// Adds a value.
    pub fn push(&mut self, value: V) {
        if self.is_passing {
            self.kept.pop();
        }
        // One slot is reserved for the last value.
        if self.kept.len() + 1 >= M && self.is_due() {
            self.halve();
        }
        self.is_passing = !self.is_due();
        // There is room: at most M − 1 stay.
        let _ = self.kept.push(value);
        self.count = self.count.wrapping_add(1);
    }

    /// Whether the next value is one that is kept.
    fn is_due(&self) -> bool {
        self.count & (self.stride - 1) == 0
    }

    /// Drops every other value.
    fn halve(&mut self) {
        let mut left = 0;
        while let Some(&value) = self.kept.get(2 * left) {
            if let Some(place) = self.kept.get_mut(left) {
                *place = value;
            }
            left += 1;
        }
        self.kept.truncate(left);
        // No stream is long enough for a stride that does not fit.
        self.stride = self.stride.checked_mul(2).unwrap_or(self.stride);
    }

    /// The values kept, in order of arrival.
    #[inline]
    pub fn as_slice(&self) -> &[V] {
        &self.kept
    }

    /// Number of values so far, including those that were dropped.
    #[inline]
    pub fn count(&self) -> u64 {
        self.count
    }
}

impl<V: Copy, const M: usize> Default for Thinned<V, M> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_even_and_ends_at_the_end() {
        let mut thinned = Thinned::<u32, 9>::new();
        for number in 0..1000 {
            thinned.push(number);
            let left = thinned.as_slice();
            assert!(left.len() <= 9 && (left.len() > 4 || left.len() as u32 == number + 1));
            assert_eq!((left.first(), left.last()), (Some(&0), Some(&number)));
            let step = |pair: &[u32]| pair[1] - pair[0];
            let whole = left.get(..left.len().saturating_sub(1)).unwrap_or_default();
            let mut steps = whole.windows(2).map(step);
            let first = steps.next();
            assert!(steps.all(|step| Some(step) == first), "{left:?}");
            assert_eq!(thinned.count(), u64::from(number) + 1);
        }
    }
}
