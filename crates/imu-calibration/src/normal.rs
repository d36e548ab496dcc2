//! Normal equations of least squares, of a size known at compile time, in which some unknowns may be held at zero.

use kestirim_scalar::Scalar;

/// The smallest pivot, as a share of the unknown's own weight: below it the unknown follows from the others. A hundred
/// roundings of an `f32`.
const LEAST_PIVOT: f64 = 1e-5;

/// The normal equations Aᵀ A x = Aᵀ b.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Normal<T, const N: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::rows"))]
    pub(crate) a: [[T; N]; N],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(crate) b: [T; N],
    /// The sum of squares bᵀ b.
    pub(crate) squares: T,
}

/// The inverse (Aᵀ A)⁻¹, zero for the unknowns that are held.
pub(crate) type Inverse<T, const N: usize> = [[T; N]; N];

impl<T: Scalar, const N: usize> Normal<T, N> {
    pub(crate) fn new() -> Self {
        Self { a: [[T::ZERO; N]; N], b: [T::ZERO; N], squares: T::ZERO }
    }

    /// Adds the equation `row · x = value`.
    pub(crate) fn add(&mut self, row: &[T; N], value: T) {
        for ((line, right), &own) in self.a.iter_mut().zip(&mut self.b).zip(row) {
            for (entry, &other) in line.iter_mut().zip(row) {
                *entry += own * other;
            }
            *right += own * value;
        }
        self.squares += value * value;
    }

    pub(crate) fn is_finite(&self) -> bool {
        T::all_finite(self.a.as_flattened()) && T::all_finite(&self.b) && self.squares.is_finite()
    }

    /// By how much a unit of the unknown at `index`, which is held at zero, moves the others.
    pub(crate) fn shift(&self, inverse: &Inverse<T, N>, index: usize) -> [T; N] {
        let mut moved = [T::ZERO; N];
        for (moved, line) in moved.iter_mut().zip(inverse) {
            for (&entry, own) in line.iter().zip(&self.a) {
                *moved += entry * own.get(index).copied().unwrap_or(T::ZERO);
            }
        }
        moved
    }

    /// The inverse over the `active` unknowns, with `damping` times their own weights added (Marquardt); `None` if they
    /// cannot be separated.
    pub(crate) fn inverse(&self, active: &[bool; N], damping: T) -> Option<Inverse<T, N>> {
        let weights = self.weights(active)?;
        let (mut rest, mut inverse) = ([[T::ZERO; N]; N], [[T::ZERO; N]; N]);
        let lines = rest.iter_mut().zip(&mut inverse).zip(&self.a).zip(&weights).zip(active);
        for (i, ((((line, unit), known), &own), &is_active)) in lines.enumerate() {
            for (j, ((entry, &known), &other)) in
                line.iter_mut().zip(known).zip(&weights).enumerate()
            {
                *entry = known * own * other;
                if i == j {
                    // Held unknowns have a weight of zero.
                    *entry = if is_active { *entry + damping } else { T::ONE };
                }
            }
            *unit.get_mut(i)? = T::ONE;
        }
        eliminate(&mut rest, &mut inverse)?;
        for (line, &own) in inverse.iter_mut().zip(&weights) {
            for (entry, &other) in line.iter_mut().zip(&weights) {
                *entry *= own * other;
            }
        }
        T::all_finite(inverse.as_flattened()).then_some(inverse)
    }

    /// The reciprocal square roots of the diagonal, zero for unknowns that are held; `None` if nothing is known of an
    /// active one.
    fn weights(&self, active: &[bool; N]) -> Option<[T; N]> {
        let mut weights = [T::ZERO; N];
        for (i, ((weight, line), _)) in
            weights.iter_mut().zip(&self.a).zip(active).enumerate().filter(|(_, (_, on))| **on)
        {
            let inverse = line.get(i)?.sqrt().recip();
            if !(inverse.is_finite() && inverse > T::ZERO) {
                return None;
            }
            *weight = inverse;
        }
        Some(weights)
    }

    /// The solution for the unknowns, from the inverse.
    pub(crate) fn solution(&self, inverse: &Inverse<T, N>) -> [T; N] {
        let mut x = [T::ZERO; N];
        for (x, line) in x.iter_mut().zip(inverse) {
            *x = T::dot(line, &self.b);
        }
        x
    }

    /// The residual sum of squares; where rounding takes it below zero, it counts as zero.
    pub(crate) fn left(&self, solution: &[T; N]) -> T {
        (self.squares - T::dot(solution, &self.b)).max(T::ZERO)
    }
}

/// Gauss–Jordan elimination without pivoting, which positive definite matrices do not need.
fn eliminate<T: Scalar, const N: usize>(
    rest: &mut [[T; N]; N],
    inverse: &mut [[T; N]; N],
) -> Option<()> {
    let least = T::from_f64(LEAST_PIVOT);
    for pivot in 0..N {
        let (line, unit) = (*rest.get(pivot)?, *inverse.get(pivot)?);
        let diagonal = *line.get(pivot)?;
        if !(diagonal > least && diagonal.is_finite()) {
            return None;
        }
        let by = diagonal.divisor();
        let (line, unit) = (line.map(|x| x.divided_by(by)), unit.map(|x| x.divided_by(by)));
        for (row, (other, result)) in rest.iter_mut().zip(inverse.iter_mut()).enumerate() {
            if row == pivot {
                (*other, *result) = (line, unit);
                continue;
            }
            let factor = *other.get(pivot)?;
            for (entry, &known) in other.iter_mut().zip(&line) {
                *entry -= factor * known;
            }
            for (entry, &known) in result.iter_mut().zip(&unit) {
                *entry -= factor * known;
            }
        }
    }
    Some(())
}

/// The square roots of the diagonal: the amplification of the equations' noise in each unknown.
pub(crate) fn amplification<T: Scalar, const N: usize>(inverse: &Inverse<T, N>) -> [T; N] {
    let mut all = [T::ZERO; N];
    for (i, (own, line)) in all.iter_mut().zip(inverse).enumerate() {
        if let Some(&diagonal) = line.get(i) {
            *own = diagonal.max(T::ZERO).sqrt();
        }
    }
    all
}

/// The noise of an equation: the given one, or that of the residuals if it is larger.
pub(crate) fn noise<T: Scalar>(given: T, left: T, equations: T, unknowns: T) -> T {
    let freedom = equations - unknowns;
    if freedom < T::ONE { given } else { given.max((left / freedom).sqrt()) }
}
