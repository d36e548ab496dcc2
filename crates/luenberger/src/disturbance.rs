use crate::carried::{Carried, mac};
use crate::dense::{less_identity, less_product, negative};
use crate::increment::{Increment, IntegerIncrement};
use crate::integers::{and_magnitudes, exponents, integers, scaled};
use crate::rows::{IntegerRows, Rows};
use crate::{Error, Plant};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficients of a [`DisturbanceObserver`], independent of its scalar type.
///
/// As a `const`, they need no double-precision arithmetic on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisturbanceGains<const N: usize, const M: usize, const P: usize, const D: usize> {
    step: IntegerIncrement<N, M, P>,
    entry: [[i64; N]; D],
    learning: IntegerRows<D, P>,
    unseen_state: IntegerRows<P, N>,
    unseen_learnt: IntegerRows<P, D>,
}

impl<const N: usize, const M: usize, const P: usize, const D: usize> DisturbanceGains<N, M, P, D> {
    /// The coefficients for x⁺ = A x + B u + E d, y = C x + S d, d⁺ = d, and the gains of the augmented observer.
    ///
    /// `e` is N × D (a column of B for a disturbance of that input), `s` is P × D (a unit vector for the bias of
    /// an output; otherwise zero). `l_state` (N × P) above `l_disturbance` (D × P) is the gain L that places the poles
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
        Self {
            step: IntegerIncrement::with(exponents_of_states, &state, b, output),
            entry: integers(&entry, &exponents_of_states),
            learning: IntegerRows::new(learning),
            unseen_state: IntegerRows::new(&negative(c)),
            unseen_learnt: IntegerRows::new(&negative(s)),
        }
    }
}

/// An observer of N states and D constant or slowly changing disturbances, in predictor form:
/// `x̂⁺ = A x̂ + B u + E d̂ + L_x ν`, `d̂⁺ = d̂ + L_d ν` with ν = y − C x̂ − S d̂.
///
/// Under a constant disturbance, an ordinary observer keeps a constant error; this one has an
/// integrator for it. Pass it what the actuators applied ([`Saturation`](crate::Saturation)): the
/// difference from the command would be learnt as a disturbance. Disturbances can be told apart only
/// if the augmented pair is observable, which requires no more disturbances than outputs.
///
/// Units are the plant's; a disturbance that enters like an input has the unit of that input. Cost:
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
    /// The increment with the blocks A − I − `L_x` C, B and `L_x`.
    step: Increment<T, N, M, P>,
    /// E − `L_x` S, scaled like the blocks of `step`.
    entry: SMatrix<T, N, D>,
    /// `L_d`, the gain of the disturbances.
    learning: Rows<T, D, P>,
    /// −C and −S, which yield the innovation.
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
        let step = Increment::new(&gains.step)?;
        Ok(Self {
            estimate: Carried::new(start)?,
            learnt: Carried::new(disturbance)?,
            entry: scaled(&gains.entry, &gains.step.exponents, &step.shifts),
            step,
            learning: Rows::new(&gains.learning)?,
            unseen_state: Rows::new(&gains.unseen_state)?,
            unseen_learnt: Rows::new(&gains.unseen_learnt)?,
        })
    }

    /// Restarts at this state and with these disturbances.
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

    /// d̂, the disturbances as estimated so far.
    #[inline]
    pub const fn disturbance(&self) -> &SVector<T, D> {
        &self.learnt.value
    }

    /// y − C x̂ − S d̂, the innovation that [`DisturbanceObserver::step`] with this measurement would use.
    #[inline]
    pub fn innovation(&self, measured: &SVector<T, P>) -> SVector<T, P> {
        let [_, innovation] = self.differences(measured);
        innovation
    }

    /// y − C x̂, and y − C x̂ − S d̂.
    #[inline]
    fn differences(&self, measured: &SVector<T, P>) -> [SVector<T, P>; 2] {
        let unexpected = self.unseen_state.added(measured, &self.estimate.value);
        [unexpected, self.unseen_learnt.added(&unexpected, &self.learnt.value)]
    }

    /// Moves on by one step with the inputs that the actuators applied and a measurement made at the estimate's time;
    /// returns the innovation.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; state and disturbances are untouched.
    #[inline]
    pub fn step(
        &mut self,
        input: &SVector<T, M>,
        measured: &SVector<T, P>,
    ) -> Result<SVector<T, P>, Error> {
        let [unexpected, innovation] = self.differences(measured);
        // In fixed point each sum may leave the rail of the one before.
        let arguments = [innovation.as_array(), unexpected.as_array(), measured.as_array()];
        if !(T::all_finite(input.as_array()) && arguments.iter().all(|&all| T::all_finite(all))) {
            return Err(Error::NotFinite);
        }
        let mut sums = self.step.driven(&self.estimate, input);
        mac(&mut sums, &self.entry, &self.learnt.value);
        self.step.and_output(&mut sums, measured);
        let estimate = self.estimate.advanced(&sums, &self.step.shifts)?;
        let learnt = self.learning.advanced(&self.learnt, &innovation)?;
        (self.estimate, self.learnt) = (estimate, learnt);
        Ok(innovation)
    }
}
