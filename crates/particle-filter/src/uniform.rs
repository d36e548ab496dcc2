use rand_core::Rng;

/// Largest number of values with a common prefix that are drawn together.
const TOGETHER: usize = 32;
/// Capacity for pending halves: each of 32 bits leaves one behind.
const DEPTH: usize = 33;

/// Independent uniform 32-bit numbers, to be counted below rising limits, in constant memory and linear time.
///
/// Of n numbers, as many are in the lower half as there are heads among n coins; each half is then divided in the
/// same way. Thirty-two or fewer are drawn at once and need no order: each limit is compared with all of
/// them. Everything is done in integers, whatever the number type of the filter.
pub(crate) struct Uniform {
    /// Prefix, number of decided bits and number of values of each pending interval.
    pending: [(u32, u32, u32); DEPTH],
    depth: usize,
    /// Drawn values with a common prefix, followed by `u32::MAX`, which is larger than any.
    ready: [u32; TOGETHER],
    /// The largest value that may have the prefix of those drawn.
    last: u32,
    /// Number of drawn values, and number of those that have been counted.
    count: u32,
    counted: u32,
}

impl Uniform {
    #[inline]
    pub(crate) fn new(count: u32) -> Self {
        let mut pending = [(0, 0, 0); DEPTH];
        pending[0] = (0, 0, count);
        Self { pending, depth: 1, ready: [u32::MAX; TOGETHER], last: 0, count: 0, counted: 0 }
    }

    /// The number of values below `limit` that have not been counted yet.
    ///
    /// No branch depends on a comparison with one of the values: it would be mispredicted once per
    /// particle.
    #[inline(always)]
    pub(crate) fn below<R: Rng + ?Sized>(&mut self, limit: u32, rng: &mut R) -> u32 {
        let mut below = 0;
        while limit > self.last {
            below += self.count - self.counted;
            if !self.refill(rng) {
                return below;
            }
        }
        let counted = self.ready.iter().map(|&number| u32::from(number < limit)).sum();
        below += counted - self.counted;
        self.counted = counted;
        below
    }

    /// Draws the next values; returns whether there are any more.
    #[inline(never)]
    fn refill<R: Rng + ?Sized>(&mut self, rng: &mut R) -> bool {
        (self.count, self.counted) = (0, 0);
        self.ready = [u32::MAX; TOGETHER];
        while let Some(&(prefix, bits, count)) = self.pending.get(self.depth.wrapping_sub(1)) {
            self.depth -= 1;
            // Values that share all 32 bits come in portions; a good generator practically never produces them.
            if count as usize <= TOGETHER || bits == 32 {
                let portion = count.min(TOGETHER as u32);
                if portion < count {
                    self.push(prefix, bits, count - portion);
                }
                if portion > 0 {
                    self.draw(prefix, bits, portion, rng);
                    return true;
                }
            } else {
                let lower = heads(count, rng);
                self.push(prefix | (1 << (31 - bits)), bits + 1, count - lower);
                self.push(prefix, bits + 1, lower);
            }
        }
        false
    }

    /// Draws `count` values with a common prefix.
    #[inline(always)]
    fn draw<R: Rng + ?Sized>(&mut self, prefix: u32, bits: u32, count: u32, rng: &mut R) {
        // `u32::MAX` stands for no value, and is above all values with the prefix.
        let behind = |number: u32| (prefix | (u64::from(number) >> bits) as u32).min(u32::MAX - 1);
        for number in self.ready.iter_mut().take(count as usize) {
            *number = behind(rng.next_u32());
        }
        (self.last, self.count) = (behind(u32::MAX), count);
    }

    #[inline(always)]
    fn push(&mut self, prefix: u32, bits: u32, count: u32) {
        if let Some(slot) = self.pending.get_mut(self.depth) {
            *slot = (prefix, bits, count);
            self.depth += 1;
        }
    }
}

/// The number of heads among `count` fair coins.
#[inline]
fn heads<R: Rng + ?Sized>(count: u32, rng: &mut R) -> u32 {
    let mut heads = 0;
    for _ in 0..count / 32 {
        heads += rng.next_u32().count_ones();
    }
    // Uses as many bits of the last word as are left, which may be none of its 32.
    heads + (u64::from(rng.next_u32()) >> (32 - count % 32)).count_ones()
}
