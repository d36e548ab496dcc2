//! A fixed pseudo-random sequence, for the starting points of searches.

/// A linear congruential generator with the constants of Numerical Recipes.
pub(crate) struct Sequence(u32);

impl Sequence {
    pub(crate) fn new(seed: u32) -> Self {
        let mut sequence = Self(seed.wrapping_mul(0x9E37_79B9) ^ 0x5DEE_CE66);
        sequence.next();
        sequence
    }

    /// The next number, in −1..1.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1_u32 << 23) - 1.0
    }
}
