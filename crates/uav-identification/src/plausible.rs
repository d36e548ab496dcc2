//! What no sound log of a flight holds: sensors that stand still, other units, signs the other way.
//!
//! A model is fitted to these as well, with small standard errors: they are refused before.

use std::f64::consts::FRAC_PI_3;
use std::ops::RangeInclusive;

use crate::Error;
use crate::compatibility::{Comparison, Compatibility};
use crate::flight::{FITTED, Flight, spread};
use crate::identify::{Known, Parameter};
use crate::model::DERIVED;
use crate::parameter::at;
use crate::structure::GRAVITY;

/// What az is on average over what it is in steady level flight. Climbs take from it, turns add (at 45° of bank 1.4).
const FORCE: RangeInclusive<f64> = 0.6..=1.5;
/// Density of air, kg/m³: at 12 km of height and in great cold at sea level, with room for pitots that are not calibrated.
const DENSITY: RangeInclusive<f64> = 0.2..=2.0;
/// No elevator is turned farther, and no wing flies or climbs at more in the mean, rad.
const FARTHEST: f64 = FRAC_PI_3;
/// Scales of two sensors of one motion. Radians beside degrees are 57, knots 1.9, km/h 3.6; a scale error of a sensor is
/// some hundredths.
const SCALE: RangeInclusive<f64> = 0.67..=1.5;
/// Gusts change α and V without a force that lasts, so that less of the expected motion is seen, down to none.
const SCALE_IN_GUSTS: RangeInclusive<f64> = -0.3..=1.5;
/// A finding stands if it is so many of its standard errors beyond what is plausible.
const CLEAR: f64 = 5.0;
/// An elevator that does something is told by so many standard errors.
const EFFECT: f64 = 3.0;

/// Refuses flights that no aircraft with working sensors has flown.
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
    // Mean and deviation.
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

/// Refuses a model whose elevator turns nothing: another column stands in its place, or its times are another clock's.
pub(crate) fn check_effect(parameters: &[Parameter]) -> Result<(), Error> {
    let Parameter { value, sigma, known, .. } = parameters[at::M_ELEVATOR];
    if known == Known::Identified && value.abs() < EFFECT * sigma {
        return Err(Error::NoEffect { value, sigma });
    }
    Ok(())
}
