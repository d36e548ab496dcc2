//! Tests with streams of both formats that hold the ephemerides of the sample navigation file.

#[cfg(feature = "rtcm")]
mod rtcm;
#[cfg(feature = "rtcm")]
mod ssr;
#[cfg(feature = "ubx")]
mod ubx;

use crate::error::Error;
use crate::samples::{navigation_3, text};
use crate::{Biases, Ephemeris, Kind, Message, Navigation, Observations, Received};

/// A stream of each format.
pub(crate) fn streams() -> Vec<Vec<u8>> {
    let told = broadcast().expect("the sample");
    vec![
        #[cfg(feature = "rtcm")]
        [rtcm::ephemerides(&told), rtcm::observed(345_600_000, 7)].concat(),
        #[cfg(feature = "ubx")]
        [
            ubx::observed(345_600.0, 1_000),
            ubx::subframes(&told[0].1),
            ubx::words(&told[1].1).concat(),
        ]
        .concat(),
    ]
}

/// The two ephemerides of the sample.
fn broadcast() -> Result<[(u8, Ephemeris); 2], Error> {
    let navigation = Navigation::parse(&[text(navigation_3())])?;
    let of = |number, message| (number, navigation.satellite(number, message)[0]);
    Ok([of(1, Message::Lnav), of(101, Message::Fnav)])
}

#[test]
fn a_stream_that_is_read_once_has_what_each_of_two_readings_finds() -> Result<(), Error> {
    for stream in streams() {
        let stream = text(stream);
        let received = Received::parse(&stream, &Biases::default())?;
        assert_eq!(received.observations, Observations::parse(&stream)?);
        assert!(!received.navigation.is_empty());
        assert_eq!(received.navigation, Navigation::parse(&[stream])?);
    }
    let complaint = Received::parse(&text(navigation_3()), &Biases::default()).expect_err("a file");
    assert!(complaint.to_string().contains("expected the stream of a receiver"), "{complaint}");
    Ok(())
}

/// Asserts that two ephemerides are the same to the digits that a file has.
fn are_alike(found: &Ephemeris, told: &Ephemeris) {
    let numbers = |it: &Ephemeris| {
        let pairs = [it.latitude_terms, it.radius_terms, it.inclination_terms, it.group_delays];
        let elements = [
            it.root_of_axis,
            it.eccentricity,
            it.mean_anomaly,
            it.mean_motion_correction,
            it.perigee,
            it.node,
            it.node_rate,
            it.inclination,
            it.inclination_rate,
        ];
        [&it.clock[..], pairs.as_flattened(), &elements].concat()
    };
    for (found, told) in numbers(found).into_iter().zip(numbers(told)) {
        assert!((found - told).abs() <= 1e-11 * told.abs(), "{found} {told}");
    }
    assert_eq!((found.message, found.issue), (told.message, told.issue));
    assert_eq!((found.time, found.clock_time), (told.time, told.clock_time));
    assert_eq!((found.accuracy, found.is_healthy), (told.accuracy, told.is_healthy));
}
