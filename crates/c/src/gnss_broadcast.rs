//! Satellite states from broadcast ephemerides.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_gnss_message::{beidou, galileo, gps};
use kestirim_gnss_ppp::SatelliteState;
use kestirim_ppp_filter::{Broadcast, MessagePart, NoEphemeris};
use kestirim_scalar::Components;

use crate::gnss::carriers;
use crate::memory::{self, Handle, argument, array, held, held_mut, place, status, wanted};
use crate::{GnssSatellite, GnssTime, Status};

/// Largest number of satellites whose ephemerides are kept, of all systems together. A further one is left out until
/// another has not been heard for five minutes.
pub const MOST_BROADCAST: usize = 40;

/// An ephemeris collection: ephemerides assembled from the navigation messages that satellites broadcast. With them a
/// receiver needs no service, and its position is good to metres. It computes in double precision, for processors with
/// enough memory.
#[derive(Debug)]
pub struct GnssBroadcast {
    _private: [u8; 0],
}

impl Handle for GnssBroadcast {
    type Value = Broadcast<MOST_BROADCAST>;
    const TAG: u32 = 0x6B50_4702;
}

/// Upper bound of the size of an ephemeris collection on any target, bytes: for static memory.
pub const GNSS_BROADCAST_SIZE: usize = 16384;
const _: () = assert!(memory::size::<GnssBroadcast>() <= GNSS_BROADCAST_SIZE);

/// Navigation messages from which ephemerides can be collected.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GnssMessage {
    /// LNAV of GPS on L1 C/A: a subframe of 10 words of 30 bits, right aligned, parity last.
    Lnav = 0,
    /// I/NAV of Galileo on E1-B or E5b-I: a page of 8 words of 32 bits, the even part first.
    Inav = 1,
    /// D1 of BeiDou on B1I, B2I or B3I: a subframe of 10 words of 30 bits, right aligned, parity last. The
    /// geostationary C01 to C05 and C59 to C63 send D2 instead.
    D1 = 2,
}

fn words<const N: usize>(words: &[u32]) -> Result<&[u32; N], Status> {
    words.first_chunk().ok_or(Status::TooFew)
}

fn part(message: u32, given: &[u32]) -> Result<MessagePart, Status> {
    Ok(match message {
        0 => MessagePart::Gps(
            gps::Subframe::from_words(words(given)?).ok_or(Status::DamagedMessage)?,
        ),
        1 => {
            let word = galileo::Word::from_page(words(given)?);
            MessagePart::Galileo(word.ok_or(Status::DamagedMessage)?)
        }
        2 => MessagePart::BeiDou(
            beidou::Subframe::from_words(words(given)?).ok_or(Status::DamagedMessage)?,
        ),
        _ => return Err(Status::InvalidArgument),
    })
}

/// Size of an ephemeris collection on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_broadcast_size() -> usize {
    memory::size::<GnssBroadcast>()
}

/// Alignment of an ephemeris collection's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_broadcast_align() -> usize {
    memory::align::<GnssBroadcast>()
}

/// Creates an ephemeris collection without satellites in memory of at least `kestirim_gnss_broadcast_size()` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_broadcast_init(
    memory: *mut c_void,
    size: usize,
    broadcast: *mut *mut GnssBroadcast,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::init(memory, size, broadcast, || Ok(Broadcast::new())) }
}

/// Processes a part of a satellite's navigation message, as a receiver outputs it (UBX-RXM-SFRBX): `message` is a
/// `kestirim_gnss_message`, `words` are its `count` words, and `received` is the time of the last epoch, which
/// determines the week. `satellite` is the same number as in the satellite's observations. `complete` receives 1 if the
/// part completes an ephemeris, else 0; it may be null.
///
/// Errors: `TOO_FEW` words; `DAMAGED_MESSAGE` for a wrong checksum, an alert, or a part of another message, all of
/// which occur in streams: continue with the next part; `INVALID_ARGUMENT` for an unknown message; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_broadcast_take(
    broadcast: *mut GnssBroadcast,
    satellite: u8,
    message: u32,
    words: *const u32,
    count: usize,
    received: *const GnssTime,
    complete: *mut u8,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (broadcast, words, received, answer) = unsafe {
            (held_mut(broadcast)?, array(words, count)?, argument(received)?, wanted(complete)?)
        };
        if !received.second.is_finite() {
            return Err(Status::NotFinite);
        }
        let part = part(message, words)?;
        let is_complete = broadcast.take(satellite, part, received.instant());
        if let Some(answer) = answer {
            answer.write(is_complete.into());
        }
        Ok(())
    })
}

/// State of a satellite at the transmission of a signal, from its broadcast ephemeris. `received` is the time of
/// reception by the receiver's clock, `code` the code observation on the first carrier (m), and `on` the two observed
/// carriers, a `kestirim_gnss_carriers`. The position is that of the antenna's phase centre, so `antenna` must be null
/// in the observation.
///
/// Errors: `GAP` while no ephemeris is complete or valid at that time; `UNHEALTHY`; `NO_GROUP_DELAY` if the message has
/// none for these carriers; `INVALID_ARGUMENT` for carriers; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_broadcast_at(
    broadcast: *const GnssBroadcast,
    satellite: u8,
    on: u32,
    received: *const GnssTime,
    code: f64,
    state: *mut GnssSatellite,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (broadcast, received, answer) =
            unsafe { (held(broadcast)?, argument(received)?, place(state)?) };
        if !(code.is_finite() && received.second.is_finite()) {
            return Err(Status::NotFinite);
        }
        let found = broadcast.state(satellite, carriers(on, 0)?, received.instant(), code);
        answer.write(satellite_state(found)?);
        Ok(())
    })
}

/// A satellite's state as C has it, or the status for the reason why there is none.
pub(crate) fn satellite_state(
    found: Result<SatelliteState, NoEphemeris>,
) -> Result<GnssSatellite, Status> {
    let state = found.map_err(|reason| match reason {
        NoEphemeris::Unhealthy => Status::Unhealthy,
        NoEphemeris::Carriers => Status::NoGroupDelay,
        _ => Status::Gap,
    })?;
    Ok(GnssSatellite {
        position: *state.position.as_array(),
        velocity: *state.velocity.as_array(),
        clock: state.clock,
        clock_interval: state.clock_interval,
        clock_distance: state.clock_distance,
        accuracy: state.accuracy,
    })
}
