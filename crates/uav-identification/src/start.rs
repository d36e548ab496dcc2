//! Equation error: a first guess by least squares, from the slopes of the measured signals.

use nalgebra::{DMatrix, DVector};

use crate::flight::{OUTPUTS, Reference, Segment, spread};
use crate::likelihood::{Problem, Unknown};
use crate::parameter::{COUNT, at};
use crate::structure::GRAVITY;

/// Duration over which signals are averaged and their slopes taken, s.
const WINDOW_S: f64 = 0.2;
/// Variance of the third difference of unit white noise.
const OF_THIRD_DIFFERENCE: f64 = 20.0;
/// Initial standard deviations of the noise on ẋ in quiet air, per √s.
const PROCESS: [f64; 4] = [1e-3, 3e-3, 0.05, 3e-4];

/// Smallest standard deviations of an aircraft's sensors (rad, rad/s, m/s, rad, m/s²), which also limit how well a
/// linear model can fit.
const BEST: [f64; OUTPUTS] = [5e-4, 5e-4, 0.05, 3e-4, 0.05, 0.05];

/// Lower limits of the output variances.
pub(crate) fn floors() -> [f64; OUTPUTS] {
    BEST.map(|sigma| sigma * sigma)
}

/// Prior means of the noise logarithms: on ẋ, and of the outputs, where changes between neighbouring samples that no
/// motion explains are attributed to the sensor.
pub(crate) fn expected_noise(segments: &[Segment]) -> ([f64; 4], [f64; OUTPUTS]) {
    let measured = std::array::from_fn(|output| {
        let differences = segments.iter().flat_map(|segment| {
            segment.measured.windows(4).filter_map(move |of| {
                let [a, b, c, d] = [0, 1, 2, 3].map(|place| of[place][output]);
                Some(d? - 3.0 * c? + 3.0 * b? - a?)
            })
        });
        let variance = spread(differences).1.powi(2) / OF_THIRD_DIFFERENCE;
        variance.max(BEST[output].powi(2)).ln()
    });
    (PROCESS.map(|sigma| 2.0 * sigma.ln()), measured)
}

/// A signal along a stretch, smoothed, with its slope.
struct Smooth {
    value: Vec<f64>,
    slope: Vec<f64>,
}

fn smooth(times: &[f64], values: &[f64]) -> Smooth {
    let interval = (times[times.len() - 1] / (times.len() - 1) as f64).max(f64::MIN_POSITIVE);
    let half = ((0.5 * WINDOW_S / interval).round() as usize).max(1);
    let inner = half..values.len().saturating_sub(half);
    let mut smooth = Smooth { value: Vec::new(), slope: Vec::new() };
    for middle in inner {
        let of = middle - half..=middle + half;
        let (count, mut sum) = ((2 * half + 1) as f64, [0.0; 3]);
        for place in of {
            let from = times[place] - times[middle];
            sum[0] += values[place];
            sum[1] += from * values[place];
            sum[2] += from * from;
        }
        smooth.value.push(sum[0] / count);
        smooth.slope.push(sum[1] / sum[2]);
    }
    smooth
}

/// An output along a stretch, held between measurements.
fn held(segment: &Segment, output: usize) -> Vec<f64> {
    let mut last = segment.measured.iter().find_map(|of| of[output]).unwrap_or(0.0);
    let values = segment.measured.iter().map(|of| {
        last = of[output].unwrap_or(last);
        last
    });
    values.collect()
}

/// Regularised least squares with the priors, separately for each row of ẋ.
pub(crate) fn first_guess(problem: &Problem) -> Unknown {
    let Problem { reference, priors, .. } = problem;
    let mut derivative: [f64; COUNT] = std::array::from_fn(|which| priors[which].mean);
    let rows: [(usize, [usize; 5]); 3] = [
        (0, [at::Z_ALPHA, at::Z_RATE, at::Z_SPEED, at::Z_ELEVATOR, at::Z_THROTTLE]),
        (1, [at::M_ALPHA, at::M_RATE, at::M_SPEED, at::M_ELEVATOR, at::M_THROTTLE]),
        (2, [at::X_ALPHA, at::X_ALPHA, at::X_SPEED, at::X_ELEVATOR, at::X_THROTTLE]),
    ];
    for (state, places) in rows {
        if state == 0 && !reference.has[0] {
            continue;
        }
        let (mut regressors, mut targets) = (Vec::new(), Vec::new());
        for segment in &problem.segments {
            collect(
                reference,
                segment,
                (state, &places, &derivative),
                &mut regressors,
                &mut targets,
            );
        }
        let free: Vec<_> = (0..places.len())
            .filter(|&column| priors[places[column]].fixed.is_none() && (state, column) != (2, 1))
            .collect();
        let matrix = DMatrix::from_fn(targets.len(), free.len(), |row, column| {
            regressors[row][free[column]]
        });
        let noise = spread(targets.iter().copied()).1.powi(2).max(f64::MIN_POSITIVE);
        let mut information = matrix.tr_mul(&matrix) / noise;
        let mut towards = matrix.tr_mul(&DVector::from_vec(targets)) / noise;
        for (row, &column) in free.iter().enumerate() {
            let prior = priors[places[column]];
            information[(row, row)] += prior.sigma.powi(-2);
            towards[row] += prior.mean * prior.sigma.powi(-2);
        }
        let Some(factor) = information.cholesky() else { continue };
        let found = factor.solve(&towards);
        for (row, &column) in free.iter().enumerate() {
            derivative[places[column]] = found[row];
        }
    }
    // Larger than the noise, since a first guess explains everything badly.
    let measured = std::array::from_fn(|output| {
        let values = problem
            .segments
            .iter()
            .flat_map(|it| it.measured.iter().filter_map(move |of| of[output]));
        (0.05 * spread(values).1.powi(2)).max(problem.floors[output]).ln()
    });
    Unknown { derivative, process: None, measured }
}

/// Collects the least-squares rows of a stretch, with their means removed.
fn collect(
    reference: &Reference,
    segment: &Segment,
    (state, places, known): (usize, &[usize; 5], &[f64; COUNT]),
    regressors: &mut Vec<[f64; 5]>,
    targets: &mut Vec<f64>,
) {
    let of = |values: &[f64]| smooth(&segment.times, values);
    let airspeed = reference.state[2];
    // Without a vane, the force across the path replaces α.
    let alpha = if reference.has[0] {
        held(segment, 0)
    } else {
        let per_alpha = airspeed * known[at::Z_ALPHA];
        held(segment, 4).iter().map(|force| force / per_alpha).collect()
    };
    let signals = [alpha, held(segment, 1), held(segment, 2), held(segment, 3)].map(|it| of(&it));
    let inputs = [0, 1].map(|which| {
        of(&segment.inputs.iter().map(|input| input[which]).collect::<Vec<_>>()).value
    });
    let [alpha, rate, speed, pitch] = &signals;
    let mut lines = Vec::new();
    for line in 0..alpha.value.len() {
        let mut regressor = [
            alpha.value[line],
            rate.value[line],
            speed.value[line],
            inputs[0][line],
            inputs[1][line],
        ];
        if places[0] == places[1] {
            regressor[1] = 0.0;
        }
        let kinematic = [rate.value[line], 0.0, -GRAVITY * pitch.value[line]][state];
        lines.push((regressor, signals[state].slope[line] - kinematic));
    }
    let count = lines.len().max(1) as f64;
    let mean = lines.iter().fold(([0.0; 5], 0.0), |(mut sum, target), (regressor, more)| {
        sum.iter_mut().zip(regressor).for_each(|(sum, more)| *sum += more / count);
        (sum, target + more / count)
    });
    for (regressor, target) in lines {
        regressors.push(std::array::from_fn(|column| regressor[column] - mean.0[column]));
        targets.push(target - mean.1);
    }
}
