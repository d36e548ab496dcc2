//! The sequence numbers of a device's frames: which frames are new, missing, or from another sender.

use kestirim_telemetry::{Frame, Origin};
use serde::{Deserialize, Serialize};

/// How far behind the newest sequence number frames are still tracked: the limit on their reordering in transit.
const WINDOW: u32 = u128::BITS;
/// The number of recent frames whose checksums are remembered.
const REMEMBERED: usize = 8;
/// The number of frames of another sender from which on they are reported; fewer may be late ones from before the
/// device was switched off.
pub(crate) const TOLD: u32 = 8;

/// The place of a frame in the sequence of its device's frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// The frame is newer than all before it.
    Newest {
        /// The number of frames missing so far between this one and the newest before it.
        missing: u32,
    },
    /// The device was switched on again; this is its newest frame.
    Restarted {
        /// The number of frames missing so far since the device was switched on.
        missing: u32,
    },
    /// The frame had been missing.
    Late {
        /// How far its sequence number is behind the newest.
        behind: u16,
    },
    /// The frame is a duplicate.
    Twice,
    /// The frame has the number of an earlier one but other contents, is far behind the newest, or dates from before
    /// the device was switched on: it is from another sender with the same device number, or from one that does not
    /// count its boots.
    Another,
}

/// Tracks the sequence numbers of one device.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Numbers {
    boot: u32,
    newest: u32,
    /// Bit n is set if the frame n behind the newest has arrived.
    came: u128,
    /// Sequence numbers and checksums of recent frames.
    last: [(u32, u32); REMEMBERED],
}

impl Numbers {
    /// Starts with the first frame received from a device: earlier ones do not count as missing.
    pub(crate) fn from(origin: Origin, frame: &Frame) -> Self {
        let (sequence, checksum) = (frame.sequence, frame.checksum);
        let last = [(sequence, checksum); REMEMBERED];
        Self { boot: origin.boot, newest: sequence, came: u128::MAX, last }
    }

    /// Classifies the next frame.
    pub(crate) fn take(&mut self, origin: Origin, frame: &Frame) -> Place {
        if origin.boot < self.boot {
            return Place::Another;
        }
        if origin.boot > self.boot {
            *self = Self { came: 1, ..Self::from(origin, frame) };
            return Place::Restarted { missing: frame.sequence };
        }
        if let Some(ahead) = frame.sequence.checked_sub(self.newest).filter(|&ahead| ahead > 0) {
            self.newest = frame.sequence;
            self.came = self.came.checked_shl(ahead).unwrap_or(0) | 1;
            self.remember(frame);
            return Place::Newest { missing: ahead - 1 };
        }
        let behind = self.newest - frame.sequence;
        if behind >= WINDOW {
            return Place::Another;
        }
        let place = 1_u128 << behind;
        if self.came & place == 0 {
            self.came |= place;
            self.remember(frame);
            return Place::Late { behind: behind as u16 };
        }
        let known = self.last.iter().find(|(sequence, _)| *sequence == frame.sequence);
        let is_same = known.is_none_or(|(_, checksum)| *checksum == frame.checksum);
        if is_same { Place::Twice } else { Place::Another }
    }

    fn remember(&mut self, frame: &Frame) {
        if let Some(place) = self.last.get_mut(frame.sequence as usize % REMEMBERED) {
            *place = (frame.sequence, frame.checksum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Place::{Another, Late, Newest, Restarted, Twice};
    use super::*;
    use kestirim_telemetry::{CAPACITY, Health, Receiver, encode_from};

    const NEXT: Place = Newest { missing: 0 };

    fn frame(boot: u32, sequence: u32, accepted: u32) -> Frame {
        let (origin, mut buffer) = (Origin { device: 1, boot }, [0; CAPACITY]);
        let message = Health { time_us: 0, accepted, rejected: 0, failed: 0 }.into();
        let bytes = encode_from(origin, &message, sequence, &mut buffer).expect("it fits");
        Receiver::new().frames(bytes).next().expect("a frame")
    }

    /// Classifies frames with these boot counts and sequence numbers.
    fn places<const N: usize>(numbers: [(u32, u32); N]) -> [Place; N] {
        let mut known = None::<Numbers>;
        numbers.map(|(boot, sequence)| {
            let frame = frame(boot, sequence, 0);
            let origin = frame.origin.expect("a device");
            let place = known.as_mut().map(|numbers| numbers.take(origin, &frame));
            known.get_or_insert_with(|| Numbers::from(origin, &frame));
            place.unwrap_or(NEXT)
        })
    }

    #[test]
    fn frames_are_missing_late_or_there_twice() {
        let sent = [(1, 70_000), (1, 70_003), (1, 70_002), (1, 70_002), (1, 70_001), (1, 70_004)];
        let expected =
            [NEXT, Newest { missing: 2 }, Late { behind: 1 }, Twice, Late { behind: 2 }, NEXT];
        assert_eq!(places(sent), expected);
    }

    #[test]
    fn a_device_that_is_switched_on_again_begins_anew_and_its_boots_are_counted() {
        let sent = [(1, 500), (2, 0), (2, 1), (1, 501), (9, 3), (9, 2)];
        let expected = [
            NEXT,
            Restarted { missing: 0 },
            NEXT,
            Another,
            Restarted { missing: 3 },
            Late { behind: 1 },
        ];
        assert_eq!(places(sent), expected);
        let without_boots: Vec<_> = places([(0, 500), (0, 0), (0, 1), (0, 2)]).into();
        assert_eq!(without_boots, [NEXT, Another, Another, Another]);
    }

    #[test]
    fn the_same_number_with_another_content_is_another_senders() {
        let first = frame(1, 7, 100);
        let origin = first.origin.expect("a device");
        let mut numbers = Numbers::from(origin, &first);
        for sequence in 8..1000 {
            let [mine, others] = [1, 2].map(|accepted| frame(1, sequence, accepted));
            assert_eq!(numbers.take(origin, &mine), NEXT);
            assert_eq!(numbers.take(origin, &others), Another);
            assert_eq!(numbers.take(origin, &mine), Twice);
        }
    }
}
