use crate::carried::{Carried, mac};
use crate::dense::{less_identity, less_product, negative};
use crate::integers::{and_magnitudes, exponents, integers, scaled, shifts};
use crate::rows::{IntegerRows, Rows};
use crate::{Error, Plant};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

/// The coefficients of a [`DisturbanceObserver`] observer, independent of its scalar.
///
/// In a `const` it costs a target no double-precision arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisturbanceGains<const N: usize, const M: usize, const P: usize, const D: usize> {
    exponents: [i32; N],
    state: [[i64; N]; N],
    entry: [[i64; N]; D],
    input: [[i64; N]; M],
    output: [[i64; N]; P],
    learning_exponents: [i32; D],
    learning: [[i64; D]; P],
    unseen_state: IntegerRows<P, N>,
    unseen_learnt: IntegerRows<P, D>,
}

impl<const N: usize, const M: usize, const P: usize, const D: usize> DisturbanceGains<N, M, P, D> {
    /// From x⁺ = A x + B u + E d, y = C x + S d, d⁺ = d, and the gains of the augmented observer.
    ///
    /// `e` is N × D (a column of B for a disturbance of that input), `s` is P × D (a unit vector for the bias of
    /// an output; zero else). `l_state` (N × P) above `l_disturbance` (D × P) is the gain L that places the poles
    /// of \[A, E; 0, I\] − L \[C, S\], or that of its settled Kalman filter in predictor form.
    pub const fn new(
        plant: &Plant<N, M, P>,
        e: &SMatrix<f64, N, D>,
        s: &SMatrix<f64, P, D>,
        l_state: &SMatrix<f64, N, P>,
        l_disturbance: &SMatrix<f64, D, P>,
    ) -> Self {
        let (b, c, s) = (&plant.b.data.0, &plant.c.data.0, &s.data.0);
        let (output, learning) = (&l_state.data.0, &l_disturbance.data.0);
        let entry = less_product(&e.data.0, output, s);
        let state = less_product(&less_identity(&plant.a.data.0), output, c);
        let of_states = and_magnitudes(and_magnitudes([0.0; N], &state), &entry);
        let exponents_of_states = exponents(and_magnitudes(and_magnitudes(of_states, b), output));
        let learning_exponents = exponents(and_magnitudes([0.0; D], learning));
        Self {
            exponents: exponents_of_states,
            state: integers(&state, &exponents_of_states),
            entry: integers(&entry, &exponents_of_states),
            input: integers(b, &exponents_of_states),
            output: integers(output, &exponents_of_states),
            learning_exponents,
            learning: integers(learning, &learning_exponents),
            unseen_state: IntegerRows::new(&negative(c)),
            unseen_learnt: IntegerRows::new(&negative(s)),
        }
    }
}

/// An observer of N states and D constant or slowly changing disturbances, in predictor form:
/// `x̂⁺ = A x̂ + B u + E d̂ + L_x ν`, `d̂⁺ = d̂ + L_d ν` with ν = y − C x̂ − S d̂.
///
/// A plant under a constant disturbance leaves an ordinary observer with a constant error; this one has an
/// integrator for it. Tell it what the actuators applied ([`Saturation`](crate::Saturation)): the
/// difference to what was commanded would be learnt as a disturbance. It can tell disturbances apart only
/// if the augmented pair is observable: no more disturbances than outputs.
///
/// Units are the plant's; a disturbance that enters as an input has the input's. Cost:
/// N (N + D + M + P) + P (N + 2 D) multiplications.
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
pub struct DisturbanceObserver<
    T: Scalar,
    const N: usize,
    const M: usize,
    const P: usize,
    const D: usize,
> {
    estimate: Carried<T, N>,
    learnt: Carried<T, D>,
    /// A − I − `L_x` C, E − `L_x` S, B and `L_x`; row i is scaled by 2^shift i.
    state: SMatrix<T, N, N>,
    entry: SMatrix<T, N, D>,
    input: SMatrix<T, N, M>,
    output: SMatrix<T, N, P>,
    shifts: SVector<u32, N>,
    /// `L_d`, scaled likewise.
    learning: SMatrix<T, D, P>,
    learning_shifts: SVector<u32, D>,
    /// −C and −S.
    unseen_state: Rows<T, P, N>,
    unseen_learnt: Rows<T, P, D>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize, const D: usize>
    DisturbanceObserver<T, N, M, P, D>
{
    /// An observer that starts at this state and with these disturbances (usually zero).
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::TooLarge`].
    #[inline]
    pub fn new(
        gains: &DisturbanceGains<N, M, P, D>,
        start: &SVector<T, N>,
        disturbance: &SVector<T, D>,
    ) -> Result<Self, Error> {
        let (exponents, learning_exponents) = (&gains.exponents, &gains.learning_exponents);
        let shifts_of_states = shifts::<T, N>(exponents)?;
        let learning_shifts = shifts::<T, D>(learning_exponents)?;
        Ok(Self {
            estimate: Carried::new(start)?,
            learnt: Carried::new(disturbance)?,
            state: scaled(&gains.state, exponents, &shifts_of_states),
            entry: scaled(&gains.entry, exponents, &shifts_of_states),
            input: scaled(&gains.input, exponents, &shifts_of_states),
            output: scaled(&gains.output, exponents, &shifts_of_states),
            shifts: shifts_of_states,
            learning: scaled(&gains.learning, learning_exponents, &learning_shifts),
            learning_shifts,
            unseen_state: Rows::new(&gains.unseen_state)?,
            unseen_learnt: Rows::new(&gains.unseen_learnt)?,
        })
    }

    /// Starts again at this state and with these disturbances.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn reset(
        &mut self,
        start: &SVector<T, N>,
        disturbance: &SVector<T, D>,
    ) -> Result<(), Error> {
        (self.estimate, self.learnt) = (Carried::new(start)?, Carried::new(disturbance)?);
        Ok(())
    }

    /// x̂, the state at the time of the next measurement.
    #[inline]
    pub const fn estimate(&self) -> &SVector<T, N> {
        &self.estimate.value
    }

    /// d̂, the disturbances.
    #[inline]
    pub const fn disturbance(&self) -> &SVector<T, D> {
        &self.learnt.value
    }

    /// y − C x̂ − S d̂, by which [`DisturbanceObserver::step`] with this measurement would correct.
    #[inline]
    pub fn innovation(&self, measured: &SVector<T, P>) -> SVector<T, P> {
        let unexpected = self.unseen_state.added(measured, &self.estimate.value);
        self.unseen_learnt.added(&unexpected, &self.learnt.value)
    }

    /// Moves on with what the actuators applied and the sensors measured at the estimate's time; answers with
    /// the innovation.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; state and disturbances are untouched.
    #[inline]
    pub fn step(
        &mut self,
        input: &SVector<T, M>,
        measured: &SVector<T, P>,
    ) -> Result<SVector<T, P>, Error> {
        let innovation = self.innovation(measured);
        let arguments = [&innovation.data.0[0], &measured.data.0[0]];
        if !(T::all_finite(&input.data.0[0]) && arguments.iter().all(|&all| T::all_finite(all))) {
            return Err(Error::NotFinite);
        }
        let mut sums = self.estimate.sums();
        mac(&mut sums, &self.state, &self.estimate.value);
        mac(&mut sums, &self.entry, &self.learnt.value);
        mac(&mut sums, &self.input, input);
        mac(&mut sums, &self.output, measured);
        let estimate = self.estimate.advanced(&sums, &self.shifts)?;
        let mut sums = self.learnt.sums();
        mac(&mut sums, &self.learning, &innovation);
        let learnt = self.learnt.advanced(&sums, &self.learning_shifts)?;
        (self.estimate, self.learnt) = (estimate, learnt);
        Ok(innovation)
    }
}
