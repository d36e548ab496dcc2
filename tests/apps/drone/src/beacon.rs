//! The user's beacon, as reported by a `LoRa` module of the series REYAX RYLR:
//! `+RCV=<address>,<length>,<data>,<RSSI>,<SNR>`.

/// A frame that the module received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beacon {
    /// The address of the sender.
    pub address: u16,
    /// The received level, dBm.
    pub level: i16,
}

impl Beacon {
    /// Parses the line with which the module reports a frame; `None` for any other line.
    pub fn read(line: &str) -> Option<Self> {
        let (address, rest) = line.strip_prefix("+RCV=")?.split_once(',')?;
        let (length, rest) = rest.split_once(',')?;
        // The data may contain commas.
        let (level, _) = rest.get(length.parse().ok()?..)?.strip_prefix(',')?.split_once(',')?;
        Some(Self { address: address.parse().ok()?, level: level.parse().ok()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_told_from_other_lines() {
        let read = |line| Beacon::read(line).map(|beacon| (beacon.address, beacon.level));
        assert_eq!(read("+RCV=50,5,HELLO,-99,40"), Some((50, -99)));
        assert_eq!(read("+RCV=7,4,a,b,,-120,-11"), Some((7, -120)));
        for line in
            ["+OK", "+ERR=4", "+RCV=50,9,HELLO,-99,40", "+RCV=50,5,HELLO,-99", "+RCV=x,0,,-9,1"]
        {
            assert_eq!(read(line), None, "{line}");
        }
    }
}
