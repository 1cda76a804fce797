//! What all senses of one tick share: living things and morsels sorted into cells, and the scene made
//! ready for looking at.
//!
//! Things lie in one sorted list by octave of size and by cell; the cells of an octave are as large as its
//! things are far to be seen. A query therefore costs what there is around the asker, however many live
//! elsewhere. And it is made only now and then: in between each animal goes through the list of those that it may notice
//! ([`Shortlist`]).

mod cells;
mod register;
mod shared;
mod shortlist;
#[cfg(test)]
mod tests;

pub use cells::Thing;
pub use register::Register;
pub use shared::{Memory, Outlook};
pub use shortlist::{Reach, Shortlist};
