//! The last run, so that stepping through it takes no time.

use std::sync::{Arc, Mutex, PoisonError};

/// What came out for which settings.
#[derive(Debug)]
pub(super) struct Remembered<K, V>(Mutex<Option<(K, Arc<V>)>>);

impl<K, V> Default for Remembered<K, V> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<K: PartialEq, V> Remembered<K, V> {
    /// What came out for these settings, or comes out now.
    ///
    /// # Errors
    /// Those of `make`; then nothing is remembered.
    pub(super) fn of<E>(&self, key: K, make: impl FnOnce(&K) -> Result<V, E>) -> Result<Arc<V>, E> {
        // A run that panicked left nothing half-done in here.
        let last = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, value)) = &*last()
            && *known == key
        {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(make(&key)?);
        *last() = Some((key, Arc::clone(&value)));
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_settings_are_run_once() {
        let (remembered, mut runs) = (Remembered::default(), 0);
        for key in [1, 1, 2, 2, 1] {
            let value = remembered.of(key, |key| {
                runs += 1;
                Ok::<_, ()>(10 * key)
            });
            assert_eq!(*value.unwrap(), 10 * key);
        }
        assert_eq!(runs, 3);
        assert_eq!(remembered.of(3, |_| Err("no")), Err("no"));
        assert_eq!(*remembered.of(1, |_| Err("forgotten")).unwrap(), 10);
    }
}
