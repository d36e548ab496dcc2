//! Settings without effect.

use super::settings::Settings;
use crate::Error;

/// Why a setting has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Idle {
    /// The setting belongs to another choice, and is refused: `is for --mode kinematic`.
    Foreign(String),
    /// The setting describes what is already the case.
    Implied(String),
}

impl Idle {
    /// The setting belongs to another choice, for this `reason`.
    pub fn foreign(reason: impl Into<String>) -> Self {
        Self::Foreign(reason.into())
    }

    /// The setting describes what is already the case, for this `reason`.
    pub fn implied(reason: impl Into<String>) -> Self {
        Self::Implied(reason.into())
    }

    /// The reason.
    pub fn reason(&self) -> &str {
        let (Self::Foreign(reason) | Self::Implied(reason)) = self;
        reason
    }
}

/// Refuses the first given setting that belongs to another choice.
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
