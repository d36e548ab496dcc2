//! A window of the last half minute.

use std::collections::VecDeque;

/// The length of the window, in microseconds.
const SPAN_US: u64 = 30_000_000;
/// The maximum number of samples: 30 s at 400 Hz.
const MOST: usize = 12_000;

/// The samples of the last 30 s of the sender's clock; fewer if they exceed the maximum number.
#[derive(Debug, Clone)]
pub(super) struct Window<T>(VecDeque<(u64, T)>);

impl<T> Default for Window<T> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

impl<T> Window<T> {
    /// Adds a sample.
    pub(super) fn push(&mut self, time_us: u64, sample: T) {
        let old = |&(before_us, _): &(u64, T)| time_us.abs_diff(before_us) > SPAN_US;
        while self.0.len() >= MOST || self.0.front().is_some_and(old) {
            self.0.pop_front();
        }
        self.0.push_back((time_us, sample));
    }

    /// The last sample.
    pub(super) fn last(&self) -> Option<&T> {
        self.0.back().map(|(_, sample)| sample)
    }

    /// The samples with their times in seconds.
    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, &T)> {
        self.0.iter().map(|(time_us, sample)| (*time_us as f64 * 1e-6, sample))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_minute_is_held_whatever_the_times() {
        let mut window = Window::default();
        for time_us in (0..100_u64).map(|second| second * 1_000_000) {
            window.push(time_us, ());
        }
        assert_eq!(window.iter().count(), 31);
        window.push(u64::MAX, ());
        assert_eq!(window.iter().count(), 1);
        for _ in 0..2 * MOST {
            window.push(7, ());
        }
        assert_eq!(window.iter().count(), MOST);
    }
}
