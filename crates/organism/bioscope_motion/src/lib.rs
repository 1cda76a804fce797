//! How bodies move: from what a mind wants to the pose of a body.
//!
//! Bodies look along their own +Z, so +X is their left and +Y is up.

pub mod undulation;
