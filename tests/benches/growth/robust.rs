//! A robust update, worst measurement first, with codes and phases of many satellites.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Decision, Measurement, Robust};
use nalgebra::SVector;

use crate::{Curve, fastest};

/// The number of states (position, clock, zenith delay and an ambiguity for each of forty satellites), and the largest
/// number of measurements.
const STATES: usize = 45;
const MOST: usize = 80;

/// The time over the number of measurements, none of which is an outlier.
pub(crate) fn measurements() -> Curve {
    curve(&[10, 20, 40, MOST].map(|count| (count, count, 0)))
}

/// The time over the number of outliers among eighty measurements, which are off by 20 standard deviations.
pub(crate) fn outliers() -> Curve {
    curve(&[0, 1, 2, 5, 10, 15, 20].map(|count| (count, MOST, count)))
}

/// The processor times, s, of cases given by their size, the number of measurements and the number of outliers. Every
/// case is timed in each round, so that disturbances of the machine affect all alike.
fn curve(cases: &[(usize, usize, usize)]) -> Curve {
    let epochs: Vec<_> = cases.iter().map(|&(_, count, off)| Epoch::new(count, off)).collect();
    let mut curve: Curve = cases.iter().map(|&(size, ..)| (size as f64, f64::INFINITY)).collect();
    for _ in 0..400 {
        for (epoch, (_, seconds)) in epochs.iter().zip(&mut curve) {
            *seconds = seconds.min(fastest(1, || epoch.update()));
        }
    }
    curve
}

/// A prediction, with the rows, innovations and variances of measurements.
struct Epoch {
    predicted: Gaussian<f64, STATES>,
    rows: Vec<[(usize, f64); 5]>,
    numbers: Vec<[f64; 2]>,
}

impl Epoch {
    fn new(count: usize, outliers: usize) -> Self {
        let variances: [f64; STATES] =
            std::array::from_fn(|state| if state == 3 { 100.0 } else { 0.05 });
        let covariance = Covariance::from_variances(&variances);
        let number = |index: usize, of: f64| (index as f64 * of).sin();
        let rows = (0..count).map(|index| {
            let own = if index % 2 == 1 { 5 + index / 2 } else { 4 };
            let place = [1.1, 2.3, 3.7].map(|of| number(index, of));
            [(0, place[0]), (1, place[1]), (2, place[2]), (3, 1.0), (own, 0.7)]
        });
        let numbers = (0..count).map(|index| {
            let sigma = if index % 2 == 1 { 0.1 } else { 0.3 };
            // Outliers are spread by a permutation.
            let is_off = (index * 37) % MOST < outliers;
            let off =
                if is_off { 20.0_f64.copysign(number(index, 5.3)) } else { number(index, 1.7) };
            [sigma * off, sigma * sigma]
        });
        let predicted = Gaussian::new(SVector::zeros(), covariance);
        Self { predicted, rows: rows.collect(), numbers: numbers.collect() }
    }

    fn update(&self) -> Gaussian<f64, STATES> {
        let all = self.rows.iter().zip(&self.numbers);
        let epoch: Vec<_> = all
            .map(|(row, &[innovation, variance])| Measurement { row, innovation, variance })
            .collect();
        let (mut estimate, mut decisions) = (self.predicted, [Decision::NONE; MOST]);
        let decisions = &mut decisions[..epoch.len()];
        Robust::iterative_igg3().update(&mut estimate, &epoch, decisions).expect("an update");
        estimate
    }
}
