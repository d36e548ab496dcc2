//! Whether the receiver moves, and what is done about observations that do not fit.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use kestirim_ppp_filter::{Estimator, Motion};
use serde::Serialize;

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

/// Satellites of which systems serve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Systems {
    /// Those of all that are observed and known
    #[default]
    All,
    /// Of GPS alone
    Gps,
    /// Of Galileo alone
    Galileo,
}

impl Systems {
    /// Whether a satellite serves, by its number: those of Galileo begin at 101.
    pub const fn has(self, satellite: u8) -> bool {
        match self {
            Self::All => true,
            Self::Gps => satellite <= 100,
            Self::Galileo => satellite > 100,
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

    /// Whether the paper publishes formulas of it from which ours differ.
    pub const fn is_published(self) -> bool {
        matches!(self, Self::Rkf | Self::Skf | Self::Ikf | Self::Adaptive)
    }

    /// Whether it weights by IGG III, between two thresholds.
    pub(super) const fn has_thresholds(self) -> bool {
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
}

/// One filter, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// One of them.
    One(FilterKind),
    /// All of them, compared.
    All,
}

impl Choice {
    /// Which, in the order of tables.
    pub const fn filters(&self) -> &[FilterKind] {
        match self {
            Self::One(filter) => std::slice::from_ref(filter),
            Self::All => &FilterKind::ALL,
        }
    }
}

impl Default for Choice {
    fn default() -> Self {
        Self::One(FilterKind::default())
    }
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

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::One(kind) => kind.to_possible_value(),
            Self::All => Some(PossibleValue::new("all").help("All six, compared")),
        }
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
