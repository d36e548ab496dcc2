//! Observations of GLONASS, whose messages give Moscow time, and only some of them the satellites' channels.

use std::collections::BTreeMap;

use super::Epoch;
use crate::observations::{CHANNELS, Raw, Signal, channel_scale};
use crate::streams::{Locks, WEEK_MS};
use crate::system::System;

/// Moscow time minus UTC, ms.
const MOSCOW: i64 = 10_800_000;
const DAY: i64 = 86_400_000;

/// Observations that are held until the offset of UTC from GPS time is known.
#[derive(Debug, Default)]
pub(super) struct OfGlonass {
    cells: Vec<Cell>,
    pub(super) channels: BTreeMap<u8, i8>,
}

#[derive(Debug)]
struct Cell {
    /// The index of the epoch before the observation.
    place: usize,
    /// Moscow time since the beginning of Sunday, ms.
    time: i64,
    satellite: u8,
    /// The observation; a phase as if on channel 0.
    raw: Raw,
}

impl OfGlonass {
    /// Time since the beginning of Sunday, ms, from the day of the week, if that is known, and the ms of the day.
    pub(super) fn time(day: Option<u8>, milliseconds: u32) -> Option<i64> {
        Some(DAY * i64::from(day?) + i64::from(milliseconds))
    }

    /// Notes a satellite's channel, if the channel exists.
    pub(super) fn on(&mut self, number: u8, channel: Option<i8>) {
        let channel = channel.filter(|channel| CHANNELS.contains(channel));
        if let (Some(satellite), Some(channel)) = (System::Glonass.number(number), channel) {
            self.channels.insert(satellite, channel);
        }
    }

    /// Adds a signal that follows `epochs` epochs: its code and its phase, ms.
    pub(super) fn take(
        &mut self,
        (epochs, time): (usize, i64),
        number: u8,
        [code, phase]: [(Signal, Option<f64>); 2],
        (locks, tracked): (&mut Locks, u32),
    ) {
        let Some(satellite) = System::Glonass.number(number) else { return };
        let place = epochs.saturating_sub(1);
        let mut take = |raw| self.cells.push(Cell { place, time, satellite, raw });
        if let (signal, Some(milliseconds)) = code {
            let value = crate::biases::SPEED_OF_LIGHT * 1e-3 * milliseconds;
            take(Raw { signal, value, lock_lost: false });
        }
        if let (signal, Some(milliseconds)) = phase {
            let lock_lost = locks.lost(satellite, signal, time, tracked);
            let value = signal.frequency(System::Glonass) * 1e-3 * milliseconds;
            take(Raw { signal, value, lock_lost });
        }
    }

    /// Adds all observations to the epochs of the same instants; GPS time is `ahead` of UTC, ms. Observations without
    /// an epoch of other systems are left out.
    pub(super) fn join(self, epochs: &mut [Epoch], ahead: i64) -> BTreeMap<u8, i8> {
        let Self { cells, channels } = self;
        for Cell { place, time, satellite, mut raw } in cells {
            let time = (time - MOSCOW + ahead).rem_euclid(WEEK_MS);
            // A GLONASS message may come first in an epoch, or after the first message of the next.
            let near = epochs.iter_mut().skip(place.saturating_sub(1)).take(3);
            let Some((_, satellites)) = near.into_iter().find(|(of, _)| *of == time) else {
                continue;
            };
            if raw.signal.phase {
                raw.value *= channels.get(&satellite).map_or(1.0, |it| channel_scale(*it));
            }
            match satellites.iter_mut().find(|(other, _)| *other == satellite) {
                Some((_, all)) => all.push(raw),
                None => satellites.push((satellite, vec![raw])),
            }
        }
        channels
    }
}
