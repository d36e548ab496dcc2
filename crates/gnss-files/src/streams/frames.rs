//! Detection of stream frames by their checksums.

use kestirim_gnss_message::crc_24q;

/// The first bytes of a UBX frame.
const UBX: [u8; 2] = [0xb5, 0x62];
/// The number of bytes around the payload of a UBX frame.
const AROUND_UBX: usize = 8;
/// The first byte of an RTCM 3 frame.
const RTCM: u8 = 0xd3;
/// The number of bytes around the payload of an RTCM 3 frame.
const AROUND_RTCM: usize = 6;
/// How many bytes are searched for a frame: a log may begin within a frame, or with lines of NMEA.
const BEGINNING: usize = 4096;

/// Whether there is a complete UBX frame near the beginning.
pub(crate) fn is_ubx(bytes: &[u8]) -> bool {
    frames(bytes, &UBX, |frame| {
        let length = usize::from(u16::from_le_bytes([*frame.get(4)?, *frame.get(5)?]));
        let frame = frame.get(..length + AROUND_UBX)?;
        let (held, told) = frame[2..].split_at(length + 4);
        let sums = held.iter().fold([0_u8; 2], |[a, b], byte| {
            let a = a.wrapping_add(*byte);
            [a, b.wrapping_add(a)]
        });
        Some(sums == told)
    })
}

/// Whether there is a complete RTCM 3 frame near the beginning.
pub(crate) fn is_rtcm(bytes: &[u8]) -> bool {
    frames(bytes, &[RTCM], |frame| {
        let length = u16::from_be_bytes([*frame.get(1)?, *frame.get(2)?]);
        // Six bits are reserved; an empty frame is no sign of anything.
        if !(1..=0x3ff).contains(&length) {
            return Some(false);
        }
        let frame = frame.get(..usize::from(length) + AROUND_RTCM)?;
        // The checksum over a whole frame, including its own checksum, is zero.
        Some(crc_24q(frame) == 0)
    })
}

/// Whether anything near the beginning that starts with `first` is a frame.
fn frames(bytes: &[u8], first: &[u8], is_frame: impl Fn(&[u8]) -> Option<bool>) -> bool {
    let beginning = &bytes[..bytes.len().min(BEGINNING)];
    memchr::memmem::find_iter(beginning, first)
        .any(|place| is_frame(&bytes[place..]).unwrap_or_default())
}
