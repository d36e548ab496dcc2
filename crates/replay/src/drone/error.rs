/// Why a user cannot be searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The area cannot be used.
    #[error("the area cannot be used: {0}")]
    Area(#[from] kestirim_user_locator::Error),
    /// The measurements have no finite places.
    #[error("expected measurements at finite places")]
    Surroundings,
}
