//! Options of `host-sim run drone`.

use kestirim_particle_filter::Resampler;

use super::scenario::EnvironmentKind;
use crate::system::RunOptions;
use crate::system::Outputs;

/// `host-sim run drone`: all tables and figures, or with any option of a cell that cell alone.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct Run {
    /// Options that all systems share.
    #[command(flatten)]
    pub options: RunOptions,
    /// The cell.
    #[command(flatten)]
    pub cell: CellOptions,
    /// Where the results go.
    #[command(flatten)]
    pub outputs: Outputs,
}

/// One cell: a user who stays in 2000 m × 2000 m, or moves in 4000 m × 4000 m.
#[derive(Debug, Clone, Copy, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "One cell instead of all tables")]
pub struct CellOptions {
    /// Which filter [default: best]
    #[arg(long, value_enum)]
    pub filter: Option<FilterKind>,
    /// How the thesis' filter resamples [default: systematic]
    #[arg(long, value_enum)]
    pub resampler: Option<ResamplerKind>,
    /// Particles L [default: 500; with --moving 1000]
    #[arg(long, value_name = "L", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub particles: Option<u32>,
    /// Height of the drone, m [default: 800; with --moving 500]
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub height: Option<f64>,
    /// Radius of the drone's circle, m [default: 2000/3]
    #[arg(long, value_name = "METRES", value_parser = positive, conflicts_with = "moving")]
    pub radius: Option<f64>,
    /// Measurements T on the circle [default: 12]
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u32).range(1..=400), conflicts_with = "moving")]
    pub measurements: Option<u32>,
    /// What is built on the ground [default: urban]
    #[arg(long, value_enum)]
    pub environment: Option<EnvironmentKind>,
    /// The user walks a circle, and the drone follows
    #[arg(long)]
    pub moving: bool,
    /// Radius of the user's circle, m [default: 1000]
    #[arg(long, value_name = "METRES", value_parser = positive, requires = "moving")]
    pub user_radius: Option<f64>,
    /// Steps in which the user walks the circle [default: 500]
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(1..=10_000), requires = "moving")]
    pub end_time: Option<u32>,
    /// Speed of the drone, km/h; it costs energy [default: 40]
    #[arg(long, value_name = "KM/H", value_parser = positive)]
    pub speed: Option<f64>,
}

impl CellOptions {
    /// Whether one cell is asked for.
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// Which filter finds the user.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum FilterKind {
    /// The thesis' particle filter, literally
    Paper,
    /// A lattice that is laid anew where the posterior is; of a moving user a cloud whose particles know their
    /// velocity
    #[default]
    Best,
}

/// How particles are resampled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
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
    /// All, in the order of the thesis' figures.
    pub const ALL: [Self; 4] =
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

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.1..=10_000.0).contains(&value) => Ok(value),
        _ => Err("expected a number from 0.1 to 10000".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_positive() {
        assert_eq!(positive("666.7"), Ok(666.7));
        for text in ["0", "-5", "nan", "inf", "1e9", "x"] {
            assert!(positive(text).is_err(), "{text}");
        }
    }

    #[test]
    fn any_option_asks_for_a_cell() {
        assert!(!CellOptions::default().any());
        assert!(CellOptions { moving: true, ..CellOptions::default() }.any());
        assert!(CellOptions { filter: Some(FilterKind::Paper), ..CellOptions::default() }.any());
    }
}
