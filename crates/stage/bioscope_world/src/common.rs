use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// What several populations of a world work out once for all of them, one value of each type: no part of the state, so it
/// must change nothing but how soon things are known.
#[derive(Default)]
pub struct Common {
    values: Mutex<BTreeMap<TypeId, Arc<dyn Any + Send + Sync>>>,
}

impl Common {
    /// The value of this type, made by its default when it is asked for first.
    pub fn get<T: Any + Default + Send + Sync>(&self) -> Arc<T> {
        let mut values = self.values.lock().unwrap_or_else(PoisonError::into_inner);
        let value = values.entry(TypeId::of::<T>()).or_insert_with(|| Arc::<T>::default());
        // What is kept under a type is of this type.
        Arc::clone(value).downcast().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn all_who_ask_for_a_type_get_the_same_value() {
        let common = Common::default();
        common.get::<AtomicU32>().store(7, Ordering::Relaxed);
        assert_eq!(common.get::<Mutex<String>>().lock().unwrap().as_str(), "");
        assert_eq!(common.get::<AtomicU32>().load(Ordering::Relaxed), 7);
    }
}
