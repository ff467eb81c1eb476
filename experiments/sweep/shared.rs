//! Values that several tasks of one process need and that are dear to make, such as a model that all arms share.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use edifice_base::Result;

/// The last values made, by key. A value depends on its key alone, so that results do not depend on which task made it.
pub struct Shared<V>(Mutex<VecDeque<(String, Arc<V>)>>);

impl<V> Default for Shared<V> {
    fn default() -> Self {
        Self::new()
    }
}

/// Values that are kept.
const KEPT: usize = 64;

impl<V> Shared<V> {
    /// A store without any value.
    pub const fn new() -> Self {
        Self(Mutex::new(VecDeque::new()))
    }

    /// The value of a key, made where it is not kept. Two threads that ask for a new one at once both make it: one that waited for
    /// the other could wait for itself, where making it runs other tasks of the pool.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get(&self, key: String, make: impl FnOnce() -> Result<V>) -> Result<Arc<V>> {
        if let Some((_, value)) = self.kept().iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(make()?);
        let mut kept = self.kept();
        kept.push_back((key, Arc::clone(&value)));
        if kept.len() > KEPT {
            kept.pop_front();
        }
        Ok(value)
    }

    fn kept(&self) -> std::sync::MutexGuard<'_, VecDeque<(String, Arc<V>)>> {
        self.0.lock().unwrap_or_else(|e| e.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_once_and_the_oldest_goes() {
        let shared = Shared::new();
        for key in 0..=KEPT {
            let value = shared.get(key.to_string(), || Ok(key)).unwrap();
            assert_eq!(*value, key);
        }
        let again = |key: usize| *shared.get(key.to_string(), || Ok(usize::MAX)).unwrap();
        assert_eq!(again(KEPT), KEPT);
        assert_eq!(again(0), usize::MAX);
    }
}
