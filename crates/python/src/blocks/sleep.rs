//! Snapshots of estimators: their state in bytes.

use kestirim_snapshot::{Layout, Name, Number};
use pyo3::PyResult;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::{KestirimError, refused};

/// An estimator with a description of its sizes, such as 2 measurements: its layout does not tell these, as it has room
/// for more.
#[derive(Serialize, Deserialize)]
struct Asleep<E> {
    made_for: String,
    estimator: E,
}

/// The estimator's layout, except for a mark: snapshots made by Rust or C differ.
impl<E: Layout> Layout for Asleep<E> {
    const NAME: &'static str = E::NAME;
    const VERSION: u16 = E::VERSION;
    const IS_FINITE: bool = E::IS_FINITE;

    fn number() -> Number {
        E::number()
    }

    fn sizes() -> [u32; 4] {
        let [first, second, third, _] = E::sizes();
        [first, second, third, const { Name::new("python").code() }]
    }
}

/// Stores an estimator in self-describing bytes.
pub(super) fn stored<E: Layout + Serialize>(estimator: E, made_for: &str) -> PyResult<Vec<u8>> {
    let asleep = Asleep { made_for: made_for.to_owned(), estimator };
    let mut bytes = vec![0; kestirim_snapshot::size(&asleep).map_err(refused)?];
    kestirim_snapshot::store(&asleep, &mut bytes).map_err(refused)?;
    Ok(bytes)
}

/// Restores an estimator from such bytes; those of another kind or size are refused.
pub(super) fn loaded<E: Layout + Serialize + DeserializeOwned>(
    bytes: &[u8],
    made_for: &str,
) -> PyResult<E> {
    let found: Asleep<E> = kestirim_snapshot::load(bytes).map_err(refused)?;
    if found.made_for != made_for {
        let sentence =
            format!("expected a snapshot of {made_for}, found one of {}", found.made_for);
        return Err(KestirimError::new_err(sentence));
    }
    Ok(found.estimator)
}
