//! Steady flights of an aircraft with published coefficients, and the linear models near them.

use kestirim_replay::KnownAirframe;
use kestirim_uav_longitudinal::{Airframe, SteadyFlight};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::case::{Case, Problem};

/// A steady flight with states α, q, V, θ and inputs δe, δt, and the linear model ẋ = A·x + B·u of deviations from it.
#[derive(Debug, Clone, Serialize)]
pub struct Steady {
    /// The requested airspeed (m/s).
    pub airspeed: f64,
    /// The requested climb angle (rad).
    pub climb_angle: f64,
    /// The states, inputs and outputs in the flight.
    pub trim: Trim,
    /// The system matrix A.
    #[serde(rename = "A")]
    pub a: [[f64; 4]; 4],
    /// The input matrix B.
    #[serde(rename = "B")]
    pub b: [[f64; 2]; 4],
    /// The output matrix C of an accelerometer with its axes forwards and down.
    #[serde(rename = "C")]
    pub c: [[f64; 4]; 2],
    /// The feedthrough matrix D of an accelerometer with its axes forwards and down.
    #[serde(rename = "D")]
    pub d: [[f64; 2]; 2],
    /// The real and imaginary parts of the eigenvalues (1/s).
    pub eigenvalues: Vec<[f64; 2]>,
}

/// The equilibrium values of a steady flight.
#[derive(Debug, Clone, Serialize)]
pub struct Trim {
    /// The state vector.
    pub x: [f64; 4],
    /// The input vector.
    pub u: [f64; 2],
    /// The specific force forwards and down (m/s²).
    pub y: [f64; 2],
}

/// The steady flights at the airspeeds of a case, a number or a list, and the reasons why some airspeeds have none.
///
/// # Errors
/// An error in the case, or that of the first airspeed if the aircraft flies at none of them.
pub(super) fn flights(case: &Case) -> Result<(Vec<Steady>, Vec<Problem>), Problem> {
    let airframe = match (case.has("coefficients"), case.has("airframe")) {
        (true, true) => return Err("expected airframe or coefficients, found both".to_owned()),
        (true, false) => {
            let fields = case.field("coefficients")?;
            let unused =
                |path: serde_ignored::Path<'_>| case.leave(&format!("coefficients.{path}"));
            let airframe: Result<Airframe, _> = serde_ignored::deserialize(fields, unused);
            airframe.map_err(|error| format!("coefficients: {error}"))?
        }
        (false, _) => {
            let known = KnownAirframe::deserialize(case.field("airframe")?);
            known.map_err(|error| format!("airframe: {error}"))?.airframe()
        }
    };
    let climb_angle = if case.has("climb_angle") { case.number("climb_angle")? } else { 0.0 };
    let wrong = || "airspeed: expected a number or a list of some".to_owned();
    let airspeeds: Vec<f64> = match case.field("airspeed")? {
        Value::Array(list) => list.iter().map(Value::as_f64).collect::<Option<_>>(),
        number => number.as_f64().map(|airspeed| vec![airspeed]),
    }
    .ok_or_else(wrong)?;
    let flight = |airspeed: f64| {
        let refused = |error: kestirim_uav_longitudinal::Error| format!("{airspeed} m/s: {error}");
        let trim = airframe.trim(&SteadyFlight { airspeed, climb_angle }).map_err(refused)?;
        let model = airframe.linearise(&trim).map_err(refused)?;
        let force = airframe.specific_force(&trim).map_err(refused)?;
        let eigenvalues = model.a.complex_eigenvalues();
        Ok(Steady {
            airspeed,
            climb_angle,
            trim: Trim { x: trim.state.into(), u: trim.input.into(), y: force.steady.into() },
            a: model.a.transpose().into(),
            b: model.b.transpose().into(),
            c: force.c.transpose().into(),
            d: force.d.transpose().into(),
            eigenvalues: eigenvalues.iter().map(|it| [it.re, it.im]).collect(),
        })
    };
    let (mut flown, mut refused) = (Vec::new(), Vec::<Problem>::new());
    for airspeed in airspeeds {
        match flight(airspeed) {
            Ok(steady) => flown.push(steady),
            Err(problem) => refused.push(problem),
        }
    }
    match refused.first() {
        Some(problem) if flown.is_empty() => Err(problem.clone()),
        None if flown.is_empty() => Err(wrong()),
        _ => Ok((flown, refused)),
    }
}
