//! The five filters, compared with dense matrices, numpy and each other.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{
    Block, Decision, Huber, Measurement, Reason, Reweighting, Robust, Scale, Weight,
    WeightFunction, jump,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use nalgebra::SVector;

type Row = [(usize, f64); 3];

/// Rows of nine measurements of three states; the sixth and the ninth measurement do not fit.
const H: [[f64; 3]; 9] = [
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, -1.0],
    [1.0, 2.0, 0.0],
    [1.0, 0.0, 2.0],
    [1.0, -1.0, -1.0],
];
const INNOVATIONS: [f64; 9] = [0.5, 0.3, 0.7, 0.9, 0.2, -2.4, 0.6, 0.8, 1.3];
const VARIANCES: [f64; 9] = [0.04, 0.09, 0.04, 0.09, 0.04, 0.25, 0.16, 0.04, 0.09];

fn rows<T: Scalar>() -> [[(usize, T); 3]; 9] {
    H.map(|row| core::array::from_fn(|index| (index, T::from_f64(row[index]))))
}

fn epoch<T: Scalar>(rows: &[[(usize, T); 3]; 9]) -> [Measurement<'_, T>; 9] {
    core::array::from_fn(|index| Measurement {
        row: &rows[index],
        innovation: T::from_f64(INNOVATIONS[index]),
        variance: T::from_f64(VARIANCES[index]),
    })
}

fn predicted<T: Scalar>() -> Gaussian<T, 3> {
    let variances = [4.0, 1.0, 0.25].map(T::from_f64);
    Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances))
}

fn close<T: Scalar>(found: T, expected: f64, tolerance: f64) {
    assert!((found.to_f64() - expected).abs() < tolerance, "{found:?}, not {expected}");
}

/// Compares the t-test with numpy's result by dense matrices.
fn check_t_test<T: Scalar>(tolerance: f64) {
    let rows = rows::<T>();
    let mut estimate = predicted::<T>();
    let mut decisions = [Decision::NONE; 9];
    let summary =
        Robust::t_test().update(&mut estimate, &epoch(&rows), &mut decisions).expect("an update");
    let statistics = [
        0.216_552_740_931,
        0.096_724_662_193_6,
        0.190_205_119_894,
        0.503_209_187_392,
        0.689_795_526_049,
        3.403_708_633_8,
        0.363_163_463_753,
        0.129_196_151_876,
        2.345_491_508_48,
    ];
    for (decision, expected) in decisions.iter().zip(statistics) {
        close(decision.statistic, expected, tolerance);
    }
    close(decisions[5].weight, 0.033_217_094_388_532_556, tolerance);
    close(decisions[8].weight, 0.580_807_526_349_823_2, tolerance);
    close(decisions[0].thresholds.0, 1.894_578_605_090_006, tolerance);
    close(decisions[0].thresholds.1, 3.499_483_297_350_492, tolerance);
    assert_eq!((summary.down_weighted, summary.rejected, summary.passes), (2, 0, 2));
    let mean = [0.523_083_234_549_074_8, 0.046_395_686_222_937_42, 0.115_996_745_988_490_68];
    for (index, mean) in mean.into_iter().enumerate() {
        close(estimate.mean[index], mean, tolerance);
    }
    close(summary.nis, 43.271_664_813_740_12, tolerance * 100.0);
}

#[test]
fn the_t_test_is_numpys() {
    check_t_test::<f64>(1e-9);
    check_t_test::<f32>(1e-4);
    check_t_test::<Q12_20>(0.01);
    check_t_test::<Q16_16>(0.05);
}

#[test]
fn residuals_are_standardised_by_their_posterior_variance() {
    let rows = rows::<f64>();
    let mut decisions = [Decision::NONE; 9];
    let robust = Robust { scale: Scale::Unit, ..Robust::plain() };
    robust.update(&mut predicted(), &epoch(&rows), &mut decisions).expect("an update");
    let standardised = [
        0.397_641_575_912,
        -0.381_837_609_912,
        0.332_453_214_934,
        1.094_379_420_1,
        -1.811_203_101_81,
        -5.540_228_931_8,
        0.757_357_393_567,
        -0.462_614_349_181,
        4.347_055_111_12,
    ];
    for (decision, expected) in decisions.iter().zip(standardised) {
        close(decision.standardised, expected, 1e-9);
    }
    // The scale of eq. 17 is √(NIS/n).
    let robust = Robust { scale: Scale::Epoch, ..Robust::plain() };
    let summary =
        robust.update(&mut predicted(), &epoch(&rows), &mut decisions).expect("an update");
    close(summary.scale, 2.192_706_719_349_908, 1e-9);
    close(decisions[5].standardised, -5.540_228_931_8 / 2.192_706_719_349_908, 1e-9);
}

#[test]
fn the_jump_of_a_block_is_that_of_least_squares() {
    let rows = rows::<f64>();
    let jump = jump(&predicted(), &epoch(&rows), Block::new(0, 2)).expect("a block");
    assert_eq!(jump.directions, 2);
    close(jump.distance[0], 0.431_057_795_210_472_5, 1e-9);
    close(jump.distance[1], -0.032_449_483_525_912_48, 1e-9);
    close(jump.discrepancy, 0.153_941_107_875_160_74, 1e-9);
    // One measurement determines one direction, and so no distance.
    let one = kestirim_robust_kalman::jump(&predicted(), &epoch(&rows)[..1], Block::new(0, 2));
    let one = one.expect("a block");
    assert_eq!((one.directions, one.distance), (1, [0.0; 6]));
    close(one.discrepancy, 0.5 / 4.04_f64.sqrt(), 1e-12);
}

#[test]
fn the_plain_filter_is_a_sequence_of_updates_bit_for_bit() {
    fn check<T: Scalar>() {
        let rows = rows::<T>();
        let epoch = epoch(&rows);
        let mut sequence = predicted::<T>();
        for measurement in &epoch {
            let mut moved = T::accumulator();
            for &(index, value) in measurement.row {
                moved = T::mac(moved, value, sequence.mean[index]);
            }
            let left = measurement.innovation - T::finish(moved);
            let weighed = sequence
                .weigh_entries(measurement.row, left, measurement.variance)
                .expect("a weighing");
            sequence.correct(&weighed).expect("an update");
        }
        let mut plain = predicted::<T>();
        let mut decisions = [Decision::NONE; 9];
        let summary =
            Robust::plain().update(&mut plain, &epoch, &mut decisions).expect("an update");
        assert_eq!(plain, sequence);
        assert_eq!((summary.passes, summary.rejected + summary.down_weighted), (1, 0));
        assert!(decisions.iter().all(|decision| decision.weight == T::ONE));
    }
    check::<f64>();
    check::<f32>();
    check::<Q12_20>();
}

/// Ranges from a tag to twenty places; those in `wild` are off.
fn ranges(wild: &[usize]) -> (Vec<Row>, Vec<f64>) {
    let rows = (0..20).map(|index| {
        let angle = f64::from(index) * 0.9;
        [(0, angle.cos()), (1, angle.sin()), (2, 1.0)]
    });
    let innovations = (0..20).map(|index| {
        let noise = 0.1 * (f64::from(index) * 2.3).sin();
        noise + if wild.contains(&(index as usize)) { 5.0 + f64::from(index) } else { 0.0 }
    });
    (rows.collect(), innovations.collect())
}

fn of_ranges<'a>(rows: &'a [Row], innovations: &[f64]) -> Vec<Measurement<'a, f64>> {
    let pairs = rows.iter().zip(innovations);
    pairs.map(|(row, &innovation)| Measurement { row, innovation, variance: 0.01 }).collect()
}

#[test]
fn a_rejected_measurement_might_as_well_not_have_been_there() {
    let (rows, innovations) = ranges(&[7]);
    let epoch = of_ranges(&rows, &innovations);
    let mut without = epoch.clone();
    without.remove(7);
    let mut decisions = [Decision::NONE; 20];
    let mut expected = predicted::<f64>();
    Robust::plain().update(&mut expected, &without, &mut decisions).expect("an update");
    // One-shot treatment needs a scale that the outlier inflates: otherwise good measurements lose weight with it.
    let one_shot = Robust { scale: Scale::Residuals { floor: 1.0 }, ..Robust::igg3() };
    for robust in [one_shot, Robust::iterative_igg3(), Robust::adaptive(Block::new(0, 2))] {
        let mut estimate = predicted::<f64>();
        let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
        assert_eq!((decisions[7].reason, decisions[7].weight), (Reason::Rejected, 0.0));
        assert_eq!((summary.rejected, summary.down_weighted, summary.passes), (1, 0, 2));
        assert!((estimate.mean - expected.mean).abs().max() < 1e-9);
        assert_eq!(estimate.covariance, expected.covariance);
        assert!(decisions[7].residual > 11.0, "{:?}", decisions[7]);
    }
}

#[test]
fn worst_first_rejects_several_and_nothing_else() {
    let wild = [2, 7, 11, 12, 19];
    let (rows, innovations) = ranges(&wild);
    let epoch = of_ranges(&rows, &innovations);
    let mut decisions = [Decision::NONE; 20];
    let mut estimate = predicted::<f64>();
    let robust = Robust::iterative_igg3();
    let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
    let rejected = (0..20).filter(|&index| decisions[index].reason == Reason::Rejected);
    assert_eq!(rejected.collect::<Vec<_>>(), wild);
    assert_eq!((summary.down_weighted, summary.passes), (0, 2));
    assert!(estimate.mean.abs().max() < 0.1);
    // A limit on the number of treated measurements is respected.
    let bounded = Robust { reweighting: Reweighting::WorstFirst { most: 2 }, ..robust };
    let summary = bounded.update(&mut predicted(), &epoch, &mut decisions).expect("an update");
    assert_eq!(summary.passes, 2);
    assert_eq!(summary.rejected + summary.down_weighted, 2);
}

#[test]
fn two_of_eight_hide_behind_the_scale_of_the_epoch() {
    let row = [(0, 1.0)];
    let levels = [0.05, -0.1, 0.02, 4.0, -0.03, 0.08, 4.2, -0.06];
    let epoch = levels.map(|innovation| Measurement { row: &row, innovation, variance: 0.01 });
    let mut decisions = [Decision::NONE; 8];
    let mut level = |scale| {
        let prior = Covariance::from_variances(&[1.0]);
        let mut estimate = Gaussian::new(SVector::from([0.0]), prior);
        let robust = Robust { scale, ..Robust::iterative_igg3() };
        let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
        (estimate.mean[0], summary)
    };
    let (masked, of_epoch) = level(Scale::Epoch);
    assert_eq!((of_epoch.rejected, of_epoch.down_weighted), (0, 0), "{of_epoch:?}");
    assert!(of_epoch.scale > 10.0 && masked > 0.9, "{masked}");
    // No |ṽ| can exceed √n.
    let robust = Robust { scale: Scale::Epoch, ..Robust::plain() };
    let mut single = epoch;
    (single[3].innovation, single[6].innovation) = (1e6, 0.0);
    let mut estimate = Gaussian::new(SVector::from([0.0]), Covariance::from_variances(&[1.0]));
    let mut judged = [Decision::NONE; 8];
    robust.update(&mut estimate, &single, &mut judged).expect("an update");
    assert!((2.0..8.0_f64.sqrt()).contains(&judged[3].statistic), "{:?}", judged[3]);
    for scale in [Scale::Innovations { floor: 1.0 }, Scale::Unit] {
        let (found, summary) = level(scale);
        assert_eq!((summary.rejected, summary.down_weighted), (2, 0), "{summary:?}");
        assert!(found.abs() < 0.02, "{found}");
    }
    // The two outliers have shifted all residuals, so the median sees a large scale as well.
    let (_, summary) = level(Scale::Residuals { floor: 1.0 });
    assert!(summary.scale > 10.0 && summary.rejected == 0, "{summary:?}");
}

#[test]
fn huber_rejects_nothing_and_listens_less() {
    let (rows, innovations) = ranges(&[7]);
    let epoch = of_ranges(&rows, &innovations);
    let mut decisions = [Decision::NONE; 20];
    let weight = Weight::Huber(Huber { k: 1.5 });
    let robust = Robust { weight, scale: Scale::Unit, ..Robust::igg3() };
    let mut estimate = predicted::<f64>();
    let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
    assert_eq!(summary.rejected, 0);
    assert_eq!(decisions[7].reason, Reason::DownWeighted);
    assert!(decisions[7].weight < 0.1 && decisions[7].weight > 0.0);
}

fn answer<W: WeightFunction<f64>>(
    robust: &Robust<f64, W>,
) -> (SVector<f64, 3>, [Decision<f64>; 20]) {
    let (rows, innovations) = ranges(&[3, 7]);
    let (mut estimate, mut decisions) = (predicted(), [Decision::NONE; 20]);
    let epoch = of_ranges(&rows, &innovations);
    robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
    (estimate.mean, decisions)
}

#[test]
fn weight_functions_are_types_too() {
    let huber = Robust { weight: Weight::Huber(Huber { k: 1.5 }), ..Robust::igg3() };
    for robust in [huber, Robust::iterative_igg3(), Robust::t_test()] {
        let typed = match robust.weight {
            Weight::Huber(huber) => answer(&robust.with_weight(huber)),
            Weight::Igg3(igg3) => answer(&robust.with_weight(igg3)),
            Weight::TTest(test) => answer(&robust.with_weight(test)),
        };
        assert_eq!(typed, answer(&robust));
    }
}

/// A user-defined weight function: full weight up to three standard deviations, none beyond.
struct Gate;

impl WeightFunction<f64> for Gate {
    fn thresholds(&self, _: usize) -> Option<(f64, f64)> {
        Some((3.0, 3.0))
    }

    fn factor(&self, statistic: f64, (_, outer): (f64, f64)) -> f64 {
        if statistic < outer { 1.0 } else { 0.0 }
    }

    fn is_valid(&self) -> bool {
        true
    }
}

#[test]
fn a_users_own_weight_function_is_asked() {
    let (rows, innovations) = ranges(&[7]);
    let epoch = of_ranges(&rows, &innovations);
    let (mut estimate, mut decisions) = (predicted::<f64>(), [Decision::NONE; 20]);
    let robust = Robust::iterative_igg3().with_weight(Gate);
    let summary = robust.update(&mut estimate, &epoch, &mut decisions).expect("an update");
    assert_eq!((summary.rejected, summary.down_weighted), (1, 0));
    assert_eq!(decisions[7].reason, Reason::Rejected);
}

#[test]
fn what_nothing_else_tells_of_is_not_judged() {
    // The phase of a new satellite: the unknown ambiguity absorbs any value of it.
    let common = [(0, 1.0)];
    let phase = [(0, 1.0), (1, 1.0)];
    let of = |row, innovation, variance| Measurement { row, innovation, variance };
    let epoch = [
        of(&common[..], 0.1, 0.01),
        of(&common[..], -0.1, 0.01),
        of(&common[..], 0.05, 0.01),
        of(&phase[..], 500.0, 1e-4),
    ];
    let prior = Covariance::from_variances(&[1.0, 1e6]);
    let mut estimate = Gaussian::new(SVector::zeros(), prior);
    let mut decisions = [Decision::NONE; 4];
    Robust::iterative_igg3().update(&mut estimate, &epoch, &mut decisions).expect("an update");
    assert_eq!((decisions[3].reason, decisions[3].weight), (Reason::NoRedundancy, 1.0));
    assert!((estimate.mean[1] - 500.0).abs() < 0.1);
    // A single measurement of a state with zero variance is not refused either.
    let mut known = Gaussian::new(SVector::from([0.0, 0.0]), Covariance::zero());
    let alone = [of(&common[..], 0.1, 0.01)];
    Robust::t_test().update(&mut known, &alone, &mut decisions).expect("an update");
    assert_eq!(decisions[0].reason, Reason::TooFew);
}
