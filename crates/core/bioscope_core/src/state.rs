//! The one way in which state becomes bytes: for `state_hash`, saved worlds and checkpoints alike.

use serde::{Serialize, de::DeserializeOwned};

use crate::{Error, Result};

/// The state as bytes; equal states give equal bytes.
pub fn to_bytes<T: Serialize>(state: &T) -> Vec<u8> {
    // Only types with a fallible serialize implementation can fail, and state types are plain data.
    postcard::to_allocvec(state).expect("plain data serializes")
}

/// The state that these bytes stand for; `part` names what is being read in the error.
pub fn from_bytes<T: DeserializeOwned>(part: &str, bytes: &[u8]) -> Result<T> {
    let (value, rest) = postcard::take_from_bytes(bytes)
        .map_err(|error| Error::format(part, format!("not a valid saved state ({error})")))?;
    if rest.is_empty() {
        Ok(value)
    } else {
        Err(Error::format(part, format!("{} bytes too many in the saved state", rest.len())))
    }
}
