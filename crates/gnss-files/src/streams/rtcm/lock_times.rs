//! Lock time indicators: how long phases have been tracked.

use crate::streams::Locks;

/// The minimum tracking time of a phase, ms, from the indicator of MSM4 (DF402).
pub(super) const fn tracked_short(indicator: u8) -> u32 {
    match indicator {
        0 => 0,
        1..=14 => 1 << (indicator + 4),
        _ => Locks::LONGEST,
    }
}

/// The minimum tracking time of a phase, ms, from the indicator of MSM7 (DF407), whose steps double after every 32.
pub(super) const fn tracked_long(indicator: u16) -> u32 {
    let step = indicator / 32;
    match indicator {
        0..64 => indicator as u32,
        64..704 => (32 + (indicator % 32) as u32) << (step - 1),
        _ => Locks::LONGEST,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indicators_of_lock_times() {
        let short = [0, 1, 2, 14, 15].map(tracked_short);
        assert_eq!(short, [0, 32, 64, 262_144, Locks::LONGEST]);
        // The first values of some rows of the table, and the last before them.
        let long = [0, 63, 64, 95, 96, 160, 672, 703, 704].map(tracked_long);
        let table = [0, 63, 64, 126, 128, 512, 33_554_432, 66_060_288, Locks::LONGEST];
        assert_eq!(long, table);
    }
}
