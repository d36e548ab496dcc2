//! Findings: what a log shows before any estimator has seen it.

use kestirim_health::{Health, Reason};

/// A finding about a log.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Finding {
    /// The subject, such as `rate`.
    pub about: &'static str,
    /// The reason why answers suffer, if it does harm.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub reason: Option<Reason>,
    /// The fact that was found.
    pub found: String,
    /// The consequence, if it does harm.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub consequence: Option<String>,
    /// The remedy.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub remedy: Option<String>,
}

impl Finding {
    /// A finding that does no harm.
    pub fn note(about: &'static str, found: impl Into<String>) -> Self {
        Self { about, reason: None, found: found.into(), consequence: None, remedy: None }
    }

    /// A finding that does harm, with its consequence and remedy.
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

    /// Whether it does harm.
    pub fn is_fault(&self) -> bool {
        self.reason.is_some()
    }

    /// The doubts that findings cast on every estimate made from a log.
    pub fn doubts<'a>(findings: impl IntoIterator<Item = &'a Self>) -> Health {
        findings.into_iter().filter_map(|finding| finding.reason).collect()
    }

    /// The finding as a warning.
    pub fn sentence(&self) -> String {
        let rest = self.consequence.iter().chain(&self.remedy);
        rest.fold(self.found.clone(), |sentence, part| format!("{sentence}; {part}"))
    }
}
