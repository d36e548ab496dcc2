//! Recorded receiver streams: RTCM 3 and UBX.

#[cfg(feature = "ubx")]
mod dated;
mod frames;
#[cfg(feature = "rtcm")]
mod rtcm;
#[cfg(all(test, any(feature = "rtcm", feature = "ubx")))]
pub(crate) mod tests;
#[cfg(feature = "ubx")]
mod ubx;

use std::collections::BTreeMap;
use std::mem::take;

pub(crate) use self::frames::{first_of_rtcm, is_ubx};
use crate::error::{Error, Warning};
use crate::kind::Kind;
use crate::navigation::Ephemeris;
use crate::observations::Raw;
#[cfg(any(feature = "rtcm", feature = "ubx"))]
use crate::observations::Signal;
use crate::ssr::SsrCorrection;
use crate::text::Text;
use crate::time::GpsTime;
use crate::unserved::Unserved;

/// A satellite with all its signals.
pub(crate) type Signals = (u8, Vec<Raw>);

/// The contents of a stream.
#[derive(Debug, Default)]
pub(crate) struct Stream {
    /// Epochs in the order of the stream.
    pub(crate) epochs: Vec<(GpsTime, Vec<Signals>)>,
    /// The frequency channels of GLONASS satellites, by satellite number.
    pub(crate) channels: BTreeMap<u8, i8>,
    /// Ephemerides, with the numbers of their satellites.
    pub(crate) ephemerides: Vec<(u8, Ephemeris)>,
    /// Corrections of ephemerides, in the order of the stream.
    pub(crate) corrections: Vec<SsrCorrection>,
    /// The coefficients α and β of Klobuchar's model.
    pub(crate) ionosphere: Option<[[f64; 4]; 2]>,
    /// The number of messages passed over: other systems, other content.
    pub(crate) skipped: usize,
    /// The observed satellites of systems that are not read.
    pub(crate) observed: Unserved,
    /// The satellites with ephemerides that are not read.
    pub(crate) unread: Unserved,
    /// Warnings about the stream.
    pub(crate) warnings: Vec<Warning>,
}

impl Stream {
    /// The contents of a file if it is a recorded stream; `None` if it is not.
    ///
    /// # Errors
    /// [`Error::File`] if the stream cannot be interpreted.
    pub(crate) fn of(text: &Text) -> Result<Option<Self>, Error> {
        match Kind::of(text.bytes()) {
            #[cfg(feature = "ubx")]
            Some(Kind::Ubx) => Ok(Some(ubx::read(text))),
            #[cfg(feature = "rtcm")]
            Some(Kind::Rtcm | Kind::Corrections) => rtcm::read(text).map(Some),
            _ => Ok(None),
        }
    }

    /// Moves the broadcast data into a stream of their own, leaving the observations.
    pub(crate) fn take_broadcast(&mut self) -> Self {
        Self {
            ephemerides: take(&mut self.ephemerides),
            corrections: take(&mut self.corrections),
            ionosphere: self.ionosphere.take(),
            skipped: take(&mut self.skipped),
            unread: take(&mut self.unread),
            ..Self::default()
        }
    }
}

/// The length of a week, ms.
#[cfg(any(feature = "rtcm", feature = "ubx"))]
const WEEK_MS: i64 = 604_800_000;

/// Detects loss of lock on phases between observations, from how long they have been tracked.
#[cfg(any(feature = "rtcm", feature = "ubx"))]
#[derive(Debug, Default)]
struct Locks(BTreeMap<(u8, Signal), (i64, u32)>);

#[cfg(any(feature = "rtcm", feature = "ubx"))]
impl Locks {
    /// The tracking time for longer than a message can express.
    const LONGEST: u32 = u32::MAX;

    /// Whether lock was lost on a phase that at `time` (ms of the week) has been tracked for at least `tracked` ms: for
    /// less than before, or for less than the time since the preceding observation.
    fn lost(&mut self, satellite: u8, signal: Signal, time: i64, tracked: u32) -> bool {
        let before = self.0.insert((satellite, signal), (time, tracked));
        before.is_some_and(|(then, before)| {
            let elapsed = (time - then).rem_euclid(WEEK_MS);
            let is_shorter = tracked != Self::LONGEST && i64::from(tracked) < elapsed;
            tracked < before || is_shorter
        })
    }
}
