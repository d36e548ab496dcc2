//! The choices of settings.

use clap::ValueEnum;
use kestirim_particle_filter::Resampler;

/// Which filter finds a user.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum FilterKind {
    /// A lattice that is laid anew where the posterior is; of a moving user a cloud whose particles know their
    /// velocity
    #[default]
    Best,
    /// The thesis' particle filter, literally
    #[value(alias = "paper")]
    Published,
}

/// What the drone does while it follows a user who moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum FlightKind {
    /// Circles the estimate of a cloud whose particles know their velocity
    #[default]
    Orbit,
    /// The same, 100 to 1000 m high: low where the user is known
    Low,
    /// Hovers over the estimate of the thesis' filter
    Hover,
}

/// Where the drone measures a user who stays.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TrajectoryKind {
    /// A circle round the middle of the square: the thesis' (b)
    #[default]
    Circle,
    /// The centres of cells of the square: (a)
    Grid,
    /// A grid as long as the thesis' circle: (c)
    SmallGrid,
}

/// How particles are resampled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum ResamplerKind {
    /// Independent draws
    Multinomial,
    /// Whole numbers first, the rest by independent draws
    Residual,
    /// One draw in each stratum
    Stratified,
    /// One draw for all strata
    #[default]
    Systematic,
}

impl ResamplerKind {
    /// All resamplers, in the order of the thesis' figures.
    pub const OF_THE_THESIS: [Self; 4] =
        [Self::Multinomial, Self::Residual, Self::Stratified, Self::Systematic];
}

impl From<ResamplerKind> for Resampler {
    fn from(kind: ResamplerKind) -> Self {
        match kind {
            ResamplerKind::Multinomial => Self::Multinomial,
            ResamplerKind::Residual => Self::Residual,
            ResamplerKind::Stratified => Self::Stratified,
            ResamplerKind::Systematic => Self::Systematic,
        }
    }
}

/// The name of a choice, as on the command line.
pub fn name<T: ValueEnum>(choice: &T) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}
