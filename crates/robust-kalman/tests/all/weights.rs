//! Weight functions and Student's t in every number type, compared with published values and
//! scipy's.

use kestirim_robust_kalman::{
    Adaptive, Block, Descent, Huber, Igg3, TTest, Weight, WeightFunction, student_quantile,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use proptest::prelude::*;

fn igg3<T: Scalar>(descent: Descent) -> Weight<T> {
    Weight::Igg3(Igg3 { k0: T::from_f64(2.5), k1: T::from_f64(6.0), descent })
}

fn gamma<T: Scalar>(weight: &Weight<T>, statistic: f64) -> f64 {
    let thresholds = weight.thresholds(12).expect("enough measurements");
    weight.factor(T::from_f64(statistic), thresholds).to_f64()
}

fn check_values<T: Scalar>(tolerance: f64) {
    // Eq. 15 as published and as in Yang, Song and Xu (2002), by hand: at 4, 2.5/4 · 2/3.5.
    let cases = [
        (igg3(Descent::Published), [1.0, 1.0, 0.625 * 2.0 / 3.5, 0.0, 0.0]),
        (igg3(Descent::Squared), [1.0, 1.0, 0.625 * 4.0 / 12.25, 0.0, 0.0]),
        (Weight::Huber(Huber { k: T::from_f64(2.5) }), [1.0, 1.0, 0.625, 2.5 / 6.0, 2.5 / 100.0]),
    ];
    for (weight, expected) in cases {
        for (statistic, expected) in [0.0, 2.5, 4.0, 6.0, 100.0].into_iter().zip(expected) {
            let found = gamma::<T>(&weight, statistic);
            assert!((found - expected).abs() < tolerance, "{weight:?} of {statistic}: {found}");
        }
    }
}

#[test]
fn weights_are_the_published_ones() {
    check_values::<f64>(1e-15);
    check_values::<f32>(1e-6);
    check_values::<Q12_20>(1e-5);
    check_values::<Q16_16>(1e-4);
}

/// Values of scipy.stats.t.ppf(1 − α/2, ν), scipy 1.17.1.
const QUANTILES: [(f64, [(usize, f64); 8]); 4] = [
    (
        0.1,
        [
            (1, 6.313_751_514_675_037),
            (2, 2.919_985_580_353_724),
            (3, 2.353_363_434_801_823),
            (4, 2.131_846_786_326_649),
            (8, 1.859_548_037_530_897_3),
            (21, 1.720_742_902_811_878),
            (42, 1.681_952_357_467_533_7),
            (999, 1.646_380_345_427_535),
        ],
    ),
    (
        0.05,
        [
            (1, 12.706_204_736_174_694),
            (2, 4.302_652_729_749_462),
            (3, 3.182_446_305_283_708),
            (4, 2.776_445_105_197_793),
            (8, 2.306_004_135_204_166),
            (21, 2.079_613_844_727_68),
            (42, 2.018_081_702_818_444),
            (999, 1.962_341_461_133_449),
        ],
    ),
    (
        0.01,
        [
            (1, 63.656_741_162_871_53),
            (2, 9.924_843_200_918_287),
            (3, 5.840_909_309_733_355),
            (4, 4.604_094_871_349_992),
            (8, 3.355_387_331_333_395),
            (21, 2.831_359_558_023_05),
            (42, 2.698_066_186_219_985),
            (999, 2.580_759_637_267_636),
        ],
    ),
    (
        0.001,
        [
            (1, 636.619_248_768_789_7),
            (2, 31.599_054_576_445_36),
            (3, 12.923_978_636_687_96),
            (4, 8.610_301_581_379_52),
            (8, 5.041_305_433_373_456),
            (21, 3.819_277_164_274_51),
            (42, 3.537_745_445_327_468),
            (999, 3.300_292_440_398_757),
        ],
    ),
];

fn check_quantiles<T: Scalar>(least_alpha: f64, tolerance: f64) {
    for (alpha, row) in QUANTILES {
        for (freedom, expected) in row {
            let found = student_quantile(T::from_f64(alpha), freedom).to_f64();
            let error = (found / expected - 1.0).abs();
            let looked_at = alpha >= least_alpha && expected < 20.0;
            assert!(!looked_at || error < tolerance, "{alpha} {freedom}: {found} {error:e}");
        }
    }
}

#[test]
fn thresholds_are_scipys() {
    check_quantiles::<f64>(0.001, 1e-10);
    check_quantiles::<f32>(0.001, 2e-3);
    check_quantiles::<f32>(0.01, 2e-4);
    check_quantiles::<Q12_20>(0.01, 2e-2);
    check_quantiles::<Q16_16>(0.05, 3e-2);
    let cauchy = student_quantile(0.001, 1);
    assert!((cauchy / 636.619_248_768_789_7_f64 - 1.0).abs() < 1e-9, "{cauchy}");
    assert_eq!(student_quantile(1.0, 5), 0.0);
    assert_eq!(student_quantile(0.0, 5), f64::MAX);
    assert_eq!(student_quantile(f64::NAN, 5), 0.0);
    assert!(student_quantile(0.01, 0) > 60.0 && student_quantile(0.01, usize::MAX) < 2.6);
}

#[test]
fn a_t_test_of_two_has_no_thresholds() {
    let weight = Weight::TTest(TTest { alpha0: 0.1, alpha1: 0.01, descent: Descent::Published });
    assert_eq!(weight.thresholds(2), None);
    assert_eq!(weight.thresholds(0), None);
    let (inner, outer) = weight.thresholds(10).expect("eight degrees of freedom");
    assert!((inner - 1.859_548).abs() < 1e-6 && (outer - 3.355_387).abs() < 1e-6);
}

fn weight() -> impl Strategy<Value = Weight<f64>> {
    let descent = prop_oneof![Just(Descent::Published), Just(Descent::Squared)];
    let thresholds = (0.1..5.0f64, 0.0..5.0f64, 0.001..0.5f64, 0.01..1.0f64, descent, 0..3);
    thresholds.prop_map(|(k, more, alpha0, share, descent, kind)| match kind {
        0 => Weight::Huber(Huber { k }),
        1 => Weight::Igg3(Igg3 { k0: k, k1: k + more, descent }),
        _ => Weight::TTest(TTest { alpha0, alpha1: alpha0 * share, descent }),
    })
}

proptest! {
    #[test]
    fn weights_lie_in_the_unit_interval_and_never_rise(
        weight in weight(),
        count in 3..100_usize,
        a in 0.0..20.0f64,
        step in 0.0..20.0f64,
    ) {
        let thresholds = weight.thresholds(count).expect("enough measurements");
        prop_assert!(thresholds.0 <= thresholds.1);
        let (near, far) = (weight.factor(a, thresholds), weight.factor(a + step, thresholds));
        prop_assert!((0.0..=1.0).contains(&near) && (0.0..=1.0).contains(&far));
        prop_assert!(far <= near, "{weight:?}: {near} at {a}, {far} at {}", a + step);
        prop_assert!(a > thresholds.0 || near == 1.0);
    }

    #[test]
    fn quantiles_fall_with_alpha_and_freedom(alpha in 0.001..0.9f64, freedom in 1..200_usize) {
        let quantile = student_quantile(alpha, freedom);
        prop_assert!(quantile > student_quantile(alpha + 0.01, freedom));
        prop_assert!(quantile > student_quantile(alpha, freedom + 1));
    }

    #[test]
    fn adaptive_factors_stay_above_their_floor(discrepancy in 0.0..50.0f64, more in 0.0..5.0f64) {
        let adaptive = Adaptive::new(Block::new(0, 3));
        let (near, far) = (adaptive.factor(discrepancy), adaptive.factor(discrepancy + more));
        prop_assert!(near <= 1.0 && far <= near && far >= adaptive.floor);
    }
}
