//! Goodness of fit of a model's outputs to a flight: one sample ahead, and without any correction.

use crate::Error;
use crate::accuracy::Whiteness;
use crate::flight::{FITTED, Flight, OUTPUTS, Segment};
use crate::likelihood::{Problem, Unknown, settled, solve};
use crate::structure::Structure;

/// Goodness of fit of an output.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fit {
    /// The output's column.
    pub output: &'static str,
    /// Root mean square of the measurement minus the filter's prediction from all earlier measurements.
    pub ahead: f64,
    /// Root mean square of the measurement minus the model's simulation from the initial state and the inputs,
    /// without any correction from measurements.
    pub alone: f64,
    /// Theil's inequality coefficient of the simulation, for deviations from the mean flight: 0 is perfect, 1 is no
    /// information.
    pub theil: f64,
    /// Whiteness of the filter's residuals; `None` for held-out data.
    pub whiteness: Option<Whiteness>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: f64,
    off: f64,
    measured: f64,
    predicted: f64,
}

impl Sums {
    fn add(&mut self, off: f64, measured: f64) {
        self.count += 1.0;
        self.off += off * off;
        self.measured += measured * measured;
        self.predicted += (measured - off).powi(2);
    }

    fn rms(&self) -> f64 {
        (self.off / self.count.max(1.0)).sqrt()
    }

    fn theil(&self) -> f64 {
        let whole = self.measured.sqrt() + self.predicted.sqrt();
        self.off.sqrt() / whole.max(f64::MIN_POSITIVE)
    }
}

fn sums(
    problem: &Problem,
    unknown: &Unknown,
    segments: &[Segment],
) -> Result<[Sums; OUTPUTS], Error> {
    let structure = Structure::of(&unknown.derivative, &problem.reference);
    let filter = problem.filter(unknown, &structure);
    let mut sums = [Sums::default(); OUTPUTS];
    for segment in segments {
        let innovations = filter.innovations(segment);
        let unknowns = solve(&innovations)?;
        for innovation in &innovations {
            let measured = segment.measured[innovation.sample][innovation.output];
            sums[innovation.output].add(settled(innovation, &unknowns), measured.unwrap_or(0.0));
        }
    }
    Ok(sums)
}

/// The fit of each output in these stretches, whose initial states and constant errors are fitted.
pub(crate) fn fits(
    problem: &Problem,
    unknown: &Unknown,
    segments: &[Segment],
    whiteness: &[Option<Whiteness>; OUTPUTS],
) -> Result<Vec<Fit>, Error> {
    let ahead = sums(problem, unknown, segments)?;
    let alone = sums(problem, &Unknown { process: None, ..*unknown }, segments)?;
    let fit = |output: usize| Fit {
        output: FITTED[output],
        ahead: ahead[output].rms(),
        alone: alone[output].rms(),
        theil: alone[output].theil(),
        whiteness: whiteness[output],
    };
    Ok((0..OUTPUTS).filter(|&output| ahead[output].count > 0.0).map(fit).collect())
}

/// Splits each flight at a share of its samples: the parts before, and the parts after.
pub(crate) fn divided(flights: &[Flight], share: f64) -> (Vec<Flight>, Vec<Flight>) {
    let before = flights.iter().map(|flight| flight.part(0.0, share)).collect();
    (before, flights.iter().map(|flight| flight.part(share, 1.0)).collect())
}
