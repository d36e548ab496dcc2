//! Trilateration and least squares in every scalar type.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{
    Error, Fix, Huber, Observation, Room, Search, Solver, Trilateration, dilution_of_precision,
    expected_range, position_error, trilaterate, weighted_dilution,
};
use nalgebra::{SVector, Vector2, Vector3};
use proptest::prelude::*;

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 2.0], [4.8, 6.4, 2.5], [0.0, 6.4, 2.2], [4.8, 0.0, 1.0]];
const SPATIAL: [[f64; 3]; 5] =
    [[0.0, 0.0, 0.0], [9.0, 0.0, 0.2], [0.0, 8.0, 0.1], [9.0, 8.0, 3.0], [4.0, 1.0, 3.0]];

fn distance(place: [f64; 3], tag: [f64; 3]) -> f64 {
    (Vector3::from(place) - Vector3::from(tag)).norm()
}

fn places<T: Scalar, const A: usize>(places: [[f64; 3]; A]) -> [SVector<T, 3>; A] {
    places.map(|place| SVector::from(place.map(T::from_f64)))
}

fn observations<T: Scalar, const A: usize>(
    at: [[f64; 3]; A],
    ranges: [f64; A],
) -> [Observation<T>; A] {
    let variance = T::from_f64(0.01);
    core::array::from_fn(|i| Observation {
        anchor: SVector::from(at[i].map(T::from_f64)),
        range: T::from_f64(ranges[i]),
        variance,
    })
}

fn check_exact<T: Scalar>(tag: [f64; 3], tolerance: f64) {
    let plane = Trilateration::<T, 4, 2>::new(places(CORNERS)).unwrap();
    let ranges = CORNERS.map(|place| distance(place, tag));
    let ours = plane.position(&ranges.map(T::from_f64), T::from_f64(tag[2])).unwrap();
    let unprepared = trilaterate::<T, 2>(&observations(CORNERS, ranges), T::from_f64(tag[2]));
    assert_eq!(unprepared, Ok(ours));
    assert!((ours.map(T::to_f64) - Vector2::new(tag[0], tag[1])).norm() < tolerance, "{ours:?}");

    let solver = Solver::new(T::from_f64(tag[2]));
    let fix = solver.solve::<2>(&observations(CORNERS, ranges), None).unwrap();
    let error = (fix.position.map(T::to_f64) - Vector2::new(tag[0], tag[1])).norm();
    assert!(error < 2e-3, "{error}");

    let space = Trilateration::<T, 5, 3>::new(places(SPATIAL)).unwrap();
    let ranges = SPATIAL.map(|place| distance(place, tag));
    let ours = space.position(&ranges.map(T::from_f64), T::ZERO).unwrap();
    assert_eq!(trilaterate::<T, 3>(&observations(SPATIAL, ranges), T::ZERO), Ok(ours));
    assert!((ours.map(T::to_f64) - Vector3::from(tag)).norm() < 5.0 * tolerance, "{ours:?}");
    let fix = solver.solve::<3>(&observations(SPATIAL, ranges), None).unwrap();
    assert!((fix.position.map(T::to_f64) - Vector3::from(tag)).norm() < 5e-3);
}

#[test]
fn what_does_not_fit_into_fixed_point_is_refused() {
    // Squares of these distances exceed 2048, but half of their differences fits, or not.
    for (side, tag) in [(25.0, [25.0, 50.0]), (20.0, [35.0, 25.0]), (30.0, [15.0, 45.0])] {
        let corners = [[0.0; 3], [side, 0.0, 0.0], [0.0, side, 0.0], [side, side, 0.0]];
        let ranges = corners.map(|place| distance(place, [tag[0], tag[1], 0.0]));
        let prepared = Trilateration::<Q12_20, 4, 2>::new(places(corners)).unwrap();
        for found in [
            trilaterate::<Q12_20, 2>(&observations(corners, ranges), Q12_20::ZERO),
            prepared.position(&ranges.map(Q12_20::from_f64), Q12_20::ZERO),
        ] {
            let error = found.map(|it| (it.map(Q12_20::to_f64) - Vector2::from(tag)).norm());
            assert!(error.is_ok_and(|error| error < 0.01), "{side} m: {error:?}");
        }
        let far = ranges.map(|range| range + if range > 40.0 { 500.0 } else { 0.0 });
        let found = trilaterate::<Q12_20, 2>(&observations(corners, far), Q12_20::ZERO);
        assert_eq!(found, Err(Error::NotFinite), "{side} m");
    }
}

/// The result of a search that is interrupted after every `steps` steps, and the number of interruptions.
fn searched<T: Scalar, const D: usize>(
    solver: &Solver<T>,
    observations: &[Observation<T>],
    steps: usize,
) -> (Result<Fix<T, D>, Error>, usize) {
    let mut search = Search::new(None);
    for calls in 1..500 {
        match search.advance(solver, observations, steps) {
            Ok(None) => {}
            Ok(Some(fix)) => return (Ok(*fix), calls),
            Err(error) => return (Err(error), calls),
        }
    }
    panic!("it does not end");
}

/// Consistent ranges, or ranges of which one is too long by `excess`.
fn check_search<T: Scalar>(tag: [f64; 3], excess: f64) -> Result<(), TestCaseError> {
    let mut ranges = CORNERS.map(|place| distance(place, tag));
    ranges[1] += excess;
    let observations = observations::<T, 4>(CORNERS, ranges);
    let huber = Some(Huber { long: T::HALF, short: T::from_f64(2.5) });
    let solver = Solver { huber, ..Solver::new(T::from_f64(tag[2])) };
    let (at_once, calls) = searched::<T, 2>(&solver, &observations, usize::MAX);
    let (one_by_one, steps) = searched::<T, 2>(&solver, &observations, 1);
    prop_assert_eq!(at_once, one_by_one);
    prop_assert_eq!(calls, 1);
    prop_assert!(steps <= if excess == 0.0 { 8 } else { 150 }, "{} steps", steps);
    if excess == 0.0 {
        let exact = solver.solve::<2>(&observations, None).unwrap();
        let apart = (one_by_one.unwrap().position - exact.position).map(T::to_f64).norm();
        prop_assert!(apart < 0.02, "{} m", apart);
    }
    Ok(())
}

proptest! {
    #[test]
    fn a_search_that_is_interrupted_ends_where_the_solver_does(
        x in 0.5..4.3f64, y in 0.5..5.9f64, excess in prop_oneof![Just(0.0), 0.5..5.0f64]
    ) {
        check_search::<f64>([x, y, 1.0], excess)?;
        check_search::<f32>([x, y, 1.0], excess)?;
        check_search::<Q12_20>([x, y, 1.0], excess)?;
    }

    #[test]
    fn exact_ranges_give_the_exact_place(x in 0.2..4.6f64, y in 0.2..6.2f64, z in 0.0..1.5f64) {
        check_exact::<f64>([x, y, z], 1e-9);
        check_exact::<f32>([x, y, z], 3e-5);
        check_exact::<Q12_20>([x, y, z], 3e-4);
    }

    #[test]
    fn whatever_is_measured_the_answer_is_a_number_or_an_error(
        ranges in proptest::array::uniform4(prop_oneof![
            -200.0..1000.0f64, Just(f64::NAN), Just(f64::INFINITY), Just(0.0), Just(-1e30),
        ])
    ) {
        fn check<T: Scalar>(ranges: [f64; 4]) -> Result<(), TestCaseError> {
            let observations = observations::<T, 4>(CORNERS, ranges);
            let huber = Huber { long: T::HALF, short: T::TWO };
            let solver = Solver {
                common_bias: Some(T::HALF),
                huber: Some(huber),
                ..Solver::new(T::ONE)
            };
            if let Ok(fix) = solver.solve::<2>(&observations, None) {
                prop_assert!(fix.position.iter().all(|x| x.is_finite()));
            }
            if let Ok(position) = trilaterate::<T, 2>(&observations, T::ONE) {
                prop_assert!(position.iter().all(|x| x.is_finite()));
            }
            let plane = Trilateration::<T, 4, 2>::new(places(CORNERS)).unwrap();
            if let Ok(position) = plane.position(&ranges.map(T::from_f64), T::ONE) {
                prop_assert!(position.iter().all(|x| x.is_finite()));
            }
            Ok(())
        }
        check::<f64>(ranges)?;
        check::<f32>(ranges)?;
        check::<Q12_20>(ranges)?;
    }
}

#[test]
fn the_covariance_is_that_of_the_errors() {
    let tag = [1.5, 2.0, 1.0];
    let truth = CORNERS.map(|place| distance(place, tag));
    let mut squares = nalgebra::Matrix2::<f64>::zeros();
    let (mut count, mut covariance) = (0.0, nalgebra::Matrix2::zeros());
    for pattern in 0..16_u32 {
        // ±σ on every link: the exact second moments of the errors, to first order.
        let ranges =
            core::array::from_fn(|i| truth[i] + if pattern >> i & 1 == 0 { 0.1 } else { -0.1 });
        let fix =
            Solver::new(1.0).solve::<2>(&observations::<f64, 4>(CORNERS, ranges), None).unwrap();
        let error = fix.position - Vector2::new(tag[0], tag[1]);
        squares += error * error.transpose();
        count += 1.0;
        covariance += fix.covariance;
    }
    assert!((squares / count - covariance / count).abs().max() < 5e-4);
}

#[test]
fn a_common_bias_is_found_where_there_are_ranges_enough() {
    let tag = [1.0, 2.0, 1.0];
    let ranges = CORNERS.map(|place| distance(place, tag) + 0.25);
    let solver = Solver { common_bias: Some(0.3), ..Solver::new(1.0_f32) };
    let fix = solver.solve::<2>(&observations(CORNERS, ranges), None).unwrap();
    assert!((fix.common_bias - 0.25).abs() < 0.05, "{fix:?}");
    assert!((fix.position - Vector2::new(1.0, 2.0)).norm() < 0.02);
    let three = solver.solve::<2>(&observations(CORNERS, ranges)[..3], None).unwrap();
    assert_eq!(three.common_bias, 0.0);
}

#[test]
fn a_wall_tells_a_place_from_its_mirror_image() {
    // Three nearly collinear anchors along a wall.
    let wall = [[0.0, 0.0, 2.0], [2.0, 0.05, 2.0], [4.0, 0.0, 2.0]];
    let ranges = wall.map(|place| distance(place, [1.0, 3.0, 1.0]));
    let free = Solver::new(1.0_f32);
    assert!(free.solve::<2>(&observations(wall, ranges), None).unwrap().ambiguous);
    for (y0, y1, y) in [(0.0, 5.0, 3.0), (-5.0, 0.0, -3.0)] {
        let solver = Solver { room: Some(Room::plane(0.0, y0, 4.0, y1)), ..free };
        let fix = solver.solve::<2>(&observations(wall, ranges), None).unwrap();
        assert!((fix.position.y - y).abs() < 0.3, "{fix:?}");
    }
}

#[test]
fn both_sides_of_a_line_of_anchors_are_looked_at() {
    let line = [0.0, 2.0, 4.0, 6.0, 8.0].map(|x| [x, 0.0, 1.0]);
    let ranges = line.map(|place| distance(place, [3.0, 2.0, 1.0]));
    let solver = Solver::new(1.0_f32);
    assert!(solver.solve::<2>(&observations(line, ranges), None).unwrap().ambiguous);
    for side in [1.5, -1.5] {
        let start = Some(Vector2::new(3.5, side));
        let fix = solver.solve(&observations(line, ranges), start).unwrap();
        assert!(fix.ambiguous && fix.position.y * side > 0.0, "{fix:?}");
    }
    // One anchor out of the line tells its sides apart.
    let mut bent = line;
    bent[2][1] = 1.0;
    let ranges = bent.map(|place| distance(place, [3.0, 2.0, 1.0]));
    let start = Some(Vector2::new(3.5, -1.5));
    let fix = solver.solve(&observations(bent, ranges), start).unwrap();
    assert!(!fix.ambiguous && (fix.position.y - 2.0).abs() < 0.1, "{fix:?}");
}

#[test]
fn one_wall_in_the_way_is_outvoted() {
    let at = [[0.0, 0.0, 1.0], [8.0, 0.0, 1.0], [8.0, 8.0, 1.0], [0.0, 8.0, 1.0], [4.0, 9.0, 1.0]];
    let tag = [3.0, 5.0, 1.0];
    let mut ranges = at.map(|place| distance(place, tag));
    ranges[2] += 2.0;
    let plain = Solver::new(1.0_f32);
    let robust = Solver { huber: Some(Huber { long: 0.5, short: 2.5 }), ..plain };
    let error = |solver: Solver<f32>| {
        let fix = solver.solve::<2>(&observations(at, ranges), None).unwrap();
        (fix.position - Vector2::new(3.0, 5.0)).norm()
    };
    assert!(error(plain) > 0.5 && error(robust) < 0.12, "{} {}", error(plain), error(robust));
}

#[test]
fn impossible_questions_have_their_errors() {
    let line = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [2.0, 2.0, 1.0]];
    assert_eq!(Trilateration::<f32, 3, 2>::new(places(line)), Err(Error::DegenerateGeometry));
    assert_eq!(
        Trilateration::<f32, 2, 2>::new(places([line[0], line[1]])),
        Err(Error::TooFewRanges)
    );
    let solver = Solver::new(1.0_f32);
    let few = observations(CORNERS, [3.0; 4]);
    assert_eq!(solver.solve::<2>(&few[..2], None), Err(Error::TooFewRanges));
    let mut bad = few;
    bad[1].variance = 0.0;
    assert_eq!(solver.solve::<2>(&bad, None), Err(Error::NotPositive));
    bad[1].range = f32::NAN;
    assert_eq!(solver.solve::<2>(&bad, None), Err(Error::NotFinite));
    assert_eq!(dilution_of_precision([[1.0_f32, 0.0]]), Err(Error::TooFewRanges));
    let parallel = [[1.0_f32, 0.0], [1.0, 0.0], [-1.0, 0.0]];
    assert_eq!(dilution_of_precision(parallel), Err(Error::DegenerateGeometry));
    let around = [[1.0_f32, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    assert!((dilution_of_precision(around).unwrap() - 1.0).abs() < 1e-6);
    // Ranges with a quarter of the weight have twice the error; ranges without weight have no effect if the others
    // suffice.
    let weighted = |weights: [f32; 4]| weighted_dilution(around.into_iter().zip(weights));
    assert!((weighted([0.25; 4]).unwrap() - 2.0).abs() < 1e-6);
    assert!((weighted([1.0, 1.0, 0.0, 0.0]).unwrap() - 2.0_f32.sqrt()).abs() < 1e-6);
    assert_eq!(weighted([1.0, 0.0, 1.0, 0.0]), Err(Error::DegenerateGeometry));
}

#[test]
fn what_all_ranges_have_in_common_pulls_a_position_that_anchors_are_not_around() {
    let error = |directions: [[f64; 2]; 3], weights: [f64; 3], errors: [f64; 3]| {
        position_error((0..3).map(|index| (directions[index], weights[index], errors[index])))
    };
    let half = 0.75_f64.sqrt();
    let around = [[1.0, 0.0], [-0.5, half], [-0.5, -half]];
    let ahead = [[1.0, 0.0], [0.5, half], [0.5, -half]];
    let is = |found: Result<[f64; 2], Error>, expected: [f64; 2]| {
        let found = found.expect("three directions");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    };
    is(error(around, [1.0; 3], [0.3; 3]), [0.0; 2]);
    is(error(ahead, [2.0; 3], [0.3; 3]), [0.4, 0.0]);
    // Two ranges, and a third without weight: the position fits both.
    is(error(around, [0.0, 1.0, 1.0], [9.0, 0.3, 0.3]), [-0.6, 0.0]);
    assert_eq!(error([[1.0, 0.0]; 3], [1.0; 3], [0.3; 3]), Err(Error::DegenerateGeometry));
    assert_eq!(position_error([([1.0, 0.0], 1.0, 0.3)]), Err(Error::TooFewRanges));
}

#[test]
fn a_range_and_its_derivatives() {
    let anchor = Vector3::new(1.0, 2.0, 3.0);
    let plane = expected_range(&Vector2::new(4.0, 6.0), 3.0, &anchor);
    assert_eq!(plane.distance, 5.0_f64);
    assert!((plane.direction[0] - 0.6).abs() < 1e-15 && (plane.direction[1] - 0.8).abs() < 1e-15);
    let slant = expected_range(&Vector2::new(1.0, 2.0), 1.0, &anchor);
    assert_eq!((slant.distance, slant.direction), (2.0, [0.0, 0.0]));
    let space = expected_range(&Vector3::new(1.0, 2.0, 5.0), f64::NAN, &anchor);
    assert_eq!((space.distance, space.direction), (2.0, [0.0, 0.0, 1.0]));
    let here = expected_range(&anchor.map(|x| x as f32), 0.0, &anchor.map(|x| x as f32));
    assert_eq!((here.distance, here.direction), (0.0, [0.0; 3]));
}
