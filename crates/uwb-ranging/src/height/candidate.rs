use crate::calibration::{LINK_SIGMA, solved};
use crate::symmetric::NormalEquations;
use crate::{Huber, Observation, Solver, expected_range};
use heapless::Vec;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The prior of the biases: the inverse of their covariance, times the variance of a range, is `own` on the
/// diagonal minus `shared` everywhere among the anchors.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Prior<T> {
    pub(super) own: T,
    pub(super) shared: T,
    pub(super) anchors: usize,
}

/// A candidate height, and the evidence on how well it explains the ranges.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Candidate<T, const A: usize> {
    pub(super) height: T,
    /// Normal equations of the biases, without the prior, times the variance of a range.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::rows"))]
    normal: [[T; A]; A],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    right: [T; A],
    /// Sum of squared residuals without biases, m².
    squares: T,
    /// Position at the last place, m.
    pub(super) position: Option<[T; 2]>,
    /// Sum over the places of the squared distance to the position of the candidate below, m².
    pub(super) apart: T,
}

/// Huber's threshold in standard deviations (`DOUBT`), and the largest cost of a residual: a range that is off by
/// more than half a metre carries no information.
const DOUBT: f64 = 2.0;
const LARGEST_COST: f64 = 20.0;

impl<T: Scalar, const A: usize> Candidate<T, A> {
    /// A candidate before the first place.
    pub(super) fn at(height: T) -> Self {
        Self {
            height,
            normal: [[T::ZERO; A]; A],
            right: [T::ZERO; A],
            squares: T::ZERO,
            position: None,
            apart: T::ZERO,
        }
    }

    /// Adds the ranges of a place. Returns whether there is a position at this height.
    pub(super) fn add(&mut self, heard: &[(usize, Observation<T>)], prior: &Prior<T>) -> bool {
        let before = *self;
        // Twice: first with the biases known before, then with those that this place has improved.
        for _ in 0..2 {
            let biases = self.explained(prior).map_or([T::ZERO; A], |(_, biases)| biases);
            let near = self.position;
            *self = before;
            self.position = self.placed(heard, &biases, near);
            let place = self.position.map(SVector::from);
            if !place.is_some_and(|place| self.project(heard, &biases, &place)) {
                // The lack of a position must not make a height more likely.
                *self = before;
                let count = T::from_micro(heard.len().min(2000) as i32 * 1_000_000);
                self.squares += T::from_f64(LINK_SIGMA * LINK_SIGMA * LARGEST_COST) * count;
                return false;
            }
        }
        true
    }

    /// The best-fitting position, near the last one if the ranges agree there.
    fn placed(
        &self,
        heard: &[(usize, Observation<T>)],
        biases: &[T; A],
        start: Option<[T; 2]>,
    ) -> Option<[T; 2]> {
        let mut freed = Vec::<Observation<T>, A>::new();
        for &(index, observation) in heard {
            let range = observation.range - biases.get(index).copied()?;
            freed.push(Observation { range, ..observation }).ok()?;
        }
        let threshold = T::from_f64(DOUBT);
        let huber = Some(Huber { long: threshold, short: threshold });
        let solver = Solver { huber, ..Solver::new(self.height) };
        let near = start.and_then(|start| {
            let variance = freed.first()?.variance;
            solver.descend::<2>(&freed, &SVector::from(start), variance).ok()
        });
        // Two standard deviations per range.
        let most = T::from_f64(4.0) * T::from_micro(freed.len().min(2000) as i32 * 1_000_000);
        if let Some(near) = near.filter(|near| near.cost <= most) {
            return Some(*near.position.as_array());
        }
        let anywhere = solver.solve::<2>(&freed, None).ok();
        let better = match (near, anywhere) {
            (Some(near), Some(anywhere)) if near.cost <= anywhere.cost => Some(near),
            (near, None) => near,
            (_, anywhere) => anywhere,
        };
        better.map(|fix| *fix.position.as_array())
    }

    /// Adds what the ranges say beyond the position: N += W, g += W e, c += eᵀ W e with W = w − w J (Jᵀ w J)⁻¹ Jᵀ
    /// w, Huber's weights w and the excesses e of the ranges.
    fn project(
        &mut self,
        heard: &[(usize, Observation<T>)],
        biases: &[T; A],
        position: &SVector<T, 2>,
    ) -> bool {
        let (threshold, largest) = (T::from_f64(DOUBT), T::from_f64(LARGEST_COST));
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA);
        let per_sigma = T::from_f64(1.0 / LINK_SIGMA);
        let mut equations = NormalEquations::new();
        let mut rows = Vec::<(usize, [T; 2], T, T), A>::new();
        for &(index, Observation { anchor, range, .. }) in heard {
            let expected = expected_range(position, self.height, &anchor);
            let excess = range - expected.distance;
            let known = biases.get(index).copied().unwrap_or(T::ZERO);
            let deviations = (excess - known).abs() * per_sigma;
            let mut weight = T::ONE;
            if deviations > threshold {
                weight = threshold / deviations;
                // Huber's cost, limited to the largest, replaces the weighted square that is added below.
                let cost = (threshold * (T::TWO * deviations - threshold)).min(largest);
                self.squares += variance * (cost - threshold * deviations);
            }
            let row = expected.direction;
            equations.add(&row, excess, weight);
            let _ = rows.push((index, row, excess, weight));
        }
        let Some(factors) = equations.factorised() else { return false };
        let moved = factors.solve(&equations.b);
        for &(index, row, excess, weight) in &rows {
            let left = weight * (excess - T::dot(&row, &moved));
            self.squares += left * excess;
            if let Some(entry) = self.right.get_mut(index) {
                *entry += left;
            }
            let through = factors.solve(&row);
            let Some(line) = self.normal.get_mut(index) else { continue };
            for &(column, other, _, other_weight) in &rows {
                let own = if column == index { weight } else { T::ZERO };
                if let Some(entry) = line.get_mut(column) {
                    *entry += own - weight * other_weight * T::dot(&through, &other);
                }
            }
        }
        true
    }

    /// The sum of squares with the best biases (m², including their prior), and these biases, m.
    pub(super) fn explained(&self, prior: &Prior<T>) -> Option<(T, [T; A])> {
        let mut normal = self.normal;
        for (index, line) in normal.iter_mut().enumerate() {
            for (column, entry) in line.iter_mut().enumerate() {
                if column == index {
                    *entry += prior.own;
                }
                if index.max(column) < prior.anchors {
                    *entry -= prior.shared;
                }
            }
        }
        let biases = solved(&normal, &self.right)?;
        Some((self.squares - T::dot(&biases, &self.right), biases))
    }

    pub(super) fn is_finite(&self) -> bool {
        let sums = [self.squares, self.apart];
        let matrices = T::all_finite(self.normal.as_flattened()) && T::all_finite(&self.right);
        matrices && T::all_finite(&sums) && self.position.is_none_or(|it| T::all_finite(&it))
    }
    /// Halves the accumulated evidence of all places.
    pub(super) fn fade(&mut self) {
        let entries = self.normal.as_flattened_mut().iter_mut();
        for entry in entries.chain(&mut self.right) {
            *entry *= T::HALF;
        }
        self.squares *= T::HALF;
        self.apart *= T::HALF;
    }
}
