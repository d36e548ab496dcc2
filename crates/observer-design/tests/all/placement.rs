//! Placed poles are the wanted ones.

use kestirim_observer_design::{
    Complex, Error, Placement, eigenvalues, hidden_modes, observability, place,
};
use nalgebra::{Matrix4, RowVector4, SMatrix, Vector2, matrix};
use proptest::prelude::*;

fn real<const N: usize>(poles: [f64; N]) -> [Complex<f64>; N] {
    poles.map(Complex::from)
}

/// An aircraft like that of the thesis, in continuous time; x = [α, q, V, θ].
fn aircraft() -> Matrix4<f64> {
    matrix![
        -1.79, 1.0, -0.0076, -0.0171;
        -25.0, -20.0, -0.02, 0.0;
        2.0, 0.0, -0.0267, -9.7861;
        0.0, 1.0, 0.0, 0.0
    ]
}

#[test]
fn a_double_integrator_has_the_gain_of_the_textbook() {
    let placed =
        place(&matrix![1.0, 0.5; 0.0, 1.0], &matrix![1.0, 0.0], &real([0.5, 0.25])).unwrap();
    assert_eq!(placed.gain, Vector2::new(1.25, 0.75));
    assert_eq!(placed.digits_lost(), 0.0);
}

#[test]
fn one_output_places_real_complex_and_repeated_poles() {
    let theta = RowVector4::new(0.0, 0.0, 0.0, 1.0);
    let pair = [Complex::new(-2.0, 3.0), Complex::new(-2.0, -3.0)];
    let placed =
        place(&aircraft(), &theta, &[pair[1], Complex::from(-4.0), pair[0], Complex::from(-5.0)])
            .unwrap();
    assert!(placed.error < 1e-13, "{placed:?}");
    // The poles are in the order in which they were wanted.
    assert!((placed.poles[0].im + 3.0).abs() < 1e-10 && (placed.poles[2].im - 3.0).abs() < 1e-10);

    let placed = place(&aircraft(), &theta, &real([-4.0; 4])).unwrap();
    assert!(placed.error < 1e-3, "a fourfold pole keeps a quarter of the digits: {}", placed.error);
    let mut sum = Complex::from(0.0);
    for pole in eigenvalues(&(aircraft() - placed.gain * theta)).unwrap() {
        sum += pole;
    }
    assert!((sum.re + 16.0).abs() < 1e-11, "but their sum is right: {sum}");
}

#[test]
fn the_whole_state_can_be_given_any_dynamics() {
    let placed = place(&aircraft(), &Matrix4::identity(), &real([-1.0, -2.0, -3.0, -3.0])).unwrap();
    assert!(placed.error < 1e-14);
    let largest = placed.gain.iter().fold(0.0, |largest: f64, gain| largest.max(gain.abs()));
    assert!(largest < 30.0, "no gain is larger than what it cancels: {largest}");
}

#[test]
fn a_pole_may_stay_where_it_was() {
    let outputs = matrix![0.0, 0.0, 1.0, 0.0; 0.0, 0.0, 0.0, 1.0];
    let open = eigenvalues(&aircraft()).unwrap();
    let placed = place(&aircraft(), &outputs, &open).unwrap();
    assert!(placed.error < 1e-12, "{}", placed.error);
}

#[test]
fn outputs_that_say_the_same_share_the_work() {
    let a = matrix![1.0, 0.1; 0.0, 1.0];
    let thrice: SMatrix<f64, 3, 2> = matrix![1.0, 0.0; 1.0, 0.0; 0.0, 0.0];
    let placed = place(&a, &thrice, &real([0.5, 0.6])).unwrap();
    let single = place(&a, &matrix![1.0, 0.0], &real([0.5, 0.6])).unwrap();
    for row in 0..2 {
        assert!((placed.gain[(row, 0)] - single.gain[row] / 2.0).abs() < 1e-14);
        assert!((placed.gain[(row, 1)] - single.gain[row] / 2.0).abs() < 1e-14);
        assert_eq!(placed.gain[(row, 2)], 0.0);
    }
}

#[test]
fn more_poles_in_one_place_than_outputs() {
    let outputs = matrix![0.0, 0.0, 1.0, 0.0; 0.0, 0.0, 0.0, 1.0];
    let placed = place(&aircraft(), &outputs, &real([-4.0; 4])).unwrap();
    assert!(placed.error < 1e-2 && placed.digits_lost() > 3.0, "{}", placed.error);
}

#[test]
fn a_thousandth_of_a_second_loses_nothing() {
    let step =
        kestirim_observer_design::zero_order_hold(&aircraft(), &Vector4::zeros(), 1e-3).unwrap();
    let theta = RowVector4::new(0.0, 0.0, 0.0, 1.0);
    let poles = real([-3.0, -3.5, -4.0, -4.5].map(|pole: f64| (1e-3 * pole).exp()));
    let placed = place(&step.a, &theta, &poles).unwrap();
    assert!(placed.error < 1e-11, "{}", placed.error);
    assert!(observability(&step.a, &theta).unwrap() > 1e-7);
}

type Vector4 = nalgebra::Vector4<f64>;

fn hidden<const N: usize, const P: usize>(
    result: Result<Placement<N, P>, Error>,
) -> (f64, f64, usize) {
    match result {
        Err(Error::Unobservable(mode)) => (mode.re, mode.im.abs(), mode.state),
        other => panic!("expected a hidden mode, found {other:?}"),
    }
}

#[test]
fn a_hidden_mode_is_refused_by_name() {
    let diagonal = Matrix4::from_diagonal(&Vector4::new(-1.0, -2.0, -3.0, -4.0));
    let poles = real([-5.0, -6.0, -7.0, -8.0]);
    let (re, im, state) = hidden(place(&diagonal, &RowVector4::new(1.0, 1.0, 0.0, 1.0), &poles));
    assert!((re + 3.0).abs() < 1e-12 && im < 1e-12 && state == 2);
    // The hidden mode is refused even where it is a wanted pole.
    hidden(place(&diagonal, &RowVector4::new(1.0, 1.0, 0.0, 1.0), &real([-5.0, -6.0, -3.0, -8.0])));
    // Two modes with the same eigenvalue cannot be told apart by one output.
    let twins = Matrix4::from_diagonal(&Vector4::new(-1.0, -2.0, -2.0, -4.0));
    let (re, ..) = hidden(place(&twins, &RowVector4::new(1.0, 1.0, 1.0, 1.0), &poles));
    assert!((re + 2.0).abs() < 1e-9);
    // A hidden oscillation.
    let swing = matrix![0.0, 1.0, 0.0; -4.0, 0.0, 0.0; 0.0, 0.0, -1.0];
    let (re, im, _) = hidden(place(&swing, &matrix![0.0, 0.0, 1.0], &real([-5.0, -6.0, -7.0])));
    assert!(re.abs() < 1e-12 && (im - 2.0).abs() < 1e-12);
    let modes = hidden_modes(&swing, &matrix![0.0, 0.0, 1.0]).unwrap();
    assert_eq!(modes.iter().flatten().count(), 1, "a pair is one mode");
}

#[test]
fn the_head_of_a_chain_is_missed_although_its_mode_is_double() {
    // Rotated, so that the entries are rounded and the double mode splits by 1e-8.
    let (cosine, sine) = (0.6, 0.8);
    let turn = matrix![cosine, -sine; sine, cosine];
    let a = turn * matrix![-2.0, 1.0; 0.0, -2.0] * turn.transpose();
    let c = matrix![0.0, 1.0] * turn.transpose();
    let (re, ..) = hidden(place(&a, &c, &real([-5.0, -6.0])));
    assert!((re + 2.0).abs() < 1e-6);
}

#[test]
fn weak_sight_is_sight() {
    for coupling in [1e-3, 1e-8] {
        let a = matrix![-1.0, coupling; 0.0, -2.0];
        let placed = place(&a, &matrix![1.0, 0.0], &real([-5.0, -6.0])).unwrap();
        assert!(placed.error < 1e-12);
    }
}

#[test]
fn what_cannot_be_placed_is_refused() {
    let a = matrix![0.0, 1.0; 0.0, 0.0];
    let c = matrix![1.0, 0.0];
    let alone = [Complex::new(-1.0, 1.0), Complex::from(-2.0)];
    assert_eq!(place(&a, &c, &alone), Err(Error::NotConjugate));
    assert_eq!(place(&a, &c, &real([f64::NAN, -2.0])), Err(Error::NotFinite));
    assert_eq!(place(&a.map(|_| f64::NAN), &c, &real([-1.0, -2.0])), Err(Error::NotFinite));
    assert_eq!(place(&a, &matrix![f64::INFINITY, 0.0], &real([-1.0, -2.0])), Err(Error::NotFinite));
    // A chain from 1 to 1e4 measured at its end: the gain would need 20 digits.
    let chain = SMatrix::<f64, 5, 5>::from_fn(|row, column| match column.wrapping_sub(row) {
        0 => -(10.0_f64.powi(row as i32)),
        1 => 1.0,
        _ => 0.0,
    });
    let last = SMatrix::<f64, 1, 5>::from_fn(|_, column| if column == 0 { 1.0 } else { 0.0 });
    let refused = place(&chain, &last, &real([-1.0, -2.0, -3.0, -4.0, -5.0]));
    assert!(matches!(refused, Err(Error::IllConditioned(error)) if error > 1.0), "{refused:?}");
}

proptest! {
    /// Every observable pair is placed, almost to the last digit.
    #[test]
    fn any_pair_with_two_outputs(
        a in prop::array::uniform16(-2.0_f64..2.0),
        c in prop::array::uniform8(-2.0_f64..2.0),
        re in -3.0_f64..-1.0,
        im in 0.1_f64..2.0,
        others in prop::array::uniform2(-3.0_f64..-1.0),
    ) {
        let a = Matrix4::from_row_slice(&a);
        let c = SMatrix::<f64, 2, 4>::from_row_slice(&c);
        prop_assume!(observability(&a, &c).is_ok_and(|sight| sight > 1e-2));
        let poles = [Complex::new(re, im), Complex::from(others[0]), Complex::new(re, -im), Complex::from(others[1])];
        let placed = place(&a, &c, &poles).unwrap();
        prop_assert!(placed.error < 1e-12, "{}", placed.error);
    }

    /// No pair, however odd, makes placement panic.
    #[test]
    fn anything_is_answered(
        a in prop::array::uniform9(prop::num::f64::ANY),
        c in prop::array::uniform6(prop::num::f64::ANY),
        poles in prop::array::uniform6(prop::num::f64::ANY),
    ) {
        let a = SMatrix::<f64, 3, 3>::from_row_slice(&a);
        let c = SMatrix::<f64, 2, 3>::from_row_slice(&c);
        let poles = [0, 2, 4].map(|index| Complex::new(poles[index], poles[index + 1]));
        if let Ok(placed) = place(&a, &c, &poles) {
            prop_assert!(placed.gain.iter().all(|gain| gain.is_finite()));
        }
    }
}

#[test]
fn a_pole_near_zero_is_told_by_its_own_size() {
    let a = matrix![-1000.0, 1.0, 3.0; 300.0, -2000.0, 7.0; 0.1, 0.2, -3000.0];
    let placed = place(&a, &matrix![1.0, 0.0, 0.0], &real([-1e-7, -1500.0, -2500.0])).unwrap();
    let own = (placed.poles[0].re + 1e-7).abs() / 1e-7;
    assert!(placed.error >= 0.99 * own, "{} beside {own}", placed.error);
}

#[test]
fn the_size_of_a_system_does_not_matter() {
    let cycle = matrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 1.0, 0.0, 0.0];
    for size in [1e-165, 1e-150, 1.0, 1e150] {
        for pole in eigenvalues(&(cycle * size)).unwrap() {
            assert!((pole.re.hypot(pole.im) / size - 1.0).abs() < 1e-15, "{pole} at {size}");
        }
    }
    let whole = place(&nalgebra::Matrix1::new(1e16), &nalgebra::Matrix1::new(1.0), &real([1e15]));
    assert_eq!(whole.unwrap().error, 0.0);
}
