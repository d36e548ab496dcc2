//! The responses of the plants without an estimator: the thesis' chapter 5.

use kestirim_observer_design::{self as design, Complex, controllability, eigenvalues};
use kestirim_observer_design::{observability, singular_values};
use kestirim_replay::uav::{Noise, Plant};
use kestirim_simulate::with_outputs;
use kestirim_uav_longitudinal::{StateSpace, full_state};
use nalgebra::{SMatrix, SVector};
use serde::Serialize;

use crate::random::stream;
use crate::systems::uav::simulate::plant::Outputs;
use crate::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, SAMPLES, START, fly};

/// The number of samples of a step response, 25 min in all.
const STEP_SAMPLES: usize = 30_000;
/// The time between the samples of a step response (s).
const STEP_INTERVAL_S: f64 = 0.05;
/// The share of the final value within which a response counts as settled.
const SETTLED: f64 = 0.02;
/// The ratio to the peak below which a final value counts as zero.
const NOTHING: f64 = 1e-9;
/// The number of samples of a plotted response, which are evenly spaced among those computed.
const PLOTTED: usize = 600;

/// The logarithm of the ratio of neighbouring frequencies: twenty per decade, from 0.001 to 100 rad/s.
const BODE_STEP: f64 = std::f64::consts::LN_10 / 20.0;

/// The responses of a plant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Responses {
    /// The aircraft.
    pub plant: Plant,
    /// The real and imaginary parts of the poles (1/s).
    pub poles: [[f64; 2]; 4],
    /// The observability of the least observable mode for each choice of outputs: the smallest singular value of the
    /// PBH test.
    pub observability: Vec<Visibility>,
    /// The controllability of the least controllable mode.
    pub controllability: f64,
    /// The settling times to 2 % of the final value, or of the peak where that is zero (s): a row per input, a column
    /// per state.
    pub settling_s: [[f64; 4]; 2],
    /// The final values of unit step responses.
    pub static_gain: [[f64; 4]; 2],
    /// The largest gain over all frequencies and input directions, and its frequency (rad/s).
    pub peak: Peak,
    /// The step responses, as `[input][sample][state]`, at `step_times_s`.
    pub step: [Vec<[f64; 4]>; 2],
    /// The impulse responses, as `[input][sample][state]`, at `step_times_s`.
    pub impulse: [Vec<[f64; 4]>; 2],
    /// The times of the samples (s).
    pub step_times_s: Vec<f64>,
    /// The frequency response.
    pub bode: Vec<Bode>,
    /// The response to the thesis' constant inputs: t and the state.
    pub constant_inputs: Vec<[f64; 5]>,
}

/// The observability with one choice of outputs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Visibility {
    /// The measured outputs.
    pub outputs: Outputs,
    /// The smallest singular value.
    pub least: f64,
}

/// The maximum of the largest singular value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Peak {
    /// The frequency (rad/s).
    pub omega: f64,
    /// The largest singular value at that frequency.
    pub gain: f64,
}

/// The response at one frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bode {
    /// The frequency (rad/s).
    pub omega: f64,
    /// The gain |G|, with a row per state and a column per input.
    pub magnitude: [[f64; 2]; 4],
    /// The phase arg G (rad), with a row per state and a column per input.
    pub phase: [[f64; 2]; 4],
    /// The largest and the smallest singular value.
    pub singular_values: [f64; 2],
}

/// Computes the responses of a plant.
pub fn responses(plant: Plant) -> Responses {
    const FINITE: &str = "a plant of the experiment";
    let StateSpace { a, b } = plant.model();
    let system = design::StateSpace::new(a, b, full_state());
    let unit =
        |input: usize| SVector::<f64, 2>::from_fn(|row, _| f64::from(u8::from(row == input)));
    let step = |input| system.step_response(&unit(input), STEP_INTERVAL_S).expect(FINITE);
    let impulse = |input| system.impulse_response(&unit(input), STEP_INTERVAL_S).expect(FINITE);
    let gain = system.frequency_response(0.0).expect("no pole at zero");
    let static_gain =
        std::array::from_fn(|input| std::array::from_fn(|state| gain[(state, input)].re));
    let steps = [0, 1].map(|input| step(input).take(STEP_SAMPLES).collect::<Vec<_>>());
    let settling_s = std::array::from_fn(|input| settling(&steps[input], &static_gain[input]));
    let every = STEP_SAMPLES / PLOTTED;
    let thinned = |samples: &[SVector<f64, 4>]| {
        samples.iter().step_by(every).map(|sample| (*sample).into()).collect()
    };
    let impulses = [0, 1].map(|input| impulse(input).take(STEP_SAMPLES).collect::<Vec<_>>());
    let points: Vec<_> =
        (-60..=40).map(|place| bode(&system, (BODE_STEP * f64::from(place)).exp())).collect();
    Responses {
        plant,
        poles: eigenvalues(&a).expect(FINITE).map(|pole| [pole.re, pole.im]),
        observability: Outputs::ALL
            .map(|outputs| {
                let least = with_outputs!(outputs, least_visible, &a);
                Visibility { outputs, least }
            })
            .into(),
        controllability: controllability(&a, &b).expect("the inputs move everything"),
        settling_s,
        static_gain,
        peak: peak(&system, &points),
        step: steps.each_ref().map(|samples| thinned(samples)),
        impulse: impulses.each_ref().map(|samples| thinned(samples)),
        step_times_s: (0..STEP_SAMPLES)
            .step_by(every)
            .map(|sample| sample as f64 * STEP_INTERVAL_S)
            .collect(),
        bode: points,
        constant_inputs: constant_inputs(plant),
    }
}

/// The time from which on each response stays within its band (s).
fn settling(samples: &[SVector<f64, 4>], last: &[f64; 4]) -> [f64; 4] {
    std::array::from_fn(|state| {
        // A pitch angle that comes to rest leaves q with a final value of zero.
        let peak = samples.iter().fold(0.0, |peak, sample| f64::max(peak, sample[state].abs()));
        let size = if last[state].abs() < NOTHING * peak { peak } else { last[state].abs() };
        let outside =
            |sample: &SVector<f64, 4>| (sample[state] - last[state]).abs() > SETTLED * size;
        let samples = samples.iter().rposition(outside).map_or(0, |place| place + 1);
        samples as f64 * STEP_INTERVAL_S
    })
}

fn least_visible<const P: usize>(c: &SMatrix<f64, P, 4>, a: &SMatrix<f64, 4, 4>) -> f64 {
    observability(a, c).expect("the outputs see everything")
}

type Gain = SMatrix<Complex<f64>, 4, 2>;

fn gain_at(system: &design::StateSpace<4, 2, 4>, omega: f64) -> Gain {
    system.frequency_response(omega).expect("no pole on the axis")
}

fn bode(system: &design::StateSpace<4, 2, 4>, omega: f64) -> Bode {
    let gain = gain_at(system, omega);
    let each = |of: fn(&Complex<f64>) -> f64| {
        std::array::from_fn(|state| std::array::from_fn(|input| of(&gain[(state, input)])))
    };
    Bode {
        omega,
        magnitude: each(|number| number.re.hypot(number.im)),
        phase: each(|number| number.im.atan2(number.re)),
        singular_values: singular_values(&gain),
    }
}

/// The phugoid's resonance: the highest point of the Bode diagram, refined between its neighbours.
fn peak(system: &design::StateSpace<4, 2, 4>, bode: &[Bode]) -> Peak {
    let highest = bode.iter().max_by(|a, b| a.singular_values[0].total_cmp(&b.singular_values[0]));
    let mut best = highest.map_or(Peak { omega: 1.0, gain: 0.0 }, |point| Peak {
        omega: point.omega,
        gain: point.singular_values[0],
    });
    let mut width = BODE_STEP;
    while width > 1e-9 {
        let centre = best.omega;
        for place in -10..=10 {
            let omega = centre * (width * f64::from(place) / 10.0).exp();
            let gain = singular_values(&gain_at(system, omega))[0];
            if gain > best.gain && omega >= bode[0].omega {
                best = Peak { omega, gain };
            }
        }
        width /= 5.0;
    }
    best
}

/// Ten seconds of the thesis' constant inputs.
fn constant_inputs(plant: Plant) -> Vec<[f64; 5]> {
    let discrete = plant.discrete(INTERVAL_S);
    let flight = fly(discrete, START.into(), Inputs::Constant, Noise::NONE, stream(0, 0));
    let row = |(sample, state): (usize, SVector<f64, 4>)| {
        let [alpha, q, airspeed, theta] = state.into();
        [sample as f64 * INTERVAL_S, alpha, q, airspeed, theta]
    };
    flight.map(|sample| sample.x).take(SAMPLES + 1).enumerate().map(row).collect()
}

impl Responses {
    /// The natural frequency √(p₁ p₂) (rad/s) and damping ratio −(p₁ + p₂)/2 √(p₁ p₂) of short period and phugoid: of
    /// the two fastest and the two slowest poles, whether real or a pair.
    pub fn modes(&self) -> [[f64; 2]; 2] {
        let mut poles = self.poles;
        poles.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])));
        let [first, second, third, fourth] = poles;
        [[first, second], [third, fourth]].map(|[a, b]| {
            let omega = (a[0].hypot(a[1]) * b[0].hypot(b[1])).sqrt();
            [omega, -(a[0] + b[0]) / (2.0 * omega)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thesis_like_plant_has_a_fast_mode_and_a_hardly_damped_one() {
        let responses = responses(Plant::P2);
        assert!(responses.peak.gain > 14_000.0 && (responses.peak.omega - 0.156).abs() < 1e-3);
        let [[short, damped], [phugoid, lightly]] = responses.modes();
        // The poles at −18.5 and −3.3 do not oscillate.
        assert!((short - 7.8).abs() < 0.1 && (damped - 1.39).abs() < 0.02, "{short} {damped}");
        assert!((phugoid - 0.1565).abs() < 1e-3 && (lightly - 0.0424).abs() < 1e-3);
    }
}
