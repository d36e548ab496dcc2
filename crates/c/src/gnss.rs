//! Where a GNSS receiver is: the filter of precise point positioning of `kestirim-ppp-filter`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use heapless::Vec;
use kestirim_gnss_ppp::{Carriers, Corrections, GpsTime, Pattern, Receiver, SatelliteState};
use kestirim_ppp_filter::{
    Config, Health as Quality, Motion, PppFilter, SatelliteObservation, Solution, states,
};
use kestirim_scalar::Components;
use kestirim_snapshot::layout;
use nalgebra::SVector;

use crate::memory::{
    self, Handle, argument, array, held, held_mut, optional, place, status, wanted,
};
use crate::{Health, Status};

/// Most satellites of an epoch.
pub const MOST_SATELLITES: usize = 12;
const STATES: usize = states(MOST_SATELLITES);

/// A filter of precise point positioning: where a receiver is, to a centimetre, from its dual-frequency observations and
/// from orbits and clocks of a service. Double precision: for processors with memory.
///
/// Frame: Earth-centred and Earth-fixed (ECEF, that of the orbits), m; deviations to the east, north and up. Time is GPS
/// time.
#[derive(Debug)]
pub struct Gnss {
    _private: [u8; 0],
}

/// What the memory holds.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Positioning {
    filter: PppFilter<STATES>,
    ut1_minus_gps: f64,
    eccentricity: [f64; 3],
    last: Option<GnssSolution>,
}

layout! {
    [] for Positioning as "c/gnss", 3, f64, [STATES]
}

impl Handle for Gnss {
    type Value = Positioning;
    const TAG: u32 = 0x6B50_4701;
}

/// Bytes that a filter takes at most, on any target.
pub const GNSS_SIZE: usize = 10240;
const _: () = assert!(memory::size::<Gnss>() <= GNSS_SIZE);
/// Bytes that a snapshot takes at most, on any target.
pub const GNSS_SNAPSHOT: usize = GNSS_SIZE / 4 * 5 + 64;

/// Settings of the filter.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssConfig {
    /// 0: the receiver is at rest. Above: it moves, and this is the variance that a second adds to each coordinate, m²/s
    /// (1e4 for anything).
    pub process_noise: f64,
    /// Lowest elevation of a satellite, rad; 0.14 is 8 degrees.
    pub elevation_mask: f64,
    /// UT1 (or UTC) minus GPS time, s: the leap seconds since 1980, negated; -18 since 2017.
    pub ut1_minus_gps: f64,
    /// From the marker to the antenna's reference point, m: east, north, up.
    pub eccentricity: [f64; 3],
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

/// The phase centre of an antenna on one frequency, as an ANTEX file describes it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnssPattern {
    /// Mean phase centre from the antenna's reference point, m: north, east, up of a receiver's; X, Y, Z of a satellite's.
    pub offset: [f64; 3],
    /// First zenith or nadir angle of the grid, degrees.
    pub first: f64,
    /// Step of the grid, degrees.
    pub step: f64,
    /// Phase centre variation at each angle, whatever the azimuth, m: `count` numbers.
    pub mean: *const f64,
    /// How many angles the grid has.
    pub count: usize,
    /// Step of the azimuths, degrees; 0 without them.
    pub azimuth_step: f64,
    /// A row like `mean` for each azimuth from 0 to 360 degrees, one after the other, m.
    pub by_azimuth: *const f64,
    /// How many numbers all these rows have; 0 without them.
    pub azimuth_count: usize,
}

impl GnssPattern {
    /// The same for the models.
    ///
    /// # Safety
    /// Its pointers may be read.
    unsafe fn pattern<'a>(&self) -> Result<Pattern<'a>, Status> {
        // SAFETY: the caller keeps what the header asks for.
        let (mean, by_azimuth) =
            unsafe { (array(self.mean, self.count)?, array(self.by_azimuth, self.azimuth_count)?) };
        let (offset, first, step) = (self.offset, self.first, self.step);
        Ok(Pattern { offset, first, step, mean, azimuth_step: self.azimuth_step, by_azimuth })
    }
}

/// Carriers on which a satellite is observed.
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

/// A satellite at the time of transmission.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssSatellite {
    /// Centre of mass, ECEF at that time, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Satellite clock minus GPS time, s, without the effect of its eccentric orbit.
    pub clock: f64,
    /// Time from the clock's sample before to that after, s; 0: not interpolated.
    pub clock_interval: f64,
    /// Time to the nearer of both, s.
    pub clock_distance: f64,
}

/// Observation of one satellite.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnssObservation {
    /// Number of the satellite, which no other has: a GPS satellite's PRN, a Galileo satellite's number and 100, say.
    pub satellite: u8,
    /// 1 if the receiver reports a loss of lock since the last epoch, else 0.
    pub lock_lost: u8,
    /// The channel of a satellite of GLONASS, -7 to 6; 0 of others.
    pub channel: i8,
    /// Its two carriers: a `kestirim_gnss_carriers`.
    pub carriers: u32,
    /// Codes on both, m.
    pub code: [f64; 2],
    /// Carrier phases on both, cycles.
    pub phase: [f64; 2],
    /// The satellite.
    pub state: GnssSatellite,
    /// Its antenna on both carriers: two patterns, or null if they are not known.
    pub antenna: *const [GnssPattern; 2],
}

/// Solution of one epoch.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GnssSolution {
    /// The marker, ECEF, m, free of tides.
    pub position: [f64; 3],
    /// Standard deviations to the east, north and up, m.
    pub sigma: [f64; 3],
    /// Receiver clock minus GPS time, m.
    pub clock: f64,
    /// Wet zenith delay, m.
    pub wet_delay: f64,
    /// Whether it can be relied upon.
    pub health: Health,
    /// 1 if the ambiguities are known, so that the position is better than 10 cm, else 0.
    pub converged: u8,
    /// Satellites above the elevation mask.
    pub satellites: u8,
    /// Observations (codes and phases) that had less than their full weight.
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
        let GnssConfig { process_noise, elevation_mask, ut1_minus_gps, eccentricity } = *config;
        let numbers = [process_noise, elevation_mask, ut1_minus_gps];
        if !numbers.iter().chain(&eccentricity).all(|number| number.is_finite()) {
            return Err(Status::NotFinite);
        }
        let motion =
            if process_noise > 0.0 { Motion::Kinematic { process_noise } } else { Motion::Static };
        // All room is for satellites.
        let config = Config { elevation_mask, gradient: 0.0, ..Config::new(motion) };
        Ok(Self { filter: PppFilter::new(config), ut1_minus_gps, eccentricity, last: None })
    }
}

/// Two patterns behind a pointer that may be null.
///
/// # Safety
/// It and the pointers of the patterns may be read.
unsafe fn antenna<'a>(
    patterns: *const [GnssPattern; 2],
) -> Result<Option<[Pattern<'a>; 2]>, Status> {
    // SAFETY: the caller keeps what the header asks for.
    unsafe {
        let Some([first, second]) = optional(patterns)? else { return Ok(None) };
        Ok(Some([first.pattern()?, second.pattern()?]))
    }
}

impl GnssObservation {
    /// The same for the filter.
    ///
    /// # Safety
    /// The pointer to its antenna may be read.
    unsafe fn observation<'a>(&self) -> Result<SatelliteObservation<'a>, Status> {
        let carriers = match self.carriers {
            0 => Carriers::L1L2,
            1 => Carriers::E1E5a,
            2 => Carriers::E1E5b,
            3 if (-7..=6).contains(&self.channel) => Carriers::G1G2 { channel: self.channel },
            4 => Carriers::B1B3,
            5 => Carriers::B1B2,
            6 => Carriers::B1cB2a,
            _ => return Err(Status::InvalidArgument),
        };
        let state = &self.state;
        Ok(SatelliteObservation {
            satellite: self.satellite,
            carriers,
            code: self.code,
            phase: self.phase,
            lock_lost: self.lock_lost != 0,
            state: SatelliteState {
                position: SVector::from(state.position),
                velocity: SVector::from(state.velocity),
                clock: state.clock,
                clock_interval: state.clock_interval,
                clock_distance: state.clock_distance,
                accuracy: 0.0,
            },
            // SAFETY: the caller keeps what the header asks for.
            antenna: unsafe { antenna(self.antenna)? },
        })
    }
}

/// Bytes that a filter takes on this target. An epoch needs 96 kB of stack at most.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_size() -> usize {
    memory::size::<Gnss>()
}

/// Alignment of its memory, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_gnss_align() -> usize {
    memory::align::<Gnss>()
}

/// Makes a filter in memory of at least `kestirim_gnss_size()` bytes, before its first epoch: it starts by itself.
///
/// Errors: `NOT_FINITE`.
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

/// Takes in an epoch, observed at `time` by the receiver's clock: up to `KESTIRIM_MOST_SATELLITES` complete observations. The clock
/// of each system beside GPS takes the room of one: what there is no room for is left out.
/// `receiver` is the receiver's antenna on L1 and L2, two patterns, or null if it is not known; for the carriers of
/// other systems it serves as well. `solution` may be null if it is not wanted. Tides of the ocean are not corrected for.
///
/// Errors: `TOO_FEW` satellites; `TOO_MANY`; `GEOMETRY`; `OUT_OF_ORDER`; `CONTRADICTORY`; `NOT_FINITE`;
/// `INVALID_ARGUMENT` of carriers, a channel or settings.
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

/// The marker in the last epoch that had a solution, ECEF, m.
///
/// Errors: `NO_ESTIMATE`.
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

/// Its standard deviations to the east, north and up, m.
///
/// Errors: `NO_ESTIMATE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_sigma(filter: *const Gnss, sigma: *mut [f64; 3]) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(sigma)?) };
        answer.write(filter.last.as_ref().ok_or(Status::NoEstimate)?.sigma);
        Ok(())
    })
}

/// Whether it can be relied upon: `NOT_OBSERVABLE` where hardly more is observed than is unknown, `INNOVATIONS` where the
/// observations contradict the solution or each other, with `REJECTED` if too many were left out.
///
/// Errors: `NO_ESTIMATE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_health(filter: *const Gnss, health: *mut Health) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(health)?) };
        answer.write(filter.last.as_ref().ok_or(Status::NoEstimate)?.health);
        Ok(())
    })
}

/// Stores the filter in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_GNSS_SNAPSHOT` bytes are
/// enough, `length` tells how many it took.
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

/// Makes the filter in memory of at least `kestirim_gnss_size()` bytes that `kestirim_gnss_snapshot` stored: it goes on
/// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
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
