//! The least squares of a recording, and how they are solved.

use kestirim_uwb_tracker::Config;
use nalgebra::{DVector, SVector};

use super::super::{Epoch, Setup};
use super::Unsmoothed;
use super::knots::{Knot, Knots, Measured};
use super::noise::Noise;
use crate::chain::{Chain, Solution, Tie, Want};

/// How a tag moves from one knot to the next.
pub(super) trait Motion<const N: usize> {
    /// A state to begin with.
    fn begin(&self, knot: &Knot) -> SVector<f64, N>;

    /// Inverse variances of every part's first state beforehand, about zero.
    fn prior(&self) -> SVector<f64, N>;

    /// Parameters of the motion: what they are about beforehand, and by what standard deviation.
    fn parameters(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// What ties a knot to the one that comes after an interval (s), with the motion's own parameters.
    fn tie(
        &self,
        index: usize,
        interval: f64,
        states: [&SVector<f64, N>; 2],
        own: &DVector<f64>,
    ) -> Tie<N, N>;
}

/// Noise is learnt so often at most, and positions are improved so often with each.
const ROUNDS: usize = 20;
const STEPS: usize = 2;
/// In the first rounds anchors have no errors of their own: positions are near before those are looked for.
const ROUGH_ROUNDS: usize = 4;
/// Anchors' own errors by those that the tracker considers. It expects as much again where a tag stands: one constant lies
/// between.
const BIAS_SHARE: f64 = 1.2;
/// A step of any position that is shorter ends the improving, m.
const SMALL_STEP: f64 = 1e-3;
/// With the noise as it was found, positions are improved so often, until none moves by more than this, m.
const LAST_STEPS: usize = 100;
const SETTLED: f64 = 0.01;
/// A step that makes the cost larger is halved, down to this share, below which there is none.
const LEAST_SHARE: f64 = 0.1;
/// Inverse variance of every part's first position about where it is, 1/m²: so that equations always have a solution.
const HARDLY: f64 = 1e-6;

/// Unknowns of a tag in D dimensions, N of each knot; and as parameters each anchor's own error, the error common to
/// all, its excess in 10 m, and those of the motion.
#[derive(Debug)]
pub(super) struct Problem<'a, const N: usize, const D: usize, M> {
    setup: &'a Setup,
    knots: &'a Knots,
    motion: M,
    states: Vec<SVector<f64, N>>,
    parameters: DVector<f64>,
    /// What the parameters are about beforehand, and by what standard deviation.
    known: Vec<[f64; 2]>,
    noise: Noise,
}

/// A solution.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    /// One of each knot.
    pub(super) epochs: Vec<Epoch>,
    /// What each anchor measures too long beyond all others, with its standard deviation, m.
    pub(super) biases: Vec<[f64; 2]>,
    /// What all do, and what more in 10 m, m, each with its standard deviation.
    pub(super) common: [[f64; 2]; 2],
    /// −2 ln of how probable all is if each range's error is its own, but for a constant.
    pub(super) cost: f64,
}

/// A range as it is expected.
struct Expected<const N: usize> {
    /// By how much longer than it was measured, m.
    residual: f64,
    /// Derivatives by the state.
    row: SVector<f64, N>,
    /// Derivatives by parameters.
    by: [(usize, f64); 3],
}

impl<'a, const N: usize, const D: usize, M: Motion<N>> Problem<'a, N, D, M> {
    pub(super) fn new(setup: &'a Setup, config: &Config<f64>, knots: &'a Knots, motion: M) -> Self {
        let anchors = setup.anchors::<f64>();
        let scaled = config.of_place(&anchors);
        let common = match setup.biases {
            // What is left of the common error is one of each anchor.
            Some(_) => [config.bias_sigma; 2],
            None => config.common_sigmas(&anchors),
        };
        let mut known = vec![[0.0, BIAS_SHARE * scaled.bias_sigma]; anchors.len()];
        known.extend(common.map(|sigma| [0.0, sigma]));
        known.extend(motion.parameters());
        Self {
            setup,
            knots,
            states: knots.points.iter().map(|knot| motion.begin(knot)).collect(),
            parameters: DVector::from_iterator(known.len(), known.iter().map(|known| known[0])),
            noise: Noise::new(anchors.len(), scaled.range_sigma),
            motion,
            known,
        }
    }

    /// The most probable track.
    ///
    /// # Errors
    /// [`Unsmoothed::NotObservable`] or [`Unsmoothed::NotConverged`].
    pub(super) fn solve(mut self) -> Result<Solved, Unsmoothed> {
        let known = self.known.clone();
        for round in 0..ROUNDS {
            let is_rough = round < ROUGH_ROUNDS;
            for (index, known) in known.iter().enumerate().take(self.setup.anchors.len()) {
                self.known[index][1] = known[1] * if is_rough { 0.01 } else { 1.0 };
            }
            for _ in 0..STEPS {
                if self.improve().ok_or(Unsmoothed::NotObservable)? < SMALL_STEP {
                    break;
                }
            }
            let solution = self.certainty().ok_or(Unsmoothed::NotObservable)?;
            let mut noise = self.noise.clone();
            let changed = noise.learn(self.knots, self.knots.left_over(D), |measured| {
                let expected = self.expected(measured);
                let covariance = solution.covariances[measured.knot];
                (expected.residual, expected.row.dot(&(covariance * expected.row)))
            });
            self.noise = noise;
            if !changed && !is_rough {
                break;
            }
        }
        let mut moved = f64::INFINITY;
        for _ in 0..LAST_STEPS {
            moved = self.improve().ok_or(Unsmoothed::NotObservable)?;
            if moved < SMALL_STEP {
                break;
            }
        }
        if moved > SETTLED {
            return Err(Unsmoothed::NotConverged);
        }
        let solution = self.certainty().ok_or(Unsmoothed::NotObservable)?;
        self.noise.forget_lasting();
        let cost = self.equations(None);
        Ok(self.solved(&solution, cost))
    }

    fn chain(&self) -> Chain<N> {
        Chain::new(self.knots.points.len(), self.known.len())
    }

    /// The covariances where the unknowns are now.
    fn certainty(&self) -> Option<Solution<N>> {
        let mut chain = self.chain();
        self.equations(Some(&mut chain));
        chain.solve(Want::Covariances)
    }

    /// Takes a step, and says how far the farthest position has moved, m.
    fn improve(&mut self) -> Option<f64> {
        let mut chain = self.chain();
        let cost = self.equations(Some(&mut chain));
        let solution = chain.solve(Want::Step)?;
        let (states, parameters) = (self.states.clone(), self.parameters.clone());
        let mut share = 1.0;
        while share > LEAST_SHARE {
            let steps = states.iter().zip(&solution.states);
            self.states = steps.map(|(state, step)| state + step * share).collect();
            self.parameters = &parameters + &solution.parameters * share;
            if self.equations(None) <= cost + 1e-9 * cost.abs() {
                let moved = solution.states.iter().map(|step| share * step.rows(0, D).norm());
                return Some(moved.fold(0.0, f64::max));
            }
            share *= 0.5;
        }
        // No step makes it better.
        (self.states, self.parameters) = (states, parameters);
        Some(0.0)
    }

    fn expected(&self, measured: &Measured) -> Expected<N> {
        let &Measured { knot, anchor, metres } = measured;
        let (state, place) = (&self.states[knot], self.setup.anchors[anchor]);
        let at =
            |axis: usize| if axis < D { state[axis] } else { self.knots.points[knot].begin[axis] };
        let apart: [f64; 3] = std::array::from_fn(|axis| at(axis) - place[axis]);
        let distance = apart.iter().map(|it| it * it).sum::<f64>().sqrt().max(1e-6);
        let (common, excess) = (self.setup.anchors.len(), self.setup.anchors.len() + 1);
        let gain = 1.0 + 0.1 * self.parameters[excess];
        let biases = self.parameters[anchor] + self.parameters[common];
        Expected {
            residual: distance * gain + biases - metres,
            row: SVector::from_fn(|i, _| if i < D { gain * apart[i] / distance } else { 0.0 }),
            by: [(anchor, 1.0), (common, 1.0), (excess, 0.1 * distance)],
        }
    }

    /// The cost where the unknowns are now; adds the normal equations there, if they are wanted.
    fn equations(&self, mut chain: Option<&mut Chain<N>>) -> f64 {
        let (knots, count) = (&self.knots.points, self.setup.anchors.len() + 2);
        let mut cost = 0.0;
        for (index, [about, sigma]) in self.known.iter().enumerate() {
            let (residual, information) = (self.parameters[index] - about, sigma.powi(-2));
            if let Some(chain) = chain.as_deref_mut() {
                chain.add_prior(index, residual, information);
            }
            cost += information * residual * residual;
        }
        for measured in &self.knots.measured {
            let Expected { residual, row, by } = self.expected(measured);
            let weighed = self.noise.weigh(measured.anchor, residual);
            if let Some(chain) = chain.as_deref_mut() {
                chain.observe(measured.knot, &row, &by, residual, weighed.information);
            }
            cost += weighed.cost;
        }
        let own = self.parameters.rows(count, self.known.len() - count).into_owned();
        let expected = self.motion.prior();
        for (index, knot) in knots.iter().enumerate() {
            if index == 0 || knots[index - 1].part != knot.part {
                cost += self.begin(chain.as_deref_mut(), index, &expected);
            }
            let Some(next) = knots.get(index + 1).filter(|next| next.part == knot.part) else {
                continue;
            };
            let interval = (next.epoch.time_us - knot.epoch.time_us) as f64 * 1e-6;
            let states = [&self.states[index], &self.states[index + 1]];
            let mut tie = self.motion.tie(index, interval, states, &own);
            cost += tie.residual.norm_squared();
            if let Some(chain) = chain.as_deref_mut() {
                for (parameter, _) in &mut tie.shared {
                    *parameter += count;
                }
                chain.tie(index, &tie);
            }
        }
        cost
    }

    /// What is known of a part's first state beforehand; its cost.
    fn begin(
        &self,
        mut chain: Option<&mut Chain<N>>,
        index: usize,
        expected: &SVector<f64, N>,
    ) -> f64 {
        let mut cost = 0.0;
        for i in 0..N {
            let row = SVector::from_fn(|j, _| if i == j { 1.0 } else { 0.0 });
            let (residual, information) = if expected[i] > 0.0 {
                (self.states[index][i], expected[i])
            } else {
                (0.0, HARDLY)
            };
            if let Some(chain) = chain.as_deref_mut() {
                chain.observe(index, &row, &[], residual, information);
            }
            cost += information * residual * residual;
        }
        cost
    }

    fn solved(&self, solution: &Solution<N>, cost: f64) -> Solved {
        let epochs = self.knots.points.iter().zip(&self.states).zip(&solution.covariances);
        let epochs = epochs.map(|((knot, state), covariance)| {
            let at = |axis: usize| if axis < D { state[axis] } else { knot.begin[axis] };
            let height = (D == 3).then(|| covariance[(2, 2)]);
            let mut epoch = Epoch {
                position: Some(std::array::from_fn(at)),
                spread: Some([covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]]),
                height_variance: height,
                ..knot.epoch
            };
            if let Some(found) = &self.setup.found {
                epoch.widen(found);
            }
            epoch.doubt_side();
            epoch
        });
        let count = self.setup.anchors.len();
        let bias = |index| {
            [self.parameters[index], solution.parameter_covariance[(index, index)].max(0.0).sqrt()]
        };
        Solved {
            epochs: epochs.collect(),
            biases: (0..count).map(bias).collect(),
            common: [bias(count), bias(count + 1)],
            cost,
        }
    }
}
