//! Forces along the flight path: steady flight, and linear models near it.

use core::array::from_fn;
use core::f64::consts::FRAC_PI_2;

use kestirim_scalar::Components;
use nalgebra::{SMatrix, SVector};

use crate::dual::Dual;
use crate::solve::solve;
use crate::{Airframe, Drag, Error, LongitudinalDerivatives, StateSpace};

/// Limit of Newton's iteration, which doubles the number of digits in each step; from zero it takes seven or eight
/// steps.
const MOST_STEPS: u32 = 50;
/// Size of a step, relative to 1 plus the unknown, that is due to rounding errors alone.
const LAST_STEP: f64 = 1e-14;
/// Largest angle of attack if no stall is given, rad: there the flow over no plain wing stays attached any more.
const STALLED: f64 = 0.35;

/// A straight flight in which only the position changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SteadyFlight {
    /// Airspeed V, m/s.
    pub airspeed: f64,
    /// Climb angle γ, rad.
    pub climb_angle: f64,
}

/// States and inputs of a steady flight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Trim {
    /// The states α (rad), q (rad/s), V (m/s), θ (rad).
    pub state: SVector<f64, 4>,
    /// The inputs δe (rad) and δt (0 to 1).
    pub input: SVector<f64, 2>,
}

/// Specific forces `ax` and `az` along the body's axes, forwards and down, near a steady flight: `steady` + C·x +
/// D·u.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpecificForce {
    /// Specific force in the steady flight, m/s².
    pub steady: SVector<f64, 2>,
    /// C: derivatives with respect to the states.
    pub c: SMatrix<f64, 2, 4>,
    /// D: derivatives with respect to the inputs.
    pub d: SMatrix<f64, 2, 2>,
}

impl Airframe {
    /// Rates of the state α, q, V, θ under elevator δe and throttle δt, per second.
    ///
    /// With lift L, drag D, thrust T along the body's x axis, pitching moment M and γ = θ − α:
    /// α̇ = q − (L + T·sin α)/(m·V) + g·cos γ/V, q̇ = M/Jy, V̇ = (T·cos α − D)/m − g·sin γ, θ̇ = q.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] for an airspeed that is not positive.
    pub fn rates(
        &self,
        state: &SVector<f64, 4>,
        input: &SVector<f64, 2>,
    ) -> Result<SVector<f64, 4>, Error> {
        self.differentiated(state, input).map(|rates| rates.map(|rate| rate.value).into())
    }

    /// Finds angle of attack, elevator and throttle of a steady flight, by Newton's method.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotPositive`], [`Error::BeyondVertical`], [`Error::NotConverged`],
    /// [`Error::BeyondStall`], [`Error::BeyondThrottle`].
    pub fn trim(&self, flight: &SteadyFlight) -> Result<Trim, Error> {
        let SteadyFlight { airspeed, climb_angle } = *flight;
        if climb_angle.is_finite() && libm::fabs(climb_angle) >= FRAC_PI_2 {
            return Err(Error::BeyondVertical);
        }
        let most = self.lift.stall.map_or(STALLED, |stall| stall.alpha);
        let point = |alpha: f64, elevator: f64, throttle: f64| Trim {
            state: SVector::from([alpha, 0.0, airspeed, alpha + climb_angle]),
            input: SVector::from([elevator, throttle]),
        };
        // The propeller windmills at zero thrust, a throttle of V/`k_motor`; the start is above it, as the parabola
        // of thrust falls below.
        let mut unknown = [0.0, 0.0, 1.2 * airspeed / self.propeller.motor];
        for _ in 0..MOST_STEPS {
            let [alpha, elevator, throttle] = unknown;
            let Trim { state, input } = point(alpha, elevator, throttle);
            let rates = self.differentiated(&state, &input)?;
            // θ changes along with α, at a constant climb angle.
            let slope = SMatrix::<f64, 3, 3>::from_fn(|row, column| {
                let partial = &rates[row].gradient;
                [partial[0] + partial[3], partial[4], partial[5]][column]
            });
            let miss = SVector::<f64, 3>::from_fn(|row, _| rates[row].value);
            let step = solve(slope, miss).map_err(|error| match error {
                Error::Singular => Error::NotConverged,
                other => other,
            })?;
            let small =
                |i: usize| libm::fabs(step[i]) <= LAST_STEP * (1.0 + libm::fabs(unknown[i]));
            let settled = (0..3).all(small);
            unknown = from_fn(|i| unknown[i] - step[i]);
            if settled {
                let [alpha, elevator, throttle] = unknown;
                if !(0.0..=1.0).contains(&throttle) {
                    return Err(Error::BeyondThrottle);
                }
                if libm::fabs(alpha) > most {
                    return Err(Error::BeyondStall);
                }
                return Ok(point(alpha, elevator, throttle));
            }
        }
        Err(Error::NotConverged)
    }

    /// The linear model of deviations from a flight, with exact derivatives.
    ///
    /// # Errors
    /// Those of [`Airframe::rates`].
    pub fn linearise(&self, trim: &Trim) -> Result<StateSpace, Error> {
        let rates = self.differentiated(&trim.state, &trim.input)?;
        let a = SMatrix::from_fn(|row, column| rates[row].gradient[column]);
        let b = SMatrix::from_fn(|row, column| rates[row].gradient[4 + column]);
        StateSpace { a, b }.finite()
    }

    /// The specific force at the centre of mass near a flight, as an accelerometer measures it, with exact
    /// derivatives.
    ///
    /// Along the body's axes: (T − D·cos α + L·sin α)/m forwards, (−L·cos α − D·sin α)/m down.
    ///
    /// # Errors
    /// Those of [`Airframe::rates`].
    pub fn specific_force(&self, trim: &Trim) -> Result<SpecificForce, Error> {
        let variables = self.variables(&trim.state, &trim.input)?;
        let [alpha, ..] = variables;
        let Forces { lift, drag, thrust, .. } = self.forces(&variables);
        let per_mass = 1.0 / self.mass;
        let force = [
            (thrust - drag * alpha.cos() + lift * alpha.sin()) * per_mass,
            -(lift * alpha.cos() + drag * alpha.sin()) * per_mass,
        ];
        let force = finite(force)?;
        Ok(SpecificForce {
            steady: force.map(|axis| axis.value).into(),
            c: SMatrix::from_fn(|row, column| force[row].gradient[column]),
            d: SMatrix::from_fn(|row, column| force[row].gradient[4 + column]),
        })
    }

    /// The linear model of deviations from a flight as stability derivatives, from which the thesis forms its
    /// matrices.
    ///
    /// # Errors
    /// Those of [`Airframe::rates`].
    pub fn longitudinal(&self, trim: &Trim) -> Result<LongitudinalDerivatives, Error> {
        self.check()?;
        let [alpha, _, airspeed, theta] = trim.state.into();
        let forces = self.forces(&variables(&trim.state, &trim.input));
        let [per_mass, per_inertia] = [1.0 / self.mass, 1.0 / self.inertia.y];
        let Forces { lift, drag, moment, thrust } = forces;
        Ok(LongitudinalDerivatives {
            airspeed,
            gravity: self.gravity,
            thrust_angle: alpha,
            climb_angle: theta - alpha,
            // Lift and drag rotate with α as well.
            x_alpha: (lift.value - drag.gradient[0]) * per_mass,
            x_airspeed: -drag.gradient[2] * per_mass,
            x_thrust_airspeed: thrust.gradient[2] * per_mass,
            x_elevator: -drag.gradient[4] * per_mass,
            x_throttle: thrust.gradient[5] * per_mass,
            z_alpha: -(lift.gradient[0] + drag.value) * per_mass,
            z_pitch_rate: -lift.gradient[1] * per_mass,
            z_airspeed: -lift.gradient[2] * per_mass,
            z_elevator: -lift.gradient[4] * per_mass,
            m_alpha: moment.gradient[0] * per_inertia,
            m_pitch_rate: moment.gradient[1] * per_inertia,
            m_airspeed: moment.gradient[2] * per_inertia,
            m_elevator: moment.gradient[4] * per_inertia,
            // Neither downwash lag nor thrust beside the centre of mass is modelled.
            ..LongitudinalDerivatives::default()
        })
    }

    fn differentiated(
        &self,
        state: &SVector<f64, 4>,
        input: &SVector<f64, 2>,
    ) -> Result<[Dual; 4], Error> {
        let variables = self.variables(state, input)?;
        let [alpha, rate, airspeed, theta, ..] = variables;
        let Forces { lift, drag, moment, thrust } = self.forces(&variables);
        let climb = theta - alpha;
        let upwards = (lift + thrust * alpha.sin()) * (1.0 / self.mass);
        let forwards = (thrust * alpha.cos() - drag) * (1.0 / self.mass);
        finite([
            rate - (upwards - climb.cos() * self.gravity) / airspeed,
            moment * (1.0 / self.inertia.y),
            forwards - climb.sin() * self.gravity,
            rate,
        ])
    }

    /// The variables of the forces, after a check of the numbers.
    fn variables(
        &self,
        state: &SVector<f64, 4>,
        input: &SVector<f64, 2>,
    ) -> Result<[Dual; 6], Error> {
        self.check()?;
        if state.iter().chain(input.iter()).any(|number| !number.is_finite()) {
            return Err(Error::NotFinite);
        }
        if state[2] <= 0.0 {
            return Err(Error::NotPositive);
        }
        Ok(variables(state, input))
    }

    fn forces(&self, &[alpha, rate, airspeed, _, elevator, throttle]: &[Dual; 6]) -> Forces {
        let pressure = airspeed.square() * (0.5 * self.air_density * self.wing_area);
        let turning = rate / airspeed * (0.5 * self.chord);
        let attached = alpha * self.lift.alpha + self.lift.zero;
        let lift = self.lift.of_wing(alpha, attached)
            + turning * self.lift.pitch_rate
            + elevator * self.lift.elevator;
        let drag = match self.drag {
            Drag::Induced { parasitic, efficiency } => {
                let slenderness = self.span * self.span / self.wing_area;
                let induced = 1.0 / (core::f64::consts::PI * efficiency * slenderness);
                attached.square() * induced + parasitic
            }
            Drag::Polynomial { zero, alpha: slope, alpha_squared, elevator_squared } => {
                alpha * slope
                    + alpha.square() * alpha_squared
                    + elevator.square() * elevator_squared
                    + zero
            }
        };
        let moment = alpha * self.pitch.alpha
            + self.pitch.zero
            + turning * self.pitch.pitch_rate
            + elevator * self.pitch.elevator;
        let disc = 0.5 * self.air_density * self.propeller.area * self.propeller.coefficient;
        let behind = throttle * self.propeller.motor;
        Forces {
            lift: pressure * lift,
            drag: pressure * drag,
            moment: pressure * moment * self.chord,
            thrust: (behind.square() - airspeed.square()) * disc,
        }
    }
}

impl crate::Lift {
    /// Lift coefficient of the wing: attached flow up to the stall, that of a flat plate beyond.
    fn of_wing(&self, alpha: Dual, attached: Dual) -> Dual {
        let Some(stall) = self.stall else { return attached };
        let flat = alpha.sin().square() * alpha.cos() * if alpha.value < 0.0 { -2.0 } else { 2.0 };
        // The book's 1 − σ(α) is a product of two steps.
        let below = ((alpha + -stall.alpha) * -stall.sharpness).logistic();
        let above = ((alpha + stall.alpha) * stall.sharpness).logistic();
        flat + (attached - flat) * (below * above)
    }
}

/// Forces, N, and the moment about the body's y axis, N·m.
struct Forces {
    lift: Dual,
    drag: Dual,
    moment: Dual,
    thrust: Dual,
}

/// Passes numbers on if their values are finite.
fn finite<const N: usize>(of: [Dual; N]) -> Result<[Dual; N], Error> {
    if of.iter().all(|it| it.value.is_finite()) { Ok(of) } else { Err(Error::NotFinite) }
}

fn variables(state: &SVector<f64, 4>, input: &SVector<f64, 2>) -> [Dual; 6] {
    let [alpha, rate, airspeed, pitch] = *state.as_array();
    let [elevator, throttle] = *input.as_array();
    let mut index = 0..;
    [alpha, rate, airspeed, pitch, elevator, throttle]
        .map(|value| Dual::variable(value, index.next().unwrap_or_default()))
}
