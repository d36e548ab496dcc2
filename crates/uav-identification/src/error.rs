/// The reason why no model is identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The inputs or a column differ in length from the times.
    #[error("expected as many inputs and measurements as times")]
    Lengths,
    /// A number is not finite.
    #[error("expected finite numbers")]
    NotFinite,
    /// The times are not strictly increasing.
    #[error("expected later times, sample after sample")]
    NotLater,
    /// A required column is missing.
    #[error("expected a column {0}, found none with measurements")]
    Missing(&'static str),
    /// Neither alpha nor az is measured, so nothing shows the lift.
    #[error("expected a column alpha or az, found neither with measurements")]
    NoLift,
    /// No stretch without gaps is long enough.
    #[error("expected at least {needed_s} s of flight without a gap, found {found_s:.1} s")]
    TooShort {
        /// Duration of the longest stretch, s.
        found_s: f64,
        /// Required duration, s.
        needed_s: f64,
    },
    /// The mean airspeed (m/s) is too low for flight.
    #[error("expected the airspeed of a flight, found {0:.2} m/s on average")]
    NotFlying(f64),
    /// The elevator does not move: the standard deviation of its angle, rad.
    #[error("expected an elevator that is moved, found a standard deviation of {0:.1e} rad")]
    NotExcited(f64),
    /// An angle is implausibly large: its name and value, rad.
    #[error("expected {0} in rad, found {1:.2}: in degrees?")]
    Angle(&'static str, f64),
    /// The same flight is given twice, and would count as independent.
    #[error("expected different flights, found one given twice")]
    Twice,
    /// A sensor's value never changes.
    #[error(
        "expected {0} to change in flight, found one value throughout: leave out a sensor that stands still"
    )]
    Stuck(&'static str),
    /// The mean of az (m/s²) is not that of a flying aircraft.
    #[error(
        "expected az of about -9.8 m/s² on average, found {0:.2}: in g, of the other sign, or without gravity?"
    )]
    Force(f64),
    /// 2·qbar/V² (kg/m³) is not a density of air.
    #[error(
        "expected qbar to be ½ρV², found air of {0:.3} kg/m³: qbar not in Pa, or V not in m/s?"
    )]
    Density(f64),
    /// A sensor contradicts the motion shown by others.
    #[error(
        "expected {of} to move as {by} tells, found {scale:.3} of that: other units, or another sign?"
    )]
    Contradiction {
        /// The sensor.
        of: &'static str,
        /// The sensors with which it is compared.
        by: &'static str,
        /// Its scale: measured over expected motion.
        scale: f64,
    },
    /// The pitching moment does not depend on the elevator.
    #[error(
        "expected an elevator that turns the aircraft, found M_delta_e of {value:.2} ± {sigma:.2} 1/s²: its column, its times?"
    )]
    NoEffect {
        /// `M_delta_e`, 1/s².
        value: f64,
        /// Its standard error.
        sigma: f64,
    },
    /// The likelihood has no maximum near these measurements.
    #[error("expected measurements that a linear model explains, found none that does")]
    NotConverged,
    /// The aircraft's mass, inertia, size or air density is not positive and finite.
    #[error("expected mass, inertia, area, chord and density above zero")]
    NotPositive,
}
