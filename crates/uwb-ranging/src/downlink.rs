//! Differences of distances (TDOA), from messages that anchors send and a tag only receives.

use crate::ticks::light_distance;
use crate::{ClockOffset, Error, TICKS_PER_SECOND, Timestamp};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// An anchor's report, in its own message, of another anchor's message that it received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Heard {
    /// Index of the other anchor.
    pub anchor: usize,
    /// Sequence number of the message that was heard.
    pub sequence: u8,
    /// Time of reception of that message on the reporting anchor's clock; 32 bits suffice.
    pub received: Timestamp,
}

/// A message of an anchor, as received by a tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Broadcast<'a> {
    /// Time of reception at the tag (µs from any epoch): distinguishes timestamps that look alike after a counter
    /// wrap.
    pub time_us: u64,
    /// Index of the sending anchor.
    pub anchor: usize,
    /// Sequence number of the message, which wraps at 256 or earlier.
    pub sequence: u8,
    /// Time of transmission on the anchor's clock; 32 bits suffice.
    pub sent: Timestamp,
    /// Time of reception on the tag's clock, 40 bits.
    pub received: Timestamp,
    /// Messages of the other anchors that the sender received before.
    pub heard: &'a [Heard],
}

/// The difference of a tag's distances to two anchors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Difference<T> {
    /// Indices of the two anchors: first the one whose message was received earlier, then the other.
    pub anchors: [usize; 2],
    /// Distance to the second anchor minus distance to the first, m.
    pub difference: T,
    /// Variance of the difference, m².
    pub variance: T,
}

/// Downlink TDOA (Ledergerber, Hamer and D'Andrea 2015, IROS; Crazyflie's TDOA 2 and 3).
///
/// A anchors at known positions transmit, and report when they received each other's messages; any number of tags
/// only listen.
///
/// Anchor *n* sends at t on its clock and received *r*'s message at s; the tag received the two messages at T and S
/// on its own clock. Then |p − n| − |p − r| = c ((T − S) (1 + o) − (t − s)) − |n − r|, with the rate o of n's clock
/// against the tag's from two of n's own messages, a quarter to half a second apart. Timestamps remain integers up
/// to the conversion to metres.
///
/// The messages of all anchors that *n* heard tie its arrival to theirs, and the mean is taken: the anchors' own
/// errors average out, and those of the tag's receptions remain.
///
/// Half of each anchor's antenna delay remains in the difference, with that anchor's sign, as any bias of an anchor
/// does.
#[derive(Clone, Debug)]
pub struct Downlink<T: Scalar, const A: usize> {
    places: [SVector<T, 3>; A],
    /// Standard deviations of a reception timestamp, m: the tag's and the anchors'.
    sigmas: [T; 2],
    last: [Option<Track<T>>; A],
    /// Anchor of the latest message whose arrival is known, relative to which arrivals are counted.
    latest: Option<usize>,
}

/// The state kept per anchor.
#[derive(Clone, Copy, Debug)]
struct Track<T> {
    time_us: u64,
    sequence: u8,
    message: Stamps,
    /// Two earlier messages; the clock's rate is measured from the older one.
    bases: [Stamps; 2],
    /// How much later its message arrived than the latest one, m, beyond the time that passed between the two
    /// transmissions: the difference of the distances and the errors of both receptions.
    arrival: Option<T>,
}

/// How much later a new message arrived than the latest one, and the variance of that, m².
#[derive(Clone, Copy)]
struct Arrival<T> {
    metres: T,
    variance: T,
}

/// The timestamps of a message on the sender's and on the receiver's clock.
#[derive(Clone, Copy, Debug)]
struct Stamps {
    sent: Timestamp,
    received: Timestamp,
}

/// The rate of an anchor's clock against the tag's, over an interval (ticks) of the tag's.
struct Rate {
    offset: ClockOffset,
    ticks: u64,
}

const fn ticks(seconds: f64) -> u64 {
    (seconds * TICKS_PER_SECOND) as u64
}

/// An anchor that was silent for longer than this starts afresh, µs.
const FORGOTTEN_US: u64 = 1_000_000;
/// Shortest interval over which a clock's rate is measured (`LEAST`), and the spacing of its base messages
/// (`BASE`), in ticks.
const LEAST: u64 = ticks(0.05);
const BASE: u64 = ticks(0.25);
/// Longest interval between two messages that form a difference, in ticks.
const APART: u64 = ticks(0.1);
/// Largest plausible rate difference of two radios' clocks, in units of 2⁻⁴⁰: 100 ppm; two DW1000s may differ by 40
/// ppm.
const LARGEST_OFFSET: i32 = 109_951_163;
/// Margin by which a difference may exceed the distance between the anchors, its geometric limit, m.
const MARGIN: f64 = 1.0;

impl Stamps {
    /// The rate of the sender's clock from an earlier message to this one; `None` if the interval is too short.
    fn rate_since(&self, base: &Self) -> Result<Option<Rate>, Error> {
        let remote = self.received.since(base.received).get();
        if remote < LEAST {
            return Ok(None);
        }
        let drift = gained(self.sent.since(base.sent).get(), remote);
        let local = (remote as i64).wrapping_add(i64::from(drift));
        let offset = ClockOffset::between(local, remote as i64)?;
        if offset.to_bits().unsigned_abs() > LARGEST_OFFSET.unsigned_abs() {
            return Err(Error::ImplausibleClock);
        }
        Ok(Some(Rate { offset, ticks: remote }))
    }
}

/// The excess of an interval on one clock over the same interval on another; 32 bits cover ±33 ms.
const fn gained(local: u64, remote: u64) -> i32 {
    local.wrapping_sub(remote) as i32
}

impl<T: Scalar, const A: usize> Downlink<T, A> {
    /// Creates the state before the first message, for anchors at these positions (m).
    ///
    /// `tag_sigma` and `anchor_sigma` are the standard deviations (m) of a reception timestamp at the tag and at
    /// the anchors, which see each other.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::NotPositive`].
    pub fn new(places: [SVector<T, 3>; A], tag_sigma: T, anchor_sigma: T) -> Result<Self, Error> {
        let sigmas = [tag_sigma, anchor_sigma];
        if !(places.iter().all(|place| T::all_finite(place.as_array())) && T::all_finite(&sigmas)) {
            return Err(Error::NotFinite);
        }
        if tag_sigma <= T::ZERO || anchor_sigma < T::ZERO {
            return Err(Error::NotPositive);
        }
        Ok(Self { places, sigmas, last: [None; A], latest: None })
    }

    /// Processes a message, and returns the difference between its anchor and that of the latest message with a
    /// known arrival.
    ///
    /// `None` while the clock of the sender is not known yet, or if it heard nothing that the tag heard, too.
    /// Successive differences share receptions: each begins with the reception that ended the previous one, so
    /// their errors are correlated, which the user of the differences may account for.
    ///
    /// # Errors
    /// [`Error::NoSuchAnchor`]; [`Error::Repeated`] for a message that is not newer than the last one of its
    /// anchor; [`Error::ImplausibleClock`] for a clock that is off by more than 100 ppm;
    /// [`Error::ImplausibleDifference`] if all differences exceed the distance between the anchors. An anchor that
    /// restarts is refused for a second.
    pub fn take(&mut self, message: &Broadcast<'_>) -> Result<Option<Difference<T>>, Error> {
        let stamps = Stamps { sent: message.sent, received: message.received };
        let fresh = self.last.get(message.anchor).ok_or(Error::NoSuchAnchor)?;
        let fresh = fresh.filter(|track| is_fresh(track, message.time_us));
        let (mut bases, mut arrival) = ([stamps; 2], None);
        if let Some(track) = fresh {
            if message.time_us < track.time_us || message.sequence == track.sequence {
                return Err(Error::Repeated);
            }
            bases = track.bases;
            if let Some(rate) = stamps.rate_since(&bases[0])? {
                arrival = self.arrival(message, &rate)?;
            }
            if stamps.received.since(bases[1].received).get() >= BASE {
                bases = [bases[1], stamps];
            }
        }
        let (time_us, sequence) = (message.time_us, message.sequence);
        let track = Track { time_us, sequence, message: stamps, bases, arrival: None };
        let begins = arrival.is_none() && !self.is_known(message);
        if let Some(last) = self.last.get_mut(message.anchor) {
            *last = Some(track);
        }
        if arrival.is_none() && !begins {
            return Ok(None);
        }
        let found = arrival.and_then(|arrival| {
            let first = self.latest.filter(|&latest| latest != message.anchor)?;
            let anchors = [first, message.anchor];
            Some(Difference { anchors, difference: arrival.metres, variance: arrival.variance })
        });
        // From now on arrivals are relative to this message.
        let metres = arrival.map_or(T::ZERO, |arrival| arrival.metres);
        for known in self.last.iter_mut().flatten() {
            known.arrival = known.arrival.map(|arrival| arrival - metres);
        }
        if let Some(Some(last)) = self.last.get_mut(message.anchor) {
            last.arrival = Some(T::ZERO);
        }
        self.latest = Some(message.anchor);
        Ok(found)
    }

    /// The offset of an anchor's clock against the tag's, once it is known.
    pub fn clock_offset(&self, anchor: usize) -> Option<ClockOffset> {
        let track = self.last.get(anchor)?.as_ref()?;
        let rate = track.message.rate_since(&track.bases[0]).ok()??;
        Some(rate.offset)
    }

    /// How much later a message arrived than the latest one, beyond the time that passed between their
    /// transmissions.
    fn arrival(&self, message: &Broadcast<'_>, rate: &Rate) -> Result<Option<Arrival<T>>, Error> {
        let (mut sum, mut count, mut farthest) = (T::ZERO, 0, 0);
        let mut is_implausible = false;
        for heard in message.heard.iter().filter(|heard| heard.anchor != message.anchor) {
            let Some((track, known)) = self.heard_too(message, heard) else { continue };
            let remote = message.received.since(track.message.received).get();
            match self.between(message, heard, (remote, rate)) {
                Some(difference) => {
                    sum += known + difference;
                    count += 1;
                    farthest = farthest.max(remote);
                }
                None => is_implausible = true,
            }
        }
        if count == 0 {
            return if is_implausible { Err(Error::ImplausibleDifference) } else { Ok(None) };
        }
        let share = T::from_micro(count.min(2000) * 1_000_000).recip();
        let variance = self.variance(farthest, rate, share);
        Ok(Some(Arrival { metres: sum * share, variance }))
    }

    /// The difference of the distances to the sender of a message and to an anchor that it heard; `None` if it is
    /// implausible.
    fn between(
        &self,
        message: &Broadcast<'_>,
        heard: &Heard,
        (remote, rate): (u64, &Rate),
    ) -> Option<T> {
        let shorter = gained(message.sent.since(heard.received).get(), remote).wrapping_neg();
        let offset = i128::from(rate.offset.to_bits()).wrapping_mul(i128::from(remote));
        let numerator = (i128::from(shorter) << ClockOffset::FRACTION).wrapping_add(offset);
        let (place, other) = (self.places.get(message.anchor)?, self.places.get(heard.anchor)?);
        let apart = T::norm((place - other).as_array());
        let difference = light_distance::<T>(numerator, 1 << ClockOffset::FRACTION) - apart;
        (difference.abs() <= apart + T::from_f64(MARGIN)).then_some(difference)
    }

    /// The message that an anchor heard and its arrival, if the tag heard it, too, and knows its arrival.
    fn heard_too(&self, message: &Broadcast<'_>, heard: &Heard) -> Option<(&Track<T>, T)> {
        let track = self.last.get(heard.anchor)?.as_ref()?;
        let is_same = track.sequence == heard.sequence && is_near(track, message);
        track.arrival.filter(|_| is_same).map(|arrival| (track, arrival))
    }

    /// Whether an arrival is known to which this message's could be related.
    fn is_known(&self, message: &Broadcast<'_>) -> bool {
        let mut known = self.last.iter().flatten();
        known.any(|track| track.arrival.is_some() && is_near(track, message))
    }

    /// The variance of an arrival: of two receptions at the tag, the later of which also ends the interval over
    /// which the sender's clock is measured, and of the anchors' receptions that relate them.
    fn variance(&self, remote: u64, rate: &Rate, share: T) -> T {
        let part = T::from_f32(remote as f32 / rate.ticks as f32);
        let rest = T::ONE - part;
        let [tag, anchor] = self.sigmas;
        let ties = (share + share).min(T::ONE);
        tag * tag * (rest * rest + part * part + T::ONE) + anchor * anchor * ties
    }
}

/// Whether the last message of `track` was received within a tenth of a second before `message`.
fn is_near<T>(track: &Track<T>, message: &Broadcast<'_>) -> bool {
    is_fresh(track, message.time_us)
        && message.received.since(track.message.received).get() <= APART
}

fn is_fresh<T>(track: &Track<T>, time_us: u64) -> bool {
    time_us.saturating_sub(track.time_us) <= FORGOTTEN_US
}
