//! Dimensionless coefficients, which hold for other speeds and heights and can be compared with tables.

use crate::identify::{Known, Parameter};
use crate::model::Model;
use crate::parameter::at;
use crate::structure::GRAVITY;

/// Size, mass and air density of an aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Airplane {
    /// Mass m, kg.
    pub mass: f64,
    /// Moment of inertia about the body's y axis, kg·m².
    pub inertia: f64,
    /// Wing area S, m².
    pub area: f64,
    /// Mean chord c, m.
    pub chord: f64,
    /// Density of the air ρ, kg/m³, for flights without a column `qbar`.
    pub density: f64,
}

/// An aerodynamic coefficient, per radian (`CL_q`, `Cm_q`: per unit of the dimensionless rate q·c/(2V)).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Coefficient {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub sigma: f64,
}

impl Airplane {
    pub(crate) fn is_possible(&self) -> bool {
        let Self { mass, inertia, area, chord, density } = *self;
        [mass, inertia, area, chord, density].iter().all(|it| it.is_finite() && *it > 0.0)
    }
}

/// The coefficients of lift, pitching moment and drag, from the parameters of α̇, q̇ and V̇. The part of the lift
/// slope that is due to drag and thrust (`CD` + `CT`) is not separated from `CL_alpha`.
pub(crate) fn coefficients(
    airplane: &Airplane,
    parameters: &[Parameter],
    model: &Model,
) -> Vec<Coefficient> {
    let [alpha, _, airspeed, theta] = model.trim.x;
    let Airplane { mass, inertia, area, chord, density } = *airplane;
    let logged = model.outputs.iter().position(|name| *name == "qbar");
    let pressure = logged.map_or(0.5 * density * airspeed * airspeed, |at| model.trim.y[at]);
    let (sin_climb, cos_climb) = (theta - alpha).sin_cos();
    let force = mass / (pressure * area);
    let moment = inertia / (pressure * area * chord);
    let turning = 2.0 * airspeed / chord;
    // The contribution of the weight as the path turns is not aerodynamic.
    let rows = [
        ("CL_alpha", at::Z_ALPHA, -force * airspeed, GRAVITY * sin_climb / airspeed),
        ("CL_q", at::Z_RATE, -force * airspeed * turning, 0.0),
        ("CL_delta_e", at::Z_ELEVATOR, -force * airspeed, 0.0),
        ("Cm_alpha", at::M_ALPHA, moment, 0.0),
        ("Cm_q", at::M_RATE, moment * turning, 0.0),
        ("Cm_delta_e", at::M_ELEVATOR, moment, 0.0),
        ("CD_alpha", at::X_ALPHA, -force, GRAVITY * cos_climb),
        ("CD_delta_e", at::X_ELEVATOR, -force, 0.0),
    ];
    rows.into_iter()
        .filter(|&(_, which, ..)| parameters[which].known == Known::Identified)
        .map(|(name, which, scale, weight)| Coefficient {
            name,
            value: scale * (parameters[which].value - weight),
            sigma: scale.abs() * parameters[which].sigma,
        })
        .collect()
}
