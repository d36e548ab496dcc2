//! Streams of receivers as they were recorded: RTCM 3 and UBX.

#[cfg(any(feature = "rtcm", feature = "ubx"))]
mod bits;
#[cfg(feature = "ubx")]
mod collection;
mod frames;
#[cfg(feature = "ubx")]
mod inav;
#[cfg(any(feature = "rtcm", feature = "ubx"))]
mod indices;
#[cfg(feature = "ubx")]
mod lnav;
#[cfg(feature = "rtcm")]
mod rtcm;
#[cfg(all(test, any(feature = "rtcm", feature = "ubx")))]
pub(crate) mod tests;
#[cfg(feature = "ubx")]
mod ubx;

use std::collections::BTreeMap;
use std::mem::take;

pub(crate) use self::frames::{is_rtcm, is_ubx};
use crate::error::{Error, Warning};
use crate::kind::Kind;
use crate::navigation::Ephemeris;
use crate::observations::Raw;
#[cfg(any(feature = "rtcm", feature = "ubx"))]
use crate::observations::Signal;
use crate::text::Text;
use crate::time::GpsTime;
use crate::unserved::Unserved;

/// A satellite with all its signals.
pub(crate) type Signals = (u8, Vec<Raw>);

/// What a stream held.
#[derive(Debug, Default)]
pub(crate) struct Stream {
    /// Epochs in the order of the stream.
    pub(crate) epochs: Vec<(GpsTime, Vec<Signals>)>,
    /// Of satellites of GLONASS, by number.
    pub(crate) channels: BTreeMap<u8, i8>,
    /// Ephemerides with the numbers of their satellites.
    pub(crate) ephemerides: Vec<(u8, Ephemeris)>,
    /// α and β of Klobuchar's model.
    pub(crate) ionosphere: Option<[[f64; 4]; 2]>,
    /// How many messages were passed over: other systems, other things.
    pub(crate) skipped: usize,
    /// Which satellites were observed whose systems are not served.
    pub(crate) observed: Unserved,
    /// Which satellites sent ephemerides that are not read.
    pub(crate) unread: Unserved,
    /// Warnings about it.
    pub(crate) warnings: Vec<Warning>,
}

impl Stream {
    /// What a file holds if it is a recorded stream, and none if it is none.
    ///
    /// # Errors
    /// [`Error::File`] if nothing can be made of it.
    pub(crate) fn of(text: &Text) -> Result<Option<Self>, Error> {
        match Kind::of(text.bytes()) {
            #[cfg(feature = "ubx")]
            Some(Kind::Ubx) => Ok(Some(ubx::read(text))),
            #[cfg(feature = "rtcm")]
            Some(Kind::Rtcm) => rtcm::read(text).map(Some),
            _ => Ok(None),
        }
    }

    /// Takes what the satellites broadcast out of what was observed of them.
    pub(crate) fn take_broadcast(&mut self) -> Self {
        Self {
            ephemerides: take(&mut self.ephemerides),
            ionosphere: self.ionosphere.take(),
            skipped: take(&mut self.skipped),
            unread: take(&mut self.unread),
            ..Self::default()
        }
    }
}

/// A week, ms.
#[cfg(any(feature = "rtcm", feature = "ubx"))]
const WEEK_MS: i64 = 604_800_000;

/// Tells which phases were lost since they were observed before, by for how long they have been tracked.
#[cfg(any(feature = "rtcm", feature = "ubx"))]
#[derive(Debug, Default)]
struct Locks(BTreeMap<(u8, Signal), (i64, u32)>);

#[cfg(any(feature = "rtcm", feature = "ubx"))]
impl Locks {
    /// For longer than a message can tell.
    const LONGEST: u32 = u32::MAX;

    /// Whether a phase was lost, which at `time` (ms of the week) has been tracked for at least `tracked` ms: for less than before,
    /// or not ever since it was observed before.
    fn lost(&mut self, satellite: u8, signal: Signal, time: i64, tracked: u32) -> bool {
        let before = self.0.insert((satellite, signal), (time, tracked));
        before.is_some_and(|(then, before)| {
            let elapsed = (time - then).rem_euclid(WEEK_MS);
            let is_shorter = tracked != Self::LONGEST && i64::from(tracked) < elapsed;
            tracked < before || is_shorter
        })
    }
}
