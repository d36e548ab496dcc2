use crate::crc_24q;

/// The first byte of a frame.
const PREAMBLE: u8 = 0xd3;
/// The bytes before the data: preamble and length. As many are behind them: the checksum.
const HEAD: usize = 3;

/// The length of the frame of RTCM 3 that begins with these bytes, of which three suffice. `None` if no frame begins so.
pub fn frame_length(beginning: &[u8]) -> Option<usize> {
    match *beginning {
        [PREAMBLE, high @ 0..4, low, ..] => {
            Some(usize::from(u16::from_be_bytes([high, low])) + 2 * HEAD)
        }
        _ => None,
    }
}

/// The data of a frame of RTCM 3, given as a whole. `None` without the preamble, with another length or a wrong checksum.
pub fn frame_data(frame: &[u8]) -> Option<&[u8]> {
    let is_whole = frame_length(frame) == Some(frame.len()) && crc_24q(frame) == 0;
    frame.get(HEAD..frame.len().checked_sub(HEAD)?).filter(|_| is_whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_are_those_of_a_whole_frame_alone() {
        // Message 1005 of the standard's example (RTCM 10403.1, 4.2).
        let frame = [
            0xd3, 0x00, 0x13, 0x3e, 0xd7, 0xd3, 0x02, 0x02, 0x98, 0x0e, 0xde, 0xef, 0x34, 0xb4,
            0xbd, 0x62, 0xac, 0x09, 0x41, 0x98, 0x6f, 0x33, 0x36, 0x0b, 0x98,
        ];
        assert_eq!(frame_data(&frame), frame.get(3..22));
        assert_eq!(frame_length(&frame[..3]), Some(25));
        for place in 0..frame.len() {
            let mut damaged = frame;
            damaged[place] ^= 0x10;
            assert_eq!(frame_data(&damaged), None);
            assert_eq!(frame_data(&frame[..place]), None);
        }
        assert_eq!(frame_length(&[0xd3, 0x04, 0]), None);
        assert_eq!(frame_length(&[0xd3, 0]), None);
    }
}
