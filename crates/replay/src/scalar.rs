//! Number types.

/// The number type in which an estimator computes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum ScalarKind {
    /// Single precision
    #[default]
    F32,
    /// Double precision
    F64,
    /// Fixed point
    Fixed,
}

impl ScalarKind {
    /// All number types.
    pub const ALL: [Self; 3] = [Self::F32, Self::F64, Self::Fixed];

    /// The name as it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Fixed => "fixed",
        }
    }
}
