//! Settings without effect.

use super::settings::Settings;
use crate::Error;

/// Why a setting has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Idle {
    /// It belongs to something else, and is refused: `is for --mode kinematic`.
    Foreign(String),
    /// It is so anyway.
    Implied(String),
}

impl Idle {
    /// It belongs to something else.
    pub fn foreign(reason: impl Into<String>) -> Self {
        Self::Foreign(reason.into())
    }

    /// It is so anyway.
    pub fn implied(reason: impl Into<String>) -> Self {
        Self::Implied(reason.into())
    }

    /// Why.
    pub fn reason(&self) -> &str {
        let (Self::Foreign(reason) | Self::Implied(reason)) = self;
        reason
    }
}

/// Refuses the first given setting that belongs to something else.
pub(super) fn refuse(
    settings: &Settings,
    idle: impl Fn(&str) -> Option<Idle>,
) -> Result<(), Error> {
    for setting in settings.table().iter().filter(|setting| settings.is_given(setting.name)) {
        if let Some(Idle::Foreign(reason)) = idle(setting.name) {
            return Err(Error::Usage(format!("--{} {reason}", setting.option())));
        }
    }
    Ok(())
}
