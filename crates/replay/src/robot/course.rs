//! What is known over time.

/// Something known over time, interpolated linearly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Course<const K: usize> {
    rows: Vec<(i64, [f64; K])>,
}

impl<const K: usize> Course<K> {
    /// What is known at these times, µs, which do not decrease.
    pub fn new(rows: Vec<(i64, [f64; K])>) -> Self {
        Self { rows }
    }

    /// Times, µs, and what is known then.
    pub fn rows(&self) -> &[(i64, [f64; K])] {
        &self.rows
    }

    /// What is known at a time; nothing before the first row and after the last.
    pub fn within(&self, time_us: i64) -> Option<[f64; K]> {
        let after = self.rows.partition_point(|(row_us, _)| *row_us < time_us);
        let (next_us, next) = *self.rows.get(after)?;
        let Some(&(last_us, last)) = after.checked_sub(1).and_then(|i| self.rows.get(i)) else {
            return (next_us == time_us).then_some(next);
        };
        let share = (time_us - last_us) as f64 / (next_us - last_us).max(1) as f64;
        Some(std::array::from_fn(|k| last[k] + share * (next[k] - last[k])))
    }

    /// What is known at a time; beyond the ends, what is known there.
    pub fn held(&self, time_us: i64) -> Option<[f64; K]> {
        let (first, last) = (self.rows.first()?, self.rows.last()?);
        self.within(time_us.clamp(first.0, last.0))
    }
}
