//! Blocks, gates, model traits and the steady state, in every scalar where it matters.

use kestirim_kalman::{
    ConstantVelocity, Covariance, Error, Gate, Gaussian, Observation, Process, SparseRow, Verdict,
    steady_state,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3, matrix, vector};

fn cast<T: Scalar, const R: usize, const C: usize>(m: &SMatrix<f64, R, C>) -> SMatrix<T, R, C> {
    m.map(T::from_f64)
}

fn check_block<T: Scalar>(tolerance: f64) {
    let p = matrix![2.0, 0.5, 0.1; 0.5, 1.0, -0.3; 0.1, -0.3, 0.7];
    let h = matrix![1.0, 0.0, 0.5; 0.3, -1.0, 0.0];
    let r = matrix![0.5, 0.2; 0.2, 0.4];
    let innovation = vector![0.7, -0.4];
    let mut ours =
        Gaussian::<T, 3>::new(SVector::zeros(), Covariance::from_lower_triangle(&cast(&p)));
    let noise = Covariance::from_lower_triangle(&cast(&r));
    let report = ours.update_block(&cast(&h), &cast(&innovation), &noise).unwrap();

    let s: Matrix2<f64> = h * p * h.transpose() + r;
    let spread: Matrix2<f64> = report.covariance.to_matrix().map(T::to_f64);
    let inverse = s.try_inverse().unwrap();
    let gain = p * h.transpose() * inverse;
    let mean: Vector3<f64> = gain * innovation;
    let covariance: Matrix3<f64> = p - gain * h * p;
    let nis = (innovation.transpose() * inverse * innovation)[0];
    assert!((ours.mean.map(T::to_f64) - mean).abs().max() < tolerance);
    assert!((ours.covariance.to_matrix().map(T::to_f64) - covariance).abs().max() < tolerance);
    assert!((spread - s).abs().max() < tolerance);
    assert!((report.nis.to_f64() - nis).abs() < tolerance);
}

#[test]
fn a_block_is_the_dense_textbook_update() {
    check_block::<f64>(1e-13);
    check_block::<f32>(1e-6);
    check_block::<Q12_20>(2e-5);
}

#[test]
fn a_block_with_impossible_noise_is_refused() {
    let start = Gaussian::<f32, 2>::new(Vector2::zeros(), Covariance::from_variances(&[1.0, 1.0]));
    let rows = Matrix2::identity();
    for (noise, error) in [
        (matrix![1.0, 2.0; 2.0, 1.0], Error::NotPositive),
        (matrix![0.0, 0.0; 0.0, 1.0], Error::NotPositive),
        (matrix![f32::NAN, 0.0; 0.0, 1.0], Error::NotFinite),
    ] {
        let mut ours = start;
        let noise = Covariance::from_lower_triangle(&noise);
        assert_eq!(ours.update_block(&rows, &Vector2::new(1.0, 1.0), &noise), Err(error));
        assert_eq!(ours, start);
    }
    let mut ours = start;
    let noise = Covariance::from_variances(&[1.0, 1.0]);
    let innovation = Vector2::new(1.0, f32::INFINITY);
    assert_eq!(ours.update_block(&rows, &innovation, &noise), Err(Error::NotFinite));
    assert_eq!(ours, start);
}

/// A pendulum's angle and rate.
struct Pendulum {
    dt: f64,
}

/// The measured height of the pendulum's bob.
struct Height<T>(T);

impl<T: Scalar> Process<T, 2> for Pendulum {
    fn advance(&self, estimate: &mut Gaussian<T, 2>) {
        let dt = T::from_f64(self.dt);
        let (sin, cos) = estimate.mean[0].sin_cos();
        estimate.mean[1] -= dt * sin;
        estimate.covariance.shear::<1, 0>(-dt * cos);
        let rate = estimate.mean[1];
        estimate.mean[0] += dt * rate;
        estimate.covariance.shear::<0, 1>(dt);
        estimate.covariance.add_variance::<1>(T::from_f64(1e-5));
    }
}

impl<T: Scalar> Observation<T, 2> for Height<T> {
    type Row = SparseRow<T, 1>;

    fn linearise(&self, mean: &SVector<T, 2>) -> Result<(T, SparseRow<T, 1>), Error> {
        let (sin, cos) = mean[0].sin_cos();
        Ok((self.0 - (T::ONE - cos), SparseRow::new([(0, sin)])))
    }
}

fn check_extended<T: Scalar>(tolerance: f64) {
    let model = Pendulum { dt: 0.02 };
    let (mut angle, mut rate) = (1.0_f64, 0.0_f64);
    let start = Vector2::new(0.8, 0.3).map(T::from_f64);
    let variances = [0.1, 0.1].map(T::from_f64);
    let mut ours = Gaussian::new(start, Covariance::from_variances(&variances));
    for _ in 0..1000 {
        rate -= model.dt * angle.sin();
        angle += model.dt * rate;
        ours.advance(&model).unwrap();
        ours.observe(&Height(T::from_f64(1.0 - angle.cos())), T::from_f64(1e-3)).unwrap();
    }
    let error = (ours.mean[0].to_f64() - angle).hypot(ours.mean[1].to_f64() - rate);
    assert!(error < tolerance, "{error}");
}

#[test]
fn an_extended_filter_follows_a_pendulum_by_its_height() {
    check_extended::<f64>(0.01);
    check_extended::<f32>(0.01);
    check_extended::<Q12_20>(0.01);
}

#[test]
fn a_prediction_out_of_range_is_refused() {
    let variances = Covariance::from_variances(&[Q12_20::from_f64(1000.0); 2]);
    let mut ours = Gaussian::new(SVector::zeros(), variances);
    let start = ours;
    let f = Matrix2::identity() * Q12_20::TWO;
    assert_eq!(ours.predict(&f, &Covariance::zero()), Err(Error::NotFinite));
    assert_eq!(ours, start);
}

fn check_gate<T: Scalar>() {
    let number = T::from_f64;
    let row = SparseRow::new([(0, T::ONE)]);
    let mut ours =
        Gaussian::<T, 1>::new(SVector::zeros(), Covariance::from_variances(&[number(0.01)]));
    let mut gate = Gate::new(number(25.0), 3);
    let mut offer = |gate: &mut Gate<T>, z: f64| {
        let weighed = ours.weigh(&row, number(z) - ours.mean[0], number(0.01)).unwrap();
        let before = ours;
        let (verdict, _) = gate.correct(&mut ours, &weighed).unwrap();
        assert_eq!(ours == before, verdict == Verdict::Reject);
        (verdict, ours.mean[0].to_f64())
    };
    assert_eq!(offer(&mut gate, 0.1).0, Verdict::Admit);
    // Single outliers are rejected, however many there are,
    for _ in 0..10 {
        assert_eq!(offer(&mut gate, 300.0).0, Verdict::Reject);
        assert_eq!(offer(&mut gate, 0.1).0, Verdict::Admit);
    }
    // but the fourth agreeing one in a row is believed.
    for _ in 0..3 {
        assert_eq!(offer(&mut gate, 5.0).0, Verdict::Reject);
    }
    let (verdict, mean) = offer(&mut gate, 5.0);
    assert_eq!(verdict, Verdict::Recover);
    assert!(mean > 4.5 && mean < 5.0, "{mean}");
    assert_eq!(gate.rejected(), 0);
    assert_eq!(offer(&mut gate, 5.0).0, Verdict::Admit);
}

#[test]
fn a_gate_recovers() {
    check_gate::<f64>();
    check_gate::<f32>();
    check_gate::<Q12_20>();
}

#[test]
fn the_steady_gain_of_a_tracker_is_the_alpha_beta_filters() {
    // Kalata's tracking index for white acceleration held over a step: Λ = σ_w T²/σ_v.
    let (dt, sigma_w, sigma_v) = (0.5_f64, 2.0_f64, 0.7_f64);
    let index = sigma_w * dt * dt / sigma_v;
    let r = (4.0 + index - (8.0 * index + index * index).sqrt()) / 4.0;
    let alpha = 1.0 - r * r;
    let beta = 2.0 * (2.0 - alpha) - 4.0 * (1.0 - alpha).sqrt();

    let push = vector![dt * dt / 2.0, dt] * sigma_w;
    let q = Covariance::from_lower_triangle(&(push * push.transpose()));
    let f = matrix![1.0, dt; 0.0, 1.0];
    let noise = Covariance::from_variances(&[sigma_v * sigma_v]);
    let steady = steady_state(&f, &q, &matrix![1.0, 0.0], &noise).unwrap();
    assert!((steady.gain[0] - alpha).abs() < 1e-9, "{} {alpha}", steady.gain[0]);
    assert!((steady.gain[1] - beta / dt).abs() < 1e-9, "{} {}", steady.gain[1], beta / dt);
    assert!(steady.posterior.variances()[0] < steady.prior.variances()[0]);
}

#[test]
fn what_is_never_seen_does_not_settle() {
    let q = Covariance::from_variances(&[1.0_f64, 1.0]);
    let noise = Covariance::from_variances(&[1.0]);
    let (f, h) = (Matrix2::identity(), matrix![1.0, 0.0]);
    assert_eq!(steady_state(&f, &q, &h, &noise), Err(Error::NotConverged));
}

fn moving<T: Scalar>() -> Gaussian<T, 5> {
    let mean = vector![1.0, 2.0, 0.5, -0.25, 0.1].map(T::from_f64);
    Gaussian::new(mean, Covariance::from_variances(&[0.5, 0.4, 0.3, 0.2, 0.1].map(T::from_f64)))
}

fn check_constant_velocity<T: Scalar>(tolerance: f64) {
    let (h, q) = (0.2, 0.7);
    let mut ours = moving::<T>();
    let motion = ConstantVelocity::<T, 2>::new(T::from_f64(h), T::from_f64(q));
    let pushed = [1.0, -2.0].map(T::from_f64);
    ours.advance(&ConstantVelocity { acceleration: Some(pushed), ..motion }).unwrap();

    let dense = moving::<f64>();
    let mut f = SMatrix::<f64, 5, 5>::identity();
    let mut noise = SMatrix::<f64, 5, 5>::zeros();
    for axis in 0..2 {
        f[(axis, axis + 2)] = h;
        noise[(axis, axis)] = q * h * h * h / 3.0;
        noise[(axis, axis + 2)] = q * h * h / 2.0;
        noise[(axis + 2, axis)] = q * h * h / 2.0;
        noise[(axis + 2, axis + 2)] = q * h;
    }
    let push = vector![h * h / 2.0, -h * h, h, -2.0 * h, 0.0];
    let mean: SVector<f64, 5> = f * dense.mean + push;
    let covariance = f * dense.covariance.to_matrix() * f.transpose() + noise;
    assert!((ours.mean.map(T::to_f64) - mean).abs().max() < tolerance);
    let ours: SMatrix<f64, 5, 5> = ours.covariance.to_matrix().map(T::to_f64);
    assert!((ours - covariance).abs().max() < tolerance);
}

#[test]
fn constant_velocity_is_the_textbooks() {
    check_constant_velocity::<f64>(1e-12);
    check_constant_velocity::<f32>(1e-6);
    check_constant_velocity::<Q12_20>(2e-5);
}

#[test]
fn a_decaying_velocity_hardly_cares_for_the_length_of_its_steps() {
    let run = |steps: u32, seconds: f64| {
        let mut ours = moving::<f64>();
        let step = seconds / f64::from(steps);
        let motion = ConstantVelocity::<f64, 2>::new(step, 0.1);
        for _ in 0..steps {
            ours.advance(&ConstantVelocity { decay_time: Some(2.0), ..motion }).unwrap();
        }
        ours
    };
    for seconds in [0.1, 1.0, 10.0, 60.0] {
        let (one, many) = (run(1, seconds), run(1000, seconds));
        for axis in 0..2 {
            let ratio = one.covariance.variances()[axis] / many.covariance.variances()[axis];
            assert!((0.75..1.35).contains(&ratio), "{seconds} s: {ratio}");
        }
        assert!((one.mean - many.mean).abs().max() < 0.35, "{seconds} s");
        assert!(one.covariance.to_matrix().symmetric_eigenvalues().min() > 0.0);
    }
    // It coasts v τ far, and the variance of its velocity settles at q τ / 2.
    let still = run(1000, 60.0);
    assert!((still.mean - vector![2.0, 1.5, 0.0, 0.0, 0.1]).abs().max() < 1e-3);
    assert!((still.covariance.variances()[2] - 0.1).abs() < 2e-3);
}

/// With many states, P hᵀ is computed by columns, and columns that a row does not reach are skipped: the numbers are
/// the same but for the allowance for rounding, which grows with the number of states.
fn many_states_are_updated_as_few<T: Scalar>(tolerance: f64) {
    const FEW: usize = 4;
    const MANY: usize = 20;
    let number = T::from_f64;
    let mut few = Gaussian::<T, FEW>::new(
        SVector::zeros(),
        Covariance::from_variances(&[1.0, 2.0, 0.5, 4.0].map(number)),
    );
    // Places of the same four states, in the same order, among others that nothing measures.
    let among = |index: usize| [3, 7, 8, 19][index];
    let mut variances = [T::ONE; MANY];
    for index in 0..FEW {
        variances[among(index)] = few.covariance.get(index, index).expect("a variance");
    }
    let mut many = Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances));
    let is_near = |a: T, b: T| {
        let (a, b) = (a.to_f64(), b.to_f64());
        assert!((a - b).abs() < tolerance * (1.0 + b.abs()), "{a} and {b}");
    };
    let rows = [[(0, 1.0), (2, -0.5)], [(1, 0.75), (3, 1.25)], [(3, -1.0), (0, 0.5)]];
    for (round, row) in rows.iter().cycle().take(30).enumerate() {
        let (innovation, variance) = (number(0.1 * round as f64 - 1.0), number(0.3));
        let row = row.map(|(index, value)| (index, number(value)));
        let spread = row.map(|(index, value)| (among(index), value));
        let [told, same] = [
            few.update(&SparseRow::new(row), innovation, variance).expect("a measurement"),
            many.update(&SparseRow::new(spread), innovation, variance).expect("a measurement"),
        ];
        is_near(told.variance, same.variance);
    }
    for i in 0..FEW {
        is_near(few.mean[i], many.mean[among(i)]);
        for j in 0..FEW {
            let entries = [few.covariance.get(i, j), many.covariance.get(among(i), among(j))];
            let [few, many] = entries.map(|entry| entry.expect("an entry"));
            is_near(few, many);
        }
    }
}

#[test]
fn many_states_are_updated_as_few_in_every_number() {
    many_states_are_updated_as_few::<f32>(1e-4);
    many_states_are_updated_as_few::<f64>(1e-12);
    many_states_are_updated_as_few::<Q12_20>(5e-3);
}
