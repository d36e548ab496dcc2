use rand_core::Rng;

/// Largest number of values of one prefix that are drawn together.
const TOGETHER: usize = 32;
/// Halves still to come: each of 32 bits leaves one behind.
const DEPTH: usize = 33;

/// Independent uniform 32-bit numbers, to be counted below rising limits, in constant memory and linear time.
///
/// Of n numbers, those in the lower half are as many as heads among n coins; then both halves go on by
/// themselves. Thirty-two or fewer are drawn at once, and need no order: each limit is compared with all of
/// them. All in integers, whatever the filter computes in.
pub(crate) struct Uniform {
    /// Prefix, bits decided, how many.
    pending: [(u32, u32, u32); DEPTH],
    depth: usize,
    /// Numbers of one prefix, and behind them what is larger than any.
    ready: [u32; TOGETHER],
    /// The largest that may have this prefix.
    last: u32,
    /// Number of values that are ready, and number of these that have been counted.
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

    /// Number of values below a limit that have not been counted yet.
    ///
    /// No branch depends on a comparison with one of them: a processor would guess it wrongly once a
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

    /// Whether there are any more.
    #[inline(never)]
    fn refill<R: Rng + ?Sized>(&mut self, rng: &mut R) -> bool {
        (self.count, self.counted) = (0, 0);
        self.ready = [u32::MAX; TOGETHER];
        while let Some(&(prefix, bits, count)) = self.pending.get(self.depth.wrapping_sub(1)) {
            self.depth -= 1;
            // Numbers that share all bits come in portions; no generator worth the name makes any.
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

    /// Numbers of one prefix.
    #[inline(always)]
    fn draw<R: Rng + ?Sized>(&mut self, prefix: u32, bits: u32, count: u32, rng: &mut R) {
        // The largest number there is stands for none, and lies behind all that have its prefix.
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

/// Number of heads among `count` coins.
#[inline]
fn heads<R: Rng + ?Sized>(count: u32, rng: &mut R) -> u32 {
    let mut heads = 0;
    for _ in 0..count / 32 {
        heads += rng.next_u32().count_ones();
    }
    // Of the last word as many bits as are left; none of 32 if none.
    heads + (u64::from(rng.next_u32()) >> (32 - count % 32)).count_ones()
}
