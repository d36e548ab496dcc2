//! The user's beacon, as a `LoRa` module of the series REYAX RYLR tells it:
//! `+RCV=<address>,<length>,<data>,<RSSI>,<SNR>`.

/// A frame that the module received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beacon {
    /// Who sent it.
    pub address: u16,
    /// How strongly it came in, dBm.
    pub level: i16,
}

impl Beacon {
    /// The frame that a line tells of, if it does.
    pub fn read(line: &str) -> Option<Self> {
        let (address, rest) = line.strip_prefix("+RCV=")?.split_once(',')?;
        let (length, rest) = rest.split_once(',')?;
        // The data may have commas.
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
