//! Ephemerides from subframes through C's interface are those of the crate.
#![allow(unsafe_code)] // Calls what C calls.

use std::ptr::{null, null_mut};

use kestirim_c::{
    GNSS_BROADCAST_SIZE, GnssBroadcast, GnssCarriers, GnssMessage, GnssSatellite, GnssTime, Status,
    kestirim_gnss_broadcast_align, kestirim_gnss_broadcast_at, kestirim_gnss_broadcast_init,
    kestirim_gnss_broadcast_size, kestirim_gnss_broadcast_take,
};
use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_ppp::{Carriers, GpsTime};
use kestirim_ppp_filter::{Broadcast, MessagePart};

pub(super) static NOON: GnssTime = GnssTime { day: 59_025, second: 43_200.0 };
pub(super) const CODE: f64 = 21e6;

/// The words of a subframe of LNAV: of noon of a Thursday, issue 0, with orbit and clock by chance. The sixth bit of health is set of an
/// unhealthy satellite.
pub(super) fn words(number: u32, unhealthy: bool) -> [u32; 10] {
    let mut state = 0x9E37_79B9_u32 ^ number;
    let mut words = [(); 10].map(|()| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 2
    });
    let noon = 388_800 / 16;
    words[0] = 0x8b << 22;
    words[1] = number << 8;
    match number {
        1 => {
            words[2] = u32::from(unhealthy) << 12;
            words[7] = noon << 6;
        }
        2 => {
            words[2] &= 0xff_ffff >> 2;
            // √A of a satellite of GPS, in words 8 and 9, and toe in the tenth.
            let root = 5_153 << 19;
            words[7] = words[7] & !(0xff << 6) | (root >> 24) << 6;
            words[8] = (root & 0xff_ffff) << 6;
            words[9] = noon << 14;
        }
        _ => words[9] &= 0x3f_ffff,
    }
    words
}

fn take(broadcast: *mut GnssBroadcast, satellite: u8, words: &[u32]) -> (Status, u8) {
    let mut complete = 7;
    // SAFETY: memory of this test's.
    let status = unsafe {
        kestirim_gnss_broadcast_take(
            broadcast,
            satellite,
            GnssMessage::Lnav as u32,
            words.as_ptr(),
            words.len(),
            &raw const NOON,
            &raw mut complete,
        )
    };
    (status, complete)
}

/// A state that nothing was written to.
pub(super) const fn nowhere() -> GnssSatellite {
    GnssSatellite {
        position: [0.0; 3],
        velocity: [0.0; 3],
        clock: 0.0,
        clock_interval: 0.0,
        clock_distance: 0.0,
        accuracy: 0.0,
    }
}

fn at(broadcast: *const GnssBroadcast, satellite: u8, on: u32) -> Result<GnssSatellite, Status> {
    let mut state = nowhere();
    // SAFETY: memory of this test's.
    let status = unsafe {
        kestirim_gnss_broadcast_at(broadcast, satellite, on, &raw const NOON, CODE, &raw mut state)
    };
    if status == Status::Ok { Ok(state) } else { Err(status) }
}

#[test]
fn a_state_is_the_crates() {
    assert!(kestirim_gnss_broadcast_size() <= GNSS_BROADCAST_SIZE);
    assert!(align_of::<u64>() >= kestirim_gnss_broadcast_align());
    let mut memory = [0_u64; GNSS_BROADCAST_SIZE / 8];
    let mut broadcast = null_mut();
    // SAFETY: memory of this test's.
    let status = unsafe {
        let size = size_of_val(&memory);
        kestirim_gnss_broadcast_init(memory.as_mut_ptr().cast(), size, &raw mut broadcast)
    };
    assert_eq!(status, Status::Ok);

    let mut expected = Broadcast::<40>::new();
    let noon = GpsTime::new(NOON.day, NOON.second);
    for number in [2, 3, 1] {
        let complete = u8::from(number == 1);
        assert_eq!(take(broadcast, 5, &words(number, false)), (Status::Ok, complete));
        assert_eq!(take(broadcast, 6, &words(number, true)), (Status::Ok, complete));
        let part = MessagePart::Gps(Subframe::from_words(&words(number, false)).expect("LNAV"));
        assert_eq!(expected.take(5, part, noon), complete == 1);
    }
    let expected = expected.state(5, Carriers::L1L2, noon, CODE).expect("a state");
    let found = at(broadcast, 5, GnssCarriers::L1L2 as u32).expect("a state");
    assert_eq!(
        (found.position, found.velocity),
        (expected.position.into(), expected.velocity.into())
    );
    assert_eq!((found.clock, found.accuracy), (expected.clock, 2.0));
    let radius = expected.position.norm();
    assert!((1e7..5e7).contains(&radius), "{radius} m from the Earth's centre");

    assert_eq!(at(broadcast, 6, 0), Err(Status::Unhealthy));
    assert_eq!(at(broadcast, 7, 0), Err(Status::Gap));
    assert_eq!(at(broadcast, 5, GnssCarriers::B1B3 as u32), Err(Status::NoGroupDelay));
    assert_eq!(at(broadcast, 5, 9), Err(Status::InvalidArgument));
    assert_eq!(at(null(), 5, 0), Err(Status::NullPointer));
}

#[test]
fn what_is_no_message_is_refused() {
    let mut memory = [0_u64; GNSS_BROADCAST_SIZE / 8];
    let mut broadcast = null_mut();
    let mut take = |message: u32, words: &[u32], received: &GnssTime| {
        // SAFETY: memory of this test's.
        unsafe {
            let size = size_of_val(&memory);
            let memory = memory.as_mut_ptr().cast();
            assert_eq!(kestirim_gnss_broadcast_init(memory, size, &raw mut broadcast), Status::Ok);
            let (words, count) = (words.as_ptr(), words.len());
            kestirim_gnss_broadcast_take(broadcast, 5, message, words, count, received, null_mut())
        }
    };
    assert_eq!(take(0, &[0; 9], &NOON), Status::TooFew);
    assert_eq!(take(1, &[1; 8], &NOON), Status::DamagedMessage);
    assert_eq!(take(3, &[0; 10], &NOON), Status::InvalidArgument);
    let never = GnssTime { second: f64::NAN, ..NOON };
    assert_eq!(take(2, &[0; 10], &never), Status::NotFinite);
    assert_eq!(take(0, &[0; 10], &NOON), Status::DamagedMessage);
    let mut words = [0; 10];
    words[0] = 0b111_0001_0010 << 19;
    assert_eq!(take(2, &words, &NOON), Status::Ok);
}
