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

/// The first share of each flight is identified from for the validation, the rest predicted.
const IDENTIFIED: f64 = 0.7;
/// A flight that narrows what is expected of any aircraft by less than this does not tell a parameter.
const NARROWED: f64 = 0.5;
/// Correlations from here on are worth telling.
const CORRELATED: f64 = 0.9;

/// What is known of a parameter after the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Known {
    /// The flight tells it.
    Identified,
    /// The flight tells less than what holds of any aircraft: the value is mostly that.
    Weak,
    /// Nothing in the log depends on it, for this reason: it was not searched for.
    Fixed(&'static str),
}

/// A parameter. `Z_…` are derivatives of α̇ (`Z_q` without the 1 of kinematics), `M_…` of q̇, `X_…` of V̇, all three at the centre of mass and
/// with what α̇ does to them; `vane_lead` how far the vane is ahead of the centre of mass over the airspeed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard error, with coloured residuals.
    pub sigma: f64,
    /// Cramér and Rao's bound, as if residuals were white.
    pub bound: f64,
    /// The guess of least squares that it began with.
    pub equation_error: f64,
    /// What output error said, without process noise; none where that explains no flight.
    pub output_error: Option<f64>,
    /// Whether the flight tells it.
    pub known: Known,
}

/// Two parameters that cannot be told apart well.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Correlation {
    /// The two.
    pub of: [&'static str; 2],
    /// Their correlation.
    pub value: f64,
}

/// What came of flights.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Identified {
    /// What a filter takes.
    pub model: Model,
    /// Its modes, 1/s: real and imaginary parts of the eigenvalues of A.
    pub modes: Vec<[f64; 2]>,
    /// What was found.
    pub parameters: Vec<Parameter>,
    /// Pairs of parameters that are nearly one.
    pub correlations: Vec<Correlation>,
    /// How well the outputs fit.
    pub fits: Vec<Fit>,
    /// Residuals of output error, whose colour says whether process noise was needed; none where it explains no flight.
    pub without_process_noise: Option<Vec<Fit>>,
    /// By how much process noise raises the logarithm of the likelihood of output error.
    pub gain: Option<f64>,
    /// A model of the first part of the flights, on the rest; none if either is too short.
    pub validation: Option<Vec<Fit>>,
    /// What sensors say of one another.
    pub compatibility: Compatibility,
    /// Pure numbers, if the aircraft's size is known.
    pub coefficients: Vec<Coefficient>,
    /// What was used, s.
    pub seconds: f64,
}

/// Both fits of some flights.
struct Fitted {
    problem: Problem,
    first: Unknown,
    /// None where the aircraft strays too far from what it does in calm air.
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
        // With process noise, what was taken for a bad sensor need not be one.
        let measured =
            std::array::from_fn(|output| unknown.measured[output].min(expected_measured[output]));
        climb(&problem, Unknown { process: Some(expected_process), measured, ..unknown })
    };
    let output_error = climb(&problem, first).ok();
    let starts = output_error.iter().map(|top| top.unknown).chain([first]);
    // Without corrections, turbulence and motion that grows may have led astray: a filter's corrections lead back.
    let filter_error =
        starts.map(filter_error_from).find_map(Result::ok).ok_or(Error::NotConverged)?;
    let calm = Unknown { process: None, ..filter_error.unknown };
    let output_error = match output_error {
        None => climb(&problem, calm).ok(),
        some => some,
    };
    Ok(Fitted { problem, first, output_error, filter_error })
}

/// Identifies the linear model that explains these flights of an aircraft: least squares, then output error, then filter error.
///
/// # Errors
/// [`Error`]: what is missing in the flights, or that no linear model explains them.
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

/// Identifies from the first part of each flight and tests on the rest; none if a part tells nothing.
fn validation(flights: &[Flight]) -> Option<Vec<Fit>> {
    let (before, after) = divided(flights, IDENTIFIED);
    let reference = Reference::of(&before).ok()?;
    let fitted = fit(&before, &reference).ok()?;
    let after = Segment::all(&after, &reference).ok()?;
    let none: [Option<Whiteness>; OUTPUTS] = [None; OUTPUTS];
    fits(&fitted.problem, &fitted.filter_error.unknown, &after, &none).ok()
}
