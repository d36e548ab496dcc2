//! Quantities that are known over time.

/// A quantity that is known over time, interpolated linearly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Course<const K: usize> {
    rows: Vec<(i64, [f64; K])>,
}

impl<const K: usize> Course<K> {
    /// A course of values at these times, µs, in any order.
    pub fn new(mut rows: Vec<(i64, [f64; K])>) -> Self {
        rows.sort_by_key(|(time_us, _)| *time_us);
        Self { rows }
    }

    /// Adds to all times, µs.
    pub fn shift(&mut self, by_us: i64) {
        for (time_us, _) in &mut self.rows {
            *time_us = time_us.saturating_add(by_us);
        }
    }

    /// The times, µs, and the values at them.
    pub fn rows(&self) -> &[(i64, [f64; K])] {
        &self.rows
    }

    /// The value at a time; `None` before the first row and after the last.
    pub fn within(&self, time_us: i64) -> Option<[f64; K]> {
        let after = self.rows.partition_point(|(row_us, _)| *row_us < time_us);
        let (next_us, next) = *self.rows.get(after)?;
        let Some(&(last_us, last)) = after.checked_sub(1).and_then(|i| self.rows.get(i)) else {
            return (next_us == time_us).then_some(next);
        };
        let share = (time_us - last_us) as f64 / (next_us - last_us).max(1) as f64;
        Some(std::array::from_fn(|k| last[k] + share * (next[k] - last[k])))
    }

    /// The value at a time; beyond the ends, the value at the nearest end. `None` only if there are no rows.
    pub fn held(&self, time_us: i64) -> Option<[f64; K]> {
        let (first, last) = (self.rows.first()?, self.rows.last()?);
        self.within(time_us.clamp(first.0, last.0))
    }
}
