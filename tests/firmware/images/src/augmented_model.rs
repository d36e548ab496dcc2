//! The aeroplane of `uav` augmented with unknowns: 4 states, 2 gusts, 3 biases, 4 outputs. The host's tests include
//! this file.

use core::array::from_fn;

use kestirim_uav_estimator::{
    AugmentedFilter, AugmentedModel, AugmentedTransition, Drift, Error, Gust, Output, Reference,
};
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::SMatrix;

use crate::uav::{A, B};

/// The filter in single precision.
pub type Filter = AugmentedFilter<f32, 9, 6, 4>;
/// The transition of one step of the filter.
pub type Transition = AugmentedTransition<f32, 9, 6>;

/// The airspeed of the steady flight, m/s.
const AIRSPEED: f64 = 40.0;

/// The filter, its transition over an interval (s), and the factors that convert outputs to the filter's units, which
/// are powers of two.
///
/// # Errors
/// None, as the tests show.
pub fn filter(interval: f64) -> Result<(Filter, Transition, [f32; 4]), Error> {
    let density = SMatrix::from_diagonal(&[1e-6, 1e-3, 1e-2, 1e-8].into());
    // There is no sensor for it here: it is set to what the elevator adds directly, with little weight.
    let force = Output {
        row: [-71.6, 0.0, -0.304, -0.684],
        direct: [12.0, -6.3],
        sigma: 5.0,
        reference: Reference::Pressure { steady: -9.8, airspeed: AIRSPEED },
    };
    let [rate, airspeed, pitch] = [(1, 0.0087), (2, 0.5), (3, 0.0087)];
    let state = |(state, sigma)| Output::state(state, sigma);
    let outputs = [state(rate), state(airspeed), state(pitch), force];
    let bias = Drift { sigma: 0.02, rate: 1e-5 };
    let gust = Gust { sigmas: [2.0; 2], lengths: [300.0; 2], airspeed: AIRSPEED };
    let model = AugmentedModel::new(&StateSpace { a: A, b: B }, &density, &outputs)?
        .with_gust(&gust)?
        .with_bias(0, &bias)?
        .with_bias(2, &bias)?
        .with_bias(3, &Drift { sigma: 0.05, rate: 0.01 })?;
    let step = model.over(interval, interval, &[0.0087, 0.02].into())?;
    let filter = Filter::new(&model)?;
    let transition = filter.transition(&step);
    let units = *filter.output_units();
    Ok((filter, transition, from_fn(|output| units[output].recip() as f32)))
}

/// Takes a sample, inputs and three outputs of the log, and returns the bits of the four states.
///
/// # Errors
/// Those of the filter.
pub fn step(
    filter: &mut Filter,
    transition: &Transition,
    scales: &[f32; 4],
    inputs: [f32; 2],
    outputs: [f32; 3],
) -> Result<[i64; 4], Error> {
    let [elevator, throttle] = inputs;
    let [rate, airspeed, pitch] = outputs;
    let all = [rate, airspeed, pitch, 12.0 * elevator - 6.3 * throttle];
    let measured = from_fn(|output| Some(all[output] * scales[output]));
    let inputs = inputs.into();
    filter.step(transition, &inputs, &measured, &inputs)?;
    Ok(from_fn(|state| i64::from(filter.state().mean[state].to_bits())))
}
