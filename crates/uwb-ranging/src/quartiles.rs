use kestirim_scalar::Scalar;

/// Median and quartiles of a stream, in constant memory: the P² algorithm (Jain and Chlamtac 1985) with
/// its five markers at the minimum, the quartiles and the maximum.
///
/// A tenth of outliers moves the median by a fraction of the spread, however large they are: values beyond the
/// limits are clamped to them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Quartiles<T> {
    /// Values at the markers, in rising order.
    heights: [T; 5],
    /// Number of values at or below each marker.
    positions: [u32; 5],
    count: u32,
    limits: (T, T),
}

impl<T: Scalar> Quartiles<T> {
    /// Quartiles of values that are expected between `low` and `high`.
    pub fn within(low: T, high: T) -> Self {
        let limits = (low.min(high), low.max(high));
        Self { heights: [T::ZERO; 5], positions: [1, 2, 3, 4, 5], count: 0, limits }
    }

    /// Number of values so far.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Adds a value; one that is not finite is ignored.
    pub fn add(&mut self, value: T) {
        if !value.is_finite() || self.count == u32::MAX {
            return;
        }
        let value = value.clamp(self.limits.0, self.limits.1);
        self.count += 1;
        if self.count <= 5 {
            self.insert(value);
            return;
        }
        let [least, .., most] = &mut self.heights;
        *least = least.min(value);
        *most = most.max(value);
        for (position, height) in self.positions.iter_mut().zip(&self.heights).skip(1).take(3) {
            if value < *height {
                *position += 1;
            }
        }
        self.positions[4] += 1;
        for marker in 1..4 {
            self.adjust(marker);
        }
    }

    /// The median; `None` before the first value.
    pub fn median(&self) -> Option<T> {
        self.quantile(2)
    }

    /// The interquartile range times 0.7413, which is the standard deviation of a normal distribution; `None`
    /// before the first value.
    pub fn deviation(&self) -> Option<T> {
        Some((self.quantile(3)? - self.quantile(1)?) * T::from_f64(0.7413))
    }

    /// Inserts one of the first values in order.
    fn insert(&mut self, value: T) {
        let mut value = value;
        for height in self.heights.iter_mut().take(self.count as usize - 1) {
            if value < *height {
                core::mem::swap(&mut value, height);
            }
        }
        if let Some(height) = self.heights.get_mut(self.count as usize - 1) {
            *height = value;
        }
    }

    fn quantile(&self, marker: usize) -> Option<T> {
        let last = self.count.checked_sub(1)?;
        // With fewer than five values, the one nearest to the quantile.
        let index = if last < 4 { (last as usize * marker + 2) / 4 } else { marker };
        self.heights.get(index).copied()
    }

    /// Moves a marker by one place towards its desired position.
    fn adjust(&mut self, marker: usize) {
        let (Some(&[below, here, above]), Some(&[low, height, high])) = (
            self.positions.get(marker - 1..).and_then(<[u32]>::first_chunk::<3>),
            self.heights.get(marker - 1..).and_then(<[T]>::first_chunk::<3>),
        ) else {
            return;
        };
        // Four times the desired position, 1 + (n − 1)·marker/4.
        let wanted = 4 + u64::from(self.count - 1) * marker as u64;
        let place = 4 * u64::from(here);
        let up = wanted >= place + 4 && above > here + 1;
        let down = wanted + 4 <= place && here > below + 1;
        if !(up || down) {
            return;
        }
        let whole = |n: u32| T::from_micro(n.min(2000) as i32 * 1_000_000);
        let (left, right) = (whole(here - below), whole(above - here));
        let step = if up { T::ONE } else { -T::ONE };
        // The parabola through the three markers, or a line where the parabola would break their order.
        let rise = (left + step) * (high - height) / right;
        let fall = (right - step) * (height - low) / left;
        let parabola = height + step * (rise + fall) / (left + right);
        let moved = if low < parabola && parabola < high {
            parabola
        } else if up {
            height + (high - height) / right
        } else {
            height - (height - low) / left
        };
        if let (Some(height), Some(position)) =
            (self.heights.get_mut(marker), self.positions.get_mut(marker))
        {
            *height = moved;
            *position = if up { *position + 1 } else { *position - 1 };
        }
    }
}
