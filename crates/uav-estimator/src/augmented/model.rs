use kestirim_observer_design::{Discrete, Error as DesignError};
use kestirim_scalar::{Columns, Components};
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{SMatrix, SVector};

use super::discretise::Flow;
use super::{Output, Reference};
use crate::Error;
use crate::flight_filter::UNKNOWN;
use crate::transitions::Moves;

/// Indices of α, q and V among the states.
const ALPHA: usize = 0;
const RATE: usize = 1;
const AIRSPEED: usize = 2;

/// An unknown constant, or a slow random walk.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Drift {
    /// Initial standard deviation, in the quantity's unit.
    pub sigma: f64,
    /// Random-walk rate: the standard deviation after one second, in the quantity's unit per √s.
    pub rate: f64,
}

/// Gusts as first-order processes carried past at the airspeed: Dryden's along the path (MIL-F-8785C), and one of the
/// same form across it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gust {
    /// Standard deviations along (u) and across (w) the path, m/s.
    pub sigmas: [f64; 2],
    /// Length scales along and across the path, m.
    pub lengths: [f64; 2],
    /// Airspeed V₀ of the steady flight, m/s.
    pub airspeed: f64,
}

/// A linear model of an aircraft with disturbances and sensor errors.
///
/// It has P outputs and N states: the first four are the deviations of α, q, V and θ, and the first K are those that
/// drive these four.
///
/// α and V are relative to the surrounding air, gusts included. Gusts take two of the K − 4 states, an unknown force
/// one; each bias takes one of the N − K others, as do the wind and the density. Unused states remain zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AugmentedModel<const N: usize, const K: usize, const P: usize> {
    a: SMatrix<f64, N, N>,
    b: SMatrix<f64, N, 2>,
    /// Spectral density of the white noise on ẋ, in units²·s.
    density: SMatrix<f64, N, N>,
    /// Initial standard deviations of the states.
    pub(super) start: SVector<f64, N>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(super) outputs: [Output; P],
    /// Output matrix C.
    pub(super) c: SMatrix<f64, P, N>,
    /// End of the used states among the first K, and among the others.
    taken: [u8; 2],
}

/// A step of all states: x⁺ = A x + B u + w.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AugmentedStep<const N: usize> {
    /// A and B.
    pub transition: Discrete<N, 2>,
    /// Q, the covariance of w.
    pub noise: SMatrix<f64, N, N>,
}

impl<const N: usize, const K: usize, const P: usize> AugmentedModel<N, K, P> {
    /// Creates the model ẋ = A x + B u + w with these outputs; `density` is the spectral density of the white noise w
    /// (units²·s of ẋ). The four states are initially unknown: 0.2 rad, 0.5 rad/s, 20 m/s, 0.5 rad.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(
        plant: &StateSpace,
        density: &SMatrix<f64, 4, 4>,
        outputs: &[Output; P],
    ) -> Result<Self, Error> {
        const { assert!(4 <= K && K <= N && N < 256, "four states move, by the first K of N") };
        let given = |row: usize| {
            outputs.get(row).is_some_and(|output| {
                let numbers = output.row.iter().chain(&output.direct).chain([&output.sigma]);
                let steady = match &output.reference {
                    Reference::Pressure { steady, airspeed } => {
                        steady.is_finite() && airspeed.is_normal()
                    }
                    _ => true,
                };
                steady && numbers.copied().all(f64::is_finite)
            })
        };
        let matrices = plant.a.iter().chain(&plant.b).chain(density);
        if !(matrices.copied().all(f64::is_finite) && (0..P).all(given)) {
            return Err(Error::NotFinite);
        }
        let mut start = SVector::<f64, N>::zeros();
        let (mut a, mut b) = (SMatrix::<f64, N, N>::zeros(), SMatrix::<f64, N, 2>::zeros());
        let (mut c, mut q) = (SMatrix::<f64, P, N>::zeros(), SMatrix::<f64, N, N>::zeros());
        for state in 0..4 {
            start.as_array_mut()[state] = UNKNOWN[state];
            for row in 0..4 {
                a.as_columns_mut()[state][row] = plant.a.as_columns()[state][row];
                q.as_columns_mut()[state][row] = density.as_columns()[state][row];
            }
            for input in 0..2 {
                b.as_columns_mut()[input][state] = plant.b.as_columns()[input][state];
            }
            for (part, output) in c.as_columns_mut()[state].iter_mut().zip(outputs) {
                *part = output.row[state];
            }
        }
        Ok(Self { a, b, density: q, start, outputs: *outputs, c, taken: [4, K as u8] })
    }

    /// Adds a bias of one of the outputs, in its unit.
    ///
    /// # Errors
    /// [`Error::NoRoom`] if all of the last N − K states are used, or there is no such output; [`Error::NotFinite`].
    pub fn with_bias(mut self, output: usize, drift: &Drift) -> Result<Self, Error> {
        let state = self.place(1, output < P)?;
        self.drifting(state, drift)?;
        if let Some(part) = self.c.get_mut((output, state)) {
            *part = 1.0;
        }
        Ok(self)
    }

    /// Adds a head wind (m/s), which is subtracted from outputs relative to the ground.
    ///
    /// # Errors
    /// [`Error::NoRoom`] if all of the last N − K states are used; [`Error::NotFinite`].
    pub fn with_wind(mut self, drift: &Drift) -> Result<Self, Error> {
        let state = self.place(1, true)?;
        self.drifting(state, drift)?;
        self.grounded(state, AIRSPEED, 1.0);
        Ok(self)
    }

    /// Adds an unknown density of the air, relative to that of the steady flight, to which outputs proportional to
    /// the dynamic pressure are proportional, too.
    ///
    /// # Errors
    /// [`Error::NoRoom`] if all of the last N − K states are used; [`Error::NotFinite`].
    pub fn with_density(mut self, drift: &Drift) -> Result<Self, Error> {
        let state = self.place(1, true)?;
        self.drifting(state, drift)?;
        for (output, known) in self.outputs.iter().enumerate() {
            if let Reference::Pressure { steady, .. } = known.reference
                && let Some(part) = self.c.get_mut((output, state))
            {
                *part = steady;
            }
        }
        Ok(self)
    }

    /// Adds an unknown part of a state's derivative, constant or a slow random walk, in the state's unit per second:
    /// it represents a trim different from the assumed one.
    ///
    /// # Errors
    /// [`Error::NoRoom`] if all of the first K states are used, or the state is none of the four;
    /// [`Error::NotFinite`].
    pub fn with_force(mut self, moved: usize, drift: &Drift) -> Result<Self, Error> {
        let state = self.place(0, moved < 4)?;
        self.drifting(state, drift)?;
        if let Some(part) = self.a.get_mut((moved, state)) {
            *part = 1.0;
        }
        Ok(self)
    }

    /// Adds gusts along and across the path, which act as V and α do, and change the measurements of these.
    ///
    /// The tail feels a gust across the path later than the wing, which turns the aircraft. This is approximated by
    /// white noise: the derivative of the gust's angle times half the pitch damping.
    ///
    /// # Errors
    /// [`Error::NoRoom`] if fewer than two of the first K states are free; [`Error::NotFinite`], also for a length
    /// scale or an airspeed of zero.
    pub fn with_gust(mut self, gust: &Gust) -> Result<Self, Error> {
        let felt = [(AIRSPEED, 1.0), (ALPHA, 1.0 / gust.airspeed)];
        for ((sigma, length), (moved, share)) in gust.sigmas.iter().zip(gust.lengths).zip(felt) {
            let state = self.place(0, true)?;
            let fading = gust.airspeed / length;
            self.drifting(state, &Drift { sigma: *sigma, rate: 0.0 })?;
            let density = 2.0 * sigma * sigma * fading;
            if !(fading >= 0.0 && share.is_finite() && density.is_finite()) {
                return Err(Error::NotFinite);
            }
            // A gust changes the air-relative α or V through its own derivative: −g/τ plus white noise.
            for (place, value) in [((state, state), -fading), ((moved, state), -fading * share)] {
                if let Some(part) = self.a.get_mut(place) {
                    *part += value;
                }
            }
            for (place, value) in [
                ((state, state), 1.0),
                ((moved, state), share),
                ((state, moved), share),
                ((moved, moved), share * share),
            ] {
                if let Some(part) = self.density.get_mut(place) {
                    *part += value * density;
                }
            }
            self.grounded(state, moved, share);
            if moved == ALPHA {
                let lag = 0.5 * self.a.as_columns()[RATE][RATE] * share;
                self.density.as_columns_mut()[RATE][RATE] += lag * lag * density;
            }
        }
        Ok(self)
    }

    /// Reserves the next free state of the first K (`of` = 0) or of the others (1).
    fn place(&mut self, of: usize, is_there: bool) -> Result<usize, Error> {
        let end = if of == 0 { K } else { N };
        let taken = self.taken.get_mut(of).filter(|taken| is_there && usize::from(**taken) < end);
        let taken = taken.ok_or(Error::NoRoom)?;
        *taken += 1;
        Ok(usize::from(*taken) - 1)
    }

    fn drifting(&mut self, state: usize, drift: &Drift) -> Result<(), Error> {
        let variance = drift.rate * drift.rate;
        if !((drift.sigma * drift.sigma).is_finite() && variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        if let Some(start) = self.start.get_mut(state) {
            *start = drift.sigma.abs();
        }
        if let Some(density) = self.density.get_mut((state, state)) {
            *density = variance;
        }
        Ok(())
    }

    /// Subtracts a state's contribution to one of the four from the outputs relative to the ground.
    fn grounded(&mut self, state: usize, moved: usize, share: f64) {
        for (output, known) in self.outputs.iter().enumerate() {
            if known.reference == Reference::Ground
                && let Some(part) = self.c.get_mut((output, state))
            {
                *part -= known.row.get(moved).copied().unwrap_or(0.0) * share;
            }
        }
    }

    /// Whether both models have the same states with equal initial standard deviations.
    pub(super) fn has_states_of(&self, other: &Self) -> bool {
        self.taken == other.taken && self.start == other.start
    }

    /// Initial standard deviations of all states.
    pub const fn start(&self) -> &SVector<f64, N> {
        &self.start
    }

    /// The step of the model over `interval` (s), with white noise of the standard deviations `noise` (rad; 1) per
    /// `sample` (s) on the inputs δe and δt in addition to that on ẋ.
    ///
    /// # Errors
    /// [`Error::Design`] if an argument or the result is not finite, or the interval is not positive.
    pub fn over(
        &self,
        interval: f64,
        sample: f64,
        noise: &SVector<f64, 2>,
    ) -> Result<AugmentedStep<N>, Error> {
        let variances = SMatrix::from_diagonal(&noise.map(|sigma| sigma * sigma));
        let density = self.density + self.b * variances * self.b.transpose() * sample;
        if !(interval.is_finite() && density.iter().copied().all(f64::is_finite)) {
            return Err(DesignError::NotFinite.into());
        }
        if interval <= 0.0 {
            return Err(DesignError::Interval.into());
        }
        let flow = Flow::<N, K>::new(&self.a, &density, interval).ok_or(DesignError::NotFinite)?;
        let mut a = flow.transition;
        // In fixed point, rounding errors would accumulate in unused states that are remembered.
        let [moving, others] = self.taken.map(usize::from);
        for state in (moving..K).chain(others..N) {
            if let Some(part) = a.as_columns_mut().get_mut(state).and_then(|it| it.get_mut(state)) {
                *part = 0.0;
            }
        }
        let transition = Discrete { a, b: flow.integral * self.b };
        Ok(AugmentedStep { transition, noise: flow.noise })
    }
}

impl<const N: usize, const K: usize, const P: usize> Moves for AugmentedModel<N, K, P> {
    type Step = AugmentedStep<N>;

    fn over(
        &self,
        interval: f64,
        sample: f64,
        noise: &SVector<f64, 2>,
    ) -> Result<AugmentedStep<N>, Error> {
        Self::over(self, interval, sample, noise)
    }
}
