//! Corrections of ephemerides on a board: which of them serve, and from when to when.

use kestirim_gnss_message::ssr::Message;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Carriers, GpsTime};
use kestirim_ppp_filter::{Broadcast, Corrected, NoEphemeris};

use super::broadcast::{CODE, SUNDAY, hear, issue};

/// The time between two messages, s, and its index.
const INTERVAL: f64 = 10.0;
const INDEX: u64 = 3;

/// The data of a message for satellites and issues: orbits a metre too high (1057), clocks 2 m too late, with a rate of 1 cm/s (1058),
/// or both (1060).
fn data(kind: u64, second: u32, provider: u64, satellites: &[(u64, u64)]) -> Vec<u8> {
    let mut bits: Vec<bool> = Vec::new();
    let mut push = |value: u64, width: u32| {
        bits.extend((0..width).rev().map(|bit| value >> bit & 1 == 1));
    };
    let unused = if kind == 1_058 { 5 } else { 6 };
    for (value, width) in [(kind, 12), (u64::from(second), 20), (INDEX, 4), (0, unused)] {
        push(value, width);
    }
    for (value, width) in [(provider, 16), (0, 4), (satellites.len() as u64, 6)] {
        push(value, width);
    }
    for (satellite, issue) in satellites {
        push(*satellite, 6);
        let orbit = [(*issue, 8), (10_000, 22), (0, 20), (0, 20), (0, 21), (0, 19), (0, 19)];
        let clock = [(20_000, 22), (10_000, 21), (0, 27)];
        let orbit = orbit.into_iter().filter(|_| kind != 1_058);
        for (value, width) in orbit.chain(clock.into_iter().filter(|_| kind != 1_057)) {
            push(value, width);
        }
    }
    let byte = |bits: &[bool]| {
        let of = |(place, bit): (usize, &bool)| u8::from(*bit) << (7 - place);
        bits.iter().enumerate().map(of).sum()
    };
    bits.chunks(8).map(byte).collect()
}

fn message(second: u32, provider: u64, satellites: &[(u64, u64)]) -> Vec<u8> {
    data(1_060, second, provider, satellites)
}

fn take<const N: usize>(
    corrected: &mut Corrected<N>,
    broadcast: &Broadcast<4>,
    data: &[u8],
    received: GpsTime,
) {
    let message = Message::from_data(data).expect("corrections");
    corrected.take(&message, |it| (it != 9).then_some(it), broadcast, received);
}

#[test]
fn corrections_move_the_satellite_and_its_clock() {
    let now = GpsTime::new(SUNDAY, 7_000.0);
    let mut broadcast = Broadcast::<4>::new();
    hear(&mut broadcast, 5, 7_200, 0, now);
    let mut corrected = Corrected::<4>::new();
    assert_eq!(corrected.state(5, &broadcast, now, CODE), Err(NoEphemeris::Missing));
    take(&mut corrected, &broadcast, &message(7_000, 1, &[(5, issue(7_200))]), now);

    let received = now.plus(15.0);
    let found = corrected.state(5, &broadcast, received, CODE).expect("a state");
    let before = broadcast.state(5, Carriers::L1L2, received, CODE).expect("a state");
    let lower = before.position.norm() - found.position.norm();
    assert!((lower - 1.0).abs() < 1e-6, "{lower}");
    // The correction refers to the middle of the interval, and the signal was sent at 15 s less its way.
    let elapsed = 15.0 - CODE / SPEED_OF_LIGHT - INTERVAL / 2.0;
    let later = SPEED_OF_LIGHT * (found.clock - before.clock);
    assert!((later - (2.0 + 0.01 * elapsed)).abs() < 1e-6, "{later}");
    assert!(found.accuracy < 0.1);

    // Corrections serve for a minute and a half.
    assert!(corrected.state(5, &broadcast, now.plus(90.0), CODE).is_ok());
    for at in [now.plus(-2.0), now.plus(91.0)] {
        assert_eq!(corrected.state(5, &broadcast, at, CODE), Err(NoEphemeris::Missing));
    }
}

#[test]
fn an_ephemeris_serves_as_long_as_it_is_the_one_that_is_corrected() {
    let now = GpsTime::new(SUNDAY, 7_000.0);
    let mut broadcast = Broadcast::<4>::new();
    hear(&mut broadcast, 5, 7_200, 0, now);
    let mut corrected = Corrected::<4>::new();
    let old = [(5, issue(7_200))];
    let new = [(5, issue(14_400))];
    // Not yet received.
    take(&mut corrected, &broadcast, &message(7_000, 1, &new), now);
    assert!(corrected.state(5, &broadcast, now.plus(1.0), CODE).is_err());
    take(&mut corrected, &broadcast, &message(7_010, 1, &old), now.plus(10.0));
    assert!(corrected.state(5, &broadcast, now.plus(11.0), CODE).is_ok());
    // The satellite sends the next one, and the service follows half a minute later.
    hear(&mut broadcast, 5, 14_400, 0, now.plus(200.0));
    take(&mut corrected, &broadcast, &message(7_210, 1, &old), now.plus(210.0));
    assert!(corrected.state(5, &broadcast, now.plus(211.0), CODE).is_ok());
    take(&mut corrected, &broadcast, &message(7_230, 1, &new), now.plus(230.0));
    assert!(corrected.state(5, &broadcast, now.plus(231.0), CODE).is_ok());
    take(&mut corrected, &broadcast, &message(7_240, 1, &old), now.plus(240.0));
    assert!(corrected.state(5, &broadcast, now.plus(241.0), CODE).is_err(), "the old one is gone");
    // A satellite that calls itself unhealthy is left out, whatever the service says.
    take(&mut corrected, &broadcast, &message(7_250, 1, &new), now.plus(250.0));
    assert!(corrected.state(5, &broadcast, now.plus(251.0), CODE).is_ok());
    hear(&mut broadcast, 5, 14_400, 1, now.plus(252.0));
    let unhealthy = corrected.state(5, &broadcast, now.plus(253.0), CODE);
    assert_eq!(unhealthy, Err(NoEphemeris::Unhealthy));
}

#[test]
fn one_service_counts_until_it_falls_silent_and_a_silent_satellite_makes_room() {
    let now = GpsTime::new(SUNDAY, 7_000.0);
    let mut broadcast = Broadcast::<4>::new();
    for satellite in [3, 4, 5, 9] {
        hear(&mut broadcast, satellite, 7_200, 0, now);
    }
    let own = issue(7_200);
    let mut corrected = Corrected::<2>::new();
    take(&mut corrected, &broadcast, &message(7_000, 1, &[(3, own), (9, own)]), now);
    take(&mut corrected, &broadcast, &message(7_001, 2, &[(4, own)]), now.plus(1.0));
    let known = |corrected: &Corrected<2>, second| {
        [3, 4, 5, 9].map(|it| corrected.state(it, &broadcast, now.plus(second), CODE).is_ok())
    };
    assert_eq!(known(&corrected, 2.0), [true, false, false, false]);
    // A service whose clock is fast does not take the place of the first one either.
    take(&mut corrected, &broadcast, &message(7_300, 2, &[(4, own)]), now.plus(1.0));
    assert_eq!(known(&corrected, 2.0), [true, false, false, false]);
    // No room for a third one while both serve.
    take(&mut corrected, &broadcast, &message(7_050, 1, &[(4, own), (5, own)]), now.plus(50.0));
    assert_eq!(known(&corrected, 51.0), [true, true, false, false]);
    take(&mut corrected, &broadcast, &message(7_120, 1, &[(5, own)]), now.plus(120.0));
    assert_eq!(known(&corrected, 121.0), [false, true, true, false]);
    take(&mut corrected, &broadcast, &message(7_300, 2, &[(4, own)]), now.plus(300.0));
    assert_eq!(known(&corrected, 301.0), [false, true, false, false]);
}

#[test]
fn a_clock_belongs_to_the_ephemeris_of_the_orbit_before_it() {
    let now = GpsTime::new(SUNDAY, 7_000.0);
    let mut broadcast = Broadcast::<4>::new();
    hear(&mut broadcast, 5, 7_200, 0, now);
    let mut corrected = Corrected::<4>::new();
    let [old, new] = [7_200, 14_400].map(|second| [(5, issue(second))]);
    let is_known = |corrected: &Corrected<4>, broadcast: &Broadcast<4>, second| {
        corrected.state(5, broadcast, now.plus(second), CODE).is_ok()
    };
    take(&mut corrected, &broadcast, &data(1_058, 7_000, 1, &old), now);
    take(&mut corrected, &broadcast, &data(1_057, 7_000, 1, &old), now);
    assert!(!is_known(&corrected, &broadcast, 1.0), "an orbit without a clock");
    take(&mut corrected, &broadcast, &data(1_058, 7_010, 1, &old), now.plus(10.0));
    assert!(is_known(&corrected, &broadcast, 11.0));
    take(&mut corrected, &broadcast, &data(1_060, 7_205, 1, &old), now.plus(205.0));
    hear(&mut broadcast, 5, 14_400, 0, now.plus(200.0));
    take(&mut corrected, &broadcast, &data(1_057, 7_210, 1, &new), now.plus(210.0));
    assert!(!is_known(&corrected, &broadcast, 211.0), "the clock is one of the old ephemeris");
    // A late one, of the old ephemeris.
    take(&mut corrected, &broadcast, &data(1_058, 7_205, 1, &new), now.plus(210.0));
    assert!(!is_known(&corrected, &broadcast, 211.0));
    take(&mut corrected, &broadcast, &data(1_058, 7_210, 1, &new), now.plus(210.0));
    assert!(is_known(&corrected, &broadcast, 211.0));
    // What is older than what is known changes nothing.
    take(&mut corrected, &broadcast, &data(1_060, 7_205, 1, &old), now.plus(211.0));
    assert!(is_known(&corrected, &broadcast, 212.0));
}

#[test]
fn messages_may_be_late_and_weeks_end() {
    let end = GpsTime::new(SUNDAY + 6, 86_395.0);
    let mut broadcast = Broadcast::<4>::new();
    for satellite in [4, 5] {
        hear(&mut broadcast, satellite, 0, 0, end);
    }
    let mut corrected = Corrected::<4>::new();
    let own = issue(0);
    let known = |corrected: &Corrected<4>, second| {
        [4, 5].map(|it| corrected.state(it, &broadcast, end.plus(second), CODE).is_ok())
    };
    take(&mut corrected, &broadcast, &message(5, 1, &[(4, own)]), end.plus(10.0));
    // Ten seconds older, and of the week before; of another service, too.
    take(&mut corrected, &broadcast, &message(604_795, 1, &[(5, own)]), end.plus(12.0));
    take(&mut corrected, &broadcast, &message(604_795, 2, &[(5, own)]), end.plus(12.0));
    assert_eq!(known(&corrected, 13.0), [true; 2]);
    assert_eq!(known(&corrected, 95.0), [true, false]);
    // A time that is not a number changes nothing.
    take(&mut corrected, &broadcast, &message(100, 2, &[(5, own)]), GpsTime::new(SUNDAY, f64::NAN));
    assert_eq!(known(&corrected, 95.0), [true, false]);
}
