use crate::Error;
use crate::carried::Carried;
use crate::dense::{Dense, all, less_identity, less_product, negative, part};
use crate::increment::{Increment, IntegerIncrement};
use crate::rows::{IntegerRows, Rows};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficients of a [`ReducedObserver`] of N states, P of them measured and R not, with M inputs.
///
/// They are independent of the scalar type of the observer. As a `const`, they need no double-precision arithmetic on
/// the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedGains<const N: usize, const M: usize, const P: usize, const R: usize> {
    measured: [usize; P],
    unmeasured: [usize; R],
    step: IntegerIncrement<R, M, P>,
    shown: IntegerRows<R, P>,
    hidden: IntegerRows<R, P>,
}

impl<const N: usize, const M: usize, const P: usize, const R: usize> ReducedGains<N, M, P, R> {
    /// The coefficients for a plant x⁺ = A x + B u, the indices of the measured states (in the order of the outputs),
    /// and the gain L, R × P, that places the poles of `A_uu − L A_mu` (u: the unmeasured states in ascending order, m:
    /// the measured states).
    ///
    /// # Errors
    /// [`Error::WrongState`]. In a `const`, use `match … { Ok(gains) => gains, Err(_) => panic!() }`.
    pub const fn new(
        a: &SMatrix<f64, N, N>,
        b: &SMatrix<f64, N, M>,
        measured: &[usize; P],
        l: &SMatrix<f64, R, P>,
    ) -> Result<Self, Error> {
        const { assert!(P + R == N, "a state is either measured or not") };
        let Some(unmeasured) = others::<N, P, R>(measured) else { return Err(Error::WrongState) };
        let (a, b, l) = (&a.data.0, &b.data.0, &l.data.0);
        let inputs = all::<M>();
        let from_unmeasured = part(a, measured, &unmeasured);
        let state =
            less_product(&less_identity(&part(a, &unmeasured, &unmeasured)), l, &from_unmeasured);
        let input: Dense<R, M> =
            less_product(&part(b, &unmeasured, &inputs), l, &part(b, measured, &inputs));
        // G = A_um − L A_mm + F L = A_um + L − L A_mm + (F − I) L.
        let direct: Dense<R, P> = less_product(
            &part(a, &unmeasured, measured),
            l,
            &less_identity(&part(a, measured, measured)),
        );
        let output = less_product(&direct, &negative(&state), l);
        Ok(Self {
            measured: *measured,
            unmeasured,
            step: IntegerIncrement::new(&state, &input, &output),
            shown: IntegerRows::new(l),
            hidden: IntegerRows::new(&negative(l)),
        })
    }
}

/// The unmeasured states in ascending order; `None` if an index of a measured state is beyond N or given twice.
const fn others<const N: usize, const P: usize, const R: usize>(
    measured: &[usize; P],
) -> Option<[usize; R]> {
    let mut is_measured = [false; N];
    let mut i = 0;
    while i < P {
        if measured[i] >= N || is_measured[measured[i]] {
            return None;
        }
        is_measured[measured[i]] = true;
        i += 1;
    }
    let mut others = [0; R];
    let (mut state, mut count) = (0, 0);
    while state < N && count < R {
        if !is_measured[state] {
            others[count] = state;
            count += 1;
        }
        state += 1;
    }
    Some(others)
}

/// A reduced-order observer, which estimates only the unmeasured states: w⁺ = F w + G y + H u, `x̂_u = w + L y`.
///
/// `F = A_uu − L A_mu`, `G = F L + A_um − L A_mm`, `H = B_u − L B_m` (Luenberger 1971). The estimate responds to a
/// measurement at once, as in the current form, and also to its noise: measured states are taken as they are.
///
/// Units are the plant's. Cost: R (R + 2 P + M) multiplications.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
    ))
)]
pub struct ReducedObserver<
    T: Scalar,
    const N: usize,
    const M: usize,
    const P: usize,
    const R: usize,
> {
    measured: SVector<usize, P>,
    unmeasured: SVector<usize, R>,
    w: Carried<T, R>,
    /// The increment with the blocks F − I, H and G.
    step: Increment<T, R, M, P>,
    /// L and −L, which add or remove the share of the measurement.
    shown: Rows<T, R, P>,
    hidden: Rows<T, R, P>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize, const R: usize>
    ReducedObserver<T, N, M, P, R>
{
    /// An observer that starts with these unmeasured states and the measurement made at the same time.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::TooLarge`].
    #[inline]
    pub fn new(
        gains: &ReducedGains<N, M, P, R>,
        unmeasured: &SVector<T, R>,
        measured: &SVector<T, P>,
    ) -> Result<Self, Error> {
        let hidden = Rows::new(&gains.hidden)?;
        Ok(Self {
            measured: SVector::from(gains.measured),
            unmeasured: SVector::from(gains.unmeasured),
            w: start(&hidden, unmeasured, measured)?,
            step: Increment::new(&gains.step)?,
            shown: Rows::new(&gains.shown)?,
            hidden,
        })
    }

    /// Restarts with these unmeasured states and the measurement made at the same time.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn reset(
        &mut self,
        unmeasured: &SVector<T, R>,
        measured: &SVector<T, P>,
    ) -> Result<(), Error> {
        self.w = start(&self.hidden, unmeasured, measured)?;
        Ok(())
    }

    /// `x̂_u`, the unmeasured states at the time of this measurement, in ascending order of their indices.
    #[inline]
    pub fn unmeasured(&self, measured: &SVector<T, P>) -> SVector<T, R> {
        self.shown.added(&self.w.value, measured)
    }

    /// All states at the time of this measurement, the measured ones as measured.
    #[inline]
    pub fn estimate(&self, measured: &SVector<T, P>) -> SVector<T, N> {
        let mut estimate = SVector::<T, N>::from([T::ZERO; N]);
        let estimated = self.unmeasured(measured);
        let values = measured.as_array().iter().chain(estimated.as_array());
        let indices = self.measured.as_array().iter().chain(self.unmeasured.as_array());
        for (&index, &value) in indices.zip(values) {
            if let Some(state) = estimate.as_array_mut().get_mut(index) {
                *state = value;
            }
        }
        estimate
    }

    /// Moves on to the time of the next measurement, with this measurement and the inputs applied from now on.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn step(&mut self, input: &SVector<T, M>, measured: &SVector<T, P>) -> Result<(), Error> {
        self.w = self.step.advanced(&self.w, input, measured)?;
        Ok(())
    }
}

/// The initial `w = x_u − L y`.
fn start<T: Scalar, const P: usize, const R: usize>(
    hidden: &Rows<T, R, P>,
    unmeasured: &SVector<T, R>,
    measured: &SVector<T, P>,
) -> Result<Carried<T, R>, Error> {
    if !(T::all_finite(unmeasured.as_array()) && T::all_finite(measured.as_array())) {
        return Err(Error::NotFinite);
    }
    Carried::new(&hidden.added(unmeasured, measured))
}
