//! Passes over particles in blocks that fit into registers and cache lines: copied into local arrays first, so
//! that the compiler sees neither bounds nor aliases and makes vector instructions of the rest.

use kestirim_scalar::Scalar;

use crate::weights::Weights;

/// Particles of a block.
pub(crate) const BLOCK: usize = 32;
/// Sums are kept in so many lanes, so that they become vector instructions, and round alike everywhere.
const LANES: usize = 4;

/// Where the points of a filter are.
pub(crate) trait Points<T, const D: usize> {
    /// Copies the coordinates of `used` points from number `base` on.
    fn load(&self, base: usize, used: usize, block: &mut [[T; BLOCK]; D]);
}

impl<T: Scalar, const D: usize, const N: usize> Points<T, D> for [[T; N]; D] {
    #[inline(always)]
    fn load(&self, base: usize, used: usize, block: &mut [[T; BLOCK]; D]) {
        for axis in 0..D {
            let source = self[axis].get(base..base.saturating_add(used)).unwrap_or_default();
            for (to, &from) in block[axis].iter_mut().zip(source) {
                *to = from;
            }
        }
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
    fn load(&self, base: usize, used: usize, block: &mut [[T; BLOCK]; K]) {
        let mut states = [[T::ZERO; BLOCK]; D];
        self.points.load(base, used, &mut states);
        for index in 0..BLOCK {
            let point = (self.of)(gather(&states, index));
            for axis in 0..K {
                block[axis][index] = point[axis];
            }
        }
    }
}

/// The point number `index` of a block.
#[inline(always)]
pub(crate) fn gather<T: Scalar, const D: usize>(block: &[[T; BLOCK]; D], index: usize) -> [T; D] {
    let mut point = [T::ZERO; D];
    for axis in 0..D {
        point[axis] = block[axis][index];
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
    let mut block = [[T::ZERO; BLOCK]; D];
    let mut base = 0;
    while let Some(logs) = weights.block(base) {
        points.load(base, logs.len(), &mut block);
        // What is not used of the last block has no weight.
        let mut weight = [T::ZERO; BLOCK];
        for (weight, &log) in weight.iter_mut().zip(logs) {
            *weight = log.exp();
        }
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
