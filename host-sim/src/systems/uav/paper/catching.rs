//! The time that an estimator with a wrong start takes to catch the plant, without noise.

use kestirim_replay::uav::{FAST, MIDDLE, Noise, Plant, SLOW};
use nalgebra::SVector;
use serde::Serialize;

use crate::system::ScalarKind;
use crate::systems::uav::account::states::caught;
use crate::systems::uav::paper::published::{KALMAN_CAUGHT, LUENBERGER_CAUGHT, SINE_CAUGHT};
use crate::systems::uav::simulate::design::{Family, Kind};
use crate::systems::uav::simulate::flight::{Flight, Moment};
use crate::systems::uav::simulate::plant::Outputs;
use crate::systems::uav::simulate::scenario::{FAR, Inputs, NEAR, SAMPLES, START};

/// A noise-free flight of one estimator from a given start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chase {
    /// The aircraft.
    pub plant: Plant,
    /// The measured outputs.
    pub outputs: Outputs,
    /// The estimator.
    pub kind: Kind,
    /// The estimator's start.
    pub start: [f64; 4],
    /// The pilot's inputs.
    pub inputs: Inputs,
}

/// The errors x − x̂ of a run, sample by sample.
pub type Errors = Vec<SVector<f64, 4>>;

impl Chase {
    /// The errors, with the estimator in this number type.
    ///
    /// # Errors
    /// The reason why there is no such estimator.
    pub fn errors(&self, scalar: ScalarKind) -> Result<Errors, kestirim_uav_estimator::Error> {
        let errors = self.flight().follow(&self.kind, scalar, 0)?;
        Ok(errors.iter().map(Moment::error).collect())
    }

    /// The error of the start.
    fn off(&self) -> SVector<f64, 4> {
        SVector::from(START) - SVector::from(self.start)
    }

    /// The times to catch each state (s).
    fn times(&self, scalar: ScalarKind) -> Option<[Option<f64>; 4]> {
        self.errors(scalar).ok().map(|errors| caught(&errors))
    }

    /// The times to catch by the error recursion alone: with neither plant nor input, in double precision.
    fn predicted(&self) -> Option<[Option<f64>; 4]> {
        // The plant rests at zero, with the same error of the estimator.
        let flight = Flight {
            inputs: Inputs::None,
            truth: [0.0; 4],
            start: (-self.off()).into(),
            ..self.flight()
        };
        let moments = flight.follow(&self.kind, ScalarKind::F64, 0).ok()?;
        Some(caught(&moments.iter().map(Moment::error).collect::<Vec<_>>()))
    }

    /// The flight to simulate.
    pub(super) fn flight(&self) -> Flight {
        let Self { plant, outputs, start, inputs, .. } = *self;
        let (noise, truth, samples) = (Noise::NONE, START, SAMPLES);
        Flight { plant, outputs, inputs, noise, truth, start, samples }
    }
}

/// A row of the table: the times to catch of one estimator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The aircraft.
    pub plant: Plant,
    /// The measured outputs.
    pub outputs: Outputs,
    /// The name of the estimator.
    pub estimator: String,
    /// The family of the estimator.
    pub family: Family,
    /// The estimator's start.
    pub start: [f64; 4],
    /// The pilot's inputs.
    pub inputs: Inputs,
    /// The values that the thesis reads off its figures for α, q, V and θ.
    pub published: Option<[&'static str; 4]>,
    /// The figures of the thesis.
    pub source: Option<&'static str>,
    /// The times to catch α, q, V, θ (s); `None` means not within ten seconds.
    pub ours_s: Option<[Option<f64>; 4]>,
    /// The times to catch by the error recursion, in double precision (s).
    pub limit_s: Option<[Option<f64>; 4]>,
}

/// All chases.
pub fn rows(scalar: ScalarKind) -> Vec<Row> {
    let all = chases().into_iter().map(|chase| {
        let (published, source) = chase.published().unzip();
        Row {
            plant: chase.plant,
            outputs: chase.outputs,
            estimator: chase.kind.name(),
            family: chase.kind.family(),
            start: chase.start,
            inputs: chase.inputs,
            published,
            source,
            ours_s: chase.times(scalar),
            limit_s: chase.predicted(),
        }
    });
    all.collect()
}

/// The thesis' chase with its Kalman filter, with the gain and start that explain its figures.
pub const THESIS: Chase = Chase {
    plant: Plant::P2,
    outputs: Outputs::Full,
    kind: Kind::Ratio(1e-2),
    start: FAR,
    inputs: Inputs::Constant,
};
/// The thesis' chase with its observer, with the poles and start that explain its figures.
pub const THESIS_LUENBERGER: Chase = Chase { kind: Kind::Luenberger(SLOW), start: NEAR, ..THESIS };
/// The thesis' chase with its observer under sine inputs.
pub const THESIS_SINE: Chase =
    Chase { kind: Kind::Luenberger(FAST), inputs: Inputs::Sine, ..THESIS_LUENBERGER };

impl Chase {
    /// The values in the thesis, and their source.
    fn published(&self) -> Option<([&'static str; 4], &'static str)> {
        [
            (THESIS, KALMAN_CAUGHT),
            (THESIS_LUENBERGER, LUENBERGER_CAUGHT),
            (THESIS_SINE, SINE_CAUGHT),
        ]
        .into_iter()
        .find_map(|(chase, published)| (chase == *self).then_some(published))
    }
}

fn chases() -> Vec<Chase> {
    let mut all = Vec::new();
    for start in [FAR, NEAR] {
        for inputs in [Inputs::Constant, Inputs::Sine] {
            let ratios = [1e-4, 1e-2, 1.0, 1e2].map(Kind::Ratio);
            let poles = [SLOW, MIDDLE, FAST].map(Kind::Luenberger);
            let known = [Kind::Matched(Noise::SENSORS), Kind::TimeVarying(Noise::SENSORS)];
            for kind in ratios.into_iter().chain(known).chain(poles) {
                all.push(Chase { kind, start, inputs, ..THESIS });
            }
        }
    }
    // Fewer outputs, and the other aircraft.
    for plant in [Plant::P2, Plant::P1, Plant::P3] {
        for outputs in Outputs::ALL {
            if (plant, outputs) == (Plant::P2, Outputs::Full) {
                continue;
            }
            let noise = Noise::SENSORS;
            for kind in [
                Kind::Ratio(1e-2),
                Kind::Matched(noise),
                Kind::TimeVarying(noise),
                Kind::Luenberger(SLOW),
                Kind::Luenberger(FAST),
            ] {
                all.push(Chase { plant, outputs, kind, ..THESIS_LUENBERGER });
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::uav::account::states::BANDS;
    use crate::systems::uav::simulate::scenario::INTERVAL_S;

    /// With a pole for each state, every error decays as e^(p·t).
    #[test]
    fn times_follow_from_the_poles() {
        let chase = Chase { plant: Plant::P3, ..THESIS_LUENBERGER };
        let times = chase.times(ScalarKind::F64).unwrap();
        for state in 0..4 {
            let ideal = (chase.off()[state].abs() / BANDS[state]).ln() / -SLOW[state].re;
            let samples = (ideal / INTERVAL_S).ceil();
            assert!((times[state].unwrap() - samples * INTERVAL_S).abs() < 0.0101, "{state}");
        }
    }
}
