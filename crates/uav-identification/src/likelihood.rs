//! How well a model explains the flights, with the likeliest initial conditions of each stretch.

use nalgebra::{SMatrix, SVector};

use crate::Error;
use crate::flight::{OUTPUTS, Reference, Segment};
use crate::innovations::{EXPECTED, Filter, Innovation, UNKNOWNS};
use crate::parameter::{COUNT, Prior};
use crate::structure::Structure;

/// Prior standard deviation of the logarithms of noise densities and variances about their first guess.
const NOISE_SPREAD: f64 = 3.0;

/// All quantities to be estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknown {
    /// Values of [`crate::parameter::PARAMETERS`].
    pub(crate) derivative: [f64; COUNT],
    /// Logarithms of the spectral densities of the noise on ẋ; `None` without process noise.
    pub(crate) process: Option<[f64; 4]>,
    /// Logarithms of the output variances in excess of their floors.
    pub(crate) measured: [f64; OUTPUTS],
}

/// The flights and the priors.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    pub(crate) reference: Reference,
    pub(crate) segments: Vec<Segment>,
    pub(crate) priors: [Prior; COUNT],
    /// Lower limits of the output variances.
    pub(crate) floors: [f64; OUTPUTS],
    /// Prior means of the noise parameters (logarithms).
    pub(crate) expected_process: [f64; 4],
    pub(crate) expected_measured: [f64; OUTPUTS],
}

/// A model's innovations and cost.
#[derive(Debug, Clone)]
pub(crate) struct Explained {
    /// The negative log-likelihood plus the negative log-priors, up to a constant.
    pub(crate) cost: f64,
    /// The deviation of every measurement, then that of every prior.
    pub(crate) off: Vec<f64>,
    /// The variance of each deviation.
    pub(crate) variance: Vec<f64>,
    /// The likeliest unknowns of each stretch.
    pub(crate) linear: Vec<[f64; UNKNOWNS]>,
}

/// A coordinate of the search, with its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Coordinate {
    Derivative(usize),
    Process(usize),
    Measured(usize),
}

impl Problem {
    pub(crate) fn filter<'a>(&self, unknown: &Unknown, structure: &'a Structure) -> Filter<'a> {
        Filter {
            structure,
            process: unknown.process.map_or([0.0; 4], |density| density.map(f64::exp)),
            measured: std::array::from_fn(|output| {
                unknown.measured[output].exp() + self.floors[output]
            }),
            delay: unknown.derivative[crate::parameter::at::DELAY],
        }
    }

    /// The coordinates of the search.
    pub(crate) fn coordinates(&self, unknown: &Unknown) -> Vec<Coordinate> {
        let free = (0..COUNT).filter(|&which| self.priors[which].fixed.is_none());
        let process = (0..4).filter(|_| unknown.process.is_some());
        let measured = (0..OUTPUTS).filter(|&output| self.reference.has[output]);
        free.map(Coordinate::Derivative)
            .chain(process.map(Coordinate::Process))
            .chain(measured.map(Coordinate::Measured))
            .collect()
    }

    /// The prior mean and standard deviation of a coordinate.
    pub(crate) fn expected(&self, coordinate: Coordinate) -> (f64, f64) {
        match coordinate {
            Coordinate::Derivative(which) => (self.priors[which].mean, self.priors[which].sigma),
            Coordinate::Process(state) => (self.expected_process[state], NOISE_SPREAD),
            Coordinate::Measured(output) => (self.expected_measured[output], NOISE_SPREAD),
        }
    }

    /// Filters all stretches.
    pub(crate) fn explain(&self, unknown: &Unknown) -> Result<Explained, Error> {
        let structure = Structure::of(&unknown.derivative, &self.reference);
        let filter = self.filter(unknown, &structure);
        let (mut off, mut variance, mut linear) = (Vec::new(), Vec::new(), Vec::new());
        for segment in &self.segments {
            let innovations = filter.innovations(segment);
            let unknowns = solve(&innovations)?;
            off.extend(innovations.iter().map(|innovation| settled(innovation, &unknowns)));
            variance.extend(innovations.iter().map(|innovation| innovation.variance));
            linear.push(unknowns);
        }
        for unknowns in &linear {
            off.extend(unknowns);
            variance.extend(EXPECTED.map(|sigma| sigma * sigma));
        }
        for coordinate in self.coordinates(unknown) {
            let (mean, sigma) = self.expected(coordinate);
            off.push(unknown.get(coordinate) - mean);
            variance.push(sigma * sigma);
        }
        let cost: f64 = off.iter().zip(&variance).map(|(off, s)| off * off / s + s.ln()).sum();
        if cost.is_finite() {
            Ok(Explained { cost: 0.5 * cost, off, variance, linear })
        } else {
            Err(Error::NotConverged)
        }
    }
}

/// The innovation with the unknowns inserted.
pub(crate) fn settled(innovation: &Innovation, unknowns: &[f64; UNKNOWNS]) -> f64 {
    let [value, rest @ ..] = innovation.value;
    value + rest.iter().zip(unknowns).map(|(part, unknown)| part * unknown).sum::<f64>()
}

/// The likeliest unknowns.
pub(crate) fn solve(innovations: &[Innovation]) -> Result<[f64; UNKNOWNS], Error> {
    let mut information =
        SMatrix::from_diagonal(&SVector::from(EXPECTED.map(|sigma| 1.0 / (sigma * sigma))));
    let mut towards = SVector::<f64, UNKNOWNS>::zeros();
    for innovation in innovations {
        let [value, rest @ ..] = innovation.value;
        let row = SVector::<f64, UNKNOWNS>::from(rest);
        information.syger(1.0 / innovation.variance, &row, &row, 1.0);
        towards.axpy(-value / innovation.variance, &row, 1.0);
    }
    let factor = information.cholesky().ok_or(Error::NotConverged)?;
    Ok(factor.solve(&towards).into())
}

impl Unknown {
    pub(crate) fn get(&self, coordinate: Coordinate) -> f64 {
        match coordinate {
            Coordinate::Derivative(which) => self.derivative[which],
            Coordinate::Process(state) => self.process.map_or(0.0, |density| density[state]),
            Coordinate::Measured(output) => self.measured[output],
        }
    }

    pub(crate) fn add(&mut self, coordinate: Coordinate, step: f64) {
        match coordinate {
            Coordinate::Derivative(which) => self.derivative[which] += step,
            Coordinate::Process(state) => {
                if let Some(density) = &mut self.process {
                    density[state] += step;
                }
            }
            Coordinate::Measured(output) => self.measured[output] += step,
        }
    }
}
