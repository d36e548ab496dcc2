use kestirim_uav_identification::{Airplane, Error, Flight, identify};

use crate::simulated::{CALM, Plan, fly};

fn refused(change: impl FnOnce(&mut Flight)) -> Error {
    let mut flight = fly(&Plan { seconds: 10.0, ..CALM });
    change(&mut flight);
    identify(&[flight], None).unwrap_err()
}

#[test]
fn what_is_no_flight_is_refused_with_the_reason() {
    assert_eq!(identify(&[], None).unwrap_err(), Error::Missing("q"));
    assert_eq!(refused(|it| it.times.truncate(99)), Error::Lengths);
    assert_eq!(refused(|it| it.times[3] = f64::NAN), Error::NotFinite);
    assert_eq!(refused(|it| it.times[3] = it.times[2]), Error::NotLater);
    assert_eq!(refused(|it| it.columns.retain(|(name, _)| name != "V")), Error::Missing("V"));
    let blind =
        |it: &mut Flight| it.columns.retain(|(name, _)| !["alpha", "az"].contains(&&**name));
    assert_eq!(refused(blind), Error::NoLift);
    let short = refused(|it| *it = fly(&Plan { seconds: 3.0, ..CALM }));
    assert!(matches!(short, Error::TooShort { .. }), "{short}");
    let still = |it: &mut Flight| it.inputs.iter_mut().for_each(|input| input[0] = 0.1);
    assert!(matches!(refused(still), Error::NotExcited(_)));
    let standing = |it: &mut Flight| it.columns[2].1.iter_mut().for_each(|v| *v = Some(0.1));
    assert!(matches!(refused(standing), Error::NotFlying(_)));
}

/// Applies a change to a column.
fn change(flight: &mut Flight, name: &str, change: impl Fn(f64) -> f64) {
    let (_, values) = flight.columns.iter_mut().find(|(column, _)| column == name).unwrap();
    values.iter_mut().flatten().for_each(|value| *value = change(*value));
}

#[test]
fn a_sensor_that_stands_still_is_refused() {
    for name in ["alpha", "q", "V", "theta", "az", "ax"] {
        assert_eq!(refused(|it| change(it, name, |_| 15.0)), Error::Stuck(name));
    }
}

#[test]
fn other_units_and_signs_are_refused() {
    assert!(matches!(refused(|it| change(it, "az", |az| az / 9.8)), Error::Force(_)));
    assert!(matches!(refused(|it| change(it, "az", |az| -az)), Error::Force(_)));
    assert!(matches!(refused(|it| change(it, "az", |az| az + 9.8)), Error::Force(_)));
    let contradicts = |name: &'static str, factor: f64| {
        let error = refused(|it| change(it, name, |value| factor * value));
        let Error::Contradiction { of, scale, .. } = error else { panic!("{name}: {error}") };
        (of, scale)
    };
    let (of, scale) = contradicts("q", 57.3);
    assert_eq!(of, "theta");
    assert!((scale * 57.3 - 1.0).abs() < 0.05, "{scale}");
    assert_eq!(contradicts("q", -1.0).0, "theta");
    assert!(matches!(refused(|it| change(it, "theta", |at| 57.3 * at)), Error::Angle("theta", _)));
    assert!(matches!(refused(|it| change(it, "alpha", |at| 57.3 * at)), Error::Angle("alpha", _)));
    assert_eq!(contradicts("V", 3.6).0, "V");
    let degrees = |it: &mut Flight| it.inputs.iter_mut().for_each(|input| input[0] *= 57.3);
    assert!(matches!(refused(degrees), Error::Angle("delta_e", _)));
    let hectopascal = |it: &mut Flight| {
        let rising = (0..it.times.len()).map(|at| Some(2.4 + 1e-4 * at as f64)).collect();
        it.columns.push(("qbar".to_owned(), rising));
    };
    assert!(matches!(refused(hectopascal), Error::Density(_)));
}

#[test]
fn an_elevator_of_another_flight_is_refused() {
    let other = |it: &mut Flight| {
        let inputs = it.inputs.clone();
        let count = inputs.len();
        for (at, input) in it.inputs.iter_mut().enumerate() {
            *input = inputs[(37 * at) % count];
        }
    };
    assert!(matches!(refused(other), Error::NoEffect { .. }));
}

#[test]
fn a_flight_that_is_there_twice_is_refused() {
    let flight = fly(&Plan { seconds: 10.0, ..CALM });
    assert_eq!(identify(&[flight.clone(), flight], None).unwrap_err(), Error::Twice);
}

#[test]
fn an_airplane_without_mass_is_refused() {
    let airplane = Airplane { mass: 0.0, inertia: 1.0, area: 1.0, chord: 1.0, density: 1.0 };
    assert_eq!(identify(&[fly(&CALM)], Some(&airplane)), Err(Error::NotPositive));
}

#[test]
fn nothing_panics_on_noise_alone() {
    let mut flight = fly(&Plan { seconds: 20.0, ..CALM });
    for (place, (_, values)) in flight.columns.iter_mut().enumerate() {
        let mean = if place == 2 { 20.0 } else { 0.0 };
        for (at, value) in values.iter_mut().enumerate() {
            *value = Some(mean + 0.1 * ((at * at * (place + 3)) as f64).sin());
        }
    }
    let _ = identify(&[flight], None);
}
