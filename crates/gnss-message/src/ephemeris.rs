/// An ephemeris as a satellite broadcasts it: m, s and rad.
///
/// Times are seconds of the week of the satellite's own system: the week is not known by every message, so that it must be
/// taken from when the message came. What IS-GPS-200 (table 20-III), the Galileo OS SIS ICD (5.1.1) and BDS-SIS-ICD-B1I (5.2.4) call the
/// parameters stands behind each.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ephemeris {
    /// Reference time of the orbit, s of the week: toe.
    pub second: f64,
    /// Reference time of the clock, s of the week: toc.
    pub clock_second: f64,
    /// The satellite's clock minus the time of its system, s, s/s and s/s²: af0, af1, af2. Without the effect of the orbit's
    /// eccentricity.
    pub clock: [f64; 3],
    /// Number of this issue: IODE, `IODnav` or AODE.
    pub issue: u16,
    /// Square root of the semi-major axis, √m: √A.
    pub root_of_axis: f64,
    /// Eccentricity: e.
    pub eccentricity: f64,
    /// Mean anomaly at the reference time: M0.
    pub mean_anomaly: f64,
    /// Correction of the mean motion, rad/s: Δn.
    pub mean_motion_correction: f64,
    /// Argument of perigee: ω.
    pub perigee: f64,
    /// Longitude of the ascending node at the beginning of the week: Ω0.
    pub node: f64,
    /// Rate of the longitude of the ascending node, rad/s: Ω̇.
    pub node_rate: f64,
    /// Inclination at the reference time: i0.
    pub inclination: f64,
    /// Rate of the inclination, rad/s: IDOT.
    pub inclination_rate: f64,
    /// Cosine and sine terms of the argument of latitude, rad: Cuc, Cus.
    pub latitude_terms: [f64; 2],
    /// Cosine and sine terms of the radius, m: Crc, Crs.
    pub radius_terms: [f64; 2],
    /// Cosine and sine terms of the inclination, rad: Cic, Cis.
    pub inclination_terms: [f64; 2],
    /// Group delays, s: `TGD` and 0 of GPS; BGD(E1, E5a) and BGD(E1, E5b) of Galileo; TGD1 of B1I and TGD2 of B2I of BeiDou.
    pub group_delays: [f64; 2],
    /// Standard deviation of a range by this ephemeris, m: URA or SISA. `None` if the satellite predicts none.
    pub accuracy: Option<f64>,
    /// Whether the satellite calls the signals of this message healthy and its data valid.
    pub is_healthy: bool,
}
