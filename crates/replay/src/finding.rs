//! What a log shows before any estimator has seen it.

use kestirim_health::{Health, Reason};

/// Something that a log shows.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Finding {
    /// What it is about, such as `rate`.
    pub about: &'static str,
    /// Why answers suffer, if it harms.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub reason: Option<Reason>,
    /// What was found.
    pub found: String,
    /// What comes of it, if it harms.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub consequence: Option<String>,
    /// What to do about it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub remedy: Option<String>,
}

impl Finding {
    /// What harms nothing.
    pub fn note(about: &'static str, found: impl Into<String>) -> Self {
        Self { about, reason: None, found: found.into(), consequence: None, remedy: None }
    }

    /// What harms, how, and what to do.
    pub fn fault(
        about: &'static str,
        reason: Reason,
        found: impl Into<String>,
        consequence: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            reason: Some(reason),
            consequence: Some(consequence.into()),
            remedy: Some(remedy.into()),
            ..Self::note(about, found)
        }
    }

    /// Whether it harms.
    pub fn is_fault(&self) -> bool {
        self.reason.is_some()
    }

    /// What findings say against every estimate that is made of a log.
    pub fn doubts<'a>(findings: impl IntoIterator<Item = &'a Self>) -> Health {
        findings.into_iter().filter_map(|finding| finding.reason).collect()
    }

    /// As a warning.
    pub fn sentence(&self) -> String {
        let rest = self.consequence.iter().chain(&self.remedy);
        rest.fold(self.found.clone(), |sentence, part| format!("{sentence}; {part}"))
    }
}
