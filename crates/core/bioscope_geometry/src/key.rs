use std::sync::atomic::{AtomicU64, Ordering};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// By which observers tell shared assets apart: unique in the process, not part of any state.
/// Every default and every clone is a new key, so a changed copy is never mistaken for its original.
#[derive(Debug, PartialEq, Eq)]
pub struct Key(u64);

impl Key {
    /// The number itself.
    pub fn number(&self) -> u64 {
        self.0
    }
}

impl Default for Key {
    fn default() -> Self {
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

impl Clone for Key {
    fn clone(&self) -> Self {
        Self::default()
    }
}
