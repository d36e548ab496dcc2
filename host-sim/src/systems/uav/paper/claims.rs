//! The conclusions of the thesis, tested by measurements.

use kestirim_observer_design::eigenvalues;
use kestirim_replay::uav::{FAST, Noise, Plant, SLOW};
use kestirim_uav_longitudinal::full_state;
use serde::Serialize;

use super::accuracy::{self, Window};
use super::catching::{self, Chase};
use crate::system::ScalarKind;
use crate::systems::uav::simulate::design::{Family, Kind};
use crate::systems::uav::simulate::plant::Outputs;
use crate::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, NEAR};

/// A claim tested in one setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// The claim.
    pub claim: &'static str,
    /// The setting in which it is tested.
    pub setting: &'static str,
    /// The results of the Kalman filter for α, q, V, θ: RMSE (rad, rad/s, m/s, rad) or times to catch (s).
    pub kalman: [f64; 4],
    /// The results of the best Luenberger observer of the table, state by state.
    pub luenberger: [f64; 4],
    /// Whether the claim holds for every state.
    pub holds: bool,
}

/// The claim for flights with noise.
const NOISY: &str = "with noise, Kalman better on every state";
/// The claim for flights without noise.
const QUIET: &str = "without noise, Luenberger faster on every state";

/// The claims, evaluated from the rows of the tables.
pub fn claims(caught: &[catching::Row], accuracy: &[accuracy::Row]) -> Vec<Claim> {
    let thesis = Kind::Ratio(1e-2).name();
    let noisy = [
        (
            Family::Kalman,
            None,
            Noise::SENSORS,
            Window::Settled,
            "settled, the filter for the noise there is",
        ),
        (
            Family::Kalman,
            None,
            Noise::SENSORS,
            Window::Whole,
            "10 s from a wrong start, steady-state gain",
        ),
        (
            Family::TimeVarying,
            None,
            Noise::SENSORS,
            Window::Whole,
            "10 s from a wrong start, time-varying gain",
        ),
        (
            Family::Kalman,
            Some(thesis.as_str()),
            Noise::EQUAL,
            Window::Settled,
            "settled, the gain that explains the thesis' figures",
        ),
    ];
    let noisy = noisy.into_iter().filter_map(|(family, name, noise, window, setting)| {
        let of = |family, name| best_rmse(accuracy, family, name, noise, window);
        let (kalman, luenberger) = (of(family, name)?, of(Family::Luenberger, None)?);
        let holds = kalman.iter().zip(&luenberger).all(|(k, l)| k <= l);
        Some(Claim { claim: NOISY, setting, kalman, luenberger, holds })
    });
    let quiet = [
        ("the gain that explains the thesis' figures", Family::Kalman, Some(thesis.as_str())),
        ("the best steady-state gain of each state", Family::Kalman, None),
        ("time-varying gain", Family::TimeVarying, None),
    ];
    let quiet = quiet.into_iter().filter_map(|(setting, family, name)| {
        let kalman = best_time(caught, family, name)?;
        let luenberger = best_time(caught, Family::Luenberger, None)?;
        let holds = kalman.iter().zip(&luenberger).all(|(k, l)| l < k);
        Some(Claim { claim: QUIET, setting, kalman, luenberger, holds })
    });
    noisy.chain(quiet).collect()
}

/// The smallest RMSE of each state, for the thesis' aircraft and outputs with constant inputs.
fn best_rmse(
    rows: &[accuracy::Row],
    family: Family,
    name: Option<&str>,
    noise: Noise,
    window: Window,
) -> Option<[f64; 4]> {
    let rows = rows.iter().filter(|row| {
        (row.plant, row.outputs) == (Plant::P2, Outputs::Full)
            && (row.noise, row.inputs) == (noise, Inputs::Constant)
            && row.family == family
            && name.is_none_or(|name| row.estimator == name)
            && row.window == window
    });
    rows.map(|row| row.rmse).reduce(least)
}

/// The shortest time to catch each state, for the thesis' aircraft, outputs and inputs and the near start; never counts
/// as infinity.
fn best_time(rows: &[catching::Row], family: Family, name: Option<&str>) -> Option<[f64; 4]> {
    let rows = rows.iter().filter(|row| {
        (row.plant, row.outputs, row.inputs) == (Plant::P2, Outputs::Full, Inputs::Constant)
            && row.start == NEAR
            && row.family == family
            && name.is_none_or(|name| row.estimator == name)
    });
    let times = rows.filter_map(|row| row.ours_s);
    times.map(|times| times.map(|time| time.unwrap_or(f64::INFINITY))).reduce(least)
}

fn least(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|state| a[state].min(b[state]))
}

/// The slowest poles of a steady-state filter (1/s): with process noise on the inputs they approach the plant's zeros
/// and no further, however little the filter trusts its model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SlowestPoles {
    /// The ratio of the variances of the inputs' and the outputs' noise.
    pub ratio: f64,
    /// The two slowest poles, the slowest first.
    pub poles: [f64; 2],
}

/// The slowest poles for the thesis' aircraft.
pub fn slowest_poles() -> Vec<SlowestPoles> {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let row = |ratio: f64| {
        let gain = Kind::Ratio(ratio).gain(&plant, &full_state()).expect("a gain of the table");
        let poles = eigenvalues(&(plant.a - gain)).expect("finite numbers");
        let mut rates = poles.map(|pole| pole.re.hypot(pole.im).ln() / INTERVAL_S);
        rates.sort_by(|a, b| b.total_cmp(a));
        SlowestPoles { ratio, poles: [rates[0], rates[1]] }
    };
    [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6, 1e8].into_iter().map(row).collect()
}

/// A test that the errors are independent of the inputs, as e⁺ = (A − L·C)·e does not contain them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Independence {
    /// The name of the estimator.
    pub estimator: String,
    /// The largest errors of α, q, V, θ in ten seconds of constant inputs.
    pub largest_error: [f64; 4],
    /// The largest difference between the errors under sine and constant inputs, over all samples.
    pub difference: [f64; 4],
}

/// The tests for the thesis' aircraft.
pub fn independence(scalar: ScalarKind) -> Vec<Independence> {
    let kinds = [
        Kind::Ratio(1e-2),
        Kind::TimeVarying(Noise::SENSORS),
        Kind::Luenberger(SLOW),
        Kind::Luenberger(FAST),
    ];
    let row = |kind: Kind| {
        let (plant, outputs, start) = (Plant::P2, Outputs::Full, NEAR);
        let errors = |inputs| Chase { plant, outputs, kind, start, inputs }.errors(scalar).ok();
        let (constant, sine) = (errors(Inputs::Constant)?, errors(Inputs::Sine)?);
        let largest = |of: &dyn Fn(usize, usize) -> f64| {
            std::array::from_fn(|state| {
                (0..constant.len()).map(|sample| of(sample, state).abs()).fold(0.0, f64::max)
            })
        };
        Some(Independence {
            estimator: kind.name(),
            largest_error: largest(&|sample, state| constant[sample][state]),
            difference: largest(&|sample, state| sine[sample][state] - constant[sample][state]),
        })
    };
    kinds.into_iter().filter_map(row).collect()
}
