//! An ephemeris as a satellite broadcasts it.

use super::record::Numbers;
use crate::error::Error;
use crate::system::System;
use crate::time::GpsTime;

/// The length of a week, s.
const WEEK: f64 = 604_800.0;
/// The accuracy that files write for a GPS satellite without one, m: index 15 (IS-GPS-200, 20.3.3.3.1.3) is 6144 m and
/// more.
const NO_ACCURACY: f64 = 6_144.0;
/// The longest fit interval that a message can hold, h.
const LONGEST_FIT: f64 = 194.0;

/// The message in which an ephemeris is broadcast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Message {
    /// The legacy message of GPS.
    Lnav,
    /// The I/NAV message of Galileo on E1 and E5b, whose clock refers to both.
    Inav,
    /// The F/NAV message of Galileo on E5a, whose clock refers to E1 and E5a.
    Fnav,
    /// The D1 message of BeiDou on B1I, B2I and B3I, whose clock refers to B3I.
    D1,
}

impl Message {
    /// All messages.
    pub const ALL: [Self; 4] = [Self::Lnav, Self::Inav, Self::Fnav, Self::D1];
}

/// An ephemeris as a satellite broadcasts it, in m, s and rad. The symbols of IS-GPS-200 (table 20-III), the Galileo OS
/// SIS ICD (5.1.1) and BDS-SIS-ICD-B1I (5.2.4) are given with each field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ephemeris {
    /// The message.
    pub message: Message,
    /// The reference time of the orbit, in GPS time: toe.
    pub time: GpsTime,
    /// The reference time of the clock: toc.
    pub clock_time: GpsTime,
    /// The satellite's clock minus the time of its system, s, s/s and s/s²: af0, af1, af2. The relativistic effect of
    /// the orbit's eccentricity is not included.
    pub clock: [f64; 3],
    /// The issue number: IODE or `IODnav`.
    pub issue: u16,
    /// The square root of the semi-major axis, √m: √A.
    pub root_of_axis: f64,
    /// Eccentricity: e.
    pub eccentricity: f64,
    /// Mean anomaly: M0.
    pub mean_anomaly: f64,
    /// Correction of the mean motion, rad/s: Δn.
    pub mean_motion_correction: f64,
    /// Argument of perigee: ω.
    pub perigee: f64,
    /// Longitude of the ascending node at the beginning of the week: Ω0.
    pub node: f64,
    /// The rate of the ascending node's longitude, rad/s: Ω̇.
    pub node_rate: f64,
    /// Inclination: i0.
    pub inclination: f64,
    /// The rate of the inclination, rad/s: IDOT.
    pub inclination_rate: f64,
    /// Cosine and sine terms of the argument of latitude, rad: Cuc, Cus.
    pub latitude_terms: [f64; 2],
    /// Cosine and sine terms of the radius, m: Crc, Crs.
    pub radius_terms: [f64; 2],
    /// Cosine and sine terms of the inclination, rad: Cic, Cis.
    pub inclination_terms: [f64; 2],
    /// Group delays, s: `TGD` for GPS; BGD(E1, E5a) and BGD(E1, E5b) for Galileo; TGD1 of B1I and TGD2 of B2I for
    /// BeiDou.
    pub group_delays: [f64; 2],
    /// The standard deviation of a range from this ephemeris, m: URA for GPS and BeiDou, SISA for Galileo; `None` if
    /// the satellite gives none.
    pub accuracy: Option<f64>,
    /// Whether the satellite declares the signals of this message healthy and its data valid.
    pub is_healthy: bool,
    /// The fit interval, s, half of it before and half after the reference time; `None` if it is not given.
    pub fit: Option<f64>,
}

impl Ephemeris {
    /// An empty ephemeris, all zeros, for the fields that a message does not hold.
    #[cfg(feature = "rtcm")]
    pub(crate) const NOTHING: Self = Self {
        message: Message::Lnav,
        time: GpsTime::EPOCH,
        clock_time: GpsTime::EPOCH,
        clock: [0.0; 3],
        issue: 0,
        root_of_axis: 0.0,
        eccentricity: 0.0,
        mean_anomaly: 0.0,
        mean_motion_correction: 0.0,
        perigee: 0.0,
        node: 0.0,
        node_rate: 0.0,
        inclination: 0.0,
        inclination_rate: 0.0,
        latitude_terms: [0.0; 2],
        radius_terms: [0.0; 2],
        inclination_terms: [0.0; 2],
        group_delays: [0.0; 2],
        accuracy: None,
        is_healthy: false,
        fit: None,
    };

    /// Whether the orbit is an ellipse with a positive axis.
    pub(super) fn is_orbit(&self) -> bool {
        let axis = self.root_of_axis;
        (0.0..1.0).contains(&self.eccentricity) && axis > 0.0 && axis.is_finite()
    }

    /// Reads a satellite's ephemeris from the numbers of a record.
    pub(super) fn read(
        satellite: u8,
        message: Option<Message>,
        numbers: &Numbers<'_>,
    ) -> Result<Self, Error> {
        let needed = |place| numbers.needed(place);
        let clock_time = numbers.time()?;
        let optional = |place| Ok(numbers.optional(place)?.unwrap_or_default());
        let system = System::of(satellite);
        let sources = if system == System::Galileo { optional(20)? as i64 } else { 0 };
        let message = message.unwrap_or(match (system, sources & 2) {
            (System::Galileo, 0) => Message::Inav,
            (System::Galileo, _) => Message::Fnav,
            (System::BeiDou, _) => Message::D1,
            _ => Message::Lnav,
        });
        let accuracy = needed(23)?;
        let is_beidou = system == System::BeiDou;
        let by_gps = |time: GpsTime| if is_beidou { time.beidou_to_gps() } else { time };
        Ok(Self {
            message,
            time: by_gps(time_of_week(clock_time, needed(11)?)),
            clock_time: by_gps(clock_time),
            clock: [needed(0)?, needed(1)?, needed(2)?],
            issue: needed(3)? as u16,
            radius_terms: [needed(16)?, needed(4)?],
            mean_motion_correction: needed(5)?,
            mean_anomaly: needed(6)?,
            latitude_terms: [needed(7)?, needed(9)?],
            eccentricity: needed(8)?,
            root_of_axis: needed(10)?,
            inclination_terms: [needed(12)?, needed(14)?],
            node: needed(13)?,
            inclination: needed(15)?,
            perigee: needed(17)?,
            node_rate: needed(18)?,
            inclination_rate: needed(19)?,
            accuracy: (accuracy > 0.0 && accuracy < NO_ACCURACY).then_some(accuracy),
            is_healthy: is_healthy(message, needed(24)?),
            group_delays: [needed(25)?, if system == System::Gps { 0.0 } else { optional(26)? }],
            fit: if system == System::Gps { fit(optional(28)?) } else { None },
        })
    }
}

/// Whether the satellite declares the signals of a message healthy. For Galileo, RINEX combines the data validity and
/// signal health bits: those of E1-B and E5b-I, or those of E5a-I, apply.
pub(crate) fn is_healthy(message: Message, bits: f64) -> bool {
    let own = match message {
        Message::Lnav => 0xff,
        Message::Inav => 0b1_1100_0111,
        Message::Fnav => 0b0_0011_1000,
        Message::D1 => 1,
    };
    bits as i64 & own == 0
}

/// The instant nearest to `near` with a given second of the week, so that the week need not be known.
pub(crate) fn time_of_week(near: GpsTime, second: f64) -> GpsTime {
    // The GPS week begins on Sunday, as day 44244 did.
    let day = (near.day() - 44_244).rem_euclid(7);
    let away = second - (f64::from(day) * 86_400.0 + near.second());
    let away = away - (away / WEEK).round() * WEEK;
    GpsTime::new(near.day(), near.second() + away)
}

/// A fit interval in hours converted to s; `None` up to 1 h, as some programs write the bit that says that it is longer
/// than four hours.
fn fit(hours: f64) -> Option<f64> {
    (hours > 1.0 && hours <= LONGEST_FIT).then_some(3600.0 * hours)
}
