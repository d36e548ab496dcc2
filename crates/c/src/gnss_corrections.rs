//! Satellite states from broadcast ephemerides with a service's corrections.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_gnss_message::frame_data;
use kestirim_gnss_message::ssr::{Message, System};
use kestirim_ppp_filter::Corrected;

use crate::gnss_broadcast::{GnssBroadcast, MOST_BROADCAST, satellite_state};
use crate::memory::{self, Handle, argument, array, held, held_mut, place, status};
use crate::{GnssSatellite, GnssTime, Status};

/// Corrections: those of a service (SSR in RTCM 3) for the satellites of an ephemeris collection. With them positions become as
/// good as the service is, a decimetre or less, without files. The filter's `broadcast` is 1 with them, too. It computes in double precision, for processors with enough memory.
#[derive(Debug)]
pub struct GnssCorrections {
    _private: [u8; 0],
}

impl Handle for GnssCorrections {
    type Value = Corrected<MOST_BROADCAST>;
    const TAG: u32 = 0x6B50_4703;
}

/// Upper bound of the size of corrections on any target, bytes: for static memory.
pub const GNSS_CORRECTIONS_SIZE: usize = 20480;
const _: () = assert!(memory::size::<GnssCorrections>() <= GNSS_CORRECTIONS_SIZE);

/// Size of corrections on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_corrections_size() -> usize {
    memory::size::<GnssCorrections>()
}

/// Alignment of the memory of corrections on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_corrections_align() -> usize {
    memory::align::<GnssCorrections>()
}

/// Creates corrections of no satellite in memory of at least `kestirim_gnss_corrections_size()` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_corrections_init(
    memory: *mut c_void,
    size: usize,
    corrections: *mut *mut GnssCorrections,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::init(memory, size, corrections, || Ok(Corrected::new())) }
}

/// Processes a frame of RTCM 3, from its preamble to its checksum: messages 1057, 1058 and 1060 of GPS, 1240, 1241 and 1243 of
/// Galileo, and 4076 of the IGS for both. `broadcast` has the ephemerides received until now, and `received` is the time of the
/// last epoch, which determines the week. In it and in observations, satellite n of GPS has the number n + `gps`, and satellite n
/// of Galileo n + `galileo`; a satellite whose number would exceed 255 is left out. Corrections of codes are not applied.
///
/// Errors: `DAMAGED_MESSAGE` for a wrong checksum or another message, both of which occur in streams: continue with the next
/// frame; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_corrections_take(
    corrections: *mut GnssCorrections,
    broadcast: *const GnssBroadcast,
    frame: *const u8,
    length: usize,
    gps: u8,
    galileo: u8,
    received: *const GnssTime,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (corrections, broadcast, frame, received) = unsafe {
            (held_mut(corrections)?, held(broadcast)?, array(frame, length)?, argument(received)?)
        };
        if !received.second.is_finite() {
            return Err(Status::NotFinite);
        }
        let message =
            frame_data(frame).and_then(Message::from_data).ok_or(Status::DamagedMessage)?;
        let offset = match message.header.system {
            System::Gps => gps,
            System::Galileo => galileo,
        };
        corrections.take(&message, |it| it.checked_add(offset), broadcast, received.instant());
        Ok(())
    })
}

/// State of a satellite at the transmission of a signal, from its corrected ephemeris. `broadcast` has the ephemerides received
/// until now, by which the satellite may be unhealthy; `received` is the time of reception by
/// the receiver's clock, and `code` the code observation on the first carrier (m). The position is that of the antenna's phase
/// centre, so `antenna` must be null in the observation.
///
/// Errors: `GAP` while no corrections of a received ephemeris serve at that time; `UNHEALTHY`; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_corrections_at(
    corrections: *const GnssCorrections,
    broadcast: *const GnssBroadcast,
    satellite: u8,
    received: *const GnssTime,
    code: f64,
    state: *mut GnssSatellite,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (corrections, broadcast, received, answer) =
            unsafe { (held(corrections)?, held(broadcast)?, argument(received)?, place(state)?) };
        if !(code.is_finite() && received.second.is_finite()) {
            return Err(Status::NotFinite);
        }
        let found = corrections.state(satellite, broadcast, received.instant(), code);
        answer.write(satellite_state(found)?);
        Ok(())
    })
}
