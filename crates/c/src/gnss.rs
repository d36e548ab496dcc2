//! The position of a GNSS receiver, by the filter of precise point positioning of `kestirim-ppp-filter`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use heapless::Vec;
use kestirim_gnss_ppp::{Carriers, Corrections, GpsTime, Receiver, SatelliteState};
use kestirim_ppp_filter::{
    Config, Health as Quality, Motion, PppFilter, SatelliteObservation, Solution, states,
};
use kestirim_scalar::Components;
use kestirim_snapshot::layout;
use nalgebra::SVector;

use crate::gnss_antenna::antenna;
use crate::memory::{self, Handle, argument, array, held, held_mut, place, status, wanted};
use crate::{GnssPattern, Health, Status};

/// Largest number of satellites in an epoch.
pub const MOST_SATELLITES: usize = 12;
const STATES: usize = states(MOST_SATELLITES);

/// A GNSS filter: precise point positioning of a receiver, to a centimetre, from its dual-frequency observations and
/// the orbits and clocks of a service. It computes in double precision, for processors with enough memory.
///
/// Frame: Earth-centred, Earth-fixed (ECEF, that of the orbits), m; standard deviations are to the east, north and up.
/// Times are in GPS time.
#[derive(Debug)]
pub struct Gnss {
    _private: [u8; 0],
}

/// The contents of the memory.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Positioning {
    filter: PppFilter<STATES>,
    ut1_minus_gps: f64,
    eccentricity: [f64; 3],
    last: Option<GnssSolution>,
}

layout! {
    [] for Positioning as "c/gnss", 4, f64, [STATES]
}

impl Handle for Gnss {
    type Value = Positioning;
    const TAG: u32 = 0x6B50_4701;
}

/// Upper bound of the size of a GNSS filter on any target, bytes: for static memory.
pub const GNSS_SIZE: usize = 10240;
const _: () = assert!(memory::size::<Gnss>() <= GNSS_SIZE);
/// Upper bound of the size of a GNSS filter's snapshot on any target, bytes.
pub const GNSS_SNAPSHOT: usize = GNSS_SIZE / 4 * 5 + 64;

/// Settings of a GNSS filter.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssConfig {
    /// Process noise of a moving receiver: the variance added to each coordinate per second, m²/s (1e4 for any motion).
    /// 0 for a receiver at rest.
    pub process_noise: f64,
    /// Elevation mask, rad: lower satellites are not used. 0.14 is 8 degrees.
    pub elevation_mask: f64,
    /// UT1 (or UTC) minus GPS time, s: the negative number of leap seconds since 1980, -18 since 2017.
    pub ut1_minus_gps: f64,
    /// Vector from the marker to the antenna's reference point, m: east, north, up.
    pub eccentricity: [f64; 3],
    /// Source of orbits and clocks: 0 for the products of a service, 1 for the satellites' broadcast ephemerides, corrected or not
    /// (`kestirim_gnss_corrections_at`, `kestirim_gnss_broadcast_at`), whose errors persist for hours.
    pub broadcast: u8,
}

/// An instant in GPS time.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssTime {
    /// The day, as a modified Julian date.
    pub day: i32,
    /// The second of the day.
    pub second: f64,
}

impl GnssTime {
    pub(crate) fn instant(self) -> GpsTime {
        GpsTime::new(self.day, self.second)
    }
}

/// Pairs of carriers on which a satellite can be observed.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GnssCarriers {
    /// L1 and L2 of GPS.
    L1L2 = 0,
    /// E1 and E5a of Galileo.
    E1E5a = 1,
    /// E1 and E5b of Galileo.
    E1E5b = 2,
    /// G1 and G2 of GLONASS, on the satellite's channel.
    G1G2 = 3,
    /// B1I and B3I of BeiDou.
    B1B3 = 4,
    /// B1I and B2I of BeiDou.
    B1B2 = 5,
    /// B1C and B2a of BeiDou.
    B1cB2a = 6,
}

/// State of a satellite at the time of transmission.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssSatellite {
    /// Position of the centre of mass, ECEF at the time of transmission, m; with broadcast ephemerides that of the
    /// antenna's phase centre.
    pub position: [f64; 3],
    /// Velocity of the satellite, m/s, inertial or relative to the Earth.
    pub velocity: [f64; 3],
    /// Satellite clock minus GPS time, s, without the relativistic effect of the eccentric orbit.
    pub clock: f64,
    /// Interval between the two clock samples around the time of transmission, s; 0 if the clock is not interpolated.
    pub clock_interval: f64,
    /// Time to the nearer of the two clock samples, s.
    pub clock_distance: f64,
    /// Standard deviation of a range due to this orbit and clock, m, as the satellite broadcasts it; 0 for a service's.
    pub accuracy: f64,
}

/// Observation of one satellite by the receiver in an epoch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnssObservation {
    /// Number of the satellite, unique among all systems: for example the PRN for GPS, 100 plus the number for Galileo.
    pub satellite: u8,
    /// 1 if the receiver reports a loss of lock since the epoch with a position in which this satellite was last given, else 0.
    pub lock_lost: u8,
    /// Frequency channel of a GLONASS satellite, -7 to 6; 0 for other systems.
    pub channel: i8,
    /// The two observed carriers: a `kestirim_gnss_carriers`.
    pub carriers: u32,
    /// Code observations (pseudoranges) on both carriers, m.
    pub code: [f64; 2],
    /// Carrier phases on both carriers, cycles.
    pub phase: [f64; 2],
    /// State of the satellite at the time of transmission.
    pub state: GnssSatellite,
    /// Antenna of the satellite on both carriers: two patterns, or null if they are unknown.
    pub antenna: *const [GnssPattern; 2],
}

/// Solution of a GNSS filter for one epoch.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GnssSolution {
    /// Position of the marker, ECEF, m, free of tides.
    pub position: [f64; 3],
    /// Standard deviations of the position to the east, north and up, m.
    pub sigma: [f64; 3],
    /// Receiver clock minus GPS time, m.
    pub clock: f64,
    /// Wet zenith delay of the troposphere, m.
    pub wet_delay: f64,
    /// Whether the solution can be relied upon.
    pub health: Health,
    /// 1 if the ambiguities are known: the standard deviation of the position is below 10 cm; else 0.
    pub converged: u8,
    /// Number of satellites above the elevation mask.
    pub satellites: u8,
    /// Number of observations (codes and phases) that had less than their full weight.
    pub treated: u8,
}

impl GnssSolution {
    fn of(solution: &Solution<STATES>) -> Self {
        let reports = &solution.satellites;
        let treated = |report: &kestirim_ppp_filter::SatelliteReport| {
            u8::from(report.code.was_treated()) + u8::from(report.phase.was_treated())
        };
        Self {
            position: *solution.position.as_array(),
            sigma: solution.deviations_enu(),
            clock: solution.clock,
            wet_delay: solution.wet_delay,
            health: solution.health.in_short().into(),
            converged: u8::from(solution.health == Quality::Converged),
            satellites: reports.len() as u8,
            treated: reports.iter().map(treated).fold(0, u8::saturating_add),
        }
    }
}

impl Positioning {
    fn new(config: &GnssConfig) -> Result<Self, Status> {
        let GnssConfig { process_noise, elevation_mask, ut1_minus_gps, eccentricity, broadcast } =
            *config;
        let numbers = [process_noise, elevation_mask, ut1_minus_gps];
        if !numbers.iter().chain(&eccentricity).all(|number| number.is_finite()) {
            return Err(Status::NotFinite);
        }
        if process_noise < 0.0 {
            return Err(Status::InvalidArgument);
        }
        let motion =
            if process_noise > 0.0 { Motion::Kinematic { process_noise } } else { Motion::Static };
        let config = match broadcast {
            0 => Config::new(motion),
            1 => Config::broadcast(motion),
            _ => return Err(Status::InvalidArgument),
        };
        // All states are reserved for satellites.
        let config = Config { elevation_mask, gradient: 0.0, ..config };
        Ok(Self { filter: PppFilter::new(config), ut1_minus_gps, eccentricity, last: None })
    }
}

/// The carriers of a `kestirim_gnss_carriers`; `channel` is that of a GLONASS satellite.
pub(crate) const fn carriers(number: u32, channel: i8) -> Result<Carriers, Status> {
    Ok(match number {
        0 => Carriers::L1L2,
        1 => Carriers::E1E5a,
        2 => Carriers::E1E5b,
        3 if channel >= -7 && channel <= 6 => Carriers::G1G2 { channel },
        4 => Carriers::B1B3,
        5 => Carriers::B1B2,
        6 => Carriers::B1cB2a,
        _ => return Err(Status::InvalidArgument),
    })
}

impl GnssObservation {
    /// The observation in the form of the filter.
    ///
    /// # Safety
    /// The pointer to its antenna may be read.
    unsafe fn observation<'a>(&self) -> Result<SatelliteObservation<'a>, Status> {
        let state = &self.state;
        if !state.accuracy.is_finite() || state.accuracy < 0.0 {
            return Err(Status::InvalidArgument);
        }
        Ok(SatelliteObservation {
            satellite: self.satellite,
            carriers: carriers(self.carriers, self.channel)?,
            code: self.code,
            phase: self.phase,
            lock_lost: self.lock_lost != 0,
            state: SatelliteState {
                position: SVector::from(state.position),
                velocity: SVector::from(state.velocity),
                clock: state.clock,
                clock_interval: state.clock_interval,
                clock_distance: state.clock_distance,
                accuracy: state.accuracy,
            },
            // SAFETY: the caller keeps what the header asks for.
            antenna: unsafe { antenna(self.antenna)? },
        })
    }
}

/// Size of a GNSS filter on this target, bytes. An epoch needs at most 96 kB of stack.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_size() -> usize {
    memory::size::<Gnss>()
}

/// Alignment of the GNSS filter's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_align() -> usize {
    memory::align::<Gnss>()
}

/// Creates a GNSS filter in memory of at least `kestirim_gnss_size()` bytes. It finds its first position by itself.
///
/// Errors: `NOT_FINITE`; `INVALID_ARGUMENT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_init(
    memory: *mut c_void,
    size: usize,
    config: *const GnssConfig,
    filter: *mut *mut Gnss,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::init(memory, size, filter, || Positioning::new(&argument(config)?)) }
}

/// Processes an epoch, observed at `time` by the receiver's clock: up to `KESTIRIM_MOST_SATELLITES` complete
/// observations. The clock of each system other than GPS takes the room of one satellite; satellites without room are
/// left out. `receiver` is the receiver's antenna on L1 and L2, two patterns, or null if it is unknown; it is also used
/// for the carriers of other systems. `solution` may be null. Ocean loading and the pole tide are not corrected for.
///
/// Errors: `TOO_FEW` satellites; `TOO_MANY`; `GEOMETRY`; `OUT_OF_ORDER`; `CONTRADICTORY`; `NOT_FINITE`;
/// `INVALID_ARGUMENT` for carriers, a channel, an accuracy or settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_update(
    filter: *mut Gnss,
    time: *const GnssTime,
    receiver: *const [GnssPattern; 2],
    observations: *const GnssObservation,
    count: usize,
    solution: *mut GnssSolution,
) -> Status {
    status(|| {
        let mut observed = Vec::<SatelliteObservation<'_>, MOST_SATELLITES>::new();
        // SAFETY: the caller keeps what the header asks for.
        let (positioning, time, antenna, answer) = unsafe {
            for observation in array(observations, count)? {
                observed.push(observation.observation()?).map_err(|_| Status::TooMany)?;
            }
            (held_mut(filter)?, argument(time)?, antenna(receiver)?, wanted(solution)?)
        };
        let receiver = Receiver {
            antenna,
            galileo_antenna: antenna,
            glonass_antenna: antenna,
            beidou_antenna: antenna,
            eccentricity: positioning.eccentricity,
            ocean_loading: None,
            pole: None,
            ut1_minus_gps: positioning.ut1_minus_gps,
            corrections: Corrections::ALL,
        };
        let found = positioning.filter.process(time.instant(), &receiver, &observed)?;
        let found = GnssSolution::of(&found);
        positioning.last = Some(found);
        if let Some(answer) = answer {
            answer.write(found);
        }
        Ok(())
    })
}

/// Position of the marker in the last epoch that had a solution, ECEF, m.
///
/// Errors: `NO_ESTIMATE` before the first solution.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_position(
    filter: *const Gnss,
    position: *mut [f64; 3],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(position)?) };
        answer.write(filter.last.as_ref().ok_or(Status::NoEstimate)?.position);
        Ok(())
    })
}

/// Standard deviations of the marker's position to the east, north and up, in the last epoch that had a solution, m.
///
/// Errors: `NO_ESTIMATE` before the first solution.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_sigma(filter: *const Gnss, sigma: *mut [f64; 3]) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(sigma)?) };
        answer.write(filter.last.as_ref().ok_or(Status::NoEstimate)?.sigma);
        Ok(())
    })
}

/// Whether the last solution can be relied upon. Reasons why not: `NOT_OBSERVABLE` if hardly more observations are left
/// than unknowns; `INNOVATIONS` if the observations contradict the solution, each other or earlier solutions, together
/// with `REJECTED` if too many were rejected.
///
/// Errors: `NO_ESTIMATE` before the first solution.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_health(filter: *const Gnss, health: *mut Health) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(health)?) };
        answer.write(filter.last.as_ref().ok_or(Status::NoEstimate)?.health);
        Ok(())
    })
}

/// Stores the GNSS filter in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_GNSS_SNAPSHOT`
/// bytes are enough; `length` receives the number of bytes used.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_snapshot(
    filter: *const Gnss,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(filter, buffer, capacity, length) }
}

/// Restores a GNSS filter from a snapshot that `kestirim_gnss_snapshot` stored, in memory of at least
/// `kestirim_gnss_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
/// the snapshot, such as a whole page of flash.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    filter: *mut *mut Gnss,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, filter) }
}
