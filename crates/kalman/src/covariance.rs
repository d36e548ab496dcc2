use crate::Error;
use crate::gaussian::MANY;
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

/// A symmetric N × N covariance P, of which only the lower triangle is stored.
///
/// The upper triangle is never written nor read, so P cannot lose its symmetry, whatever the rounding. It stays
/// positive, too: predictions and updates add to the diagonal what rounding may take from it ([`Scalar::rounding`]; see
/// the crate's documentation). The storage is a plain [`SMatrix`]: [`Covariance::to_matrix`] gives the whole P.
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
pub struct Covariance<T: Scalar, const N: usize> {
    /// P in the entries with row ≥ column; the others stay zero. Indexed as `lower.data.0[column][row]`: through
    /// [`Columns`](kestirim_scalar::Columns), filters take 4 % more stack at opt-level "s".
    #[cfg_attr(feature = "serde", serde(deserialize_with = "lower_triangle"))]
    lower: SMatrix<T, N, N>,
}

/// Deserialises a triangle, whose variances must not be negative, nor any entry infinite, nor any above the diagonal
/// nonzero.
#[cfg(feature = "serde")]
fn lower_triangle<'de, D, T, const N: usize>(deserializer: D) -> Result<SMatrix<T, N, N>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: Scalar + serde::Deserialize<'de>,
{
    let lower = <SMatrix<T, N, N> as serde::Deserialize>::deserialize(deserializer)?;
    for (column, entries) in lower.data.0.iter().enumerate() {
        let (above, below) = entries.split_at_checked(column).unwrap_or_default();
        let variance = below.first().is_none_or(|&variance| variance >= T::ZERO);
        let zero = above.iter().all(|&entry| entry == T::ZERO);
        if !(variance && zero && T::all_finite(below)) {
            return Err(serde::de::Error::custom("no covariance"));
        }
    }
    Ok(lower)
}

impl<T: Scalar, const N: usize> Covariance<T, N> {
    /// P = 0: every state is known exactly.
    #[inline]
    pub fn zero() -> Self {
        Self { lower: SMatrix::zeros() }
    }

    /// The covariance of independent states with these variances (unit: the state's, squared).
    #[inline]
    pub fn from_variances(variances: &[T; N]) -> Self {
        let mut covariance = Self::zero();
        for (index, &variance) in variances.iter().enumerate() {
            *covariance.entry(index, index) = variance;
        }
        covariance
    }

    /// P from the lower triangle (row ≥ column) of a full matrix.
    #[inline]
    pub fn from_lower_triangle(matrix: &SMatrix<T, N, N>) -> Self {
        let mut covariance = Self::zero();
        for column in 0..N {
            for row in column..N {
                covariance.lower.data.0[column][row] = matrix.data.0[column][row];
            }
        }
        covariance
    }

    /// The full matrix P, both triangles.
    #[inline]
    pub fn to_matrix(&self) -> SMatrix<T, N, N> {
        let mut matrix = self.lower;
        for column in 0..N {
            for row in column..N {
                matrix.data.0[row][column] = matrix.data.0[column][row];
            }
        }
        matrix
    }

    /// P\[i, j\], or `None` if an index is beyond the state.
    #[inline(always)]
    pub fn get(&self, i: usize, j: usize) -> Option<T> {
        self.lower.data.0.get(i.min(j))?.get(i.max(j)).copied()
    }

    /// The N variances, the diagonal of P.
    #[inline]
    pub fn variances(&self) -> SVector<T, N> {
        let mut variances = SVector::zeros();
        for index in 0..N {
            variances.data.0[0][index] = self.lower.data.0[index][index];
        }
        variances
    }

    /// Whether no stored entry is NaN, infinite or at a limit of fixed point.
    #[inline]
    pub fn is_finite(&self) -> bool {
        T::all_finite(self.lower.data.0.as_flattened())
    }

    #[inline(always)]
    pub(crate) fn has_finite_variances(&self) -> bool {
        let variances: [T; N] = core::array::from_fn(|index| self.lower.data.0[index][index]);
        T::all_finite(&variances)
    }

    /// P ← P + Q.
    #[inline]
    pub fn add(&mut self, noise: &Self) {
        for column in 0..N {
            for row in column..N {
                self.lower.data.0[column][row] += noise.lower.data.0[column][row];
            }
        }
    }

    /// P ← a·P, for a ≥ 0: all standard deviations grow by √a.
    #[inline]
    pub fn scale(&mut self, a: T) {
        for entry in self.lower.data.0.as_flattened_mut() {
            *entry *= a;
        }
    }

    /// P ← P + a·(Q − P) with `other` = Q and a in 0..=1: a blend of two covariances, which is itself one.
    #[inline]
    pub fn blend(&mut self, other: &Self, a: T) {
        for column in 0..N {
            for row in column..N {
                let entry = &mut self.lower.data.0[column][row];
                *entry += (other.lower.data.0[column][row] - *entry) * a;
            }
        }
    }

    /// Adds process noise to state `I` alone (unit: the state's, squared).
    #[inline]
    pub fn add_variance<const I: usize>(&mut self, variance: T) {
        const { assert!(I < N, "the state has no such component") };
        *self.entry(I, I) += variance;
    }

    /// P ← P + v·vᵀ: the covariance of an error that is an unknown multiple, of unit variance, of `vector`.
    #[inline]
    pub fn add_outer(&mut self, vector: &SVector<T, N>) {
        let [vector] = &vector.data.0;
        // Hides the number of states from the compiler: unrolled, 17 states of doubles take six kilobytes.
        let states = core::hint::black_box(N);
        for (j, (column, &other)) in
            self.lower.data.0.iter_mut().zip(vector).enumerate().take(states)
        {
            for (entry, &own) in column.iter_mut().zip(vector).take(states).skip(j) {
                *entry += own * other;
            }
        }
    }

    /// P ← E P Eᵀ with `E = 1 + a·e_I·e_Jᵀ`: state `I` becomes `I + a·J`.
    ///
    /// A transition in which a few states move by others is a product of such shears. A constant-velocity model is one
    /// shear a dimension (`position += dt·velocity`), at N multiplications each, where the dense F P Fᵀ takes 2N³. The
    /// order is that of the updates of the states themselves: where the transition reads the old value of a state, that
    /// state is sheared afterwards. The rounding of a shear is left to [`Gaussian::advance`](crate::Gaussian::advance)
    /// or the next update.
    #[inline(always)]
    pub fn shear<const I: usize, const J: usize>(&mut self, a: T) {
        const { assert!(I < N && J < N && I != J, "a shear joins two different components") };
        self.shear_at(I, J, a);
    }

    /// [`Covariance::shear`] for indices known to be below N and different.
    ///
    /// Each pair has instructions of its own, for size, too: a function that all pairs share takes more flash, stack and time for
    /// four states, and saves 2 to 4 % of the flash for the nine of a foot.
    #[inline(always)]
    pub(crate) fn shear_at(&mut self, i: usize, j: usize, a: T) {
        let cross = self.known(i, j);
        for other in 0..N {
            if other != i {
                let step = a * self.known(j, other);
                self.change(i, other, |entry| entry + step);
            }
        }
        // In E P Eᵀ, P[i, i] gains a·P[i, j] twice: with the cross term before and after the shear.
        let sheared = self.known(i, j);
        self.change(i, i, |entry| entry + a * (cross + sheared));
    }

    /// Sets the variance of state `I`, and its covariances with the other states to zero.
    #[inline]
    pub fn reset_component<const I: usize>(&mut self, variance: T) {
        const { assert!(I < N, "the state has no such component") };
        for other in 0..N {
            *self.entry(I, other) = T::ZERO;
        }
        *self.entry(I, I) = variance;
    }

    /// F P Fᵀ for any F; each entry is rounded twice in fixed point.
    #[inline]
    pub fn transformed(&self, f: &SMatrix<T, N, N>) -> Self {
        let p = self.to_matrix();
        let mut fp = SMatrix::<T, N, N>::zeros();
        for row in 0..N {
            for column in 0..N {
                let mut sum = T::accumulator();
                for k in 0..N {
                    sum = T::mac(sum, f.data.0[k][row], p.data.0[column][k]);
                }
                fp.data.0[column][row] = T::finish(sum);
            }
        }
        let mut result = Self::zero();
        for column in 0..N {
            for row in column..N {
                let mut sum = T::accumulator();
                for k in 0..N {
                    sum = T::mac(sum, fp.data.0[k][row], f.data.0[k][column]);
                }
                result.lower.data.0[column][row] = T::finish(sum);
            }
        }
        result
    }

    /// P hᵀ for a sparse row h whose indices are below N, by the columns of P.
    pub(crate) fn times(&self, row: &[(usize, T)]) -> [T; N] {
        let mut sums = [T::accumulator(); N];
        for &(index, value) in row {
            let columns = self.lower.data.0.iter();
            for (sum, column) in sums.iter_mut().zip(columns).take(index) {
                let entry = column.get(index).copied().unwrap_or(T::ZERO);
                *sum = T::mac(*sum, value, entry);
            }
            let column = self.lower.data.0.get(index).and_then(|column| column.get(index..));
            let (entries, sums) = (column.unwrap_or_default(), sums.get_mut(index..));
            for (sum, &entry) in sums.unwrap_or_default().iter_mut().zip(entries) {
                *sum = T::mac(*sum, value, entry);
            }
        }
        sums.map(T::finish)
    }

    /// P ← P − k·gᵀ for the gain k = g/S and g = P hᵀ; in fixed point the variances become `left`.
    #[inline(always)]
    pub(crate) fn downdate(&mut self, gain: &[T; N], g: &[T; N], left: &[T; N]) {
        if !T::IS_FLOAT {
            return self.downdate_fixed(N, gain, g, left);
        }
        self.absorb_rounding();
        for column in 0..N {
            // Among many states, some have nothing to do with the measurement, such as ambiguities of satellites out of
            // view.
            if N >= MANY && g[column] == T::ZERO {
                continue;
            }
            for row in column..N {
                self.lower.data.0[column][row] -= gain[row] * g[column];
            }
        }
    }

    /// P ← P − k·gᵀ as in [`Covariance::downdate`], for all entries but row and column `i`.
    #[inline(always)]
    pub(crate) fn downdate_beside(&mut self, i: usize, gain: &[T; N], g: &[T; N], left: &[T; N]) {
        if !T::IS_FLOAT {
            return self.downdate_fixed(i, gain, g, left);
        }
        self.absorb_rounding();
        for column in 0..N {
            for row in column..N {
                if row != i && column != i {
                    self.lower.data.0[column][row] -= gain[row] * g[column];
                }
            }
        }
    }

    /// P ← P − k·gᵀ in fixed point for all entries but row and column `but`, if there are such.
    #[inline(always)]
    fn downdate_fixed(&mut self, but: usize, gain: &[T; N], g: &[T; N], left: &[T; N]) {
        // Half a unit of the gain is multiplied by g: where one is large, the smaller of two gives the smaller error.
        let large = g.iter().any(|g| g.abs() > T::ONE);
        for column in 0..N {
            if column == but {
                let variance = &mut self.lower.data.0[column][column];
                *variance += Self::absorbed(*variance, g[column]);
                continue;
            }
            self.lower.data.0[column][column] = left[column];
            if N >= MANY && g[column] == T::ZERO {
                continue;
            }
            for row in column + 1..N {
                if row != but {
                    let larger = large && g[column].abs() > g[row].abs();
                    let (gain, g) =
                        if larger { (gain[column], g[row]) } else { (gain[row], g[column]) };
                    self.lower.data.0[column][row] -= gain * g;
                }
            }
        }
    }

    /// Scales row and column `i` < N by `factor`, their common entry once.
    #[inline(always)]
    pub(crate) fn scale_component(&mut self, i: usize, factor: T) {
        for other in 0..N {
            self.change(i, other, |entry| entry * factor);
        }
    }

    /// Roundings to absorb for an update. The gain, the product and the difference of each entry err by a
    /// rounding of no more than √(P\[i, i\]·P\[j, j\]) each; N such roundings on the diagonal outweigh a matrix
    /// of these errors.
    const ROUNDINGS: u16 = N as u16;

    /// Adds to the diagonal what the rounding of the next step may take from it.
    #[inline(always)]
    pub(crate) fn absorb_rounding(&mut self) {
        for index in 0..N {
            let variance = &mut self.lower.data.0[index][index];
            *variance += variance.rounding(Self::ROUNDINGS);
        }
    }

    /// What rounding may take from a variance of fixed point in an update with this entry of g.
    #[inline(always)]
    fn absorbed(variance: T, g: T) -> T {
        variance.rounding(Self::ROUNDINGS).max(g.abs().rounding(ROUNDINGS_OF_GAIN))
    }

    /// The variances that an update in fixed point leaves, with what its rounding may take from them: half a unit of the gain
    /// counts |g| times. For floats, `left` stays as it is: what is not finite stays so, and is found in the mean.
    ///
    /// # Errors
    /// If the gain or a variance is on a rail, which the update would leave, or if a variance would become negative.
    #[inline(always)]
    pub(crate) fn variances_left(
        &self,
        gain: &[T; N],
        g: &[T; N],
        left: &mut [T; N],
    ) -> Result<(), Error> {
        if T::IS_FLOAT {
            return Ok(());
        }
        if !T::all_finite(gain) {
            return Err(Error::NotFinite);
        }
        for index in 0..N {
            let variance = self.lower.data.0[index][index];
            if !variance.is_finite() {
                return Err(Error::NotFinite);
            }
            left[index] = variance + Self::absorbed(variance, g[index]) - gain[index] * g[index];
            if left[index] < T::ZERO {
                return Err(Error::NotPositive);
            }
        }
        Ok(())
    }

    /// P\[i, j\] for indices below N that the compiler does not know: one bounds check and no panic.
    #[inline(always)]
    pub(crate) fn known(&self, i: usize, j: usize) -> T {
        let place = i.min(j).wrapping_mul(N).wrapping_add(i.max(j));
        self.lower.data.0.as_flattened().get(place).copied().unwrap_or(T::ZERO)
    }

    /// Changes P\[i, j\] for indices below N, with one bounds check and no panic.
    #[inline(always)]
    fn change(&mut self, i: usize, j: usize, change: impl FnOnce(T) -> T) {
        let place = i.min(j).wrapping_mul(N).wrapping_add(i.max(j));
        if let Some(entry) = self.lower.data.0.as_flattened_mut().get_mut(place) {
            *entry = change(*entry);
        }
    }

    /// P\[i, j\] for indices known to be below N.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize, j: usize) -> T {
        if i >= j { self.lower.data.0[j][i] } else { self.lower.data.0[i][j] }
    }

    #[inline(always)]
    pub(crate) fn entry(&mut self, i: usize, j: usize) -> &mut T {
        if i >= j { &mut self.lower.data.0[j][i] } else { &mut self.lower.data.0[i][j] }
    }
}

/// Roundings of the gain to absorb in fixed point. Errors of many entries are as often positive as negative.
const ROUNDINGS_OF_GAIN: u16 = 4;
