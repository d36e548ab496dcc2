//! Tests of what is learnt from standstills, and of motions from which nothing is learnt.

extern crate std;

use super::*;
use nalgebra::Vector3;
use std::vec::Vec;

#[test]
fn a_fast_sensor_at_rest_shows_gravity_in_fixed_point() {
    use kestirim_scalar::Q12_20;
    let mut alignment = Alignment::<Q12_20>::new(SensorClass::Consumer);
    let specific_force = Vector3::new(0.0, 0.0, STANDARD_GRAVITY).map(Q12_20::from_f64);
    let at =
        |k: u64| ImuSample { time_us: k * 250, specific_force, angular_rate: SVector::zeros() };
    let shown: Vec<_> = (0..8000).filter_map(|k| alignment.update(&at(k))).collect();
    assert!(!shown.is_empty());
    assert!(shown.iter().all(|gravity| (gravity.to_f64() - 1.0).abs() < 1e-3), "{shown:?}");
}

const BIAS: [f64; 3] = [0.02, -0.03, 0.05];
const GRAVITY: [f64; 3] = [0.0, 0.6, 0.8];

/// An alignment that processes samples a hundredth of a second apart.
struct Shown {
    alignment: Alignment<f64>,
    time_us: u64,
}

impl Shown {
    fn new(sensor: SensorClass) -> Self {
        // The lower half of the clock wraps round.
        Self { alignment: Alignment::new(sensor), time_us: u64::from(u32::MAX) - 200_000 }
    }

    /// Processes `count` samples of a rate (rad/s) and a force (g); returns the magnitudes that standstills showed.
    fn on(
        &mut self,
        samples: u32,
        motion: impl Fn(u32) -> (Vector3<f64>, Vector3<f64>),
    ) -> Vec<f64> {
        let update = |k| {
            self.time_us += 10_000;
            let (angular_rate, force) = motion(k);
            let specific_force = force * STANDARD_GRAVITY;
            self.alignment.update(&ImuSample {
                time_us: self.time_us,
                specific_force,
                angular_rate,
            })
        };
        (0..samples).filter_map(update).collect()
    }

    fn bias_off(&self) -> f64 {
        (self.alignment.gyro_bias() - Vector3::from(BIAS)).norm()
    }
}

fn still(_: u32) -> (Vector3<f64>, Vector3<f64>) {
    (BIAS.into(), GRAVITY.into())
}

#[test]
fn a_standstill_takes_half_a_second_and_shows_the_bias() {
    let mut shown = Shown::new(SensorClass::Consumer);
    // A block ends with the sample that is an eighth of a second after its first: of 14 samples, then of 13.
    assert_eq!(shown.on(52, still).len(), 0);
    let magnitudes = shown.on(1, still);
    assert!(magnitudes.len() == 1 && (magnitudes[0] - 1.0).abs() < 1e-9, "{magnitudes:?}");
    assert!(shown.bias_off() < 1e-5, "{:?}", shown.alignment);
    assert!(shown.alignment.accelerometer_bias().norm() < 1e-6);
    // Each half second is another standstill.
    assert_eq!(shown.on(52 * 3, still).len(), 3);
}

#[test]
fn a_good_gyroscope_is_believed_beside_a_short_standstill() {
    let mut shown = Shown::new(SensorClass::Industrial);
    shown.on(53, still);
    // Its standard deviation of 0.3 against that of the standstill, 0.07: a gain of P/(P + R).
    let gain = |p: f64| p / (p + 0.07 * 0.07);
    let first = gain(0.3 * 0.3 + 1e-4);
    let total = Vector3::from(BIAS).norm();
    assert!((shown.bias_off() / total - (1.0 - first)).abs() < 1e-6, "{}", shown.bias_off());
    shown.on(52, still);
    let second = gain((0.3 * 0.3 + 1e-4) * (1.0 - first) + 1e-4);
    let left = (1.0 - first) * (1.0 - second);
    assert!((shown.bias_off() / total - left).abs() < 1e-6, "{}", shown.bias_off());
}

#[test]
fn what_moves_is_no_standstill() {
    let about = |axis: usize, size: f64| {
        let mut vector = Vector3::zeros();
        vector[axis] = size;
        vector
    };
    for axis in 0..3 {
        // Another rate or force in each eighth of a second; or a rate that no bias explains.
        let steps =
            |size: f64| move |k: u32| if k.saturating_sub(1) / 13 % 2 == 1 { size } else { 0.0 };
        let turns = |size: f64| {
            let step = steps(size);
            Shown::new(SensorClass::Consumer)
                .on(300, |k| (about(axis, step(k)), GRAVITY.into()))
                .len()
        };
        let pushes = |size: f64| {
            let step = steps(size);
            Shown::new(SensorClass::Consumer)
                .on(300, |k| (BIAS.into(), Vector3::from(GRAVITY) + about(axis, step(k))))
                .len()
        };
        let spins = |size: f64| {
            Shown::new(SensorClass::Consumer).on(300, |_| (about(axis, size), GRAVITY.into())).len()
        };
        assert!(turns(0.025) > 0 && turns(0.035) == 0, "{axis}");
        assert!(pushes(0.035) > 0 && pushes(0.047) == 0, "{axis}");
        assert!(spins(0.34) > 0 && spins(-0.34) > 0, "{axis}");
        assert!(spins(0.36) == 0 && spins(-0.36) == 0, "{axis}");
    }
}

#[test]
fn what_is_not_gravity_teaches_nothing() {
    for (force, teaches) in [(1.49, true), (0.51, true), (1.51, false), (0.49, false), (0.0, false)]
    {
        let mut shown = Shown::new(SensorClass::Consumer);
        let magnitudes = shown.on(60, |_| (BIAS.into(), Vector3::from(GRAVITY) * force));
        assert!((magnitudes[0] - force).abs() < 1e-9, "it is told all the same");
        assert_eq!(shown.bias_off() < 1e-3, teaches, "{force} g");
        let bias = shown.alignment.accelerometer_bias().norm();
        assert_eq!(bias > 0.0, teaches, "{force} g: {bias}");
    }
}

#[test]
fn an_accelerometer_bias_is_what_is_beyond_gravity_along_it() {
    let mut shown = Shown::new(SensorClass::Consumer);
    for _ in 0..20 {
        shown.on(52, |_| (BIAS.into(), Vector3::from(GRAVITY) * 1.03));
    }
    let expected = Vector3::from(GRAVITY) * (0.03 * STANDARD_GRAVITY);
    let found = *shown.alignment.accelerometer_bias();
    assert!((found - expected).norm() < 1e-3 * expected.norm(), "{found} {expected}");
    // A first standstill is believed almost completely, as a bare chip may be off by 5 %, and a standstill by a
    // thousandth.
    let mut shown = Shown::new(SensorClass::Consumer);
    shown.on(60, |_| (BIAS.into(), Vector3::from(GRAVITY) * 1.03));
    let share = shown.alignment.accelerometer_bias().norm() / expected.norm();
    assert!((share - 0.0025 / (0.0025 + 1e-6)).abs() < 1e-6, "{share}");
}

/// A person who sways by `by` (rad/s) in steps of an eighth of a second, about a mean of half of that.
fn swayed(by: f64, sensor: SensorClass) -> Shown {
    swayed_beside(Shown::new(sensor), by)
}

fn swayed_beside(mut shown: Shown, by: f64) -> Shown {
    let rate =
        |k: u32| Vector3::new(if k.saturating_sub(1) / 13 % 2 == 1 { by } else { 0.0 }, 0.0, 0.0);
    let told = shown.on(53, |k| (rate(k), GRAVITY.into()));
    assert_eq!(told.len(), 1);
    shown
}

#[test]
fn a_sway_is_no_bias_to_a_gyroscope_of_which_nothing_is_known() {
    let unknown = swayed(0.025, SensorClass::Consumer);
    assert_eq!(*unknown.alignment.gyro_bias(), Vector3::zeros());
    // For a good sensor it has the weight that its spread leaves.
    let good = swayed(0.025, SensorClass::Industrial);
    let bias = good.alignment.gyro_bias().x;
    // Four means of 0 and 0.025 rad/s: their mean has the standard deviation of one over √4.
    let deviation = 0.025 / 3_f64.sqrt() / 2.0;
    let (p, noise) = (0.3 * 0.3 + 1e-4, 1e4 * deviation * deviation + 0.07 * 0.07);
    assert!((bias - 0.0125 * p / (p + noise)).abs() < 1e-6, "{bias}");
    // A bias that may be off by a hundredth of a radian per second or more is unknown.
    for (sigma, learns) in [(0.99, true), (1.01, false)] {
        let mut shown = Shown::new(SensorClass::Consumer);
        shown.alignment.bias_variance = sigma * sigma;
        let bias = *swayed_beside(shown, 0.025).alignment.gyro_bias();
        assert_eq!(bias != Vector3::zeros(), learns, "{sigma}");
    }
}

#[test]
fn a_sway_spreads_by_itself_and_beside_its_mean() {
    let rate = |x: f64| Vector3::new(0.01 * x, 0.0, 0.0);
    assert!(sways(&rate(1.0), 0.26) && !sways(&rate(1.0), 0.24));
    assert!(sways(&rate(2.5), 0.26) && !sways(&rate(2.6), 0.26));
    assert!(sways(&rate(5.0), 1.01) && !sways(&rate(5.0), 0.99));
}

#[test]
fn rewound_it_keeps_what_it_has_learnt_and_nothing_of_the_stream() {
    let mut shown = Shown::new(SensorClass::Consumer);
    shown.on(53 + 30, still);
    let mut rewound = Shown { alignment: shown.alignment.rewound(), time_us: 0 };
    assert_eq!(rewound.alignment.gyro_bias(), shown.alignment.gyro_bias());
    assert_eq!(rewound.on(52, still).len(), 0);
    assert_eq!(rewound.on(1, still).len(), 1);
}

#[test]
fn the_largest_component_is_that_of_the_largest_size() {
    assert_eq!(largest(&Vector3::new(1.0, -3.0, 2.0)), 3.0);
    assert_eq!(largest(&Vector3::new(-1.0, 0.5, 0.0)), 1.0);
}

#[test]
fn a_force_is_the_mean_of_its_eighths_and_gravity_that_of_all_standstills() {
    let mut shown = Shown::new(SensorClass::Consumer);
    let force = |k: u32| if k.saturating_sub(1) / 13 % 2 == 1 { 1.04 } else { 1.02 };
    let told = shown.on(53, |k| (BIAS.into(), Vector3::from(GRAVITY) * force(k)));
    assert!(told.len() == 1 && (told[0] - 1.03).abs() < 1e-9, "{told:?}");
    let bias = |shown: &Shown| shown.alignment.accelerometer_bias().norm() / STANDARD_GRAVITY;
    assert!((bias(&shown) - 0.03).abs() < 1e-4, "{}", bias(&shown));
    // A second standstill at 1 g has the same weight, and a third.
    for expected in [0.015, 0.01] {
        shown.on(52, still);
        assert!((bias(&shown) - expected).abs() < 1e-4, "{}", bias(&shown));
    }
}
