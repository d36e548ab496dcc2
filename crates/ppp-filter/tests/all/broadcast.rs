//! Ephemerides collected on a board: which of them serve, and from when to when.

use kestirim_gnss_message::{beidou, gps};
use kestirim_gnss_ppp::{Carriers, GpsTime};
use kestirim_ppp_filter::{Broadcast, MessagePart, NoEphemeris};

/// A Sunday, on which a week of GPS began.
pub(super) const SUNDAY: i32 = 59_021;
pub(super) const CODE: f64 = 22e6;

/// The issue of an ephemeris for a second of the week.
pub(super) const fn issue(second: u32) -> u64 {
    ((second / 16) & 0xff) as u64
}

/// A subframe of LNAV, of a circular orbit of GPS at a second of the week (a multiple of 16), with a health.
fn subframe(number: u32, second: u32, health: u32) -> MessagePart {
    let mut words = [0; 10];
    words[0] = 0x8b << 22;
    words[1] = number << 8;
    let (time, root) = (second / 16, 5_153 << 19);
    let issue = (issue(second) as u32) << 22;
    match number {
        1 => {
            words[2] = health << 8;
            words[7] = issue | time << 6;
        }
        2 => {
            words[2] = issue;
            words[7] = (root >> 24) << 6;
            words[8] = (root & 0xff_ffff) << 6;
            words[9] = time << 14;
        }
        _ => words[9] = issue,
    }
    MessagePart::Gps(gps::Subframe::from_words(&words).expect("LNAV"))
}

pub(super) fn hear<const N: usize>(
    broadcast: &mut Broadcast<N>,
    satellite: u8,
    second: u32,
    health: u32,
    received: GpsTime,
) {
    let complete = [1, 2, 3]
        .map(|number| broadcast.take(satellite, subframe(number, second, health), received));
    assert_eq!(complete, [false, false, true]);
}

fn state<const N: usize>(
    broadcast: &Broadcast<N>,
    satellite: u8,
    at: GpsTime,
) -> Result<f64, NoEphemeris> {
    let state = broadcast.state(satellite, Carriers::L1L2, at, CODE)?;
    assert!((state.position.norm() - 5_153.0 * 5_153.0).abs() < 1e-3);
    Ok(state.accuracy)
}

#[test]
fn an_ephemeris_serves_for_two_hours_across_the_end_of_the_week() {
    // For the first hour of the next week, heard in the last one of this.
    let heard = GpsTime::new(SUNDAY + 6, 86_000.0);
    let mut broadcast = Broadcast::<4>::new();
    assert_eq!(state(&broadcast, 5, heard), Err(NoEphemeris::Missing));
    hear(&mut broadcast, 5, 3_600, 0, heard);
    let next = |second| GpsTime::new(SUNDAY + 7, second);
    for at in [heard, next(0.0), next(10_700.0)] {
        assert_eq!(state(&broadcast, 5, at), Ok(2.0), "{at:?}");
    }
    for at in [heard.plus(-3_300.0), next(10_900.0), next(608_400.0)] {
        assert_eq!(state(&broadcast, 5, at), Err(NoEphemeris::Missing), "{at:?}");
    }
    let other = broadcast.state(5, Carriers::E1E5a, heard, CODE);
    assert_eq!(other, Err(NoEphemeris::Carriers));
}

#[test]
fn a_newer_ephemeris_replaces_the_older_and_an_unhealthy_one_does_not_serve() {
    let heard = GpsTime::new(SUNDAY, 7_000.0);
    let mut broadcast = Broadcast::<4>::new();
    hear(&mut broadcast, 5, 7_200, 0, heard);
    hear(&mut broadcast, 5, 14_400, 0, heard.plus(200.0));
    assert_eq!(state(&broadcast, 5, heard), Err(NoEphemeris::Missing), "the older one is gone");
    assert_eq!(state(&broadcast, 5, heard.plus(400.0)), Ok(2.0));
    hear(&mut broadcast, 5, 14_400, 1, heard.plus(400.0));
    assert_eq!(state(&broadcast, 5, heard.plus(400.0)), Err(NoEphemeris::Unhealthy));
}

#[test]
fn satellites_that_are_heard_keep_their_places() {
    let heard = GpsTime::new(SUNDAY, 7_200.0);
    let mut broadcast = Broadcast::<2>::new();
    // The parts of three satellites come in turn.
    for number in [1, 2, 3] {
        let complete = [1, 2, 3].map(|satellite| {
            broadcast.take(
                satellite,
                subframe(number, 7_200, 0),
                heard.plus(6.0 * f64::from(number)),
            )
        });
        assert_eq!(complete, [number == 3, number == 3, false]);
    }
    // One of them sets.
    for minute in 1..=6 {
        broadcast.take(2, subframe(1, 7_200, 0), heard.plus(60.0 * f64::from(minute)));
    }
    hear(&mut broadcast, 3, 7_200, 0, heard.plus(360.0));
    let known = [1, 2, 3].map(|satellite| state(&broadcast, satellite, heard).is_ok());
    assert_eq!(known, [false, true, true]);
}

#[test]
fn what_is_no_orbit_or_of_another_system_does_not_serve() {
    let heard = GpsTime::new(SUNDAY, 0.0);
    let mut broadcast = Broadcast::<4>::new();
    let nothing = |number: u32| {
        let mut words = [0; 10];
        words[0] = 0x8b << 22;
        words[1] = number << 8;
        MessagePart::Gps(gps::Subframe::from_words(&words).expect("LNAV"))
    };
    let complete = [1, 2, 3].map(|number| broadcast.take(5, nothing(number), heard));
    assert_eq!(complete, [false, false, true]);
    assert_eq!(broadcast.state(5, Carriers::L1L2, heard, CODE), Err(NoEphemeris::Missing));
    // A part of another system begins anew, and takes the ephemeris away.
    hear(&mut broadcast, 5, 0, 0, heard);
    let mut words = [0; 10];
    words[0] = 0b111_0001_0010 << 19;
    let beidou = beidou::Subframe::from_words(&words).expect("D1");
    assert!(!broadcast.take(5, MessagePart::BeiDou(beidou), heard));
    assert_eq!(state(&broadcast, 5, heard), Err(NoEphemeris::Missing));
    hear(&mut broadcast, 5, 0, 0, heard);
    assert!(broadcast.ionosphere().is_none());
    // Neither does a part whose time of reception is not a number.
    for number in [1, 2, 3] {
        assert!(!broadcast.take(6, subframe(number, 0, 0), GpsTime::new(SUNDAY, f64::NAN)));
    }
    assert_eq!(state(&broadcast, 6, heard), Err(NoEphemeris::Missing));
}

#[test]
fn parts_of_another_pass_are_not_joined() {
    let heard = GpsTime::new(SUNDAY, 7_200.0);
    let mut broadcast = Broadcast::<4>::new();
    assert!(!broadcast.take(5, subframe(1, 7_200, 1), heard));
    let later = heard.plus(400.0);
    assert!(!broadcast.take(5, subframe(2, 7_200, 0), later));
    assert!(!broadcast.take(5, subframe(3, 7_200, 0), later));
    assert!(broadcast.take(5, subframe(1, 7_200, 0), later));
}
