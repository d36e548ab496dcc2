//! An ephemeris as a satellite broadcasts it.

use super::record::Numbers;
use crate::error::Error;
use crate::system::System;
use crate::time::GpsTime;

/// Seconds of a week.
const WEEK: f64 = 604_800.0;
/// As files write it that a satellite of GPS tells no accuracy: index 15 (IS-GPS-200, 20.3.3.3.1.3) is 6144 m and more.
const NO_ACCURACY: f64 = 6_144.0;
/// The longest fit that a message can tell, h.
const LONGEST_FIT: f64 = 194.0;

/// The message in which an ephemeris is broadcast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Message {
    /// The legacy message of GPS.
    Lnav,
    /// That of Galileo on E1 and E5b, whose clock refers to both.
    Inav,
    /// That of Galileo on E5a, whose clock refers to E1 and E5a.
    Fnav,
    /// That of BeiDou on B1I, B2I and B3I, whose clock refers to B3I.
    D1,
}

impl Message {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Lnav, Self::Inav, Self::Fnav, Self::D1];
}

/// An ephemeris as a satellite broadcasts it: m, s and rad. What IS-GPS-200 (table 20-III), the Galileo OS SIS ICD (5.1.1) and
/// BDS-SIS-ICD-B1I (5.2.4) call by symbols stands behind each name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ephemeris {
    /// The message.
    pub message: Message,
    /// The time of which the orbit is told, by GPS: toe.
    pub time: GpsTime,
    /// The time of which the clock is told: toc.
    pub clock_time: GpsTime,
    /// The satellite's clock minus the time of its system, s, s/s and s/s²: af0, af1, af2. Without the effect of the orbit's
    /// eccentricity.
    pub clock: [f64; 3],
    /// Number of this issue: IODE or `IODnav`.
    pub issue: u16,
    /// Root of the semi-major axis, √m: √A.
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
    /// Its rate, rad/s: Ω̇.
    pub node_rate: f64,
    /// Inclination: i0.
    pub inclination: f64,
    /// Its rate, rad/s: IDOT.
    pub inclination_rate: f64,
    /// Cosine and sine terms of the argument of latitude, rad: Cuc, Cus.
    pub latitude_terms: [f64; 2],
    /// Cosine and sine terms of the radius, m: Crc, Crs.
    pub radius_terms: [f64; 2],
    /// Cosine and sine terms of the inclination, rad: Cic, Cis.
    pub inclination_terms: [f64; 2],
    /// Group delays, s: `TGD` of GPS; of Galileo BGD(E1, E5a) and BGD(E1, E5b); of BeiDou TGD1 of B1I and TGD2 of B2I.
    pub group_delays: [f64; 2],
    /// Standard deviation of a range by it, m: URA of GPS and BeiDou, SISA of Galileo; none if the satellite gives none.
    pub accuracy: Option<f64>,
    /// Whether the satellite calls the signals of this message healthy and its data valid.
    pub is_healthy: bool,
    /// For how long the fit holds, half of it before and half behind its time, s; none if that is not told.
    pub fit: Option<f64>,
}

impl Ephemeris {
    /// What is not told: zeros of no satellite.
    #[cfg(any(feature = "rtcm", feature = "ubx"))]
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

    /// Whether the orbit is one: an ellipse with an axis.
    pub(super) fn is_orbit(&self) -> bool {
        let axis = self.root_of_axis;
        (0.0..1.0).contains(&self.eccentricity) && axis > 0.0 && axis.is_finite()
    }

    /// A satellite's ephemeris from the numbers of a record.
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

/// Whether the satellite calls the signals of a message healthy: of Galileo the bits that RINEX puts together for the data's
/// validity and the signal's health, of E1-B and E5b-I or of E5a-I.
pub(crate) fn is_healthy(message: Message, bits: f64) -> bool {
    let own = match message {
        Message::Lnav => 0xff,
        Message::Inav => 0b1_1100_0111,
        Message::Fnav => 0b0_0011_1000,
        Message::D1 => 1,
    };
    bits as i64 & own == 0
}

/// The instant nearest to another one of which the second of the week is told: no week needs to be known.
pub(crate) fn time_of_week(near: GpsTime, second: f64) -> GpsTime {
    // The week of GPS begins on Sunday; so did day 44244.
    let day = (near.day() - 44_244).rem_euclid(7);
    let away = second - (f64::from(day) * 86_400.0 + near.second());
    let away = away - (away / WEEK).round() * WEEK;
    GpsTime::new(near.day(), near.second() + away)
}

/// A fit of so many hours in s. Some programs write the bit that says that it is longer than four.
fn fit(hours: f64) -> Option<f64> {
    (hours > 1.0 && hours <= LONGEST_FIT).then_some(3600.0 * hours)
}
