//! The count, minimum, maximum and sum of the costs of one class of steps.

/// The instruction counts of the steps of one class. The host computes the mean.
#[derive(Clone, Copy)]
pub(crate) struct Statistics {
    steps: u32,
    min: u32,
    max: u32,
    total: u64,
}

impl Statistics {
    /// The statistics before the first step.
    pub(crate) const EMPTY: Self = Self { steps: 0, min: u32::MAX, max: 0, total: 0 };

    /// Adds a step.
    pub(crate) fn add(&mut self, instructions: u32) {
        self.steps = self.steps.wrapping_add(1);
        self.min = self.min.min(instructions);
        self.max = self.max.max(instructions);
        self.total = self.total.wrapping_add(instructions.into());
    }

    /// `[steps, min, max, total]`, or `None` without a step.
    pub(crate) fn summary(&self) -> Option<[i64; 4]> {
        let Self { steps, min, max, total } = *self;
        (steps > 0).then(|| [steps.into(), min.into(), max.into(), total as i64])
    }
}
