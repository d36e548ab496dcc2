//! Poles of continuous time, from the matrices of discrete time.

use kestirim_observer_design::{Complex, Discrete, eigenvalues, riccati};
use kestirim_uav_estimator::Step;
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

/// The filter that a time-varying one settles at.
pub(super) struct Settled<'a> {
    /// What it filters.
    pub(super) step: Step,
    /// Rows of C.
    pub(super) outputs: &'a [[f64; 4]],
    /// Standard deviations of their noise.
    pub(super) sigmas: &'a [f64],
    /// s.
    pub(super) interval: f64,
}

impl Settled<'_> {
    /// 1/s.
    pub(super) fn poles(&self) -> Vec<[f64; 2]> {
        match self.outputs.len() {
            1 => self.poles_of::<1>(),
            2 => self.poles_of::<2>(),
            3 => self.poles_of::<3>(),
            _ => self.poles_of::<4>(),
        }
    }

    fn poles_of<const P: usize>(&self) -> Vec<[f64; 2]> {
        let row = |output: usize| self.outputs.get(output).copied().unwrap_or_default();
        let c = SMatrix::<f64, P, 4>::from_fn(|output, state| row(output)[state]);
        let mut r = SMatrix::<f64, P, P>::identity();
        for (output, sigma) in self.sigmas.iter().take(P).enumerate() {
            r[(output, output)] = sigma * sigma;
        }
        let Step { transition: Discrete { a, .. }, noise } = &self.step;
        let gain = riccati(a, &c, noise, &r).map(|filter| filter.predictor_gain);
        gain.map(|gain| of(&(a - gain * c), self.interval)).unwrap_or_default()
    }
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
