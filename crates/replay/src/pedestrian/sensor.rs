//! The class of a sensor from its log: by the gyroscope's zero at rest, and the step of its numbers.

use kestirim_pedestrian::SensorClass;

use super::Sample;

/// The largest zero of a calibrated unit's gyroscope, rad/s. At rest those of the walks in the book were off by 1 to 9
/// mrad/s, bare chips by 15 to 21.
const CALIBRATED: f64 = 0.012;
/// The number of standard deviations by which the zero must exceed that: people sway.
const DOUBT: f64 = 3.0;
/// Standard deviation of a standstill's mean in addition to its own spread, rad/s.
const FLOOR: f64 = 0.0007;
/// The length of a standstill, in eighths of a second.
const EIGHTHS: usize = 4;
/// The largest difference between the mean rates of the eighths of a standstill, rad/s.
const RATE_SPREAD: f64 = 0.03;
/// The largest difference between the mean forces of the eighths of a standstill, m/s².
const FORCE_SPREAD: f64 = 0.4;
/// The spread of the eighths of a standstill above which it may be a sway, rad/s, if it also exceeds `SWAY`.
const CALM: f64 = 0.005;
/// The spread of the eighths of a standstill above which it may be a sway, as a share of their mean.
const SWAY: f64 = 0.2;
/// The largest zero of any gyroscope, rad/s.
const LARGEST: f64 = 0.35;
/// An eighth of a second, µs.
const EIGHTH_US: u64 = 125_000;

/// The full scales of chips, °/s, whose steps are a 32768th of them; and the steps of chips that are specified
/// directly, °/s.
const FULL_SCALES: [f64; 5] = [125.0, 250.0, 500.0, 1000.0, 2000.0];
const STEPS: [f64; 9] =
    [1.0 / 131.0, 1.0 / 65.5, 1.0 / 32.8, 1.0 / 16.4, 0.004_375, 0.008_75, 0.0175, 0.035, 0.07];
/// The largest rate that is tested, in steps, so that a step known to a thousandth counts them correctly.
const COUNTED: f64 = 120.0;
/// The largest deviation of a number from a whole number of steps, as it is written.
const WRITTEN: f64 = 0.05;
/// The percentage of numbers that must be whole.
const WHOLE: usize = 98;
/// The fewest numbers that are tested.
const NUMBERS: usize = 300;

/// The class of the sensor, from what it `measured` and the samples `corrected` by a calibration: bare if its numbers
/// are a chip's own steps, if its zero is surely off, or if it never stood still.
pub fn sensor_class(corrected: &[Sample], measured: &[Sample]) -> SensorClass {
    let standstills = standstills(corrected);
    let is_off = zero(&standstills)
        .is_some_and(|(zero, deviation)| norm(zero) - DOUBT * deviation > CALIBRATED);
    if standstills.is_empty() || is_off || is_raw(measured) {
        SensorClass::Consumer
    } else {
        SensorClass::Industrial
    }
}

/// The mean rate over half a second at rest, and the spread of its eighths, rad/s.
type Standstill = ([f64; 3], f64);

fn standstills(samples: &[Sample]) -> Vec<Standstill> {
    let start_us = samples.first().map_or(0, |sample| sample.time_us);
    let eighth = |sample: &Sample| (sample.time_us - start_us) / EIGHTH_US;
    let mut run: Vec<[[f64; 3]; 2]> = Vec::new();
    let mut found = Vec::new();
    for part in samples.chunk_by(|a, b| eighth(a) == eighth(b)) {
        let mean = |of: fn(&Sample) -> [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| {
                part.iter().map(|sample| of(sample)[i]).sum::<f64>() / part.len() as f64
            })
        };
        let now = [mean(|sample| sample.angular_rate), mean(|sample| sample.specific_force)];
        let agrees = |first: &[[f64; 3]; 2]| {
            apart(first[0], now[0]) < RATE_SPREAD && apart(first[1], now[1]) < FORCE_SPREAD
        };
        if !run.first().is_some_and(agrees) || apart([0.0; 3], now[0]) > LARGEST {
            run.clear();
        }
        run.push(now);
        if run.len() == EIGHTHS {
            found.push(summed_up(&run));
            run.clear();
        }
    }
    found
}

fn summed_up(run: &[[[f64; 3]; 2]]) -> Standstill {
    let count = run.len() as f64;
    let mean = std::array::from_fn(|i| run.iter().map(|[rate, _]| rate[i]).sum::<f64>() / count);
    let square =
        |[rate, _]: &[[f64; 3]; 2]| (0..3).map(|i| (rate[i] - mean[i]).powi(2)).sum::<f64>() / 3.0;
    (mean, (run.iter().map(square).sum::<f64>() / count).sqrt())
}

/// The gyroscope's zero, rad/s, from all standstills that cannot be a person's sway, and its standard deviation; `None`
/// without such standstills.
fn zero(standstills: &[Standstill]) -> Option<([f64; 3], f64)> {
    let is_calm = |(rate, spread): &&Standstill| *spread < CALM.max(SWAY * norm(*rate));
    let calm: Vec<_> = standstills.iter().filter(is_calm).collect();
    let weight = |spread: f64| 1.0 / (spread * spread + FLOOR * FLOOR);
    let sum: f64 = calm.iter().map(|(_, spread)| weight(*spread)).sum();
    let mean = std::array::from_fn(|i| {
        calm.iter().map(|(rate, spread)| rate[i] * weight(*spread)).sum::<f64>() / sum
    });
    (!calm.is_empty()).then(|| (mean, sum.sqrt().recip()))
}

/// Whether the rates are whole multiples of a chip's step.
fn is_raw(samples: &[Sample]) -> bool {
    let steps = FULL_SCALES.iter().map(|scale| scale / 32_768.0).chain(STEPS);
    steps.map(f64::to_radians).any(|step| {
        let (mut whole, mut all) = (0, 0);
        for rate in samples.iter().flat_map(|sample| sample.angular_rate) {
            let count = rate / step;
            if count.abs() > COUNTED || count.abs() < 0.5 {
                continue;
            }
            all += 1;
            whole += usize::from((count - count.round()).abs() < WRITTEN);
        }
        all >= NUMBERS && 100 * whole >= WHOLE * all
    })
}

/// The largest difference of any component.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three seconds at rest with this zero and a sway of the given amplitude, rad/s, written in steps.
    fn still(zero: f64, sway: f64, step: f64) -> Vec<Sample> {
        let rate = |k: u64, axis: u64| {
            let noise = 0.002 * ((k * 379 + axis * 137) % 101) as f64 / 50.0 - 0.002;
            let sway = sway * (k as f64 / 40.0).sin();
            let value = if axis == 0 { zero + sway + noise } else { noise };
            if step > 0.0 { (value / step).round() * step } else { value }
        };
        let sample = |k: u64| Sample {
            time_us: 10_000 * k,
            specific_force: [0.0, 0.02, 9.8],
            angular_rate: [rate(k, 0), rate(k, 1), rate(k, 2)],
        };
        (0..300).map(sample).collect()
    }

    fn of(samples: &[Sample]) -> SensorClass {
        sensor_class(samples, samples)
    }

    #[test]
    fn the_zero_at_rest_tells_the_class() {
        assert_eq!(of(&still(0.004, 0.0, 0.0)), SensorClass::Industrial);
        assert_eq!(of(&still(0.02, 0.0, 0.0)), SensorClass::Consumer);
        assert_eq!(of(&[]), SensorClass::Consumer);
    }

    #[test]
    fn a_sway_is_no_zero() {
        let swaying = still(0.004, 0.035, 0.0);
        let first = standstills(&swaying)[0];
        assert!(norm(first.0) > CALIBRATED, "{first:?}");
        assert_eq!(of(&swaying[..52]), SensorClass::Industrial);
    }

    #[test]
    fn a_chip_writes_its_own_steps_and_text_does_not() {
        let of_a_chip = (500.0_f64 / 32_768.0).to_radians();
        assert_eq!(of(&still(0.004, 0.0, of_a_chip)), SensorClass::Consumer);
        assert_eq!(of(&still(0.004, 0.0, 0.01_f64.to_radians())), SensorClass::Industrial);
        assert_eq!(of(&still(0.004, 0.0, 1e-4)), SensorClass::Industrial);
    }
}
