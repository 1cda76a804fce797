//! Corals, sponges and sea fans: colonies that stay where they are, and the shrimps that crackle
//! among them.
//!
//! | file | question it answers |
//! |---|---|
//! | `kinds` | which growth forms are there, how large, in which colors |
//! | `massive`, `slender` | what shape has a lump or plate, a branch or fan |
//! | `population` | where do colonies settle, what is seen and heard of them |

mod kinds;
mod massive;
mod population;
mod slender;

pub use kinds::CoralKind;
pub use population::{CoralParameters, Corals, CoralsOptions};
