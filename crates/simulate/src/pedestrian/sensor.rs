//! An IMU like the Razor's MPU-9250, and the text file in which the paper logs it.

use std::fmt::Write;

use kestirim_replay::metrics::STANDARD_GRAVITY;
use kestirim_replay::pedestrian::Sample;
use rand_core::Rng;

use crate::random::{normal, normal3};

/// The time constant of the bias's slow wandering, s.
const WANDER_S: f64 = 100.0;
/// The steps of a 16-bit converter on either side of zero.
const STEPS: f64 = 32_768.0;

/// The specification of a triad of equal axes, in the units of the triad: m/s² or rad/s.
struct DataSheet {
    /// The largest magnitude that the sensor measures.
    range: f64,
    /// The density of the white noise, one-sided, per √Hz.
    noise_density: f64,
    /// The standard deviation of the turn-on bias.
    turn_on_bias: f64,
    /// The standard deviation of the bias's wandering after that.
    bias_wander: f64,
    /// The standard deviation of the scale factor about 1.
    scale: f64,
}

const MILLI_G: f64 = STANDARD_GRAVITY / 1000.0;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

const ACCELEROMETER: DataSheet = DataSheet {
    range: 16_000.0 * MILLI_G,
    noise_density: 0.3 * MILLI_G,
    turn_on_bias: 25.0 * MILLI_G,
    bias_wander: 0.2 * MILLI_G,
    scale: 0.005,
};

const GYROSCOPE: DataSheet = DataSheet {
    range: 2000.0 * DEGREE,
    noise_density: 0.01 * DEGREE,
    turn_on_bias: 1.0 * DEGREE,
    bias_wander: 0.005 * DEGREE,
    scale: 0.0075,
};

/// The biases and scale factors of three axes, as drawn when the sensor was switched on.
struct Triad {
    sheet: DataSheet,
    bias: [f64; 3],
    wander: [f64; 3],
    scale: [f64; 3],
}

impl Triad {
    fn draw<R: Rng + ?Sized>(rng: &mut R, sheet: DataSheet) -> Self {
        let bias = normal3(rng, sheet.turn_on_bias)
            // No sensor leaves the factory with more than twice this standard deviation.
            .map(|bias| bias.clamp(-2.0 * sheet.turn_on_bias, 2.0 * sheet.turn_on_bias));
        let wander = normal3(rng, sheet.bias_wander);
        let scale = normal3(rng, sheet.scale).map(|error| 1.0 + error);
        Self { sheet, bias, wander, scale }
    }

    fn measure<R: Rng + ?Sized>(&mut self, rng: &mut R, truth: [f64; 3], dt: f64) -> [f64; 3] {
        let DataSheet { range, noise_density, bias_wander, .. } = self.sheet;
        let kept = (-dt / WANDER_S).exp();
        // Averaging over dt leaves a noise bandwidth of 1 / (2 dt).
        let noise = noise_density / (2.0 * dt).sqrt();
        let step = range / STEPS;
        std::array::from_fn(|i| {
            let stirred = normal(rng, bias_wander * (1.0 - kept * kept).sqrt());
            self.wander[i] = kept * self.wander[i] + stirred;
            let value =
                self.scale[i] * truth[i] + self.bias[i] + self.wander[i] + normal(rng, noise);
            ((value / step).round() * step).clamp(-range, range - step)
        })
    }
}

/// Distorts the samples of a perfect IMU at `rate_hz` as a Razor does that was just switched on.
pub fn measure<R: Rng + ?Sized>(rng: &mut R, ideal: &[Sample], rate_hz: f64) -> Vec<Sample> {
    let mut accelerometer = Triad::draw(rng, ACCELEROMETER);
    let mut gyroscope = Triad::draw(rng, GYROSCOPE);
    let measured = ideal.iter().map(|truth| Sample {
        time_us: truth.time_us,
        specific_force: accelerometer.measure(rng, truth.specific_force, 1.0 / rate_hz),
        angular_rate: gyroscope.measure(rng, truth.angular_rate, 1.0 / rate_hz),
    });
    measured.collect()
}

/// The samples in the paper's text format: whole milliseconds, 0.01 g, 0.01 °/s, no header.
pub fn razor_text(samples: &[Sample]) -> String {
    let mut text = String::new();
    for sample in samples {
        let milliseconds = (sample.time_us as f64 / 1e3).round();
        let [ax, ay, az] = sample.specific_force.map(|force| force / STANDARD_GRAVITY);
        let [gx, gy, gz] = sample.angular_rate.map(f64::to_degrees);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{milliseconds} {ax:.2} {ay:.2} {az:.2} {gx:.2} {gy:.2} {gz:.2}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::stream;
    use kestirim_replay::metrics::{mean, standard_deviation};

    fn at_rest(seconds: u64, rate_hz: u64) -> Vec<Sample> {
        let sample = |i| Sample {
            time_us: i * 1_000_000 / rate_hz,
            specific_force: [0.0, 0.0, STANDARD_GRAVITY],
            angular_rate: [0.0; 3],
        };
        (1..=seconds * rate_hz).map(sample).collect()
    }

    #[test]
    fn noise_has_the_density_of_the_data_sheet_at_any_rate() {
        for rate_hz in [50, 100] {
            let measured = measure(&mut stream(1, 0), &at_rest(20, rate_hz), rate_hz as f64);
            let x: Vec<_> = measured.iter().map(|sample| sample.specific_force[0]).collect();
            let expected = ACCELEROMETER.noise_density * (rate_hz as f64 / 2.0).sqrt();
            assert!((standard_deviation(&x) / expected - 1.0).abs() < 0.15);
        }
    }

    #[test]
    fn the_bias_differs_from_walk_to_walk() {
        let bias = |index| {
            let measured = measure(&mut stream(1, index), &at_rest(1, 100), 100.0);
            mean(&measured.iter().map(|sample| sample.angular_rate[1]).collect::<Vec<_>>())
        };
        let biases: Vec<_> = (0..200).map(bias).collect();
        assert!((0.8..1.1).contains(&(standard_deviation(&biases) / GYROSCOPE.turn_on_bias)));
    }

    #[test]
    fn large_values_saturate() {
        let mut sample = at_rest(1, 1);
        sample[0].specific_force = [1e4, -1e4, 0.0];
        let [x, y, _] = measure(&mut stream(1, 0), &sample, 100.0)[0].specific_force;
        assert!((x / STANDARD_GRAVITY - 16.0).abs() < 1e-3);
        assert!((y / STANDARD_GRAVITY + 16.0).abs() < 1e-3);
    }

    #[test]
    fn text_is_that_of_the_paper() {
        assert_eq!(razor_text(&at_rest(1, 1)), "1000 0.00 0.00 1.00 0.00 0.00 0.00\n");
    }
}
