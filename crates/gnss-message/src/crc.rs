/// Generator polynomial of the CRC-24Q, without its highest bit.
const GENERATOR: u32 = 0x86_4cfb;

/// CRC-24Q (Qualcomm), the checksum of Galileo's pages and of RTCM 3's frames. Of data followed by its checksum it is zero.
pub fn crc_24q(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte) << 16, |crc, _| {
            let shifted = crc << 1 & 0xff_ffff;
            if crc & 0x80_0000 == 0 { shifted } else { shifted ^ GENERATOR }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_catalogue() {
        // CRC-24/LTE-A has the same parameters.
        assert_eq!(crc_24q(b"123456789"), 0xcd_e703);
        assert_eq!(crc_24q(b"123456789\xcd\xe7\x03"), 0);
    }
}
