//! Detection of stream frames by their checksums.

use kestirim_gnss_message::{frame_data, frame_length};

/// The first bytes of a UBX frame.
const UBX: [u8; 2] = [0xb5, 0x62];
/// The number of bytes around the payload of a UBX frame.
const AROUND_UBX: usize = 8;
/// The first byte of an RTCM 3 frame.
const RTCM: u8 = 0xd3;
/// How many bytes are searched for a frame: a log may begin within a frame, or with lines of NMEA.
const BEGINNING: usize = 4096;

/// Whether there is a complete UBX frame near the beginning.
pub(crate) fn is_ubx(bytes: &[u8]) -> bool {
    let is_frame = |frame: &[u8]| {
        let length = usize::from(u16::from_le_bytes([*frame.get(4)?, *frame.get(5)?]));
        let frame = frame.get(..length + AROUND_UBX)?;
        let (held, told) = frame[2..].split_at(length + 4);
        let sums = held.iter().fold([0_u8; 2], |[a, b], byte| {
            let a = a.wrapping_add(*byte);
            [a, b.wrapping_add(a)]
        });
        Some(sums == told)
    };
    places(bytes, &UBX).any(|rest| is_frame(rest).unwrap_or_default())
}

/// The data of the first complete RTCM 3 frame near the beginning.
pub(crate) fn first_of_rtcm(bytes: &[u8]) -> Option<&[u8]> {
    places(bytes, &[RTCM]).find_map(|rest| {
        let frame = rest.get(..frame_length(rest)?)?;
        // An empty frame is no sign of anything.
        frame_data(frame).filter(|data| !data.is_empty())
    })
}

/// What begins with `first` near the beginning, each up to the end.
fn places<'a>(bytes: &'a [u8], first: &'a [u8]) -> impl Iterator<Item = &'a [u8]> {
    let beginning = &bytes[..bytes.len().min(BEGINNING)];
    memchr::memmem::find_iter(beginning, first).map(|place| &bytes[place..])
}
