//! Corrected ephemerides through C's interface are those of the crate.
#![allow(unsafe_code)] // Calls what C calls.

use std::ptr::null_mut;

use kestirim_c::{
    GNSS_BROADCAST_SIZE, GNSS_CORRECTIONS_SIZE, GnssBroadcast, GnssCorrections, GnssMessage,
    GnssTime, Status, kestirim_gnss_broadcast_init, kestirim_gnss_broadcast_take,
    kestirim_gnss_corrections_align, kestirim_gnss_corrections_at, kestirim_gnss_corrections_init,
    kestirim_gnss_corrections_size, kestirim_gnss_corrections_take,
};
use kestirim_gnss_message::gps::Subframe;
use kestirim_gnss_message::{crc_24q, ssr};
use kestirim_gnss_ppp::GpsTime;
use kestirim_ppp_filter::{Broadcast, Corrected, MessagePart};

use super::broadcast::{CODE, NOON, nowhere, words};

/// The frame of message 1060 for satellite 5 and issue 0 at noon of a Thursday, with small corrections by chance.
fn frame() -> Vec<u8> {
    // The lowest bits of the radial and the cross-track offset, of the clock and of its rate.
    let mut data = [0; 35];
    for place in [12, 17, 27, 29] {
        data[place] = 0x5a;
    }
    // 1060, 388,800 s, every 5 s, one satellite; its number and issue.
    data[..11].copy_from_slice(&[0x42, 0x45, 0xee, 0xc0, 0x20, 0, 0, 0, 0x11, 0x40, 0]);
    let frame = [&[0xd3, 0, 35][..], &data].concat();
    let sum = crc_24q(&frame).to_be_bytes();
    [&frame[..], &sum[1..]].concat()
}

fn take(
    corrections: *mut GnssCorrections,
    broadcast: *const GnssBroadcast,
    frame: &[u8],
    received: GnssTime,
) -> Status {
    let (data, length) = (frame.as_ptr(), frame.len());
    // SAFETY: memory of this test's.
    unsafe {
        kestirim_gnss_corrections_take(
            corrections,
            broadcast,
            data,
            length,
            100,
            200,
            &raw const received,
        )
    }
}

#[test]
fn a_corrected_state_is_the_crates() {
    assert!(kestirim_gnss_corrections_size() <= GNSS_CORRECTIONS_SIZE);
    assert!(align_of::<u64>() >= kestirim_gnss_corrections_align());
    let mut of_broadcast = [0_u64; GNSS_BROADCAST_SIZE / 8];
    let mut of_corrections = vec![0_u64; GNSS_CORRECTIONS_SIZE / 8];
    let (mut broadcast, mut corrections) = (null_mut(), null_mut());
    let (mut expected, mut corrected) = (Broadcast::<40>::new(), Corrected::<40>::new());
    let noon = GpsTime::new(NOON.day, NOON.second);
    // SAFETY: memory of this test's.
    unsafe {
        let size = size_of_val(&of_broadcast);
        kestirim_gnss_broadcast_init(of_broadcast.as_mut_ptr().cast(), size, &raw mut broadcast);
        let size = size_of_val(&of_corrections[..]);
        let memory = of_corrections.as_mut_ptr().cast();
        kestirim_gnss_corrections_init(memory, size, &raw mut corrections);
        for number in [1, 2, 3] {
            let words = words(number, false);
            let part = MessagePart::Gps(Subframe::from_words(&words).expect("LNAV"));
            expected.take(105, part, noon);
            let (words, lnav) = (words.as_ptr(), GnssMessage::Lnav as u32);
            let noon = &raw const NOON;
            kestirim_gnss_broadcast_take(broadcast, 105, lnav, words, 10, noon, null_mut());
        }
    }
    let later = GnssTime { second: NOON.second + 1.0, ..NOON };
    let at = |corrections, satellite, code| {
        let mut state = nowhere();
        // SAFETY: memory of this test's.
        let status = unsafe {
            let later = &raw const later;
            kestirim_gnss_corrections_at(
                corrections,
                broadcast,
                satellite,
                later,
                code,
                &raw mut state,
            )
        };
        (status, state)
    };
    assert_eq!(at(corrections, 105, CODE).0, Status::Gap);

    let frame = frame();
    assert_eq!(take(corrections, broadcast, &frame, NOON), Status::Ok);
    let length = frame.len();
    let message = ssr::Message::from_data(&frame[3..length - 3]).expect("corrections");
    corrected.take(&message, |it| Some(it + 100), &expected, noon);
    let expected = corrected.state(105, &expected, noon.plus(1.0), CODE).expect("a state");
    let (status, found) = at(corrections, 105, CODE);
    assert_eq!(status, Status::Ok);
    assert_eq!(
        (found.position, found.velocity),
        (expected.position.into(), expected.velocity.into())
    );
    assert_eq!((found.clock, found.accuracy), (expected.clock, expected.accuracy));
    assert_eq!(at(corrections, 5, CODE).0, Status::Gap);
    assert_eq!(at(corrections, 105, f64::NAN).0, Status::NotFinite);

    let never = GnssTime { second: f64::NAN, ..NOON };
    assert_eq!(take(corrections, broadcast, &frame, never), Status::NotFinite);
    assert_eq!(take(corrections, null_mut(), &frame, NOON), Status::NullPointer);
    for damaged in [&frame[..length - 1], &frame[1..], &[]] {
        assert_eq!(take(corrections, broadcast, damaged, NOON), Status::DamagedMessage);
    }
}
