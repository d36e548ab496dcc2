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
    /// The likelihood has no top near these measurements.
    #[error("expected measurements that a linear model explains, found none that does")]
    NotConverged,
    /// Mass, size or air of the aircraft makes no sense.
    #[error("expected mass, inertia, area, chord and density above zero")]
    NotPositive,
}
