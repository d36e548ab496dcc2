/// Why no model is identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Inputs or columns are not as many as the times.
    #[error("expected as many inputs and measurements as times")]
    Lengths,
    /// A number is not finite.
    #[error("expected finite numbers")]
    NotFinite,
    /// A time is not after the one before.
    #[error("expected later times, sample after sample")]
    NotLater,
    /// A column that there is no model without.
    #[error("expected a column {0}, found none with measurements")]
    Missing(&'static str),
    /// Nothing shows how much the wing lifts.
    #[error("expected a column alpha or az, found neither with measurements")]
    NoLift,
    /// No stretch is long enough.
    #[error("expected at least {needed_s} s of flight without a gap, found {found_s:.1} s")]
    TooShort {
        /// The longest stretch, s.
        found_s: f64,
        /// What it takes, s.
        needed_s: f64,
    },
    /// The airspeed is no flight's.
    #[error("expected the airspeed of a flight, found {0:.2} m/s on average")]
    NotFlying(f64),
    /// The elevator stands still.
    #[error("expected an elevator that is moved, found a standard deviation of {0:.1e} rad")]
    NotExcited(f64),
    /// An angle is farther than one of its kind can be.
    #[error("expected {0} in rad, found {1:.2}: in degrees?")]
    Angle(&'static str, f64),
    /// The same flight is there again, which would count as independent.
    #[error("expected different flights, found one given twice")]
    Twice,
    /// A sensor says the same all the time.
    #[error(
        "expected {0} to change in flight, found one value throughout: leave out a sensor that stands still"
    )]
    Stuck(&'static str),
    /// The mean of az carries no aircraft.
    #[error(
        "expected az of about -9.8 m/s² on average, found {0:.2}: in g, of the other sign, or without gravity?"
    )]
    Force(f64),
    /// 2·qbar/V² is not air's.
    #[error(
        "expected qbar to be ½ρV², found air of {0:.3} kg/m³: qbar not in Pa, or V not in m/s?"
    )]
    Density(f64),
    /// A sensor shows another motion than others do.
    #[error(
        "expected {of} to move as {by} tells, found {scale:.3} of that: other units, or another sign?"
    )]
    Contradiction {
        /// Which sensor.
        of: &'static str,
        /// What it is compared with.
        by: &'static str,
        /// What it shows, as a part of what is expected.
        scale: f64,
    },
    /// Pitching does not depend on the elevator.
    #[error(
        "expected an elevator that turns the aircraft, found M_delta_e of {value:.2} ± {sigma:.2} 1/s²: its column, its times?"
    )]
    NoEffect {
        /// `M_delta_e`, 1/s².
        value: f64,
        /// Its standard error.
        sigma: f64,
    },
    /// The likelihood has no top near these measurements.
    #[error("expected measurements that a linear model explains, found none that does")]
    NotConverged,
    /// Mass, size or air of the aircraft makes no sense.
    #[error("expected mass, inertia, area, chord and density above zero")]
    NotPositive,
}
