//! Settings of a filter: which are accepted, and what each changes.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{
    Adaptive, Block, Decision, Descent, Discrepancy, Error, Huber, Igg3, Measurement, Order,
    Reason, Reweighting, Robust, Scale, Summary, TTest, Weight, student_quantile,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use nalgebra::vector;

/// Updates a state of variance `prior`, measured directly with variance `noise` each time, beside
/// one not measured.
fn measured<const K: usize>(
    robust: &Robust<f64>,
    [prior, noise]: [f64; 2],
    innovations: [f64; K],
) -> Result<(Summary<f64>, [Decision<f64>; K]), Error> {
    let mut estimate = Gaussian::new(vector![0.0, 0.0], Covariance::from_variances(&[prior, 1.0]));
    let row = [(0, 1.0)];
    let measurements =
        innovations.map(|innovation| Measurement { row: &row, innovation, variance: noise });
    let mut decisions = [Decision::NONE; K];
    let summary = robust.update(&mut estimate, &measurements, &mut decisions)?;
    Ok((summary, decisions))
}

/// Variances of a state so well known that measurements hardly move it, and of its measurements.
const KNOWN: [f64; 2] = [1e-6, 1.0];

fn igg3(k0: f64, k1: f64) -> Weight<f64> {
    Weight::Igg3(Igg3 { k0, k1, descent: Descent::Squared })
}

fn t_test(alpha0: f64, alpha1: f64) -> Weight<f64> {
    Weight::TTest(TTest { alpha0, alpha1, descent: Descent::Published })
}

#[test]
fn thresholds_are_positive_and_in_order() {
    let huber = |k| Weight::Huber(Huber { k });
    let is_taken = |weight| {
        let found = measured(&Robust { weight, ..Robust::igg3() }, KNOWN, [0.1; 4]);
        found.map(drop) != Err(Error::InvalidConfiguration)
    };
    for taken in
        [huber(1e-9), igg3(2.0, 2.0), igg3(1e-9, 9.0), t_test(0.1, 0.1), t_test(0.99, 1e-9)]
    {
        assert!(is_taken(taken), "{taken:?}");
    }
    for refused in [
        huber(0.0),
        huber(-1.0),
        huber(f64::INFINITY),
        huber(f64::NAN),
        igg3(0.0, 1.0),
        igg3(2.0, 1.9),
        igg3(2.0, f64::INFINITY),
        t_test(0.1, 0.11),
        t_test(0.1, 0.0),
        t_test(1.0, 0.1),
    ] {
        assert!(!is_taken(refused), "{refused:?}");
    }
}

#[test]
fn every_setting_has_to_make_sense() {
    let good = Robust { adaptive: Some(Adaptive::new(Block::new(0, 1))), ..Robust::igg3() };
    let bad = Adaptive { floor: 0.0, ..Adaptive::new(Block::new(0, 1)) };
    let is_taken = |robust: Robust<f64>| {
        measured(&robust, KNOWN, [0.1; 4]).map(drop) != Err(Error::InvalidConfiguration)
    };
    let innovations = |floor| Scale::Innovations { floor };
    let residuals = |floor| Scale::Residuals { floor };
    for taken in [
        good,
        Robust { scale: innovations(1e-9), ..good },
        Robust { scale: residuals(1e-9), ..good },
        Robust { least_redundancy: 0.0, ..good },
        Robust { least_redundancy: 0.999, ..good },
    ] {
        assert!(is_taken(taken), "{taken:?}");
    }
    for refused in [
        Robust { weight: igg3(2.0, 1.0), ..good },
        Robust { scale: innovations(0.0), ..good },
        Robust { scale: innovations(f64::INFINITY), ..good },
        Robust { scale: residuals(-1.0), ..good },
        Robust { scale: residuals(f64::NAN), ..good },
        Robust { least_redundancy: -0.001, ..good },
        Robust { least_redundancy: 1.0, ..good },
        Robust { adaptive: Some(bad), ..good },
    ] {
        assert!(!is_taken(refused), "{refused:?}");
    }
}

#[test]
fn the_published_equations_descend_as_published() {
    let block = Block::new(0, 1);
    let adaptive = Robust::<f64>::adaptive(block);
    assert_eq!(adaptive.adaptive, Some(Adaptive::new(block)));
    assert_eq!(adaptive.reweighting, Reweighting::WorstFirst { most: usize::MAX });
    let published = adaptive.published();
    let Weight::Igg3(Igg3 { k0, k1, descent }) = published.weight else {
        panic!("{published:?}");
    };
    assert_eq!((k0, k1, descent), (2.5, 6.0, Descent::Published));
    assert_eq!(published.scale, Scale::Epoch);
    let factor = published.adaptive.expect("an adaptive factor");
    let (discrepancy, descent) = (factor.discrepancy, factor.descent);
    assert_eq!((discrepancy, descent), (Discrepancy::Innovation, Descent::Published));
    let squared = TTest { alpha0: 0.2, alpha1: 0.02, descent: Descent::Squared };
    let published = Robust { weight: Weight::TTest(squared), ..Robust::igg3() }.published();
    assert_eq!(published.weight, t_test(0.2, 0.02));
}

#[test]
fn a_redundancy_is_relative_and_what_has_no_more_than_the_least_is_not_judged() {
    // The share of R that is left is R/(P + R): one half for R = P = 4.
    let reason = |least_redundancy| {
        let robust = Robust { least_redundancy, ..Robust::igg3() };
        let (_, [decision]) = measured(&robust, [4.0, 4.0], [1.0]).expect("an update");
        assert!((decision.redundancy - 0.5).abs() < 1e-12, "{decision:?}");
        decision.reason
    };
    assert_eq!((reason(0.501), reason(0.499)), (Reason::NoRedundancy, Reason::Agrees));
}

#[test]
fn the_scale_of_innovations_is_their_lower_median() {
    let scale = |robust: &Robust<f64>, prior, innovations: [f64; 4]| {
        measured(robust, prior, innovations).expect("an update").0.scale
    };
    let robust = Robust { scale: Scale::Innovations { floor: 1e-3 }, ..Robust::plain() };
    // In units of √(h P hᵀ + R), which is 2 here.
    let prior = [3.0, 1.0];
    for (innovations, median) in [
        ([1.0, -2.0, 3.0, 100.0], 2.0),
        ([-100.0, 3.0, 2.0, 1.0], 2.0),
        ([5.0, 5.0, 1.0, 1.0], 1.0),
        ([1.0, 5.0, 5.0, 5.0], 5.0),
        ([2.0, 2.0, 2.0, 2.0], 2.0),
        ([7.0, 1.0, -1.0, 1.0], 1.0),
    ] {
        let found = scale(&robust, prior, innovations);
        assert!((found - 1.4826 * median / 2.0).abs() < 1e-12, "{innovations:?}: {found}");
    }
    let floored = Robust { scale: Scale::Innovations { floor: 1.0 }, ..Robust::plain() };
    assert_eq!(scale(&floored, prior, [0.1; 4]), 1.0);
    // The median of three is the middle one.
    let (summary, _) = measured(&robust, prior, [3.0, 1.0, 2.0]).expect("an update");
    assert!((summary.scale - 1.4826).abs() < 1e-12, "{summary:?}");
}

#[test]
fn nothing_is_a_multiple_of_a_scale_of_zero() {
    for scale in [Scale::Epoch, Scale::Residuals { floor: 1e-300 }] {
        let robust = Robust { scale, ..Robust::igg3() };
        let (summary, decisions) = measured(&robust, [1.0, 1.0], [0.0; 4]).expect("an update");
        assert!(summary.scale > 0.0, "{summary:?}");
        assert!(decisions.iter().all(|decision| decision.statistic == 0.0), "{decisions:?}");
    }
}

#[test]
fn a_t_test_measures_the_distance_from_the_others() {
    let robust = Robust { reweighting: Reweighting::Never, ..Robust::t_test() };
    let (_, decisions) = measured(&robust, KNOWN, [0.1, 0.3, 3.0]).expect("an update");
    for (index, decision) in decisions.iter().enumerate() {
        let [a, b] = [1, 2].map(|other| decisions[(index + other) % 3].standardised);
        // The standard deviation of two numbers is their difference over √2.
        let expected =
            (decision.standardised - f64::midpoint(a, b)).abs() / ((a - b).abs() / 2_f64.sqrt());
        assert!((decision.statistic - expected).abs() < 1e-9, "{decisions:?}");
        assert_eq!(decision.reason, Reason::Agrees);
    }
    // Among equal values none stands out, and two are too few for a t-test.
    let (_, decisions) = measured(&robust, KNOWN, [0.0; 5]).expect("an update");
    assert!(decisions.iter().all(|decision| decision.statistic == 0.0), "{decisions:?}");
    let (_, decisions) = measured(&robust, KNOWN, [0.1, 3.0]).expect("an update");
    assert!(decisions.iter().all(|decision| decision.reason == Reason::TooFew), "{decisions:?}");
}

/// A filter with an adaptive factor of this discrepancy and order on the measured state.
fn adaptive(discrepancy: Discrepancy, order: Order) -> Robust<f64> {
    let adaptive = Adaptive { discrepancy, order, ..Adaptive::new(Block::new(0, 1)) };
    Robust { adaptive: Some(adaptive), ..Robust::iterative_igg3() }
}

#[test]
fn a_majority_is_more_than_a_third() {
    fn is_motion<const K: usize>(wild: usize) -> bool {
        let innovations = core::array::from_fn(|index| if index < wild { 50.0 } else { 0.0 });
        let robust = adaptive(Discrepancy::Block, Order::ByMajority);
        let (summary, _) = measured::<K>(&robust, [0.01, 1.0], innovations).expect("an update");
        // Judged without the rejected measurements, the state has not moved.
        summary.discrepancy > 1.0
    }
    assert!(!is_motion::<6>(2) && is_motion::<6>(3));
    assert!(!is_motion::<8>(2) && is_motion::<8>(3));
    assert!(!is_motion::<9>(3) && is_motion::<9>(4));
    assert!(!is_motion::<5>(1) && is_motion::<5>(2));
}

#[test]
fn an_outlier_that_was_not_taken_for_motion_is_rejected_all_the_same() {
    for order in [Order::BeforeWeights, Order::AfterWeights, Order::ByMajority] {
        let mut robust = adaptive(Discrepancy::Block, order);
        let factor = robust.adaptive.expect("an adaptive factor");
        robust.adaptive = Some(Adaptive { c0: 1e6, c1: 1e7, ..factor });
        let (summary, decisions) =
            measured(&robust, [0.01, 1.0], [0.1, 50.0, -0.1, 0.0, 0.2]).expect("an update");
        assert_eq!((summary.adaptive_factor, summary.rejected), (1.0, 1), "{order:?} {summary:?}");
        assert_eq!(decisions[1].reason, Reason::Rejected);
    }
}

#[test]
fn the_published_discrepancy_is_of_what_has_a_weight() {
    let robust = adaptive(Discrepancy::Innovation, Order::AfterWeights);
    // √(εᵀε / tr Qε), where each innovation has the variance 3 + 1.
    let discrepancy = |innovations| {
        measured::<4>(&robust, [3.0, 1.0], innovations).expect("an update").0.discrepancy
    };
    let expected = ((4.0 + 4.0 + 9.0 + 9.0) / (4.0 * 4.0_f64)).sqrt();
    assert!((discrepancy([2.0, 2.0, 3.0, 3.0]) - expected).abs() < 1e-12);
    // A rejected measurement is left out.
    let expected = ((4.0 + 4.0 + 9.0) / (3.0 * 4.0_f64)).sqrt();
    assert!((discrepancy([2.0, 2.0, 500.0, 3.0]) - expected).abs() < 1e-12);
    // Without any measurement left, the discrepancy is zero.
    let (summary, _) = measured(&robust, [1e-6, 1.0], [1e3, 2e3, -1e3, -3e3]).expect("an update");
    assert_eq!((summary.rejected, summary.discrepancy), (4, 0.0), "{summary:?}");
    // A down-weighted measurement is expected to deviate more.
    let (summary, decisions) = measured(&robust, KNOWN, [0.0, 4.0, 0.0]).expect("an update");
    let weight = decisions[1].weight;
    assert!(weight > 0.0 && weight < 1.0, "{decisions:?}");
    let expected = (16.0 / (3e-6 + 2.0 + 1.0 / weight)).sqrt();
    assert!((summary.discrepancy - expected).abs() < 1e-12, "{summary:?}");
}

#[test]
fn the_smallest_share_has_the_largest_threshold_in_every_number() {
    fn check<T: Scalar>() {
        for freedom in 1..=9 {
            let [usual, small, least] = [0.01, T::EPSILON.to_f64(), 1e-30]
                .map(|alpha| student_quantile(T::from_f64(alpha), freedom));
            assert!(T::ONE < usual && usual < small && small <= least, "{freedom}: {small:?}");
        }
    }
    check::<f64>();
    check::<f32>();
    check::<Q12_20>();
    check::<Q16_16>();
}
