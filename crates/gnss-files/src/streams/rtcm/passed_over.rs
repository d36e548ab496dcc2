//! Contents of messages that are not read: satellites of other systems, and observations of supported systems in
//! another form.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use kestirim_gnss_message::Bits;
use rtcm_rs::MessageFrame;

use crate::system::System;
use crate::unserved::Unserved;

/// The numbers of multiple signal messages (MSM): ten for each system.
const SEVERAL_SIGNALS: RangeInclusive<u16> = 1071..=1137;
/// The systems of multiple signal messages: the letter, and what is added to a satellite's number for that of RINEX.
const SYSTEMS: [(u8, u8); 7] =
    [(b'G', 0), (b'R', 0), (b'E', 0), (b'S', 19), (b'J', 0), (b'C', 0), (b'I', 0)];
/// The first bit and the length of the satellite mask, which follows the header of 73 bits.
const SATELLITES: (usize, usize) = (73, 64);
/// The first bit and the length of the signal mask.
const SIGNALS: (usize, usize) = (137, 32);
/// The observation messages of GPS from before MSM.
const OLD_OF_GPS: RangeInclusive<u16> = 1001..=1004;
/// The observation messages of GLONASS from before MSM.
const OLD_OF_GLONASS: RangeInclusive<u16> = 1009..=1012;
/// Ephemerides of other systems: the message number, the letter, and the bits of the satellite's number.
const EPHEMERIDES: [(u16, u8, usize); 3] = [(1020, b'R', 6), (1041, b'I', 6), (1044, b'J', 4)];
/// The first bit after the message number.
const BEGINNING: usize = 12;

/// The number of satellite and signal cells in an observation message; `None` for another message.
pub(super) fn cell_count(frame: &MessageFrame<'_>) -> Option<u32> {
    let ones = |mask| ones(frame, mask).count() as u32;
    SEVERAL_SIGNALS.contains(&number(frame)).then(|| ones(SATELLITES) * ones(SIGNALS))
}

/// A record of what was passed over.
#[derive(Debug, Default)]
pub(super) struct PassedOver {
    pub(super) observed: Unserved,
    pub(super) ephemerides: Unserved,
    /// The numbers of observation messages that are not read in their form.
    messages: BTreeSet<u16>,
}

impl PassedOver {
    /// Notes a message that is not read.
    pub(super) fn note(&mut self, frame: &MessageFrame<'_>) {
        let number = number(frame);
        if let Some((letter, offset)) = system(number) {
            if System::of_letter(letter).is_some() {
                self.messages.insert(number);
            } else {
                ones(frame, SATELLITES).for_each(|it| self.observed.note(letter, it + offset));
            }
        } else if let Some((_, letter, bits)) = EPHEMERIDES.iter().find(|it| it.0 == number) {
            self.ephemerides.note(*letter, Bits::at(frame.data(), BEGINNING).integer(*bits) as u8);
        } else if OLD_OF_GPS.contains(&number) || OLD_OF_GLONASS.contains(&number) {
            self.messages.insert(number);
        }
    }

    /// A sentence about observations in another form, if there are any.
    pub(super) fn sentence(&self) -> Option<String> {
        let numbers: Vec<_> = self.messages.iter().map(u16::to_string).collect();
        (!numbers.is_empty()).then(|| {
            let numbers = numbers.join(", ");
            format!("observations in messages {numbers} are not read, only those in MSM4 and MSM7")
        })
    }
}

fn number(frame: &MessageFrame<'_>) -> u16 {
    frame.message_number().unwrap_or_default()
}

/// The entry of [`SYSTEMS`] for a multiple signal message.
fn system(number: u16) -> Option<(u8, u8)> {
    let place = number.checked_sub(*SEVERAL_SIGNALS.start())?;
    // The last three numbers of each ten are no such messages.
    (place % 10 < 7).then(|| SYSTEMS.get(usize::from(place / 10)).copied()).flatten()
}

/// The positions of the ones in a mask, from 1 on.
fn ones(frame: &MessageFrame<'_>, (from, bits): (usize, usize)) -> impl Iterator<Item = u8> {
    let mut mask = Bits::at(frame.data(), from);
    (1..=bits as u8).filter(move |_| mask.integer(1) == 1)
}
