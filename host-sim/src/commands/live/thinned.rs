//! A long path in bounded memory.

/// Values in order, thinned out as their number grows: those kept are always evenly spaced, and the last is included.
#[derive(Debug, Clone)]
pub(crate) struct Thinned<T> {
    kept: Vec<T>,
    most: usize,
    /// One in this many values is kept.
    stride: u64,
    count: u64,
    last: Option<T>,
}

impl<T: Copy> Thinned<T> {
    /// An empty sequence that keeps at most `most` values, but at least two, besides the last.
    pub(crate) fn new(most: usize) -> Self {
        Self { kept: Vec::new(), most: most.max(2), stride: 1, count: 0, last: None }
    }

    /// Adds a value.
    pub(crate) fn push(&mut self, value: T) {
        if self.kept.len() == self.most && self.is_due() {
            let mut keep = false;
            self.kept.retain(|_| {
                keep = !keep;
                keep
            });
            self.stride *= 2;
        }
        let due = self.is_due();
        if due {
            self.kept.push(value);
        }
        self.last = (!due).then_some(value);
        self.count += 1;
    }

    /// Whether the next value is to be kept.
    fn is_due(&self) -> bool {
        self.count.is_multiple_of(self.stride)
    }

    /// The kept values, followed by the last one.
    pub(crate) fn iter(&self) -> impl Iterator<Item = T> {
        self.kept.iter().copied().chain(self.last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_even_and_ends_at_the_end() {
        let mut thinned = Thinned::new(8);
        for number in 0..1000_u32 {
            thinned.push(number);
            let left: Vec<_> = thinned.iter().collect();
            assert!(left.len() <= 9 && (left.len() > 4 || left.len() as u32 == number + 1));
            assert_eq!((left.first(), left.last()), (Some(&0), Some(&number)));
            let steps: Vec<_> = left.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let whole = steps.get(..steps.len().saturating_sub(1)).unwrap_or_default();
            assert!(whole.windows(2).all(|pair| pair[0] == pair[1]), "{left:?}");
        }
    }
}
