//! Root mean square errors under noise, beside those predicted by the Lyapunov equation.

use kestirim_observer_design::Discrete;
use kestirim_replay::uav::{FAST, MIDDLE, Noise, Plant, SLOW};
use kestirim_simulate::with_outputs;
use kestirim_sweep::{Block, Samples};
use nalgebra::{SMatrix, SVector};
use serde::Serialize;

use crate::system::ScalarKind;
use crate::systems::uav::simulate::design::{Family, Kind, settled};
use crate::systems::uav::simulate::errors::Errors;
use crate::systems::uav::simulate::flight::Flight;
use crate::systems::uav::simulate::plant::Outputs;
use crate::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, NEAR, SAMPLES, START};

/// The number of samples after which an estimator started at the truth has settled: the slowest error of the
/// experiment, that of the Navion's airspeed, has by then decayed to a hundredth.
const SETTLING: usize = 2000;

/// A set of estimators that fly together, with the same noise.
#[derive(Debug, Clone)]
pub struct Cell {
    /// The aircraft.
    pub plant: Plant,
    /// The measured outputs.
    pub outputs: Outputs,
    /// The noise of the flight.
    pub noise: Noise,
    /// The pilot's inputs.
    pub inputs: Inputs,
    /// The part of the flight that is evaluated.
    pub window: Window,
    /// The estimators.
    pub kinds: Vec<Kind>,
}

/// The part of a flight that is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Window {
    /// The whole flight, with an error at the start.
    Whole,
    /// The last ten of thirty seconds, started at the truth.
    Settled,
}

/// A row of the table: the errors of one estimator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The aircraft.
    pub plant: Plant,
    /// The measured outputs.
    pub outputs: Outputs,
    /// The noise of the flight.
    pub noise: Noise,
    /// The pilot's inputs.
    pub inputs: Inputs,
    /// The part of the flight that is evaluated.
    pub window: Window,
    /// The name of the estimator.
    pub estimator: String,
    /// The family of the estimator.
    pub family: Family,
    /// The RMSE of α (rad), q (rad/s), V (m/s), θ (rad).
    pub rmse: [f64; 4],
    /// The predicted RMSE: from the Lyapunov equation when settled, else from its recursion.
    pub predicted: [f64; 4],
    /// The number of steps that failed in the number type.
    pub refused: u32,
}

impl Row {
    /// The relative difference from the prediction, of the state for which it is largest.
    pub fn off(&self) -> f64 {
        let ratios = self.rmse.iter().zip(&self.predicted).map(|(ours, ideal)| ours / ideal - 1.0);
        ratios.fold(0.0, |worst, ratio| if ratio.abs() > f64::abs(worst) { ratio } else { worst })
    }
}

/// All cells of the experiment.
pub fn cells() -> Vec<Cell> {
    let observers = [SLOW, MIDDLE, FAST].map(Kind::Luenberger);
    let with = |first: &[Kind]| first.iter().copied().chain(observers).collect::<Vec<_>>();
    let sensors = Noise::SENSORS;
    let both = [Kind::Matched(sensors), Kind::TimeVarying(sensors)];
    let mut cells = Vec::new();
    for outputs in Outputs::ALL {
        for (window, kinds) in [(Window::Settled, &both[..1]), (Window::Whole, &both)] {
            let (plant, noise, kinds) = (Plant::P2, sensors, with(kinds));
            cells.push(Cell { plant, outputs, noise, inputs: Inputs::Constant, window, kinds });
        }
    }
    // As in the thesis: equal noise, which the filter assumes as well; ten seconds from another start.
    for (window, inputs) in [
        (Window::Settled, Inputs::Constant),
        (Window::Whole, Inputs::Constant),
        (Window::Whole, Inputs::Sine),
    ] {
        let (plant, outputs, noise) = (Plant::P2, Outputs::Full, Noise::EQUAL);
        let kinds = with(&[1e-2, 1.0, 1e2].map(Kind::Ratio));
        cells.push(Cell { plant, outputs, noise, inputs, window, kinds });
    }
    for plant in [Plant::P1, Plant::P3] {
        let (outputs, noise, kinds) = (Outputs::RateAirspeedPitch, sensors, with(&both[..1]));
        let (inputs, window) = (Inputs::Constant, Window::Settled);
        cells.push(Cell { plant, outputs, noise, inputs, window, kinds });
    }
    cells
}

impl Cell {
    /// The flights of the cell as a block of trials.
    pub fn block(&self, place: usize, scalar: ScalarKind, seed: u64, trials: u64) -> Block {
        let numbers = ["α", "q", "V", "θ"].map(|state| format!("sum of {state} error squared"));
        let numbers = [&numbers[..], &["refused".to_owned()]].concat();
        let columns = self.kinds.iter().flat_map(|kind| {
            let name = kind.name();
            numbers.iter().map(move |number| format!("{name}: {number}")).collect::<Vec<_>>()
        });
        let columns: Vec<_> = columns.collect();
        let flight = Flight {
            plant: self.plant,
            outputs: self.outputs,
            inputs: self.inputs,
            noise: self.noise,
            truth: START,
            start: self.start(),
            samples: self.settling() + SAMPLES,
        };
        let flights = flight.errors(&self.kinds, self.settling(), scalar, seed);
        let flights = flights.expect("estimators of the table");
        let numbers = |Errors { squares: [a, q, v, t], refused }| [a, q, v, t, f64::from(refused)];
        Block::new(format!("cell {place}"), columns, trials, move |index| {
            Ok(flights(index).into_iter().flat_map(numbers).collect())
        })
    }

    /// Evaluates the flights.
    pub fn rows(&self, flights: &Samples) -> Vec<Row> {
        let count = flights.len() as f64 * SAMPLES as f64;
        let row = |(place, kind): (usize, &Kind)| {
            let mut squares = SVector::<f64, 4>::zeros();
            let mut refused = 0;
            for flight in flights.rows() {
                let flight = &flight[place * NUMBERS..];
                squares += SVector::<f64, 4>::from_column_slice(&flight[..4]);
                refused += flight[4] as u32;
            }
            Row {
                plant: self.plant,
                outputs: self.outputs,
                noise: self.noise,
                inputs: self.inputs,
                window: self.window,
                estimator: kind.name(),
                family: kind.family(),
                rmse: squares.map(|sum| (sum / count).sqrt()).into(),
                predicted: self.predicted(kind),
                refused,
            }
        };
        self.kinds.iter().enumerate().map(row).collect()
    }

    /// The predicted RMSE of α, q, V, θ: from the Lyapunov equation when settled, else from its recursion.
    pub fn predicted(&self, kind: &Kind) -> [f64; 4] {
        with_outputs!(self.outputs, predicted, self, kind)
    }

    fn start(&self) -> [f64; 4] {
        if self.window == Window::Whole { NEAR } else { START }
    }

    /// The number of samples before those that are evaluated.
    fn settling(&self) -> usize {
        if self.window == Window::Whole { 0 } else { SETTLING }
    }
}

/// The number of values per flight and estimator: the sums of its squared errors, and the number of failed steps.
const NUMBERS: usize = 5;

fn predicted<const P: usize>(c: &SMatrix<f64, P, 4>, cell: &Cell, kind: &Kind) -> [f64; 4] {
    let plant = cell.plant.discrete(INTERVAL_S);
    if cell.window == Window::Whole {
        let (q, r) = (cell.noise.process(&plant), cell.noise.measurement(c));
        let off = SVector::from(START) - SVector::from(cell.start());
        return over_a_flight(c, &plant, kind, &q, &r, &off);
    }
    settled(c, &plant, kind, &cell.noise).expect("a stable estimator of the table")
}

/// The root mean square error over a flight, from the mean and covariance of the error propagated sample by sample. The
/// initial error is given; only the estimator treats it as random.
fn over_a_flight<const P: usize>(
    c: &SMatrix<f64, P, 4>,
    plant: &Discrete<4, 2>,
    kind: &Kind,
    q: &SMatrix<f64, 4, 4>,
    r: &SMatrix<f64, P, P>,
    off: &SVector<f64, 4>,
) -> [f64; 4] {
    let settled = kind.gain(plant, c).expect("an estimator of the table");
    let mut believed = SMatrix::from_diagonal(&off.component_mul(off));
    let (mut mean, mut covariance) = (*off, SMatrix::<f64, 4, 4>::zeros());
    let mut squares = SVector::<f64, 4>::zeros();
    for _ in 0..SAMPLES {
        squares += mean.component_mul(&mean) + covariance.diagonal();
        let gain = if let Kind::TimeVarying(_) = kind {
            let innovation = c * believed * c.transpose() + r;
            let inverse = innovation.try_inverse().expect("noise in every output");
            let gain = plant.a * believed * c.transpose() * inverse;
            believed = (plant.a - gain * c) * believed * plant.a.transpose() + q;
            gain
        } else {
            settled
        };
        let error = plant.a - gain * c;
        mean = error * mean;
        covariance = error * covariance * error.transpose() + q + gain * r * gain.transpose();
    }
    squares.map(|sum| (sum / SAMPLES as f64).sqrt()).into()
}
