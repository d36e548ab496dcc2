//! Choices of the filter, the satellite systems and the method.

use kestirim_gnss_files::System;
use kestirim_ppp_filter::{Config, Estimator, Motion, states};

/// The number of states of a filter with room for twenty satellites: nowhere on earth are more of the 32 in view.
pub const STATES: usize = states(20);
/// The number of states of a filter with room for 34 satellites, those of Galileo among them.
pub const STATES_WITH_GALILEO: usize = states(34);
/// The number of states of a filter with room for 50 satellites of any system.
pub const STATES_OF_ALL: usize = states(50);

/// The systems whose satellites are used.
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
    /// Whether a satellite is used, by its number.
    pub const fn has(self, satellite: u8) -> bool {
        self.has_system(System::of(satellite))
    }

    /// Whether the satellites of a system are used.
    pub const fn has_system(self, system: System) -> bool {
        match self {
            Self::All => true,
            Self::Gps => matches!(system, System::Gps),
            Self::Galileo => matches!(system, System::Galileo),
            Self::GpsGalileo => matches!(system, System::Gps | System::Galileo),
        }
    }
}

/// Whether ambiguities are fixed to integers.
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

/// What positions are computed from.
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

/// The kind of filter.
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

    /// Whether the paper publishes formulas for it that differ from ours.
    pub const fn is_published(self) -> bool {
        matches!(self, Self::Rkf | Self::Skf | Self::Ikf | Self::Adaptive)
    }

    /// Whether it uses IGG III weights, between two thresholds.
    pub const fn has_thresholds(self) -> bool {
        !matches!(self, Self::Gkf | Self::Skf)
    }

    /// The name on the command line.
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

    /// The name for display.
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

    /// The treatment of observations that do not fit, as the paper publishes it if `published`.
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

    /// The settings of our results with this filter. A filter of the paper has the paper's states, without gradients of
    /// the troposphere.
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
