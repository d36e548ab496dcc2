//! The Kalman filter along a stretch, and the dependence of its innovations on the unknown initial conditions.

use std::collections::HashMap;

use nalgebra::{Matrix4, RowVector4, SMatrix, Vector4};

use crate::flight::{OUTPUTS, Segment};
use crate::structure::Structure;

/// Number of unknowns of a stretch in which its innovations are linear: the initial state, a constant part of ẋ, and
/// the offsets of az and ax.
pub(crate) const UNKNOWNS: usize = 10;
/// Prior standard deviations of these unknowns: a flight near its reference, moderate sensor errors.
pub(crate) const EXPECTED: [f64; UNKNOWNS] = [0.2, 0.3, 20.0, 0.5, 0.05, 0.3, 1.0, 0.05, 1.0, 1.0];
const COLUMNS: usize = UNKNOWNS + 1;

/// The innovation of a measurement, before its update.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Innovation {
    /// Index of the output.
    pub(crate) output: usize,
    /// Index of the sample.
    pub(crate) sample: usize,
    /// The measurement minus its prediction, followed by the derivatives with respect to the unknowns.
    pub(crate) value: [f64; COLUMNS],
    pub(crate) variance: f64,
}

/// A model with its assumed noise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Filter<'a> {
    pub(crate) structure: &'a Structure,
    /// Spectral densities of the noise on ẋ.
    pub(crate) process: [f64; 4],
    /// Variance of the noise of each output.
    pub(crate) measured: [f64; OUTPUTS],
    /// Delay of the inputs, s.
    pub(crate) delay: f64,
}

struct Step {
    states: Matrix4<f64>,
    inputs: SMatrix<f64, 4, 2>,
    constant: Matrix4<f64>,
    noise: Matrix4<f64>,
}

impl Filter<'_> {
    fn step(&self, interval: f64) -> Step {
        let Structure { a, b, .. } = self.structure;
        let mut block = SMatrix::<f64, 10, 10>::zeros();
        block.fixed_view_mut::<4, 4>(0, 0).copy_from(a);
        block.fixed_view_mut::<4, 2>(0, 4).copy_from(b);
        block.fixed_view_mut::<4, 4>(0, 6).fill_with_identity();
        let whole = (block * interval).exp();
        let states: Matrix4<f64> = whole.fixed_view::<4, 4>(0, 0).into_owned();
        let density = Matrix4::from_diagonal(&Vector4::from(self.process));
        // Simpson's rule: the integrand is approximated by a parabola.
        let half: Matrix4<f64> = (a * (interval / 2.0)).exp();
        let between = half * density * half.transpose() * 4.0;
        let noise = (density + between + states * density * states.transpose()) * (interval / 6.0);
        Step {
            states,
            inputs: whole.fixed_view::<4, 2>(0, 4).into_owned(),
            constant: whole.fixed_view::<4, 4>(0, 6).into_owned(),
            noise,
        }
    }

    /// Filters a stretch: the innovations at each time, one output after the other.
    pub(crate) fn innovations(&self, segment: &Segment) -> Vec<Innovation> {
        let Structure { c, d, .. } = self.structure;
        // A held input is half an interval late on average, but acts immediately.
        let late = (self.delay - 0.5 * segment.interval()).max(0.0);
        let is_noisy = self.process.iter().any(|density| *density > 0.0);
        let mut steps: HashMap<i64, Step> = HashMap::new();
        let mut mean = SMatrix::<f64, 4, COLUMNS>::zeros();
        mean.fixed_view_mut::<4, 4>(0, 1).fill_with_identity();
        let mut covariance = Matrix4::<f64>::zeros();
        let mut innovations = Vec::with_capacity(segment.times.len() * OUTPUTS);
        for (sample, measured) in segment.measured.iter().enumerate() {
            let time = segment.times[sample];
            if sample > 0 {
                let ticks = segment.ticks[sample] - segment.ticks[sample - 1];
                let step =
                    steps.entry(ticks).or_insert_with(|| self.step(ticks as f64 * segment.tick));
                let middle = 0.5 * (time + segment.times[sample - 1]);
                let input = segment.input_at(middle - self.delay);
                mean = step.states * mean;
                for (state, value) in mean.column_mut(0).iter_mut().enumerate() {
                    *value +=
                        step.inputs[(state, 0)] * input[0] + step.inputs[(state, 1)] * input[1];
                }
                let mut constant = mean.fixed_view_mut::<4, 4>(0, 5);
                constant += step.constant;
                if is_noisy {
                    covariance = step.states * covariance * step.states.transpose() + step.noise;
                }
            }
            let input = segment.input_at(time - late);
            for output in 0..OUTPUTS {
                let Some(measured) = measured[output] else { continue };
                let row: RowVector4<f64> = c.row(output).into_owned();
                let predicted = row * mean;
                let mut value: [f64; COLUMNS] = std::array::from_fn(|column| -predicted[column]);
                value[0] += measured - d[(output, 0)] * input[0] - d[(output, 1)] * input[1];
                if let Some(force) = output.checked_sub(4) {
                    value[9 + force] -= 1.0;
                }
                let spread = covariance * row.transpose();
                let variance = (row * spread)[0] + self.measured[output];
                innovations.push(Innovation { output, sample, value, variance });
                if is_noisy {
                    let gain = spread / variance;
                    mean += gain * SMatrix::<f64, 1, COLUMNS>::from(value.map(|it| [it]));
                    covariance -= gain * spread.transpose();
                }
            }
        }
        innovations
    }
}
