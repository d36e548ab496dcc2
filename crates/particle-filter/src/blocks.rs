//! Passes over particles in blocks that fit into registers and cache lines: arrays of a known length, so that the
//! compiler sees no bounds and makes vector instructions of the rest.

use kestirim_scalar::Scalar;

use crate::weights::Weights;

/// Particles of a block.
pub(crate) const BLOCK: usize = 32;
/// Sums are kept in so many lanes, so that they become vector instructions, and round alike everywhere.
const LANES: usize = 4;

/// Coordinates of the points of a block.
pub(crate) type Block<T, const D: usize> = [[T; BLOCK]; D];

/// Where the points of a filter are.
pub(crate) trait Points<T, const D: usize> {
    /// The coordinates of `used` points from number `base` on: where they are stored, or written into `room`.
    fn load<'a>(
        &'a self,
        base: usize,
        used: usize,
        room: &'a mut Block<T, D>,
    ) -> [&'a [T; BLOCK]; D];
}

impl<T: Scalar, const D: usize, const N: usize> Points<T, D> for [[T; N]; D] {
    #[inline(always)]
    fn load<'a>(
        &'a self,
        base: usize,
        used: usize,
        room: &'a mut Block<T, D>,
    ) -> [&'a [T; BLOCK]; D] {
        let stored = self.each_ref().map(|axis| axis.get(base..).unwrap_or_default());
        if stored.iter().any(|rest| rest.len() < BLOCK) {
            // The last block is not whole.
            for (to, from) in room.iter_mut().zip(stored) {
                for (to, &from) in to.iter_mut().zip(from.iter().take(used)) {
                    *to = from;
                }
            }
        }
        let mut block = room.each_ref();
        for (block, rest) in block.iter_mut().zip(stored) {
            *block = rest.first_chunk().unwrap_or(block);
        }
        block
    }
}

/// Points that follow from others.
pub(crate) struct Mapped<'a, P, F> {
    pub(crate) points: &'a P,
    pub(crate) of: F,
}

impl<T, F, const D: usize, const K: usize, const N: usize> Points<T, K>
    for Mapped<'_, [[T; N]; D], F>
where
    T: Scalar,
    F: Fn([T; D]) -> [T; K],
{
    #[inline(always)]
    fn load<'a>(
        &'a self,
        base: usize,
        used: usize,
        room: &'a mut Block<T, K>,
    ) -> [&'a [T; BLOCK]; K] {
        let mut copies = [[T::ZERO; BLOCK]; D];
        let states = self.points.load(base, used, &mut copies);
        for index in 0..BLOCK {
            let point = (self.of)(gather(&states, index));
            for axis in 0..K {
                room[axis][index] = point[axis];
            }
        }
        room.each_ref()
    }
}

/// The point number `index` of a block.
#[inline(always)]
pub(crate) fn gather<T: Scalar, const D: usize>(block: &[&[T; BLOCK]; D], index: usize) -> [T; D] {
    let mut point = [T::ZERO; D];
    for (coordinate, axis) in point.iter_mut().zip(block) {
        // Always there, which the compiler does not see everywhere.
        if let Some(&value) = axis.get(index) {
            *coordinate = value;
        }
    }
    point
}

/// Σ aᵢ·bᵢ of R × C pairs of factors, which `factors` has for each weight (the largest is one) and its point.
#[inline(always)]
pub(crate) fn sums<T: Scalar, const D: usize, const N: usize, const R: usize, const C: usize>(
    weights: &Weights<T, N>,
    points: &impl Points<T, D>,
    factors: impl Fn(T, [T; D]) -> [[(T, T); C]; R],
) -> [[T; C]; R] {
    let mut lanes = [[[T::accumulator(); LANES]; C]; R];
    let mut room = [[T::ZERO; BLOCK]; D];
    let mut weight = [T::ZERO; BLOCK];
    let mut base = 0;
    while let Some(logs) = weights.block(base) {
        let block = points.load(base, logs.len(), &mut room);
        for (weight, &log) in weight.iter_mut().zip(logs) {
            *weight = log.exp();
        }
        // What is not used of the last block has no weight.
        weight.iter_mut().skip(logs.len()).for_each(|weight| *weight = T::ZERO);
        let mut first = 0;
        while first < logs.len() && first <= BLOCK - LANES {
            for lane in 0..LANES {
                let pairs = factors(weight[first + lane], gather(&block, first + lane));
                for row in 0..R {
                    for column in 0..C {
                        let (a, b) = pairs[row][column];
                        lanes[row][column][lane] = T::mac(lanes[row][column][lane], a, b);
                    }
                }
            }
            first += LANES;
        }
        base += BLOCK;
    }
    lanes.map(|row| {
        row.map(|[a, b, c, d]| (T::finish(a) + T::finish(b)) + (T::finish(c) + T::finish(d)))
    })
}
