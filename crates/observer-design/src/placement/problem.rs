//! A system with its wanted poles, and the accuracy with which a gain places them.

use crate::Error;
use crate::eigenvalues::eigenvalues_extended;
use crate::extended::Extended;
use crate::number::{Square, Times, extend, extend_complex, finite, norm, round_complex};
use crate::pair::{Merging, Pair};
use crate::poles::{is_nearly_zero, pair_up, size};
use nalgebra::{Complex, SMatrix};

/// A gain and the poles that result from it.
#[derive(Clone, Copy)]
pub(super) struct Checked<const N: usize, const P: usize> {
    pub(super) gain: SMatrix<f64, N, P>,
    /// Resulting poles, in the order of the wanted ones.
    pub(super) placed: [Complex<f64>; N],
    /// Differences of the resulting poles from the wanted ones.
    pub(super) offsets: [Complex<f64>; N],
    /// Error of the worst pole, relative to its magnitude.
    pub(super) error: f64,
    /// Error of the worst pole as `error`, but relative to the size of the system for poles that count as zero there.
    pub(super) loss: f64,
}

/// A system and its wanted poles.
pub(super) struct Problem<'a, const N: usize, const P: usize> {
    pub(super) a: &'a Square<f64, N>,
    pub(super) c: &'a SMatrix<f64, P, N>,
    pub(super) pair: &'a Pair<N>,
    pub(super) merging: &'a Merging<N, P>,
    pub(super) poles: &'a [Complex<f64>; N],
}

impl<const N: usize, const P: usize> Problem<'_, N, P> {
    /// Computes the poles that a gain places, and their errors.
    pub(super) fn check(&self, gain: &SMatrix<f64, N, P>) -> Result<Checked<N, P>, Error> {
        if !finite(gain) {
            return Err(Error::NotFinite);
        }
        let values = eigenvalues_extended(&self.closed(gain))?;
        let offsets_from = |pole| values.map(|value| round_complex(value - extend_complex(pole)));
        let offsets = self.poles.map(offsets_from);
        let partners = pair_up(&offsets.map(|row| row.map(size)));
        let mut checked = Checked {
            gain: *gain,
            placed: *self.poles,
            offsets: *self.poles,
            error: 0.0,
            loss: 0.0,
        };
        for wanted in 0..N {
            let partner = partners[wanted];
            if let (Some(&value), Some(&offset)) =
                (values.get(partner), offsets[wanted].get(partner))
            {
                checked.placed[wanted] = round_complex(value);
                checked.offsets[wanted] = offset;
                let pole = self.poles[wanted];
                let error = size(offset) / self.reference(pole);
                let nearly_zero = is_nearly_zero(pole, self.system());
                let loss = if nearly_zero { size(offset) / self.system() } else { error };
                (checked.error, checked.loss) = (checked.error.max(error), checked.loss.max(loss));
            }
        }
        Ok(checked)
    }

    /// A − L C on the balanced scale.
    pub(super) fn closed(&self, gain: &SMatrix<f64, N, P>) -> Square<Extended, N> {
        self.pair.balanced(&(extend(self.a) - extend(gain).times(&extend(self.c))))
    }

    /// Size relative to which the error of a pole is measured: its magnitude, or the size of the system if it is zero.
    pub(super) fn reference(&self, pole: Complex<f64>) -> f64 {
        if size(pole) > 0.0 { size(pole) } else { self.system() }
    }

    fn system(&self) -> f64 {
        norm(&self.pair.dynamics).max(f64::MIN_POSITIVE)
    }
}
