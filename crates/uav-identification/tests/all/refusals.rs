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
