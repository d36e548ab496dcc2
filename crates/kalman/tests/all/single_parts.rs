//! Single parts that the tests of the filters do not tell apart: at their bounds, and from means that are not zero.

use kestirim_kalman::{
    Covariance, Error, Gate, Gaussian, LinearObservation, Observation, SparseRow, Verdict,
};
use nalgebra::{Vector2, matrix, vector};

fn covariance() -> Covariance<f64, 2> {
    Covariance::from_lower_triangle(&matrix![2.0, 0.5; 0.5, 1.0])
}

fn estimate() -> Gaussian<f64, 2> {
    Gaussian::new(vector![3.0, -7.0], covariance())
}

#[test]
fn a_block_moves_an_estimate_as_far_from_anywhere() {
    let rows = matrix![1.0, 0.2; -0.3, 1.0];
    let noise = Covariance::from_lower_triangle(&matrix![1.0, 0.3; 0.3, 0.5]);
    let mut moved = [Vector2::zeros(), vector![30.0, -70.0]].map(|mean| {
        let mut estimate = Gaussian::new(mean, covariance());
        estimate.update_block(&rows, &vector![0.7, -0.4], &noise).expect("a measurement");
        estimate.mean - mean
    });
    moved[1] -= moved[0];
    assert!(moved[0].norm() > 0.1 && moved[1].norm() < 1e-12, "{moved:?}");
}

#[test]
fn entries_are_looked_up_and_changed() {
    let mut p = covariance();
    assert_eq!((p.get(0, 1), p.get(1, 0), p.get(1, 1)), (Some(0.5), Some(0.5), Some(1.0)));
    assert_eq!((p.get(0, 2), p.get(2, 0)), (None, None));
    p.scale(3.0);
    p.add_variance::<1>(0.25);
    assert_eq!(p.to_matrix(), matrix![6.0, 1.5; 1.5, 3.25]);
    assert!(p.is_finite());
    assert!(!Covariance::from_variances(&[1.0, f64::INFINITY]).is_finite());
}

#[test]
fn between_two_covariances_is_one() {
    let other = Covariance::from_lower_triangle(&matrix![4.0, -0.5; -0.5, 3.0]);
    let at = |share: f64| {
        let mut p = covariance();
        p.blend(&other, share);
        p.to_matrix()
    };
    assert_eq!(at(0.0), covariance().to_matrix());
    assert_eq!(at(0.25), matrix![2.5, 0.25; 0.25, 1.5]);
    assert_eq!(at(1.0), other.to_matrix());
}

#[test]
fn noise_of_one_state_is_added_within_its_bounds() {
    let mut found = estimate();
    assert_eq!(found.add_variance_at(1, 0.5), Ok(()));
    assert_eq!(found.covariance.to_matrix(), matrix![2.0, 0.5; 0.5, 1.5]);
    assert_eq!(found.add_variance_at(1, 0.0), Ok(()));
    let before = found;
    for (index, variance, error) in [
        (2, 1.0, Error::IndexOutOfRange),
        (0, -1.0, Error::NotPositive),
        (0, f64::INFINITY, Error::NotFinite),
    ] {
        assert_eq!(found.add_variance_at(index, variance), Err(error));
        assert_eq!(found, before);
    }
}

#[test]
fn a_state_is_reset_within_its_bounds() {
    let mut found = estimate();
    assert_eq!(found.reset_at(0, 5.0, 0.0), Ok(()));
    assert_eq!((found.mean, found.covariance.get(0, 1)), (vector![5.0, -7.0], Some(0.0)));
    let before = found;
    for (index, mean, variance, error) in [
        (2, 0.0, 1.0, Error::IndexOutOfRange),
        (0, 0.0, -1.0, Error::NotPositive),
        (0, f64::NAN, 1.0, Error::NotFinite),
        (0, 0.0, f64::INFINITY, Error::NotFinite),
    ] {
        assert_eq!(found.reset_at(index, mean, variance), Err(error));
        assert_eq!(found, before);
    }
}

#[test]
fn a_factor_of_one_inflates_nothing() {
    let mut p = covariance();
    assert_eq!(p.inflate(0, 2, 1.0), Ok(()));
    assert_eq!(p, covariance());
}

#[test]
fn rejections_are_counted() {
    let (mut gate, mut found) = (Gate::new(9.0, 2), estimate());
    let row = SparseRow::new([(0, 1.0)]);
    for expected in [1, 2] {
        let weighed = found.weigh(&row, 50.0, 1.0).expect("a measurement");
        let (verdict, _) = gate.correct(&mut found, &weighed).expect("a verdict");
        assert_eq!((verdict, gate.rejected(), gate.gamma()), (Verdict::Reject, expected, 9.0));
    }
    let weighed = found.weigh(&row, 50.0, 1.0).expect("a measurement");
    let (verdict, _) = gate.correct(&mut found, &weighed).expect("a verdict");
    assert_eq!((verdict, gate.rejected()), (Verdict::Recover, 0));
}

#[test]
fn a_row_of_all_states_weighs_as_its_entries() {
    let all = estimate().weigh_row(&[2.0, -1.5], 0.7, 1.0);
    assert_eq!(all, estimate().weigh_entries(&[(0, 2.0), (1, -1.5)], 0.7, 1.0));
    let second = estimate().weigh_row(&[0.0, -1.5], 0.7, 1.0);
    assert_eq!(second, estimate().weigh_entries(&[(1, -1.5)], 0.7, 1.0));
    assert_eq!(second.expect("a measurement").cross_covariance(), &[-0.75, -1.5]);
    assert_eq!(estimate().weigh_row(&[1.0, 0.0], f64::NAN, 1.0), Err(Error::NotFinite));
}

#[test]
fn another_noise_weighs_as_if_it_had_been_the_first() {
    let row = SparseRow::new([(0, 1.0), (1, -0.5)]);
    let weighed = estimate().weigh(&row, 0.7, 1.0).and_then(|it| it.with_noise(4.0));
    let (weighed, expected) =
        (weighed.expect("noise"), estimate().weigh(&row, 0.7, 4.0).expect("a measurement"));
    assert_eq!(weighed, expected);
    assert_eq!(weighed.noise(), 4.0);
}

#[test]
fn a_linear_observation_differs_by_what_is_expected() {
    let row = SparseRow::new([(0, 2.0), (1, 0.5)]);
    let observation = LinearObservation { row, measured: 4.0 };
    let (innovation, _) = observation.linearise(&estimate().mean).expect("a row of the state");
    assert!((innovation - (4.0 - 2.5)).abs() < 1e-12, "{innovation}");
}
