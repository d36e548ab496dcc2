//! The least-squares problem of a recording, and its solution.

use kestirim_uwb_tracker::Config;
use nalgebra::{DVector, SVector};

use super::super::{Epoch, Setup};
use super::Unsmoothed;
use super::knots::{Knot, Knots, Measured};
use super::noise::Noise;
use crate::chain::{Chain, Solution, Tie, Want};

/// A model of the motion of a tag from one knot to the next.
pub(super) trait Motion<const N: usize> {
    /// The initial state at a knot.
    fn begin(&self, knot: &Knot) -> SVector<f64, N>;

    /// The prior inverse variances of every part's first state, about zero.
    fn prior(&self) -> SVector<f64, N>;

    /// The prior of each parameter of the motion: mean and standard deviation.
    fn parameters(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The tie between a knot and the next one after an interval (s), given the motion's own parameters.
    fn tie(
        &self,
        index: usize,
        interval: f64,
        states: [&SVector<f64, N>; 2],
        own: &DVector<f64>,
    ) -> Tie<N, N>;
}

/// The largest number of rounds in which noise is learnt; `STEPS` is the number of steps of positions in each.
const ROUNDS: usize = 20;
const STEPS: usize = 2;
/// The number of first rounds in which anchors have no errors of their own: positions are close before those are
/// estimated.
const ROUGH_ROUNDS: usize = 4;
/// The size of anchors' own errors relative to that in the tracker. The tracker expects as much again where a tag
/// stands: one constant lies between.
const BIAS_SHARE: f64 = 1.2;
/// The step of the farthest position below which the iteration ends, m.
const SMALL_STEP: f64 = 1e-3;
/// The largest number of steps with the final noise; afterwards no position may move by more than `SETTLED`, m.
const LAST_STEPS: usize = 100;
const SETTLED: f64 = 0.01;
/// The smallest share of a step: a step that increases the cost is halved as long as its share is above this, and
/// otherwise not taken.
const LEAST_SHARE: f64 = 0.1;
/// The inverse variance of every part's first position about its current value, 1/m², which ensures that the equations
/// have a solution.
const HARDLY: f64 = 1e-6;

/// The unknowns of a tag in D dimensions: N for each knot, and as parameters each anchor's own error, the common error,
/// its excess in 10 m, and those of the motion.
#[derive(Debug)]
pub(super) struct Problem<'a, const N: usize, const D: usize, M> {
    setup: &'a Setup,
    knots: &'a Knots,
    motion: M,
    states: Vec<SVector<f64, N>>,
    parameters: DVector<f64>,
    /// The prior mean and standard deviation of each parameter.
    known: Vec<[f64; 2]>,
    noise: Noise,
}

/// The solution of a problem.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    /// The epochs, one for each knot.
    pub(super) epochs: Vec<Epoch>,
    /// The bias of each anchor beyond the common one, with its standard deviation, m.
    pub(super) biases: Vec<[f64; 2]>,
    /// The common bias, and its increase over 10 m, m, each with its standard deviation.
    pub(super) common: [[f64; 2]; 2],
    /// −2 ln of the probability of everything if each range's error is independent, up to a constant.
    pub(super) cost: f64,
}

/// The prediction of a range.
struct Expected<const N: usize> {
    /// The predicted minus the measured range, m.
    residual: f64,
    /// Derivatives with respect to the state.
    row: SVector<f64, N>,
    /// Derivatives with respect to parameters.
    by: [(usize, f64); 3],
}

impl<'a, const N: usize, const D: usize, M: Motion<N>> Problem<'a, N, D, M> {
    pub(super) fn new(setup: &'a Setup, config: &Config<f64>, knots: &'a Knots, motion: M) -> Self {
        let anchors = setup.anchors::<f64>();
        let scaled = config.of_place(&anchors);
        let common = match setup.biases {
            // The remaining common error is of the size of one anchor's.
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

    /// Solves for the most probable track.
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

    /// The covariances at the current unknowns.
    fn certainty(&self) -> Option<Solution<N>> {
        let mut chain = self.chain();
        self.equations(Some(&mut chain));
        chain.solve(Want::Covariances)
    }

    /// Takes a step; returns the distance that the farthest position has moved, m.
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
        // No step reduces the cost.
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

    /// The cost at the current unknowns; adds the normal equations to `chain`, if given.
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

    /// Adds the prior of a part's first state; returns its cost.
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
