//! Steady flights of an aircraft of which the coefficients are published, and what it does near them.

use kestirim_replay::KnownAirframe;
use kestirim_uav_longitudinal::{Airframe, SteadyFlight};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::case::{Case, Problem};

/// A steady flight: states α, q, V, θ and inputs δe, δt, and deviations from them ẋ = A·x + B·u.
#[derive(Debug, Clone, Serialize)]
pub struct Steady {
    /// As asked, m/s.
    pub airspeed: f64,
    /// As asked, rad.
    pub climb_angle: f64,
    /// State and input.
    pub trim: Trim,
    /// A.
    #[serde(rename = "A")]
    pub a: [[f64; 4]; 4],
    /// B.
    #[serde(rename = "B")]
    pub b: [[f64; 2]; 4],
    /// C of an accelerometer's axes forwards and down.
    #[serde(rename = "C")]
    pub c: [[f64; 4]; 2],
    /// D of the same.
    #[serde(rename = "D")]
    pub d: [[f64; 2]; 2],
    /// Real and imaginary parts, 1/s.
    pub eigenvalues: Vec<[f64; 2]>,
}

/// What holds in the flight.
#[derive(Debug, Clone, Serialize)]
pub struct Trim {
    /// State.
    pub x: [f64; 4],
    /// Input.
    pub u: [f64; 2],
    /// Specific force forwards and down, m/s².
    pub y: [f64; 2],
}

/// A flight for each airspeed of a case, which is a number or a list; and why there is none of others.
///
/// # Errors
/// What is wrong with the case, or with the first of the airspeeds if the aircraft flies at none of them.
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
