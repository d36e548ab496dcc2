//! Whatever is fed in, the result is either a typed error and an untouched estimate, or a finite
//! estimate with a covariance.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{
    Adaptive, Block, Decision, Descent, Discrepancy, Error, Huber, Igg3, Measurement, Order,
    Reweighting, Robust, Scale, TTest, Weight, jump,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use nalgebra::{SMatrix, SVector};
use proptest::prelude::*;

#[test]
fn a_number_that_is_none_is_no_innovation_of_fixed_point() {
    let before =
        Gaussian::<Q12_20, 1>::new(SVector::zeros(), Covariance::from_variances(&[Q12_20::ONE]));
    let row = [(0, Q12_20::ONE)];
    let measured = [-Q12_20::ONE, Q12_20::from_f32(f32::NAN)];
    let variance = Q12_20::ONE;
    let both = measured.map(|innovation| Measurement { row: &row, innovation, variance });
    let mut estimate = before;
    let mut decisions = [Decision::NONE; 2];
    let found = Robust::plain().update(&mut estimate, &both, &mut decisions);
    assert!(found.is_err());
    assert_eq!(estimate, before);
    assert!(jump(&estimate, &both, Block::new(0, 1)).is_err());
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        200 => -3.0..3.0f64,
        20 => -300.0..300.0f64,
        1 => prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e30), Just(0.0),
        ],
    ]
}

/// Derivatives of everyday size: with rows of hundreds, coarse fixed point cannot represent the
/// gain.
fn derivative() -> impl Strategy<Value = f64> {
    prop_oneof![200 => -3.0..3.0f64, 1 => prop_oneof![Just(f64::NAN), Just(1e30), Just(0.0)]]
}

fn variance() -> impl Strategy<Value = f64> {
    prop_oneof![
        100 => 0.01..4.0f64,
        1 => prop_oneof![Just(0.0), Just(-1.0), Just(f64::NAN), Just(1e-30), Just(1e30)],
    ]
}

type Input = (Vec<(usize, f64)>, f64, f64);

fn inputs() -> impl Strategy<Value = Vec<Input>> {
    let index = prop_oneof![200 => 0..3_usize, 1 => Just(3), 1 => Just(usize::MAX)];
    let row = proptest::collection::vec((index, derivative()), 0..4);
    proptest::collection::vec((row, number(), variance()), 0..12)
}

fn robust<T: Scalar>() -> impl Strategy<Value = Robust<T>> {
    let number = |value: f64| T::from_f64(value);
    let descent = prop_oneof![Just(Descent::Published), Just(Descent::Squared)];
    let weight =
        (0..3, 1.0..3.0f64, 0.0..3.0f64, descent).prop_map(move |(kind, k, more, descent)| {
            match kind {
                0 => Weight::Huber(Huber { k: number(k) }),
                1 => Weight::Igg3(Igg3 { k0: number(k), k1: number(k + more), descent }),
                _ => Weight::TTest(TTest { alpha0: number(0.1), alpha1: number(0.01), descent }),
            }
        });
    let scale = prop_oneof![
        Just(Scale::Unit),
        Just(Scale::Epoch),
        Just(Scale::Innovations { floor: T::ONE }),
        Just(Scale::Residuals { floor: T::ONE }),
    ];
    let reweighting = prop_oneof![
        Just(Reweighting::Never),
        Just(Reweighting::OneShot),
        (0..20_usize).prop_map(|most| Reweighting::WorstFirst { most }),
    ];
    let adaptive = (0..3_usize, 0..3_usize, 0..3_usize, 0..4_usize, any::<bool>()).prop_map(
        |(discrepancy, order, first, count, wanted)| {
            let mut adaptive = Adaptive::new(Block::new(first, count));
            adaptive.discrepancy =
                [Discrepancy::Innovation, Discrepancy::Block, Discrepancy::Prediction][discrepancy];
            adaptive.order = [Order::AfterWeights, Order::BeforeWeights, Order::ByMajority][order];
            wanted.then_some(adaptive)
        },
    );
    (weight, scale, reweighting, adaptive).prop_map(|(weight, scale, reweighting, adaptive)| {
        Robust { weight, scale, reweighting, adaptive, ..Robust::plain() }
    })
}

/// The smallest eigenvalue of the correlation matrix; 1 where a variance is zero.
fn smallest_eigenvalue<T: Scalar>(covariance: &Covariance<T, 3>) -> f64 {
    let p: SMatrix<f64, 3, 3> = covariance.to_matrix().map(T::to_f64);
    let correlation = SMatrix::<f64, 3, 3>::from_fn(|i, j| {
        let scale = (p[(i, i)] * p[(j, j)]).sqrt();
        if i == j { 1.0 } else { p[(i, j)] / scale }
    });
    assert!(correlation.iter().all(|value| value.is_finite()), "{p}");
    correlation.symmetric_eigenvalues().min()
}

fn check<T: Scalar>(robust: &Robust<T>, epochs: &[Vec<Input>]) {
    let mut estimate =
        Gaussian::<T, 3>::new(SVector::zeros(), Covariance::from_variances(&[T::ONE; 3]));
    for inputs in epochs {
        let rows: Vec<Vec<(usize, T)>> = inputs
            .iter()
            .map(|(row, ..)| row.iter().map(|&(i, value)| (i, T::from_f64(value))).collect())
            .collect();
        let epoch: Vec<Measurement<'_, T>> = rows
            .iter()
            .zip(inputs)
            .map(|(row, &(_, innovation, variance))| Measurement {
                row,
                innovation: T::from_f64(innovation),
                variance: T::from_f64(variance),
            })
            .collect();
        let mut decisions = vec![Decision::NONE; epoch.len()];
        let before = estimate;
        let _ = jump(&estimate, &epoch, Block::new(1, 2));
        match robust.update(&mut estimate, &epoch, &mut decisions) {
            Err(_) => assert_eq!(estimate, before),
            Ok(summary) => {
                assert!(T::all_finite(estimate.mean.as_slice()));
                assert!(summary.passes <= 2 * epoch.len() + 2);
                assert!(T::ZERO < summary.adaptive_factor && summary.adaptive_factor <= T::ONE);
                for decision in &decisions {
                    assert!(T::ZERO <= decision.weight && decision.weight <= T::ONE);
                    assert_eq!(decision.was_treated(), decision.weight < T::ONE, "{decision:?}");
                }
            }
        }
        for index in 0..3 {
            estimate.add_variance_at(index, T::from_f64(0.01)).expect("a variance");
        }
        let smallest = smallest_eigenvalue(&estimate.covariance);
        assert!(smallest > -1e-9, "{smallest} {estimate:?}");
    }
}

fn epochs() -> impl Strategy<Value = Vec<Vec<Input>>> {
    proptest::collection::vec(inputs(), 1..6)
}

proptest! {
    #[test]
    fn anything_in_double_precision(robust in robust::<f64>(), epochs in epochs()) {
        check(&robust, &epochs);
    }

    #[test]
    fn anything_in_single_precision(robust in robust::<f32>(), epochs in epochs()) {
        check(&robust, &epochs);
    }

    #[test]
    fn anything_in_fixed_point(robust in robust::<Q12_20>(), epochs in epochs()) {
        check(&robust, &epochs);
    }

    #[test]
    fn anything_in_coarse_fixed_point(robust in robust::<Q16_16>(), epochs in epochs()) {
        check(&robust, &epochs);
    }
}

/// Found by the test above: a row of a few units in the last place and no noise, whose gain kept 5
/// % of its value.
#[test]
fn fixed_point_takes_no_more_than_there_is() {
    let robust = Robust { weight: Weight::Huber(Huber { k: Q16_16::ONE }), ..Robust::plain() };
    check::<Q16_16>(&robust, &[vec![(vec![(0, 0.012_597_683_569_318_072)], 0.0, 1e-30)]]);
}

#[test]
fn what_is_wrong_is_named() {
    let prior = Covariance::from_variances(&[1.0, 1.0]);
    let mut estimate = Gaussian::new(SVector::from([0.0, 0.0]), prior);
    let row = [(0, 1.0)];
    let good = Measurement { row: &row, innovation: 0.1, variance: 0.01 };
    let beyond = Measurement { row: &[(2, 1.0)], ..good };
    let nan = Measurement { innovation: f64::NAN, ..good };
    let negative = Measurement { variance: -1.0, ..good };
    let mut decisions = [Decision::NONE; 2];
    let estimates = kestirim_kalman::Error::IndexOutOfRange;
    let cases = [
        (beyond, Error::Estimate(estimates)),
        (nan, Error::Estimate(kestirim_kalman::Error::NotFinite)),
        (negative, Error::Estimate(kestirim_kalman::Error::NotPositive)),
    ];
    let before = estimate;
    for (bad, error) in cases {
        let refused = Robust::plain().update(&mut estimate, &[good, bad], &mut decisions);
        assert_eq!(refused, Err(error));
        assert_eq!(estimate, before);
    }
    let refused = Robust::plain().update(&mut estimate, &[good; 3], &mut decisions);
    assert_eq!(refused, Err(Error::TooFewDecisions));
    let blocks = [Block::new(1, 2), Block::new(0, 0), Block::new(usize::MAX, 2), Block::new(0, 7)];
    for block in blocks {
        let refused = Robust::adaptive(block).update(&mut estimate, &[good], &mut decisions);
        assert_eq!(refused, Err(Error::InvalidBlock));
        assert_eq!(jump(&estimate, &[good], block), Err(Error::InvalidBlock));
    }
    let igg3 = |k0, k1| Weight::Igg3(Igg3 { k0, k1, descent: Descent::Squared });
    let t_test =
        |alpha0, alpha1| Weight::TTest(TTest { alpha0, alpha1, descent: Descent::Squared });
    let weights = [igg3(3.0, 2.0), igg3(f64::NAN, 2.0), t_test(0.01, 0.1), t_test(1.0, 0.0)];
    for weight in weights {
        let robust = Robust { weight, ..Robust::plain() };
        let refused = robust.update(&mut estimate, &[good], &mut decisions);
        assert_eq!(refused, Err(Error::InvalidConfiguration));
    }
    let scale = Scale::Residuals { floor: 0.0 };
    let refused = Robust { scale, ..Robust::plain() }.update(&mut estimate, &[], &mut decisions);
    assert_eq!(refused, Err(Error::InvalidConfiguration));
    // An epoch without measurements is not an error.
    let summary = Robust::adaptive(Block::new(0, 2)).update(&mut estimate, &[], &mut []);
    assert_eq!(summary.expect("an update").adaptive_factor, 1.0);
    assert_eq!(estimate, before);
}
