//! Estimators that sleep: their state in bytes.

use kestirim_snapshot::{Layout, Name, Number};
use pyo3::PyResult;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::{KestirimError, refused};

/// An estimator and what it was made for, such as 2 measurements: more than its layout says, which has room for more.
#[derive(Serialize, Deserialize)]
struct Asleep<E> {
    made_for: String,
    estimator: E,
}

/// The estimator's, but for a mark: a snapshot that Rust or C made is another.
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

/// The state of an estimator, in bytes that say what they are.
pub(super) fn stored<E: Layout + Serialize>(estimator: E, made_for: &str) -> PyResult<Vec<u8>> {
    let asleep = Asleep { made_for: made_for.to_owned(), estimator };
    let mut bytes = vec![0; kestirim_snapshot::size(&asleep).map_err(refused)?];
    kestirim_snapshot::store(&asleep, &mut bytes).map_err(refused)?;
    Ok(bytes)
}

/// An estimator from such bytes; those of another kind or size are refused.
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
