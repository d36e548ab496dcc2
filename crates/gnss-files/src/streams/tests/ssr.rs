//! Corrections of ephemerides, as produced by the encoder of another library.

use rtcm_rs::msg::{Msg1060Sat, Msg1060T, message};
use rtcm_rs::prelude::MessageBuilder;

use super::broadcast;
use super::rtcm::ephemerides;
use crate::error::Error;
use crate::samples::text;
use crate::{Kind, Navigation, SsrValues};

/// A message with the orbit and clock of a satellite, whose radial correction is `radial` m.
fn corrections(satellite: u8, radial: f64) -> Vec<u8> {
    let mut message = Msg1060T {
        gps_epoch_time_s: 345_590,
        ssr_update_interval_index: 3,
        ssr_provider_id: 258,
        ssr_solution_id: 1,
        ..Msg1060T::default()
    };
    message.satellites.push(Msg1060Sat {
        gps_satellite_id: satellite,
        iode: 77,
        delta_radial_m: radial,
        delta_along_track_m: -2.4,
        delta_cross_track_m: 0.8,
        dot_delta_radial_m_s: 1e-4,
        dot_delta_along_track_m_s: 4e-4,
        dot_delta_cross_track_m_s: -8e-4,
        delta_clock_c0_m: 3.5,
        delta_clock_c1_m_s: -2e-3,
        delta_clock_c2_m_s2: 0.0,
    });
    MessageBuilder::new()
        .build_message(&message::Message::Msg1060(message))
        .expect("a message")
        .into()
}

#[test]
fn orbits_and_clocks_come_with_the_ephemerides() -> Result<(), Error> {
    let told = broadcast()?;
    let stream = [corrections(32, 1.5), ephemerides(&told), corrections(1, -0.1)].concat();
    let navigation = Navigation::parse(&[text(stream)])?;
    let found: Vec<_> = navigation.corrections.iter().map(|it| it.satellite).collect();
    assert_eq!(found, [32, 32, 1, 1]);
    assert_eq!(navigation.skipped, 0);

    let [orbit, clock, ..] = &navigation.corrections[..] else { panic!("four corrections") };
    let header = orbit.header;
    assert_eq!((header.second, header.reference), (345_590.0, 345_595.0));
    assert_eq!((header.provider, header.interval), ((258, 1), 10.0));
    let SsrValues::Orbit(values) = orbit.values else { panic!("{orbit:?}") };
    assert!(values.is_of(77) && !values.is_of(78));
    for (found, sent) in values.at(10.0).into_iter().zip([1.501, -2.396, 0.792]) {
        assert!((found - sent).abs() < 1e-9, "{found} {sent}");
    }
    let SsrValues::Clock(values) = clock.values else { panic!("{clock:?}") };
    assert!((values.at(10.0) - 3.48).abs() < 1e-9);
    Ok(())
}

#[test]
fn corrections_may_come_in_a_file_of_their_own() -> Result<(), Error> {
    let told = broadcast()?;
    let (alone, stream) = (text(corrections(1, 1.5)), text(ephemerides(&told)));
    let complaint = Navigation::parse(std::slice::from_ref(&alone)).expect_err("no ephemerides");
    assert!(complaint.to_string().ends_with("refer to, found none"), "{complaint}");
    assert_eq!(Kind::of(alone.bytes()), Some(Kind::Corrections));
    assert_eq!(Kind::of(stream.bytes()), Some(Kind::Rtcm));
    let navigation = Navigation::parse(&[alone, stream])?;
    assert_eq!(navigation.corrections.len(), 2);
    assert_eq!(navigation.satellites().collect::<Vec<_>>(), [1, 101]);
    Ok(())
}
