//! Checks for what no sound log of a flight contains: stuck sensors, wrong units, reversed signs.
//!
//! Such logs would be fitted as well, with small standard errors; they are refused beforehand.

use std::f64::consts::FRAC_PI_3;
use std::ops::RangeInclusive;

use crate::Error;
use crate::compatibility::{Comparison, Compatibility};
use crate::flight::{FITTED, Flight, spread};
use crate::identify::{Known, Parameter};
use crate::model::DERIVED;
use crate::parameter::at;
use crate::structure::GRAVITY;

/// Plausible ratio of the mean az to that in steady level flight. Climbs reduce it, turns increase it (1.4 at 45° of
/// bank).
const FORCE: RangeInclusive<f64> = 0.6..=1.5;
/// Plausible air density, kg/m³: from 12 km of height to great cold at sea level, with a margin for uncalibrated
/// pitot tubes.
const DENSITY: RangeInclusive<f64> = 0.2..=2.0;
/// Largest plausible elevator deflection, and root mean square of angle of attack and pitch angle, rad.
const FARTHEST: f64 = FRAC_PI_3;
/// Plausible scales of two sensors of the same motion. Radians and degrees differ by 57, m/s from knots by 1.9 and
/// from km/h by 3.6; the scale error of a sensor is some hundredths.
const SCALE: RangeInclusive<f64> = 0.67..=1.5;
/// Plausible scales where gusts change α and V without a lasting force, so that less of the expected motion is seen,
/// down to none.
const SCALE_IN_GUSTS: RangeInclusive<f64> = -0.3..=1.5;
/// Number of standard errors beyond the plausible range at which a contradiction is reported.
const CLEAR: f64 = 5.0;
/// Smallest ratio of the elevator's effect to its standard error.
const EFFECT: f64 = 3.0;

/// Refuses flights that no aircraft with working sensors can have flown.
pub(crate) fn check(flights: &[Flight], compatibility: &Compatibility) -> Result<(), Error> {
    let is_twice = |(place, flight): (usize, &Flight)| flights[..place].contains(flight);
    if flights.iter().enumerate().any(is_twice) {
        return Err(Error::Twice);
    }
    for flight in flights {
        check_columns(flight)?;
    }
    let pairs = [
        ("theta", "q", compatibility.pitch, SCALE),
        ("alpha", "the gyro with az", compatibility.vane, SCALE_IN_GUSTS),
        ("V", "ax with az", compatibility.airspeed, SCALE_IN_GUSTS),
    ];
    for (of, by, comparison, plausible) in pairs {
        let Some(Comparison { scale, scale_sigma, .. }) = comparison else { continue };
        let nearest = scale.clamp(*plausible.start(), *plausible.end());
        if (scale - nearest).abs() > CLEAR * scale_sigma {
            return Err(Error::Contradiction { of, by, scale });
        }
    }
    Ok(())
}

fn check_columns(flight: &Flight) -> Result<(), Error> {
    for name in FITTED.into_iter().chain(DERIVED) {
        let mut values = flight.column(name).into_iter().flatten().flatten();
        let first = values.next();
        if first.is_some() && values.all(|value| Some(value) == first) {
            return Err(Error::Stuck(name));
        }
    }
    let turned = flight.inputs.iter().map(|input| input[0].abs()).fold(0.0, f64::max);
    // Mean and standard deviation.
    let of = |name: &str| Some(spread(flight.column(name)?.iter().flatten().copied()));
    let mean = |name: &str| of(name).map(|(mean, _)| mean);
    let mean_square = |name: &str| of(name).map_or(0.0, |(mean, spread)| mean.hypot(spread));
    let angles =
        [("delta_e", turned), ("alpha", mean_square("alpha")), ("theta", mean_square("theta"))];
    if let Some((name, angle)) = angles.into_iter().find(|(_, angle)| *angle > FARTHEST) {
        return Err(Error::Angle(name, angle));
    }
    if let Some(force) = mean("az").filter(|force| !FORCE.contains(&(force / -GRAVITY))) {
        return Err(Error::Force(force));
    }
    let density =
        mean("qbar").zip(mean("V")).map(|(pressure, airspeed)| 2.0 * pressure / airspeed.powi(2));
    if let Some(density) = density.filter(|density| !DENSITY.contains(density)) {
        return Err(Error::Density(density));
    }
    Ok(())
}

/// Refuses a model whose elevator has no effect: the column is another one's, or its times are from another clock.
pub(crate) fn check_effect(parameters: &[Parameter]) -> Result<(), Error> {
    let Parameter { value, sigma, known, .. } = parameters[at::M_ELEVATOR];
    if known == Known::Identified && value.abs() < EFFECT * sigma {
        return Err(Error::NoEffect { value, sigma });
    }
    Ok(())
}
