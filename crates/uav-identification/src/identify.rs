//! From flights to a model.

use crate::Error;
use crate::accuracy::{Whiteness, covariance, whiteness};
use crate::compatibility::{Compatibility, compatibility};
use crate::fit::{Fit, divided, fits};
use crate::flight::{Flight, OUTPUTS, Reference, Segment};
use crate::likelihood::{Coordinate, Problem, Unknown};
use crate::model::Model;
use crate::nondimensional::{Airplane, Coefficient, coefficients};
use crate::parameter::{COUNT, PARAMETERS, priors};
use crate::plausible;
use crate::scoring::{Top, climb};
use crate::start::{expected_noise, first_guess, floors};
use crate::structure::Structure;

/// The share of each flight from which the validation's model is identified; the rest is predicted.
const IDENTIFIED: f64 = 0.7;
/// A parameter counts as identified if the flight reduces its standard deviation below this share of the prior's.
const NARROWED: f64 = 0.5;
/// Smallest correlation that is reported.
const CORRELATED: f64 = 0.9;

/// How well a parameter is known after the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Known {
    /// The flight determines it.
    Identified,
    /// The flight contributes less than the prior of any aircraft, which mostly determines the value.
    Weak,
    /// Nothing in the log depends on it, for this reason; it is not estimated.
    Fixed(&'static str),
}

/// An estimated parameter.
///
/// `Z_…` are derivatives of α̇ (`Z_q` without the kinematic 1), `M_…` of q̇, `X_…` of V̇, all at the centre of mass
/// and including the effect of α̇ on them; `vane_lead` is the distance of the vane ahead of the centre of mass,
/// divided by the airspeed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// Standard error, allowing for coloured residuals.
    pub sigma: f64,
    /// The Cramér-Rao bound, which assumes white residuals.
    pub bound: f64,
    /// The initial least-squares estimate (equation error).
    pub equation_error: f64,
    /// The output-error estimate, without process noise; `None` where that fails to explain the flights.
    pub output_error: Option<f64>,
    /// How well the flight determines it.
    pub known: Known,
}

/// Two parameters that are hard to distinguish.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Correlation {
    /// The names of the two parameters.
    pub of: [&'static str; 2],
    /// Their correlation.
    pub value: f64,
}

/// The result of an identification.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Identified {
    /// The model, as a filter reads it.
    pub model: Model,
    /// Modes of the model, 1/s: real and imaginary parts of the eigenvalues of A.
    pub modes: Vec<[f64; 2]>,
    /// The estimated parameters.
    pub parameters: Vec<Parameter>,
    /// Pairs of strongly correlated parameters.
    pub correlations: Vec<Correlation>,
    /// How well the outputs fit.
    pub fits: Vec<Fit>,
    /// The fit of output error, whose coloured residuals show whether process noise is needed; `None` where it fails
    /// to explain the flights.
    pub without_process_noise: Option<Vec<Fit>>,
    /// Increase of the log-likelihood over output error that process noise achieves.
    pub gain: Option<f64>,
    /// The fit, to the rest of the flights, of a model identified from their first part; `None` if either is too
    /// short.
    pub validation: Option<Vec<Fit>>,
    /// Consistency of the sensors with one another.
    pub compatibility: Compatibility,
    /// Dimensionless coefficients, if the aircraft's size is known.
    pub coefficients: Vec<Coefficient>,
    /// Duration of the data used, s.
    pub seconds: f64,
}

/// The output-error and filter-error fits of a set of flights.
struct Fitted {
    problem: Problem,
    first: Unknown,
    /// `None` if the aircraft strays too far from its motion in calm air.
    output_error: Option<Top>,
    filter_error: Top,
}

fn fit(flights: &[Flight], reference: &Reference) -> Result<Fitted, Error> {
    let segments = Segment::all(flights, reference)?;
    let (expected_process, expected_measured) = expected_noise(&segments);
    let priors = priors(reference);
    let problem = Problem {
        reference: *reference,
        segments,
        priors,
        floors: floors(),
        expected_process,
        expected_measured,
    };
    let first = first_guess(&problem);
    let filter_error_from = |unknown: Unknown| {
        // With process noise, large residuals need not come from a bad sensor.
        let measured =
            std::array::from_fn(|output| unknown.measured[output].min(expected_measured[output]));
        climb(&problem, Unknown { process: Some(expected_process), measured, ..unknown })
    };
    let output_error = climb(&problem, first).ok();
    let starts = output_error.iter().map(|top| top.unknown).chain([first]);
    // Without corrections, turbulence and unstable motion may have led astray: the filter's corrections lead back.
    let filter_error =
        starts.map(filter_error_from).find_map(Result::ok).ok_or(Error::NotConverged)?;
    let calm = Unknown { process: None, ..filter_error.unknown };
    let output_error = match output_error {
        None => climb(&problem, calm).ok(),
        some => some,
    };
    Ok(Fitted { problem, first, output_error, filter_error })
}

/// Identifies the linear model that explains these flights of an aircraft, by least squares, then output error, then
/// filter error.
///
/// # Errors
/// [`Error`]: what the flights lack, or that no linear model explains them.
pub fn identify(flights: &[Flight], airplane: Option<&Airplane>) -> Result<Identified, Error> {
    if airplane.is_some_and(|airplane| !airplane.is_possible()) {
        return Err(Error::NotPositive);
    }
    let reference = Reference::of(flights)?;
    let compatibility = compatibility(flights);
    plausible::check(flights, &compatibility)?;
    let fitted = fit(flights, &reference)?;
    let Fitted { problem, filter_error, output_error, .. } = &fitted;
    let unknown = &filter_error.unknown;
    let structure = Structure::of(&unknown.derivative, &reference);
    let filter = problem.filter(unknown, &structure);
    let white = whiteness(problem, filter_error);
    let model = Model::of(flights, &reference, &filter, &filter_error.explained.linear, &white);
    let bound = filter_error.information.clone().cholesky().ok_or(Error::NotConverged)?.inverse();
    let covariance = covariance(problem, filter_error, &bound);
    let sigma = |place: usize| covariance[(place, place)].max(0.0).sqrt();
    let place = |which: usize| {
        let wanted = Coordinate::Derivative(which);
        filter_error.coordinates.iter().position(|coordinate| *coordinate == wanted)
    };
    let parameter = |which: usize| {
        let (name, unit) = PARAMETERS[which];
        let prior = problem.priors[which];
        let (sigma, bound) = place(which).map_or((prior.sigma, prior.sigma), |place| {
            (sigma(place), bound[(place, place)].max(0.0).sqrt())
        });
        let known = match prior.fixed {
            Some(reason) => Known::Fixed(reason),
            None if sigma < NARROWED * prior.sigma => Known::Identified,
            None => Known::Weak,
        };
        Parameter {
            name,
            unit,
            value: unknown.derivative[which],
            sigma,
            bound,
            equation_error: fitted.first.derivative[which],
            output_error: output_error.as_ref().map(|top| top.unknown.derivative[which]),
            known,
        }
    };
    let parameters: Vec<_> = (0..COUNT).map(parameter).collect();
    plausible::check_effect(&parameters)?;
    let coefficients =
        airplane.map(|airplane| coefficients(airplane, &parameters, &model)).unwrap_or_default();
    let pairs = (0..COUNT).flat_map(|one| (0..one).map(move |other| (other, one)));
    let correlations = pairs.filter_map(|(one, other)| {
        let (first, second) = (place(one)?, place(other)?);
        let value = covariance[(first, second)] / (sigma(first) * sigma(second));
        let of = [PARAMETERS[one].0, PARAMETERS[other].0];
        (value.abs() >= CORRELATED).then_some(Correlation { of, value })
    });
    let fits_of =
        |top: &Top, white: &[_; OUTPUTS]| fits(problem, &top.unknown, &problem.segments, white);
    let modes = structure.a.complex_eigenvalues();
    Ok(Identified {
        model,
        modes: modes.iter().map(|mode| [mode.re, mode.im]).collect(),
        correlations: correlations.collect(),
        parameters,
        fits: fits_of(filter_error, &white)?,
        without_process_noise: output_error
            .as_ref()
            .map(|top| fits_of(top, &whiteness(problem, top)))
            .transpose()?,
        gain: output_error.as_ref().map(|top| top.explained.cost - filter_error.explained.cost),
        validation: validation(flights),
        compatibility,
        coefficients,
        seconds: problem.segments.iter().filter_map(|it| it.times.last()).sum(),
    })
}

/// Identifies from the first part of each flight and tests on the rest; `None` if either part is insufficient.
fn validation(flights: &[Flight]) -> Option<Vec<Fit>> {
    let (before, after) = divided(flights, IDENTIFIED);
    let reference = Reference::of(&before).ok()?;
    let fitted = fit(&before, &reference).ok()?;
    let after = Segment::all(&after, &reference).ok()?;
    let none: [Option<Whiteness>; OUTPUTS] = [None; OUTPUTS];
    fits(&fitted.problem, &fitted.filter_error.unknown, &after, &none).ok()
}
