//! The motion model, and the choice of filters.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use kestirim_ppp_filter::Motion;
use kestirim_replay::gnss::FilterKind;
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
    /// The mode that corresponds to a motion model.
    pub const fn of(motion: Motion) -> Self {
        match motion {
            Motion::Static => Self::Static,
            Motion::Kinematic { .. } => Self::Kinematic,
        }
    }
}

/// One filter, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A single filter.
    One(FilterKind),
    /// All filters, compared.
    All,
}

impl Choice {
    /// The chosen filters, in the order of tables.
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
