use rand_core::Rng;

/// Numbers of one prefix are drawn together from here on.
const TOGETHER: usize = 64;
/// So many numbers are compared at a time.
const LANES: usize = 4;
/// Halves still to come: each of 32 bits leaves one behind.
const DEPTH: usize = 33;

/// Coefficients of q with 14 fractional bits: minimax.
const Q: [u32; 3] = [7182, 3891, 1321];

/// Independent uniform 32-bit numbers in rising order, in constant memory and linear time.
///
/// Of n numbers, those in the lower half are as many as heads among n coins; then both halves go on by
/// themselves. Sixty-four or fewer are laid out at once: the gaps between sorted uniform numbers are
/// exponentially distributed, scaled so that they and the last one fill the interval. All in integers,
/// whatever the filter computes in.
pub(crate) struct Sorted {
    /// Prefix, bits decided, how many.
    pending: [(u32, u32, u32); DEPTH],
    depth: usize,
    /// Sorted numbers, and behind them what is larger than any.
    ready: [u32; TOGETHER + LANES],
    next: usize,
    end: usize,
}

impl Sorted {
    #[inline]
    pub(crate) fn new(count: u32) -> Self {
        let mut pending = [(0, 0, 0); DEPTH];
        pending[0] = (0, 0, count);
        Self { pending, depth: 1, ready: [u32::MAX; TOGETHER + LANES], next: 0, end: 0 }
    }

    /// How many numbers there are below a limit that have not been counted yet.
    ///
    /// Four are compared at a time and no branch depends on one: a processor would guess it wrongly once a
    /// particle.
    #[inline(always)]
    pub(crate) fn below<R: Rng + ?Sized>(&mut self, limit: u32, rng: &mut R) -> u32 {
        let mut below = 0;
        loop {
            if self.next >= self.end && !self.refill(rng) {
                return below;
            }
            let next = self.ready.get(self.next..).and_then(<[u32]>::first_chunk::<LANES>);
            let counted = match next {
                Some([a, b, c, d]) => {
                    (u32::from(*a < limit) + u32::from(*b < limit))
                        + (u32::from(*c < limit) + u32::from(*d < limit))
                }
                None => 0,
            };
            below += counted;
            self.next += counted as usize;
            if counted < LANES as u32 && self.next < self.end {
                return below;
            }
        }
    }

    /// Whether there are any more.
    #[inline(never)]
    fn refill<R: Rng + ?Sized>(&mut self, rng: &mut R) -> bool {
        (self.next, self.end) = (0, 0);
        self.ready = [u32::MAX; TOGETHER + LANES];
        while let Some(&(prefix, bits, count)) = self.pending.get(self.depth.wrapping_sub(1)) {
            self.depth -= 1;
            // Numbers that share all bits come in portions; no generator worth the name makes any.
            if count as usize <= TOGETHER || bits == 32 {
                let portion = count.min(TOGETHER as u32);
                if portion < count {
                    self.push(prefix, bits, count - portion);
                }
                if portion > 0 {
                    self.lay_out(prefix, bits, portion as usize, rng);
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

    /// Sorted numbers of one prefix.
    #[inline(always)]
    fn lay_out<R: Rng + ?Sized>(&mut self, prefix: u32, bits: u32, count: usize, rng: &mut R) {
        let mut sum = 0;
        for place in self.ready.iter_mut().take(count) {
            sum += exponential(rng.next_u32());
            *place = sum;
        }
        // 65 exponentials of 19 bits fit into 32.
        let whole = u64::from(sum.saturating_add(exponential(rng.next_u32())).max(1));
        let reciprocal = (1 << 63) / whole;
        for place in self.ready.iter_mut().take(count) {
            let fraction = ((u64::from(*place) * reciprocal) >> 31).min(u64::from(u32::MAX));
            // The largest number there is stands for none.
            *place = (prefix | (fraction >> bits) as u32).min(u32::MAX - 1);
        }
        self.end = count;
    }

    #[inline(always)]
    fn push(&mut self, prefix: u32, bits: u32, count: u32) {
        if let Some(slot) = self.pending.get_mut(self.depth) {
            *slot = (prefix, bits, count);
            self.depth += 1;
        }
    }
}

/// −log₂ u of a uniform u with 14 fractional bits, up to 32: exponentially distributed. Only ratios of them
/// count, so that the base does not matter.
///
/// Right to 2·10⁻⁴; three multiplications, since an exponent and a parabola are nearly a logarithm.
#[inline(always)]
fn exponential(bits: u32) -> u32 {
    let bits = bits | 1;
    let zeros = bits.leading_zeros();
    // The mantissa without its leading one, 14 bits: log₂(1 + t) = t + t·(1 − t)·q(t).
    let t = ((bits << zeros) << 1) >> 18;
    let q = Q[0] - ((t * (Q[1] - ((t * Q[2]) >> 14))) >> 14);
    let bulge = (((t * ((1 << 14) - t)) >> 14) * q) >> 14;
    ((zeros + 1) << 14) - (t + bulge)
}

/// How many of `count` coins show heads.
#[inline]
fn heads<R: Rng + ?Sized>(count: u32, rng: &mut R) -> u32 {
    let mut heads = 0;
    for _ in 0..count / 32 {
        heads += rng.next_u32().count_ones();
    }
    // Of the last word as many bits as are left; none of 32 if none.
    heads + (u64::from(rng.next_u32()) >> (32 - count % 32)).count_ones()
}
