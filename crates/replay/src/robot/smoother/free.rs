//! A motion model for a tag that may move in any way: a random walk of the velocity, which decays.

use kestirim_uwb_tracker::Config;
use nalgebra::{DVector, Matrix2, SMatrix, SVector};

use super::super::Setup;
use super::knots::Knot;
use super::problem::Motion;
use crate::chain::Tie;

/// The motion model, with position and velocity along each of D axes, N = 2 D.
#[derive(Debug, Clone, Copy)]
pub(super) struct Free<const D: usize, const N: usize> {
    /// Power spectral density of the acceleration, m²/s³.
    density: f64,
    /// Time constant with which a velocity decays, s.
    decay_time: f64,
}

/// The factor by which a velocity decays more slowly than in the tracker. The tracker needs the decay during silences;
/// a smoother knows how they end.
const SLOWER: f64 = 4.0;
/// The time constant where a velocity does not decay, s.
const LONG: f64 = 1e4;
/// The share of the time constant below which an interval uses a series, which avoids cancellation.
const SHORT: f64 = 0.02;
/// The variance that any interval adds to a coordinate, m²: epochs some microseconds apart would otherwise be tied more
/// firmly than the precision of numbers permits.
const LEAST_NOISE: f64 = 1e-8;
/// The largest prior variance of a velocity, m²/s².
const FASTEST: f64 = 4.0;

impl<const D: usize, const N: usize> Free<D, N> {
    pub(super) fn new(setup: &Setup, config: &Config<f64>) -> Self {
        let density = config.of_place(&setup.anchors()).acceleration_density;
        Self { density, decay_time: config.decay_time.map_or(LONG, |time| SLOWER * time) }
    }

    /// The transition of one axis over an interval (s), and a root of the inverse of its noise. Source: Bar-Shalom, Li
    /// and Kirubarajan, *Estimation with Applications to Tracking and Navigation*, 2001, 8.2.2, with a velocity that
    /// decays.
    fn axis(&self, interval: f64) -> (Matrix2<f64>, Matrix2<f64>) {
        let (tau, share) = (self.decay_time, interval / self.decay_time);
        let (kept, lost) = ((-share).exp(), -(-share).exp_m1());
        let position = if share < SHORT {
            interval.powi(3) / 3.0 * (1.0 - 0.75 * share)
        } else {
            tau.powi(3) * (share - 2.0 * lost + 0.5 * (1.0 - kept * kept))
        };
        let position = self.density * position + LEAST_NOISE;
        let both = self.density * 0.5 * (tau * lost).powi(2);
        let velocity = self.density * 0.5 * tau * (1.0 - kept * kept);
        // The inverse of the noise is L Lᵀ: the weight is Lᵀ.
        let root = (position - both * both / velocity).sqrt().recip();
        let weight = Matrix2::new(root, -root * both / velocity, 0.0, velocity.sqrt().recip());
        (Matrix2::new(1.0, tau * lost, 0.0, kept), weight)
    }
}

/// Repeats the matrix of an axis for each of D axes.
fn of_all<const D: usize, const N: usize>(axis: &Matrix2<f64>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| if i % D == j % D { axis[(i / D, j / D)] } else { 0.0 })
}

impl<const D: usize, const N: usize> Motion<N> for Free<D, N> {
    fn begin(&self, knot: &Knot) -> SVector<f64, N> {
        SVector::from_fn(|i, _| if i < D { knot.begin[i] } else { 0.0 })
    }

    fn prior(&self) -> SVector<f64, N> {
        // The stationary velocity variance of the model.
        let speed = (0.5 * self.density * self.decay_time).min(FASTEST);
        SVector::from_fn(|i, _| if i < D { 0.0 } else { speed.recip() })
    }

    fn tie(
        &self,
        _: usize,
        interval: f64,
        [before, after]: [&SVector<f64, N>; 2],
        _: &DVector<f64>,
    ) -> Tie<N, N> {
        let (transition, weight) = self.axis(interval);
        let (transition, weight) = (of_all::<D, N>(&transition), of_all::<D, N>(&weight));
        Tie {
            residual: weight * (after - transition * before),
            before: -weight * transition,
            after: weight,
            shared: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_noise_at_any_interval() {
        let motion = Free::<2, 4> { density: 0.3, decay_time: 8.0 };
        for interval in [1e-3, 0.1, 0.159, 0.161, 1.0, 30.0] {
            let (_, weight) = motion.axis(interval);
            let noise = (weight.transpose() * weight).try_inverse().unwrap();
            // The noise as the integral of the driving noise over the interval.
            let steps = 20_000;
            let mut expected = Matrix2::zeros();
            for step in 0..steps {
                let since = interval * (f64::from(step) + 0.5) / f64::from(steps);
                let moved = 8.0 * (1.0 - (-since / 8.0).exp());
                let gain = nalgebra::Vector2::new(moved, (-since / 8.0).exp());
                expected += gain * gain.transpose() * (0.3 * interval / f64::from(steps));
            }
            expected[(0, 0)] += LEAST_NOISE;
            let error = (noise - expected).component_div(&expected).amax();
            assert!(error < 1e-3, "{interval} s: {noise} {expected}");
        }
    }
}
