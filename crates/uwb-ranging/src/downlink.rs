//! Differences of distances from messages that anchors send and a tag only hears.

use crate::ticks::light_distance;
use crate::{ClockOffset, Error, TICKS_PER_SECOND, Timestamp};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// What an anchor says in its message of another's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Heard {
    /// Index of the other anchor.
    pub anchor: usize,
    /// Number of the message that it heard.
    pub sequence: u8,
    /// When it received that message, on its own clock; 32 bits will do.
    pub received: Timestamp,
}

/// A message of an anchor as a tag received it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Broadcast<'a> {
    /// When the tag received it (µs since any moment): tells stamps that look alike after the counter went round.
    pub time_us: u64,
    /// Index of the anchor.
    pub anchor: usize,
    /// Number of the message, which goes round at 256 or earlier.
    pub sequence: u8,
    /// When the anchor sent it, on its own clock; 32 bits will do.
    pub sent: Timestamp,
    /// When the tag received it, on the tag's clock, 40 bits.
    pub received: Timestamp,
    /// What the anchor heard of the others before.
    pub heard: &'a [Heard],
}

/// By how much one anchor is farther from the tag than another.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Difference<T> {
    /// Indices of two anchors: the one whose message was received earlier, and the other.
    pub anchors: [usize; 2],
    /// Distance to the second less distance to the first, m.
    pub difference: T,
    /// Its variance, m².
    pub variance: T,
}

/// Downlink TDOA (Ledergerber, Hamer and D'Andrea 2015, IROS; Crazyflie's TDOA 2 and 3): A anchors at known places send, and
/// say when they received each other's messages; any number of tags only listen.
///
/// Anchor *n* sends at t, on its clock, and received *r*'s message at s; the tag received both at T and S, on its own. Then
/// |p − n| − |p − r| = c ((T − S) (1 + o) − (t − s)) − |n − r|, with the rate o of n's clock against the tag's from two of n's
/// own messages a quarter to half a second apart. Stamps remain integers up to the metres.
///
/// The messages of all anchors that *n* heard tie its arrival to theirs, and the mean counts: so the anchors' own errors
/// average, and those of the tag's receptions remain.
///
/// What anchors' antennas delay stays in the difference as half of it, each with its sign, as a bias of each anchor does.
#[derive(Clone, Debug)]
pub struct Downlink<T: Scalar, const A: usize> {
    places: [SVector<T, 3>; A],
    /// Standard deviations of a reception's stamp, m, at the tag and at an anchor.
    sigmas: [T; 2],
    last: [Option<Track<T>>; A],
    /// Anchor of the latest message whose arrival is known, from which arrivals count.
    latest: Option<usize>,
}

/// What is kept of an anchor.
#[derive(Clone, Copy, Debug)]
struct Track<T> {
    time_us: u64,
    sequence: u8,
    message: Stamps,
    /// Two earlier messages, by the older of which the clock is measured.
    bases: [Stamps; 2],
    /// How much later it arrived than the latest message, m, after the time that went by between them: distance and the errors
    /// of both receptions.
    arrival: Option<T>,
}

/// The same of a new message, and its variance, m².
#[derive(Clone, Copy)]
struct Arrival<T> {
    metres: T,
    variance: T,
}

/// A message on two clocks.
#[derive(Clone, Copy, Debug)]
struct Stamps {
    sent: Timestamp,
    received: Timestamp,
}

/// What an anchor's clock did against the tag's over an interval of the latter.
struct Rate {
    offset: ClockOffset,
    ticks: u64,
}

const fn ticks(seconds: f64) -> u64 {
    (seconds * TICKS_PER_SECOND) as u64
}

/// An anchor that was silent for so long is begun anew (µs).
const FORGOTTEN_US: u64 = 1_000_000;
/// Interval over which a clock is measured at least before it is believed, and at which its base moves on.
const LEAST: u64 = ticks(0.05);
const BASE: u64 = ticks(0.25);
/// Two messages of which a difference is made are no farther apart.
const APART: u64 = ticks(0.1);
/// Clocks of two radios differ by no more, in units of 2⁻⁴⁰: 100 ppm, of which DW1000s allow each other 40.
const LARGEST_OFFSET: i32 = 109_951_163;
/// Beyond the anchors' own distance, which no difference exceeds, m.
const MARGIN: f64 = 1.0;

impl Stamps {
    /// How the sender's clock went from an earlier message to this one; none if that is too short to say.
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

/// By how much an interval of one clock is longer than the same on another, of which 32 bits tell: ± 33 ms.
const fn gained(local: u64, remote: u64) -> i32 {
    local.wrapping_sub(remote) as i32
}

impl<T: Scalar, const A: usize> Downlink<T, A> {
    /// For anchors at these places, m, before the first message.
    ///
    /// A stamp's standard deviation, m, is that of the tag and that of the anchors, which see each other.
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

    /// Takes in a message, and makes a difference of it and the last one of another anchor that made one, or could have; none
    /// while the clock of its sender is not known yet, or where it heard nothing that the tag heard, too.
    ///
    /// Differences follow each other: each begins with the reception that ended the last one, so their errors are not
    /// independent, which whoever takes them may know.
    ///
    /// # Errors
    /// [`Error::NoSuchAnchor`]; [`Error::Repeated`] for a message that is not newer than the last one of its anchor;
    /// [`Error::ImplausibleClock`] for a clock that goes wrong by more than 100 ppm; [`Error::ImplausibleDifference`] where
    /// nothing is left but differences that are larger than the anchors' distance. An anchor that begins anew is refused for a
    /// second.
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
        // From now on arrivals count from this one.
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

    /// How much later a message arrived than the latest one, after the time that went by between them.
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

    /// The difference of the distances to the anchor of a message and to one that it heard; none if there is no such place.
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

    /// The message that an anchor heard, if the tag heard it, too, and knows its arrival.
    fn heard_too(&self, message: &Broadcast<'_>, heard: &Heard) -> Option<(&Track<T>, T)> {
        let track = self.last.get(heard.anchor)?.as_ref()?;
        let is_same = track.sequence == heard.sequence && is_near(track, message);
        track.arrival.filter(|_| is_same).map(|arrival| (track, arrival))
    }

    /// Whether any arrival is known to which one of this message could be tied.
    fn is_known(&self, message: &Broadcast<'_>) -> bool {
        let mut known = self.last.iter().flatten();
        known.any(|track| track.arrival.is_some() && is_near(track, message))
    }

    /// Of two receptions of the tag, the later of which also ends the interval by which its sender's clock is known, and of
    /// those of anchors that tie them.
    fn variance(&self, remote: u64, rate: &Rate, share: T) -> T {
        let part = T::from_f32(remote as f32 / rate.ticks as f32);
        let rest = T::ONE - part;
        let [tag, anchor] = self.sigmas;
        let ties = (share + share).min(T::ONE);
        tag * tag * (rest * rest + part * part + T::ONE) + anchor * anchor * ties
    }
}

/// Whether a message was received within a tenth of a second before another.
fn is_near<T>(track: &Track<T>, message: &Broadcast<'_>) -> bool {
    is_fresh(track, message.time_us)
        && message.received.since(track.message.received).get() <= APART
}

fn is_fresh<T>(track: &Track<T>, time_us: u64) -> bool {
    time_us.saturating_sub(track.time_us) <= FORGOTTEN_US
}
