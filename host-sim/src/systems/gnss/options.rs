//! What the command line can choose about positioning.

use clap::ValueEnum;
use kestirim_ppp_filter::{Config, Estimator, Motion, states};
use kestirim_robust_kalman::{Igg3, Weight};
use nalgebra::Vector3;
use serde::Serialize;

use crate::system::ScalarKind;

/// Number types the filter is built for: ranges of 26 000 km to a millimetre need the digits.
pub const SCALARS: [ScalarKind; 1] = [ScalarKind::F64];

/// States of a filter with room for twenty satellites: from no place on earth more of the 32 are seen.
pub const STATES: usize = states(20);

/// Variance per second of each coordinate of a receiver that may move at will, m²/s: in the 30 s between
/// epochs it gets 55 m away, so that only what is observed in an epoch tells where it is.
pub const PROCESS_NOISE: f64 = 100.0;

/// The highest mask, degrees: above it there are hardly ever four satellites.
pub(super) const HIGHEST_MASK: f64 = 60.0;
/// No marker is nearer to the Earth's centre, or farther from it, m.
const RADII: std::ops::Range<f64> = 6.3e6..6.5e6;

/// Whether the receiver moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// It stands still
    #[default]
    Static,
    /// It may move
    Kinematic,
}

impl Mode {
    /// Of a filter.
    pub const fn of(motion: Motion) -> Self {
        match motion {
            Motion::Static => Self::Static,
            Motion::Kinematic { .. } => Self::Kinematic,
        }
    }
}

/// Which filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum FilterKind {
    /// The plain Kalman filter (the paper's GKF)
    Gkf,
    /// IGG III weights, all at once (RKF)
    Rkf,
    /// Classification by a t-test (SKF)
    Skf,
    /// IGG III weights, the worst observation first (IKF)
    Ikf,
    /// The same and an adaptive factor on the position (the paper's UKF)
    Adaptive,
    /// Our own: robust, and slips that nothing else shows are found
    #[default]
    Default,
}

impl FilterKind {
    /// Every filter, in the order of tables.
    pub const ALL: [Self; 6] =
        [Self::Gkf, Self::Rkf, Self::Skf, Self::Ikf, Self::Adaptive, Self::Default];

    /// Whether the paper prints formulas of it from which ours differ.
    pub const fn is_printed(self) -> bool {
        matches!(self, Self::Rkf | Self::Skf | Self::Ikf | Self::Adaptive)
    }

    /// As on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gkf => "gkf",
            Self::Rkf => "rkf",
            Self::Skf => "skf",
            Self::Ikf => "ikf",
            Self::Adaptive => "adaptive",
            Self::Default => "default",
        }
    }

    /// What people call it.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Gkf => "plain (GKF)",
            Self::Rkf => "IGG III (RKF)",
            Self::Skf => "t-test (SKF)",
            Self::Ikf => "iterative IGG III (IKF)",
            Self::Adaptive => "adaptive (UKF)",
            Self::Default => "default",
        }
    }

    /// What is done about observations that do not fit, by the letter of the paper if `printed`.
    pub fn estimator(self, motion: Motion, printed: bool) -> Estimator {
        let ours = match self {
            Self::Gkf => Estimator::plain(),
            Self::Rkf => Estimator::igg3(),
            Self::Skf => Estimator::t_test(),
            Self::Ikf => Estimator::iterative_igg3(),
            Self::Adaptive => Estimator::adaptive(),
            Self::Default => Estimator::guarded(motion),
        };
        if printed && self.is_printed() {
            Estimator { robust: ours.robust.published(), ..ours }
        } else {
            ours
        }
    }
}

/// One filter, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// One of them.
    One(FilterKind),
    /// All of them, in one table.
    All,
}

impl ValueEnum for Choice {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Choice; 7] = {
            let mut all = [Choice::All; 7];
            let mut place = 0;
            while place < FilterKind::ALL.len() {
                all[place] = Choice::One(FilterKind::ALL[place]);
                place += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        match self {
            Self::One(kind) => kind.to_possible_value(),
            Self::All => Some(clap::builder::PossibleValue::new("all").help("All six, compared")),
        }
    }
}

/// Everything that can be chosen about how observations become positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// Whether the receiver moves, and how.
    pub motion: Motion,
    /// Lowest elevation of a satellite, rad; none: the filter's own choice.
    pub mask: Option<f64>,
    /// Whether the paper's filters are taken by its letter.
    pub printed: bool,
    /// Thresholds k0 and k1 of filters with IGG III weights; none: the filter's own.
    pub thresholds: Option<[f64; 2]>,
}

impl Setup {
    /// The settings of a filter.
    pub fn config(&self, filter: FilterKind) -> Config {
        let config = Config::new(self.motion);
        let mut estimator = filter.estimator(self.motion, self.printed);
        if let (Some(thresholds), Weight::Igg3(Igg3 { k0, k1, .. })) =
            (self.thresholds, &mut estimator.robust.weight)
        {
            [*k0, *k1] = thresholds;
        }
        let elevation_mask = self.mask.unwrap_or(config.elevation_mask);
        Config { elevation_mask, estimator, ..config }
    }
}

/// Reads `X,Y,Z`, a place on the ground.
///
/// # Errors
/// In words: what was expected.
pub fn place(text: &str) -> Result<Vector3<f64>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|field| field.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| <[f64; 3]>::try_from(numbers).ok())
        .map(Vector3::from)
        .filter(|place| RADII.contains(&place.norm()))
        .ok_or_else(|| "expected a place on the ground as X,Y,Z (ECEF, m)".to_owned())
}

/// Reads a process noise, m²/s.
///
/// # Errors
/// In words: what was expected.
pub fn process_noise(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number| (1e-12..=1e6).contains(number));
    number.ok_or_else(|| "expected a variance per second from 1e-12 to 1e6 m²/s".to_owned())
}

/// Reads an elevation in degrees, as rad.
///
/// # Errors
/// In words: what was expected.
pub fn mask(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok();
    let number = number.filter(|number| (0.0..=HIGHEST_MASK).contains(number));
    number
        .map(f64::to_radians)
        .ok_or_else(|| format!("expected an elevation from 0 to {HIGHEST_MASK} degrees"))
}

/// Reads a time, s.
///
/// # Errors
/// In words: what was expected.
pub fn time(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok();
    let number = number.filter(|number| (0.0..=1e9).contains(number));
    number.ok_or_else(|| {
        "expected a time from 0 on, in seconds since the midnight before the first epoch".to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_where_they_can_be() {
        assert_eq!(
            place("3582104.7, 532590.2,-5232755.1"),
            Ok(Vector3::new(3_582_104.7, 532_590.2, -5_232_755.1))
        );
        for text in ["", "1,2,3", "55.5,8.4,60", "3582104,532590", "nan,0,6400000", "a,b,c"] {
            assert!(place(text).is_err(), "{text}");
        }
        assert_eq!(process_noise("1e-4"), Ok(1e-4));
        assert_eq!(mask("8"), Ok(8_f64.to_radians()));
        assert_eq!(time("85500"), Ok(85_500.0));
        for text in ["", "-1", "nan", "inf", "x", "1e300"] {
            assert!(process_noise(text).is_err() && mask(text).is_err() && time(text).is_err());
        }
    }

    #[test]
    fn the_letter_of_the_paper_is_for_its_robust_filters() {
        let estimator = |kind: FilterKind, printed| kind.estimator(Motion::Static, printed);
        for kind in FilterKind::ALL {
            assert_eq!(estimator(kind, true) != estimator(kind, false), kind.is_printed());
        }
    }
}
