//! Which filter, and of which systems the satellites.

use kestirim_gnss_files::System;
use kestirim_ppp_filter::{Config, Estimator, Motion, states};

/// States of a filter with room for twenty satellites: from no place on earth more of the 32 are seen.
pub const STATES: usize = states(20);
/// The same where satellites of Galileo are among them.
pub const STATES_WITH_GALILEO: usize = states(34);
/// The same where satellites of any system are.
pub const STATES_OF_ALL: usize = states(50);

/// Satellites of which systems serve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Systems {
    /// Those of all that are observed and known
    #[default]
    All,
    /// Of GPS alone
    Gps,
    /// Of Galileo alone
    Galileo,
    /// Of GPS and Galileo
    GpsGalileo,
}

impl Systems {
    /// Whether a satellite serves, by its number.
    pub const fn has(self, satellite: u8) -> bool {
        self.has_system(System::of(satellite))
    }

    /// Whether satellites of a system serve.
    pub const fn has_system(self, system: System) -> bool {
        match self {
            Self::All => true,
            Self::Gps => matches!(system, System::Gps),
            Self::Galileo => matches!(system, System::Galileo),
            Self::GpsGalileo => matches!(system, System::Gps | System::Galileo),
        }
    }
}

/// Whether ambiguities become whole numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Ambiguities {
    /// They stay as the filter has them
    #[default]
    Float,
    /// Whole where that passes the tests: GPS and Galileo, integer clocks or biases of phases
    Fixed,
}

/// From what positions are made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Method {
    /// From codes and phases, carried on from epoch to epoch
    #[default]
    Filter,
    /// From the codes of each epoch alone: metres, one carrier serves, too
    Single,
}

/// Which filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
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

    /// Whether the paper publishes formulas of it from which ours differ.
    pub const fn is_published(self) -> bool {
        matches!(self, Self::Rkf | Self::Skf | Self::Ikf | Self::Adaptive)
    }

    /// Whether it weights by IGG III, between two thresholds.
    pub const fn has_thresholds(self) -> bool {
        !matches!(self, Self::Gkf | Self::Skf)
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

    /// What is done about observations that do not fit, as the paper publishes it if `published`.
    pub fn estimator(self, motion: Motion, published: bool) -> Estimator {
        let ours = match self {
            Self::Gkf => Estimator::plain(),
            Self::Rkf => Estimator::igg3(),
            Self::Skf => Estimator::t_test(),
            Self::Ikf => Estimator::iterative_igg3(),
            Self::Adaptive => Estimator::adaptive(),
            Self::Default => Estimator::guarded(motion),
        };
        if published && self.is_published() {
            Estimator { robust: ours.robust.published(), ..ours }
        } else {
            ours
        }
    }

    /// The settings of our results with this filter, whose states are the paper's if it is one of the paper's: those have no
    /// gradients of the troposphere.
    pub fn config(self, motion: Motion, published: bool) -> Config {
        let ours = Config::new(motion);
        let gradient = if self == Self::Default { ours.gradient } else { 0.0 };
        Config { gradient, estimator: self.estimator(motion, published), ..ours }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_published_is_of_the_robust_filters() {
        let estimator = |kind: FilterKind, published| kind.estimator(Motion::Static, published);
        for kind in FilterKind::ALL {
            assert_eq!(estimator(kind, true) != estimator(kind, false), kind.is_published());
        }
    }
}
