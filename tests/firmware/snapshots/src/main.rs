//! Restores estimators that were stored on the host, continues with the rest of their streams, and stores them again.
//!
//! `stream.bin` is a sequence of parts: a part is its kind, a snapshot and the remaining samples, then an empty record;
//! a record is its length, of four bytes, and its bytes. Prints one line a part: `woken=` kind, number of samples, a
//! digest of all estimates after each of them, length and digest of the final snapshot.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // The host's tests read it, too.
mod systems;

use kestirim_pedestrian::{Ekf, Lite, Tracker};
use kestirim_ppp_filter::{PppFilter, states};
use kestirim_scalar::{Q12_20, Q16_16};
use kestirim_snapshot::{load, store};
use kestirim_uav_estimator::{FlightFilter, FlightObserver};
use kestirim_user_locator::{Locator, PublishedLocator};
use semihosting::fs::File;
use semihosting::io::Read;
use support::{fail, image, line};
use systems::{Digest, Drawing, SATELLITES, Sample, Sleeper};

/// The size of the largest snapshot, bytes.
const ROOM: usize = 16 * 1024;

/// The stream, read record by record.
struct Records {
    file: File,
    bytes: [u8; ROOM],
}

impl Records {
    fn fill(&mut self, length: usize) -> bool {
        let Some(wanted) = self.bytes.get_mut(..length) else { fail("a record is too long") };
        let mut filled = 0;
        while filled < length {
            let rest = wanted.get_mut(filled..).unwrap_or_default();
            match self.file.read(rest) {
                Ok(0) | Err(_) => return false,
                Ok(read) => filled += read,
            }
        }
        true
    }

    /// The next record; `None` at the end of the stream.
    fn next(&mut self) -> Option<&[u8]> {
        if !self.fill(4) {
            return None;
        }
        let length = u32::from_le_bytes(*self.bytes.first_chunk()?) as usize;
        if length > 0 && !self.fill(length) {
            fail("stream.bin is cut in the middle of a record");
        }
        self.bytes.get(..length)
    }
}

/// Processes the rest of a part.
#[inline(never)]
fn wake<E: Sleeper>(kind: u8, records: &mut Records) {
    let Some(snapshot) = records.next() else { fail("no snapshot") };
    let Ok(mut estimator) = load::<E>(snapshot) else { fail("the snapshot is refused") };
    let (mut samples, mut said) = (0, Digest::NONE);
    while let Some(record) = records.next() {
        if record.is_empty() {
            break;
        }
        let Ok(sample) = postcard::from_bytes::<Sample>(record) else { fail("no sample") };
        said = said.and(estimator.take(&sample));
        samples += 1;
    }
    let Ok(asleep) = store(&estimator, &mut records.bytes) else { fail("no room to sleep") };
    let stored = asleep.iter().fold(Digest::NONE, |digest, &byte| digest.and(u64::from(byte)));
    let numbers = [said.0, asleep.len() as u64, stored.0].map(|number| number as i64);
    let [said, length, stored] = numbers;
    line("woken", &[kind.into(), samples, said, length, stored]);
}

fn run() {
    let Ok(file) = File::open(c"stream.bin") else { fail("no stream.bin") };
    let mut records = Records { file, bytes: [0; ROOM] };
    while let Some(&[kind]) = records.next() {
        let records = &mut records;
        match kind {
            0 => wake::<Tracker<f32, Ekf<f32>>>(kind, records),
            1 => wake::<Tracker<f32, Lite<f32>>>(kind, records),
            2 => wake::<Tracker<Q12_20, Ekf<Q12_20>>>(kind, records),
            3 => wake::<kestirim_uwb_tracker::Tracker<f32, 2, 4, 4>>(kind, records),
            4 => wake::<kestirim_uwb_tracker::Tracker<Q12_20, 2, 4, 4>>(kind, records),
            5 => wake::<kestirim_uwb_tracker::WheelTracker<f32, 4>>(kind, records),
            6 => wake::<Drawing<PublishedLocator<f32, 500>>>(kind, records),
            7 => wake::<Drawing<PublishedLocator<Q16_16, 500>>>(kind, records),
            8 => wake::<Drawing<kestirim_user_locator::Tracker<f32, 500>>>(kind, records),
            9 => wake::<Locator<f32, 500, 32>>(kind, records),
            10 => wake::<kestirim_luenberger::Predictor<f32, 4, 2, 3>>(kind, records),
            11 => wake::<kestirim_luenberger::Predictor<Q16_16, 4, 2, 3>>(kind, records),
            12 => wake::<FlightFilter<f32, 3>>(kind, records),
            13 => wake::<FlightObserver<f32, 3>>(kind, records),
            14 => wake::<PppFilter<{ states(SATELLITES) }>>(kind, records),
            _ => fail("an estimator that is not known"),
        }
    }
}

image!(run);
