//! Values that many trials need and that are made once.

use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Values that are made once for all recordings that need them, one of each type.
#[derive(Clone, Default)]
pub struct Shared(Arc<Mutex<HashMap<TypeId, Arc<dyn Any + Send + Sync>>>>);

impl Shared {
    /// The value of type `T`, made by its `Default` if there is none yet.
    pub fn of<T: Default + Send + Sync + 'static>(&self) -> Arc<T> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let one = all.entry(TypeId::of::<T>()).or_insert_with(|| Arc::new(T::default()));
        // It was stored under its own type, so the downcast succeeds.
        Arc::clone(one).downcast().unwrap_or_default()
    }
}

impl fmt::Debug for Shared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl PartialEq for Shared {
    /// Always true: shared values do not affect what is read.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn there_is_one_of_each_type() {
        let shared = Shared::default();
        shared.of::<AtomicUsize>().store(7, Ordering::Relaxed);
        assert_eq!(shared.clone().of::<AtomicUsize>().load(Ordering::Relaxed), 7);
        assert_eq!(*shared.of::<String>(), "");
    }
}
