//! Least squares over a chain of states that share some parameters.
//!
//! State k is tied to state k + 1 alone, and each state to the parameters. The normal equations are then block
//! tridiagonal with a border. They are solved, with the covariance of each state, in time proportional to the number of
//! states: by forward elimination and backward substitution, which is the fixed-interval smoother of Rauch, Tung and
//! Striebel (1965), with the border by the Schur complement.

use nalgebra::{Cholesky, Const, DMatrix, DVector, Dyn, OMatrix, SMatrix, SVector};

/// A block of N rows, one for each unknown of a state, with a column per parameter.
type Border<const N: usize> = OMatrix<f64, Const<N>, Dyn>;

/// The normal equations of states of N unknowns each.
#[derive(Debug, Clone)]
pub(crate) struct Chain<const N: usize> {
    diagonal: Vec<SMatrix<f64, N, N>>,
    /// Off-diagonal blocks: rows of state k, columns of state k + 1.
    next: Vec<SMatrix<f64, N, N>>,
    border: Vec<Border<N>>,
    right: Vec<SVector<f64, N>>,
    corner: DMatrix<f64>,
    corner_right: DVector<f64>,
}

/// A tie between two states: K residuals that are independent and of variance one, with their derivatives.
#[derive(Debug, Clone)]
pub(crate) struct Tie<const N: usize, const K: usize> {
    /// The residuals.
    pub(crate) residual: SVector<f64, K>,
    /// Derivatives with respect to the earlier state.
    pub(crate) before: SMatrix<f64, K, N>,
    /// Derivatives with respect to the later state.
    pub(crate) after: SMatrix<f64, K, N>,
    /// Derivatives with respect to parameters.
    pub(crate) shared: Vec<(usize, SVector<f64, K>)>,
}

/// The results that are requested of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Want {
    /// The step alone.
    Step,
    /// The step and the covariances.
    Covariances,
}

/// The solution of the normal equations.
#[derive(Debug, Clone)]
pub(crate) struct Solution<const N: usize> {
    /// Step of each state.
    pub(crate) states: Vec<SVector<f64, N>>,
    /// Step of the parameters.
    pub(crate) parameters: DVector<f64>,
    /// Covariance of each state; empty if covariances were not requested.
    pub(crate) covariances: Vec<SMatrix<f64, N, N>>,
    /// Covariance of the parameters.
    pub(crate) parameter_covariance: DMatrix<f64>,
}

impl<const N: usize> Chain<N> {
    /// The equations for the given numbers of states and parameters, without any information yet.
    pub(crate) fn new(states: usize, parameters: usize) -> Self {
        Self {
            diagonal: vec![SMatrix::zeros(); states],
            next: vec![SMatrix::zeros(); states],
            border: vec![Border::zeros(parameters); states],
            right: vec![SVector::zeros(); states],
            corner: DMatrix::zeros(parameters, parameters),
            corner_right: DVector::zeros(parameters),
        }
    }

    /// Adds an observation that depends on one state and on parameters: its residual, its derivatives, and the inverse
    /// of its variance.
    pub(crate) fn observe(
        &mut self,
        state: usize,
        row: &SVector<f64, N>,
        shared: &[(usize, f64)],
        residual: f64,
        information: f64,
    ) {
        let weighed = row * information;
        self.diagonal[state] += weighed * row.transpose();
        self.right[state] -= weighed * residual;
        for &(i, by) in shared {
            let mut column = self.border[state].column_mut(i);
            column += weighed * by;
            self.corner_right[i] -= information * by * residual;
            for &(j, other) in shared {
                self.corner[(i, j)] += information * by * other;
            }
        }
    }

    /// Adds the prior of a parameter: the deviation from its prior mean, and the inverse of its variance.
    pub(crate) fn add_prior(&mut self, parameter: usize, residual: f64, information: f64) {
        self.corner[(parameter, parameter)] += information;
        self.corner_right[parameter] -= information * residual;
    }

    /// Adds a tie between a state and the next one.
    pub(crate) fn tie<const K: usize>(&mut self, state: usize, tie: &Tie<N, K>) {
        let (before, after) = (tie.before.transpose(), tie.after.transpose());
        self.diagonal[state] += before * tie.before;
        self.diagonal[state + 1] += after * tie.after;
        self.next[state] += before * tie.after;
        self.right[state] -= before * tie.residual;
        self.right[state + 1] -= after * tie.residual;
        for (i, by) in &tie.shared {
            let mut column = self.border[state].column_mut(*i);
            column += before * by;
            let mut column = self.border[state + 1].column_mut(*i);
            column += after * by;
            self.corner_right[*i] -= by.dot(&tie.residual);
            for (j, other) in &tie.shared {
                self.corner[(*i, *j)] += by.dot(other);
            }
        }
    }

    /// Solves the equations; `None` if they do not determine all unknowns.
    pub(crate) fn solve(mut self, want: Want) -> Option<Solution<N>> {
        let count = self.diagonal.len();
        let mut inverses = Vec::with_capacity(count);
        for k in 0..count {
            let inverse = Cholesky::new(self.diagonal[k])?.inverse();
            let (border, right) = (inverse * &self.border[k], inverse * self.right[k]);
            if k + 1 < count {
                let next = self.next[k].transpose();
                self.diagonal[k + 1] -= next * inverse * self.next[k];
                self.border[k + 1] -= next * &border;
                self.right[k + 1] -= next * right;
            }
            self.corner -= self.border[k].tr_mul(&border);
            self.corner_right -= self.border[k].tr_mul(&right);
            inverses.push(inverse);
        }
        let corner = Cholesky::new(self.corner)?;
        let (parameters, parameter_covariance) =
            (corner.solve(&self.corner_right), corner.inverse());
        // For each state: its value without a step of the parameters, and its dependence on them.
        let mut states = vec![SVector::zeros(); count];
        let wanted = if want == Want::Step { 0 } else { count };
        let mut covariances = vec![SMatrix::zeros(); wanted];
        let mut gains = vec![Border::zeros(parameters.len()); count];
        for k in (0..count).rev() {
            let inverse = inverses[k];
            let (mut border, mut right) = (self.border[k].clone(), self.right[k]);
            if k + 1 < count {
                border -= self.next[k] * &gains[k + 1];
                right -= self.next[k] * states[k + 1];
            }
            (gains[k], states[k]) = (inverse * border, inverse * right);
            if k < wanted {
                covariances[k] = inverse;
                if k + 1 < count {
                    let gain = inverse * self.next[k];
                    let after: SMatrix<f64, N, N> = covariances[k + 1];
                    covariances[k] += gain * after * gain.transpose();
                }
            }
        }
        for (state, gain) in states.iter_mut().zip(&gains) {
            *state -= gain * &parameters;
        }
        for (covariance, gain) in covariances.iter_mut().zip(&gains) {
            *covariance += gain * &parameter_covariance * gain.transpose();
        }
        Some(Solution { states, parameters, covariances, parameter_covariance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with the same equations in one matrix.
    #[test]
    fn a_chain_is_solved_as_one_matrix_would_be() {
        const STATES: usize = 5;
        let mut chain = Chain::<2>::new(STATES, 2);
        let size = 2 * STATES + 2;
        let (mut matrix, mut right) = (DMatrix::<f64>::zeros(size, size), DVector::zeros(size));
        let mut add = |row: &DVector<f64>, residual: f64, information: f64| {
            matrix += row * row.transpose() * information;
            right -= row * (information * residual);
        };
        let mut number = 0.0_f64;
        let mut draw = || {
            number += 1.0;
            (number * 12.9898).sin()
        };
        for parameter in 0..2 {
            let (residual, information) = (draw(), 0.5);
            chain.add_prior(parameter, residual, information);
            let mut row = DVector::zeros(size);
            row[2 * STATES + parameter] = 1.0;
            add(&row, residual, information);
        }
        for state in 0..STATES {
            for _ in 0..2 {
                let (by, shared) = (SVector::from([draw(), draw()]), [(0, draw()), (1, draw())]);
                let (residual, information) = (draw(), 2.0);
                chain.observe(state, &by, &shared, residual, information);
                let mut row = DVector::zeros(size);
                row.rows_mut(2 * state, 2).copy_from(&by);
                for (parameter, by) in shared {
                    row[2 * STATES + parameter] = by;
                }
                add(&row, residual, information);
            }
            if state + 1 < STATES {
                let tie = Tie::<2, 3> {
                    residual: SVector::from_fn(|_, _| draw()),
                    before: SMatrix::from_fn(|_, _| draw()),
                    after: SMatrix::from_fn(|_, _| draw()),
                    shared: vec![(1, SVector::from_fn(|_, _| draw()))],
                };
                chain.tie(state, &tie);
                for k in 0..3 {
                    let mut row = DVector::zeros(size);
                    for i in 0..2 {
                        row[2 * state + i] = tie.before[(k, i)];
                        row[2 * state + 2 + i] = tie.after[(k, i)];
                    }
                    row[2 * STATES + 1] = tie.shared[0].1[k];
                    add(&row, tie.residual[k], 1.0);
                }
            }
        }
        let found = chain.solve(Want::Covariances).unwrap();
        let inverse = matrix.try_inverse().unwrap();
        let expected = &inverse * right;
        for state in 0..STATES {
            let step = expected.rows(2 * state, 2) - found.states[state];
            let block = inverse.view((2 * state, 2 * state), (2, 2)) - found.covariances[state];
            assert!(step.amax() < 1e-9 && block.amax() < 1e-9, "{step} {block}");
        }
        let corner = inverse.view((2 * STATES, 2 * STATES), (2, 2));
        assert!((expected.rows(2 * STATES, 2) - found.parameters).amax() < 1e-9);
        assert!((corner - found.parameter_covariance).amax() < 1e-9);
    }

    #[test]
    fn what_is_not_determined_has_no_solution() {
        let mut chain = Chain::<1>::new(2, 0);
        chain.observe(0, &SVector::from([1.0]), &[], 1.0, 1.0);
        assert!(chain.solve(Want::Step).is_none());
    }
}
