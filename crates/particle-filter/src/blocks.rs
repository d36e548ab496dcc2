//! Passes over particles in blocks that fit into registers and cache lines: arrays of a known length, so that the
//! compiler needs no bounds checks and vectorises the loops.

use kestirim_arithmetic::vectors::{Kernel, Vectors};
use kestirim_scalar::Scalar;

/// Runs a kernel on the widest vectors of the processor; in fixed point, whose products no vectors speed up, on those
/// that the program is compiled for, so that less is compiled.
#[inline(always)]
pub(crate) fn on_vectors<T: Scalar, K: Kernel>(kernel: K) -> K::Output {
    if T::IS_FLOAT { Vectors::widest().run(kernel) } else { kernel.run() }
}

/// Number of particles in a block.
pub(crate) const BLOCK: usize = 32;

/// Coordinates of the points of a block, axis by axis.
pub(crate) type Block<T, const D: usize> = [[T; BLOCK]; D];

/// A source of the coordinates of a filter's points.
pub(crate) trait Points<T, const D: usize> {
    /// The coordinates of `used` points from index `base` on: references to where they are stored, or to `room`,
    /// filled.
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
            // The last block may be incomplete.
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

/// Points computed from other points by a function.
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

/// The point at position `index` of a block.
#[inline(always)]
pub(crate) fn gather<T: Scalar, const D: usize>(block: &[&[T; BLOCK]; D], index: usize) -> [T; D] {
    let mut point = [T::ZERO; D];
    for (coordinate, axis) in point.iter_mut().zip(block) {
        // Always present, which the compiler cannot prove everywhere.
        if let Some(&value) = axis.get(index) {
            *coordinate = value;
        }
    }
    point
}
