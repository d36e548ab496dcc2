//! Which forms of the covariance stay positive definite: the measurement on which this crate's choice rests.
//! `cargo test -p kestirim-kalman --test all covariance_forms:: -- --nocapture` prints the table.

mod forms;

use forms::{Conventional, Form, Joseph, Ours, Ud};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{Matrix4, Vector4};
use rand_distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// A task that a form of the covariance must survive.
struct Task {
    name: &'static str,
    variances: [f64; 4],
    /// Variance of the measurement noise.
    r: f64,
    /// Spectral density of the acceleration of a constant-velocity motion, or 0 for four constants.
    q: f64,
    /// Range of the angle of the rows, rad: how far their directions differ.
    spread: f64,
}

const TASKS: [Task; 5] = [
    Task { name: "tracking", variances: [1.0; 4], r: 1e-2, q: 0.25, spread: 6.3 },
    Task {
        name: "1 mm after 10 m",
        variances: [1e2, 1e2, 1.0, 1.0],
        r: 1e-6,
        q: 1e-4,
        spread: 6.3,
    },
    Task { name: "constants", variances: [1.0; 4], r: 1e-2, q: 0.0, spread: 6.3 },
    Task { name: "parallel rows", variances: [1e3; 4], r: 1e-4, q: 0.0, spread: 1e-4 },
    Task {
        name: "perfect, parallel",
        variances: [1e3, 1e3, 1.0, 1e-2],
        r: 0.0,
        q: 0.0,
        spread: 1e-4,
    },
];

/// The smallest eigenvalue of the correlation matrix.
fn definiteness(p: &Matrix4<f64>) -> f64 {
    let deviations = p.diagonal().map(f64::sqrt);
    if deviations.iter().any(|deviation| deviation.is_nan() || *deviation == 0.0) {
        return f64::NEG_INFINITY;
    }
    let scale = Matrix4::from_diagonal(&deviations.map(f64::recip));
    (scale * p * scale).symmetric_eigenvalues().min()
}

/// The worst [`definiteness`] over this many updates; −∞ if one was not possible.
fn worst<T: Scalar, F: Form<T>>(task: &Task, updates: u32) -> f64 {
    let number = T::from_f64;
    let mut form = F::new(task.variances.map(number));
    let (mut worst, dt) = (f64::INFINITY, 0.1);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for k in 0..updates {
        if task.q > 0.0 && k % 4 == 0 {
            for axis in 0..2 {
                form.shear(axis, number(dt / 2.0));
                form.add_variance(axis, number(task.q * dt.powi(3) / 12.0));
                form.add_variance(axis + 2, number(task.q * dt));
                form.shear(axis, number(dt / 2.0));
            }
        }
        let share: f64 = StandardUniform.sample(&mut random);
        let angle = 0.7 + task.spread * share;
        let h = if task.q > 0.0 {
            Vector4::new(angle.cos(), angle.sin(), 0.0, 0.0)
        } else {
            Vector4::new(angle.cos(), angle.sin(), (3.0 * angle).sin(), (2.0 * angle).cos())
        };
        if !form.update(std::array::from_fn(|i| number(h[i])), number(task.r)) {
            return f64::NEG_INFINITY;
        }
        if k < 200 || k % 97 == 0 {
            worst = worst.min(definiteness(&form.matrix()));
        }
    }
    worst
}

/// The number of tasks in which the form stayed positive definite.
fn survived<T: Scalar, F: Form<T>>(scalar: &str, updates: u32) -> usize {
    let worst = TASKS.map(|task| (task.name, worst::<T, F>(&task, updates)));
    for (task, worst) in worst {
        println!("{scalar:7} {:12} {task:18} {worst:9.1e}", F::NAME);
    }
    worst.iter().filter(|(_, worst)| *worst > 0.0).count()
}

#[test]
fn ours_stays_positive_definite_over_ten_million_updates_in_f32() {
    assert_eq!(survived::<f32, Ours<_>>("f32", 10_000_000), TASKS.len());
}

#[test]
fn ours_stays_positive_definite_over_a_million_updates_in_fixed_point() {
    assert_eq!(survived::<Q12_20, Ours<_>>("Q12.20", 1_000_000), TASKS.len());
}

#[test]
fn no_other_form_does_all_of_that() {
    let [f32, fixed] = ["f32", "Q12.20"];
    assert!(survived::<f32, Conventional<_>>(f32, 100_000) < TASKS.len());
    assert!(survived::<f32, Joseph<_>>(f32, 100_000) < TASKS.len());
    assert!(survived::<f32, Ud<_>>(f32, 100_000) < TASKS.len());
    assert!(survived::<Q12_20, Conventional<_>>(fixed, 100_000) < TASKS.len());
    assert!(survived::<Q12_20, Joseph<_>>(fixed, 100_000) < TASKS.len());
    assert!(survived::<Q12_20, Ud<_>>(fixed, 100_000) < TASKS.len());
}
