//! Room for large estimators: lattices and clouds of thousands of points are moved on the stack before they are on the heap, and
//! a thread of Python may have little.

use std::thread::{Builder, scope};

use pyo3::PyResult;

use crate::error::refused;

/// The stack size of the thread, bytes. Without optimisation a cloud of half a megabyte is moved twenty times.
const BYTES: usize = 64 << 20;

/// Runs something that needs much stack, and waits for it. It must not ask for the interpreter, which the caller may hold.
pub(crate) fn with_much<R: Send>(run: impl FnOnce() -> PyResult<R> + Send) -> PyResult<R> {
    scope(|scope| {
        let thread = Builder::new().stack_size(BYTES).spawn_scoped(scope, run);
        let thread = thread.map_err(|error| refused(format!("no thread: {error}")))?;
        thread.join().map_err(|_| refused("the estimator ended unexpectedly"))?
    })
}
