//! Single parts that the tests of the filters do not tell apart, at their bounds, compared with closed forms.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{
    Adaptive, Block, Decision, Discrepancy, Error, Jump, Measurement, Robust, Summary, jump,
};
use nalgebra::{SMatrix, SVector, matrix, vector};

/// Four correlated states, and three measurements that determine the last three.
fn correlated() -> (Gaussian<f64, 4>, SMatrix<f64, 3, 4>, SVector<f64, 3>) {
    let covariance = matrix![
        2.0, 0.4, 0.3, -0.2;
        0.4, 1.0, 0.5, 0.1;
        0.3, 0.5, 3.0, -0.6;
        -0.2, 0.1, -0.6, 0.5
    ];
    let estimate = Gaussian::new(SVector::zeros(), Covariance::from_lower_triangle(&covariance));
    let rows = matrix![
        0.5, 1.0, 0.3, -0.2;
        0.0, -0.4, 1.0, 0.7;
        -1.0, 0.2, 0.6, 1.0
    ];
    (estimate, rows, vector![1.5, -0.8, 2.2])
}

const VARIANCE: f64 = 0.25;

fn jump_of(count: usize, block: Block) -> Result<Jump<f64>, Error> {
    let (estimate, rows, innovations) = correlated();
    let rows: Vec<[(usize, f64); 4]> =
        (0..count).map(|row| [0, 1, 2, 3].map(|state| (state, rows[(row, state)]))).collect();
    let measurements: Vec<Measurement<'_, f64>> = rows
        .iter()
        .zip(&innovations)
        .map(|(row, &innovation)| Measurement { row, innovation, variance: VARIANCE })
        .collect();
    jump(&estimate, &measurements, block)
}

#[test]
fn a_jump_is_that_of_generalised_least_squares() {
    let (estimate, rows, innovations) = correlated();
    let spread = rows * estimate.covariance.to_matrix() * rows.transpose()
        + SMatrix::from_diagonal_element(VARIANCE);
    let spread = spread.try_inverse().expect("a covariance");
    // As many measurements as states: the jump explains them exactly, and the discrepancy is their own weighted square.
    let distance = rows.fixed_columns::<3>(1).try_inverse().expect("rows of rank 3") * innovations;
    let discrepancy = (innovations.dot(&(spread * innovations)) / 3.0).sqrt();

    let jump = jump_of(3, Block::new(1, 3)).expect("a block");
    assert_eq!(jump.directions, 3);
    assert!((jump.discrepancy - discrepancy).abs() < 1e-12, "{jump:?}, {discrepancy}");
    for (found, wanted) in jump.distance.iter().zip(&distance) {
        assert!((found - wanted).abs() < 1e-12, "{jump:?}, {distance:?}");
    }
    assert_eq!(jump.distance[3..], [0.0; 3]);
}

#[test]
fn a_jump_is_known_along_as_many_directions_as_there_are_measurements() {
    let partly = jump_of(2, Block::new(1, 3)).expect("a block");
    assert_eq!((partly.directions, partly.distance), (2, [0.0; 6]));
    assert!(partly.discrepancy > 0.0);
    let nothing = jump_of(0, Block::new(1, 3)).expect("a block");
    assert_eq!((nothing.directions, nothing.discrepancy), (0, 0.0));
    // For a single state of the block, the jump is the least squares of all three measurements.
    let (estimate, rows, innovations) = correlated();
    let spread = rows * estimate.covariance.to_matrix() * rows.transpose()
        + SMatrix::from_diagonal_element(VARIANCE);
    let weighed = spread.try_inverse().expect("a covariance") * rows.column(2);
    let distance = weighed.dot(&innovations) / weighed.dot(&rows.column(2));
    let one = jump_of(3, Block::new(2, 1)).expect("a block");
    assert!((one.distance[0] - distance).abs() < 1e-12, "{one:?}, {distance}");
}

#[test]
fn a_block_has_a_state_and_ends_with_the_states() {
    assert!(jump_of(3, Block::new(0, 4)).is_ok());
    for block in [Block::new(0, 0), Block::new(1, 4), Block::new(4, 1), Block::new(0, 7)] {
        assert_eq!(jump_of(3, block), Err(Error::InvalidBlock), "{block:?}");
    }
}

/// Two states, each measured once.
fn update(
    robust: &Robust<f64>,
    variances: [f64; 2],
    innovations: [f64; 2],
) -> Result<(Summary<f64>, [Decision<f64>; 2]), Error> {
    let mut estimate = Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances));
    let rows = [[(0, 1.0)], [(1, 1.0)]];
    let measurements: [_; 2] = std::array::from_fn(|index| Measurement {
        row: &rows[index],
        innovation: innovations[index],
        variance: 1.0,
    });
    let mut decisions = [Decision::NONE; 2];
    let summary = robust.update(&mut estimate, &measurements, &mut decisions)?;
    Ok((summary, decisions))
}

#[test]
fn an_adaptive_factor_has_thresholds_in_order_and_a_floor() {
    let usual = Adaptive::new(Block::new(0, 1));
    let is_taken = |adaptive| {
        let robust = Robust { adaptive: Some(adaptive), ..Robust::iterative_igg3() };
        match update(&robust, [1.0; 2], [0.1; 2]) {
            Ok(_) => true,
            Err(error) => {
                assert_eq!(error, Error::InvalidConfiguration);
                false
            }
        }
    };
    for taken in [
        usual,
        Adaptive { c0: 3.0, c1: 3.0, ..usual },
        Adaptive { floor: 1.0, ..usual },
        Adaptive { floor: 1e-9, ..usual },
    ] {
        assert!(is_taken(taken), "{taken:?}");
    }
    for refused in [
        Adaptive { c0: 0.0, ..usual },
        Adaptive { c0: -1.0, ..usual },
        Adaptive { c0: 8.1, ..usual },
        Adaptive { c1: f64::INFINITY, ..usual },
        Adaptive { c1: f64::NAN, ..usual },
        Adaptive { floor: 0.0, ..usual },
        Adaptive { floor: 1.1, ..usual },
    ] {
        assert!(!is_taken(refused), "{refused:?}");
    }
}

#[test]
fn what_is_known_without_doubt_has_no_discrepancy() {
    let adaptive =
        Adaptive { discrepancy: Discrepancy::Prediction, ..Adaptive::new(Block::new(0, 2)) };
    let robust = Robust { adaptive: Some(adaptive), ..Robust::plain() };
    let (summary, _) = update(&robust, [0.0; 2], [5.0; 2]).expect("an update");
    assert_eq!((summary.discrepancy, summary.adaptive_factor), (0.0, 1.0));
}

#[test]
fn a_redundancy_is_the_share_of_its_noise_that_a_residual_shows() {
    // P⁺ = P R/(P + R); the share of R = 1 that is left is R/(P + R).
    let (_, decisions) = update(&Robust::igg3(), [1.0, 3.0], [0.1; 2]).expect("an update");
    assert!((decisions[0].redundancy - 0.5).abs() < 1e-12, "{decisions:?}");
    assert!((decisions[1].redundancy - 0.25).abs() < 1e-12, "{decisions:?}");
    // Where nothing else is known of a state, no redundancy is left: not judged, whatever the least redundancy.
    let robust = Robust { least_redundancy: 0.0, ..Robust::igg3() };
    let (_, decisions) = update(&robust, [1e200; 2], [1.0; 2]).expect("an update");
    for decision in decisions {
        assert_eq!(decision.reason, kestirim_robust_kalman::Reason::NoRedundancy, "{decision:?}");
        assert_eq!((decision.weight, decision.statistic), (1.0, 0.0), "{decision:?}");
    }
}
