//! Least-squares estimate of a jump of a few states from one epoch.

use crate::{Block, Measurement};
use kestirim_kalman::{Gaussian, Weighed};
use kestirim_scalar::Scalar;

/// Largest number of states in a block: position and velocity in three dimensions.
pub const MOST_STATES: usize = 6;

/// Distance of a block of the state from its prediction, according to the measurements of one epoch alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Jump<T> {
    /// √(dᵀ C⁻¹ d / directions): 1 on average while the prediction holds; 0 where the epoch determines
    /// no part of the block.
    pub discrepancy: T,
    /// Number of directions along which the epoch determines the block.
    pub directions: usize,
    /// d, the distance of each state of the block from its prediction, in the state's unit; zeros unless
    /// the epoch determines all states of the block.
    pub distance: [T; MOST_STATES],
}

/// Least squares for an unknown jump d of the block, from the innovations that the filter whitens
/// anyway (Friedland 1969; Willsky and Jones 1976). The effect of d on the mean is carried along, in
/// units of the prediction's standard deviations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bias<T, const N: usize> {
    block: Block,
    deviations: [T; MOST_STATES],
    /// ∂(x − mean)/∂d, one column for each state of the block.
    carried: [[T; N]; MOST_STATES],
    /// Lower triangle of the information Σ sᵀs/S.
    information: [[T; MOST_STATES]; MOST_STATES],
    /// Right-hand side Σ sᵀν/S of the normal equations.
    seen: [T; MOST_STATES],
}

impl<T: Scalar, const N: usize> Bias<T, N> {
    pub(crate) fn new(prior: &Gaussian<T, N>, block: Block) -> Self {
        let mut bias = Self {
            block,
            deviations: [T::ZERO; MOST_STATES],
            carried: [[T::ZERO; N]; MOST_STATES],
            information: [[T::ZERO; MOST_STATES]; MOST_STATES],
            seen: [T::ZERO; MOST_STATES],
        };
        let columns = bias.carried.iter_mut().zip(&mut bias.deviations).take(block.count);
        for (offset, (column, deviation)) in columns.enumerate() {
            let state = block.first + offset;
            let variance = prior.covariance.get(state, state).unwrap_or(T::ZERO);
            *deviation = variance.max(T::ZERO).sqrt();
            if let Some(entry) = column.get_mut(state) {
                *entry = *deviation;
            }
        }
        bias
    }

    pub(crate) fn block(&self) -> Block {
        self.block
    }

    /// Accumulates a measurement with row h, before the filter takes it in.
    #[inline]
    pub(crate) fn take(&mut self, measurement: &Measurement<'_, T>, weighed: &Weighed<T, N>) {
        let mut shown = [T::ZERO; MOST_STATES];
        for (shown, column) in shown.iter_mut().zip(&self.carried).take(self.block.count) {
            let mut sum = T::accumulator();
            for &(index, value) in measurement.row {
                sum = T::mac(sum, value, column.get(index).copied().unwrap_or(T::ZERO));
            }
            *shown = T::finish(sum);
        }
        let innovation = weighed.innovation();
        for (i, column) in self.carried.iter_mut().enumerate().take(self.block.count) {
            let share = weighed.by_variance(shown[i]);
            self.seen[i] += share * innovation;
            for j in 0..=i {
                self.information[i][j] += share * shown[j];
            }
            for (entry, &cross) in column.iter_mut().zip(weighed.cross_covariance()) {
                *entry -= share * cross;
            }
        }
    }

    /// The least-squares jump, by L D Lᵀ; directions without information are left out.
    pub(crate) fn jump(&self) -> Jump<T> {
        let count = self.block.count.min(MOST_STATES);
        let mut rest = self.information;
        let mut seen = self.seen;
        let (mut directions, mut sum) = (0_u16, T::ZERO);
        for pivot in 0..count {
            let known = rest[pivot][pivot];
            if known <= self.information[pivot][pivot].rounding(256) {
                continue;
            }
            let divisor = known.divisor();
            directions += 1;
            sum += seen[pivot] * seen[pivot].divided_by(divisor);
            for row in pivot + 1..count {
                let factor = rest[row][pivot].divided_by(divisor);
                for column in pivot + 1..=row {
                    let taken = factor * rest[column][pivot];
                    rest[row][column] -= taken;
                }
                let taken = factor * seen[pivot];
                seen[row] -= taken;
            }
        }
        let mut distance = [T::ZERO; MOST_STATES];
        let directions = usize::from(directions);
        if directions == count {
            for row in (0..count).rev() {
                let mut left = seen[row];
                for below in row + 1..count {
                    left -= rest[below][row] * distance[below];
                }
                distance[row] = left / rest[row][row];
            }
            for (distance, &deviation) in distance.iter_mut().zip(&self.deviations) {
                *distance *= deviation;
            }
        }
        let mean = if directions == 0 { T::ZERO } else { sum / crate::student::whole(directions) };
        Jump { discrepancy: mean.max(T::ZERO).sqrt(), directions, distance }
    }

    /// ‖d‖ / √tr P⁻ of the block; 0 where the epoch does not determine d.
    pub(crate) fn in_deviations(&self, jump: &Jump<T>) -> T {
        let trace = T::norm(&self.deviations);
        if trace > T::ZERO { T::norm(&jump.distance) / trace } else { T::ZERO }
    }
}
