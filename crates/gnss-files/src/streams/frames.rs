//! Frames of streams, told by their checksums.

/// The first bytes of a frame of UBX, and how many are around what it holds.
const UBX: [u8; 2] = [0xb5, 0x62];
const AROUND_UBX: usize = 8;
/// The same of RTCM 3.
const RTCM: u8 = 0xd3;
const AROUND_RTCM: usize = 6;
/// Generator of the CRC-24Q, without its highest bit.
const CRC_24Q: u32 = 0x86_4cfb;
/// So many bytes are looked through for a frame: a log may begin within one, or with lines of NMEA.
const BEGINNING: usize = 4096;

/// Whether there is a whole frame of UBX near the beginning.
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

/// Whether there is a whole frame of RTCM 3 near the beginning.
pub(crate) fn is_rtcm(bytes: &[u8]) -> bool {
    frames(bytes, &[RTCM], |frame| {
        let length = u16::from_be_bytes([*frame.get(1)?, *frame.get(2)?]);
        // Six bits are reserved; an empty frame is no sign of anything.
        if !(1..=0x3ff).contains(&length) {
            return Some(false);
        }
        let frame = frame.get(..usize::from(length) + AROUND_RTCM)?;
        // With its own checksum behind, that of a whole frame is zero.
        Some(crc_24q(frame) == 0)
    })
}

/// Whether any that begins with `first` near the beginning is a frame.
fn frames(bytes: &[u8], first: &[u8], is_frame: impl Fn(&[u8]) -> Option<bool>) -> bool {
    let beginning = &bytes[..bytes.len().min(BEGINNING)];
    memchr::memmem::find_iter(beginning, first)
        .any(|place| is_frame(&bytes[place..]).unwrap_or_default())
}

/// The checksum of a frame of RTCM 3.
pub(super) fn crc_24q(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte) << 16, |crc, _| {
            let shifted = crc << 1 & 0xff_ffff;
            if crc & 0x80_0000 == 0 { shifted } else { shifted ^ CRC_24Q }
        })
    })
}
