//! Poles of continuous time, from the matrices of discrete time.

use kestirim_observer_design::{Complex, Discrete, eigenvalues, riccati};
use nalgebra::SMatrix;

/// Of x⁺ = A x at this interval (s), 1/s; none where an eigenvalue is zero or none was found.
pub(super) fn of(a: &SMatrix<f64, 4, 4>, interval: f64) -> Vec<[f64; 2]> {
    let continuous = |pole: Complex<f64>| {
        let rate = pole.re.hypot(pole.im).ln() / interval;
        [rate, pole.im.atan2(pole.re) / interval]
    };
    let all = eigenvalues(a).map(|poles| poles.map(continuous).to_vec()).unwrap_or_default();
    all.into_iter().filter(|pole| pole.iter().all(|part| part.is_finite())).collect()
}

/// Of the filter that a time-varying one settles at, for `outputs` (rows of C) with these standard deviations.
pub(super) fn of_filter(
    plant: &Discrete<4, 2>,
    q: &SMatrix<f64, 4, 4>,
    outputs: &[[f64; 4]],
    sigmas: &[f64],
    interval: f64,
) -> Vec<[f64; 2]> {
    match outputs.len() {
        1 => with::<1>(plant, q, outputs, sigmas, interval),
        2 => with::<2>(plant, q, outputs, sigmas, interval),
        3 => with::<3>(plant, q, outputs, sigmas, interval),
        _ => with::<4>(plant, q, outputs, sigmas, interval),
    }
}

fn with<const P: usize>(
    plant: &Discrete<4, 2>,
    q: &SMatrix<f64, 4, 4>,
    outputs: &[[f64; 4]],
    sigmas: &[f64],
    interval: f64,
) -> Vec<[f64; 2]> {
    let c = SMatrix::<f64, P, 4>::from_fn(|row, state| outputs.get(row).map_or(0.0, |c| c[state]));
    let sigma = |row: usize| sigmas.get(row).copied().unwrap_or(1.0);
    let r = SMatrix::<f64, P, P>::from_fn(
        |row, column| {
            if row == column { sigma(row).powi(2) } else { 0.0 }
        },
    );
    let gain = riccati(&plant.a, &c, q, &r).map(|filter| filter.predictor_gain);
    gain.map(|gain| of(&(plant.a - gain * c), interval)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::uav::plant::Plant;
    use crate::systems::uav::scenario::INTERVAL_S;

    #[test]
    fn discrete_poles_are_those_of_continuous_time() {
        let model = Plant::P1.model();
        let mut found = of(&Plant::P1.discrete(INTERVAL_S).a, INTERVAL_S);
        let mut known: Vec<_> = eigenvalues(&model.a).unwrap().map(|p| [p.re, p.im]).into();
        for poles in [&mut found, &mut known] {
            poles.sort_by(|a, b| (a[0], a[1]).partial_cmp(&(b[0], b[1])).unwrap());
        }
        assert_eq!(found.len(), 4);
        for (found, known) in found.iter().flatten().zip(known.iter().flatten()) {
            assert!((found - known).abs() < 1e-9, "{found} {known}");
        }
    }
}
