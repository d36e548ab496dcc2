//! The adaptive factor: motion is distinguished from outliers, and only the block is affected.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{
    Adaptive, Block, Decision, Discrepancy, Measurement, Order, Robust, Scale, Summary,
};
use nalgebra::SVector;

/// A position known to 5 mm, an unknown clock, and an ambiguity for each satellite, known to 5 mm.
fn predicted() -> Gaussian<f64, 11> {
    let mut variances = [0.005 * 0.005; 11];
    variances[2] = 1e6;
    Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances))
}

/// Takes in the phases of eight satellites after the receiver has moved; one of them is off by `wild`.
fn update(robust: &Robust<f64>, moved: [f64; 2], wild: f64) -> (Gaussian<f64, 11>, Summary<f64>) {
    let rows: Vec<[(usize, f64); 4]> = (0..8)
        .map(|index| {
            let angle = f64::from(index) * 0.8;
            [(0, angle.cos()), (1, angle.sin()), (2, 1.0), (3 + index as usize, 1.0)]
        })
        .collect();
    let mut epoch: Vec<Measurement<'_, f64>> = rows
        .iter()
        .map(|row| Measurement {
            row,
            innovation: row[0].1 * moved[0] + row[1].1 * moved[1] + 300.0,
            variance: 1e-4,
        })
        .collect();
    epoch[3].innovation += wild;
    let mut decisions = [Decision::NONE; 8];
    let mut estimate = predicted();
    let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
    (estimate, summary)
}

fn adaptive(discrepancy: Discrepancy, order: Order) -> Robust<f64> {
    let adaptive = Adaptive { discrepancy, order, ..Adaptive::new(Block::new(0, 2)) };
    let scale = Scale::Innovations { floor: 1.0 };
    Robust { adaptive: Some(adaptive), scale, ..Robust::iterative_igg3() }
}

#[test]
fn while_nothing_moves_nothing_happens() {
    let plain = update(&Robust::iterative_igg3(), [0.001, -0.002], 0.0).0;
    for discrepancy in [Discrepancy::Innovation, Discrepancy::Block] {
        for order in [Order::AfterWeights, Order::BeforeWeights, Order::ByMajority] {
            let (estimate, summary) = update(&adaptive(discrepancy, order), [0.001, -0.002], 0.0);
            assert_eq!((summary.adaptive_factor, summary.passes), (1.0, 1), "{summary:?}");
            assert_eq!(estimate, plain);
        }
    }
}

#[test]
fn a_motion_of_the_block_is_followed() {
    let moved = [0.3, -0.2];
    let stubborn = update(&Robust::iterative_igg3(), moved, 0.0).0;
    // In the published order, the phases that show the motion are rejected first.
    let (_, summary) = update(&adaptive(Discrepancy::Block, Order::AfterWeights), moved, 0.0);
    assert!(summary.rejected > 4 && summary.adaptive_factor > 0.5, "{summary:?}");
    let before = update(&adaptive(Discrepancy::Block, Order::BeforeWeights), moved, 0.0);
    let (estimate, summary) = update(&adaptive(Discrepancy::Block, Order::ByMajority), moved, 0.0);
    assert_eq!((summary.adaptive_factor, summary.rejected), (0.05, 0), "{summary:?}");
    assert_eq!(before.0, estimate);
    let error = |estimate: &Gaussian<f64, 11>| {
        (estimate.mean[0] - moved[0]).hypot(estimate.mean[1] - moved[1])
    };
    assert!(error(&estimate) < 0.5 * error(&stubborn), "{} {}", error(&estimate), error(&stubborn));
    // The variances of the other states are at most those before the update.
    for index in 2..11 {
        let variance = |of: &Gaussian<f64, 11>| of.covariance.variances()[index];
        assert!(variance(&estimate) <= variance(&predicted()) * (1.0 + 1e-9));
    }
}

#[test]
fn the_innovations_drown_in_the_clock() {
    // As published: tr Qε is dominated by the clock, and eq. 22 never fires.
    let robust = adaptive(Discrepancy::Innovation, Order::AfterWeights);
    let (_, summary) = update(&robust, [0.3, -0.2], 0.0);
    assert!(summary.discrepancy < 0.5 && summary.adaptive_factor == 1.0, "{summary:?}");
    let published = update(&Robust::adaptive(Block::new(0, 2)).published(), [0.3, -0.2], 0.0).1;
    assert_eq!(published.adaptive_factor, 1.0);
    // In units of the prediction alone, the same jump is large.
    let robust = adaptive(Discrepancy::Prediction, Order::ByMajority);
    assert_eq!(update(&robust, [0.3, -0.2], 0.0).1.adaptive_factor, 0.05);
}

#[test]
fn the_order_decides_what_a_single_outlier_is() {
    let after = update(&adaptive(Discrepancy::Block, Order::AfterWeights), [0.0, 0.0], 2.0);
    assert_eq!((after.1.rejected, after.1.adaptive_factor), (1, 1.0), "{:?}", after.1);
    let majority = update(&adaptive(Discrepancy::Block, Order::ByMajority), [0.0, 0.0], 2.0);
    assert_eq!(majority, after);
    let before = update(&adaptive(Discrepancy::Block, Order::BeforeWeights), [0.0, 0.0], 2.0);
    assert!(before.1.adaptive_factor < 1.0, "{:?}", before.1);
    assert_eq!(before.1.rejected, 1, "it is found all the same");
}
