//! The five filters on a robot among four UWB anchors: a range is a measurement like any other.

use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian};
use kestirim_robust_kalman::{Block, Decision, Measurement, Reason, Robust};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::expected_range;
use nalgebra::{SVector, Vector2, Vector3};

const ANCHORS: [[f64; 3]; 4] =
    [[0.0, 0.0, 2.5], [10.0, 0.0, 2.5], [10.0, 8.0, 2.5], [0.0, 8.0, 2.5]];
const HEIGHT: f64 = 0.5;
const SIGMA: f64 = 0.1;
const STEP: f64 = 0.1;

/// Marsaglia's xorshift, for the same noise on every machine.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// Position of the robot on a round trip through the room, in metres.
fn place(step: u32) -> Vector2<f64> {
    let angle = 0.05 * f64::from(step) * STEP * 5.0;
    Vector2::new(5.0 + 3.0 * angle.cos(), 4.0 + 2.0 * angle.sin())
}

/// Result of a filter on one drive.
#[derive(Clone, Copy, Debug, Default)]
struct Drive {
    rmse: f64,
    /// Number of rejected or down-weighted ranges among those with a detour, and the number of all
    /// of these.
    caught: (u32, u32),
    /// Number of rejected or down-weighted ranges among the direct ones, and the number of all of
    /// these.
    mistaken: (u32, u32),
}

/// Drives through the room; one range in `one_in` takes a detour of up to 5 m.
fn drive<T: Scalar>(robust: &Robust<T>, one_in: f64, seed: u64) -> Drive {
    let number = |value: f64| T::from_f64(value);
    let anchors = ANCHORS.map(|anchor| Vector3::from(anchor.map(number)));
    let start = place(0);
    let variances = [0.25, 0.25, 1.0, 1.0].map(number);
    let mean = SVector::from([number(start.x), number(start.y), T::ZERO, T::ZERO]);
    let mut robot = Gaussian::<T, 4>::new(mean, Covariance::from_variances(&variances));
    let motion = ConstantVelocity::<T, 2>::new(number(STEP), number(0.3));
    let mut random = Random(seed);
    let mut drive = Drive::default();
    let mut decisions = [Decision::NONE; 4];
    let steps = 600;
    for step in 1..=steps {
        robot.advance(&motion).expect("a prediction");
        let truth = place(step);
        let mut blocked = [false; 4];
        let mut rows = [[(0, T::ZERO); 2]; 4];
        let mut innovations = [T::ZERO; 4];
        let predicted = SVector::<T, 2>::from([robot.mean[0], robot.mean[1]]);
        for anchor in 0..4 {
            let distance = expected_range(&truth, HEIGHT, &Vector3::from(ANCHORS[anchor])).distance;
            blocked[anchor] = random.uniform() * one_in < 1.0;
            let detour = 0.5 + 4.5 * random.uniform();
            let measured =
                distance + SIGMA * random.normal() + if blocked[anchor] { detour } else { 0.0 };
            let expected = expected_range(&predicted, number(HEIGHT), &anchors[anchor]);
            rows[anchor] = [(0, expected.direction[0]), (1, expected.direction[1])];
            innovations[anchor] = number(measured) - expected.distance;
        }
        let epoch: [Measurement<'_, T>; 4] = core::array::from_fn(|anchor| Measurement {
            row: &rows[anchor],
            innovation: innovations[anchor],
            variance: number(SIGMA * SIGMA),
        });
        robust.update(&mut robot, &epoch, &mut decisions).expect("an update");
        for (decision, blocked) in decisions.iter().zip(blocked) {
            let count = if blocked { &mut drive.caught } else { &mut drive.mistaken };
            count.0 += u32::from(decision.was_treated());
            count.1 += 1;
            assert_eq!(decision.reason == Reason::Rejected, decision.weight == T::ZERO);
        }
        let error = (robot.mean[0].to_f64() - truth.x).hypot(robot.mean[1].to_f64() - truth.y);
        drive.rmse += error * error / f64::from(steps);
    }
    drive.rmse = drive.rmse.sqrt();
    drive
}

fn filters<T: Scalar>() -> [(&'static str, Robust<T>); 5] {
    [
        ("plain", Robust::plain()),
        ("IGG III", Robust::igg3()),
        ("t-test", Robust::t_test()),
        ("iterative IGG III", Robust::iterative_igg3()),
        ("adaptive", Robust::adaptive(Block::new(0, 4))),
    ]
}

fn table<T: Scalar>(one_in: f64) -> [f64; 5] {
    filters::<T>().map(|(name, robust)| {
        let drives = [1, 2, 3, 4].map(|seed| drive(&robust, one_in, seed << 40 | 0x9E37_79B9));
        let rmse = drives.iter().map(|drive| drive.rmse).sum::<f64>() / 4.0;
        println!("{name:18} {:6.1} cm  {:?}", rmse * 100.0, drives[0]);
        rmse
    })
}

fn check<T: Scalar>() {
    println!("a clear view");
    let clear = table::<T>(1e9);
    assert!(clear.iter().all(|&rmse| rmse < 1.3 * clear[0]), "{clear:?}");
    println!("one range in ten is not");
    let [plain, igg3, t_test, iterative, adaptive] = table::<T>(10.0);
    assert!(plain > 4.0 * clear[0], "{plain}");
    for rmse in [igg3, iterative, adaptive] {
        assert!(rmse < 0.2 * plain, "{rmse} of {plain}");
    }
    // The mean and the deviation of only three others tell little.
    assert!(t_test < 0.9 * plain, "{t_test} of {plain}");
    println!("the published equations");
    let published = Robust::<T>::iterative_igg3().published();
    let masked = drive(&published, 10.0, 1 << 40);
    println!("{masked:?}");
    assert!(masked.caught.0 < masked.caught.1 / 4, "outliers hide behind eq. 17: {masked:?}");
}

#[test]
fn detours_are_found_in_double_precision() {
    check::<f64>();
}

#[test]
fn detours_are_found_in_single_precision() {
    check::<f32>();
}

#[test]
fn detours_are_found_in_fixed_point() {
    check::<Q12_20>();
}
