//! Estimators that sleep: their state in bytes.

use kestirim_snapshot::Layout;
use pyo3::PyResult;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::refused;

/// The state of an estimator, in bytes that say what they are.
pub(super) fn stored<E: Layout + Serialize>(estimator: &E) -> PyResult<Vec<u8>> {
    let mut bytes = vec![0; kestirim_snapshot::size(estimator).map_err(refused)?];
    kestirim_snapshot::store(estimator, &mut bytes).map_err(refused)?;
    Ok(bytes)
}

/// An estimator from such bytes; those of another, or of another size, are refused.
pub(super) fn loaded<E: Layout + Serialize + DeserializeOwned>(bytes: &[u8]) -> PyResult<E> {
    kestirim_snapshot::load(bytes).map_err(refused)
}
