//! The wire format of the live stream (docs/reference/stream.md): a scene as MessagePack messages,
//! shared things once, moving things quantized.

mod asset;
mod batch;
mod encoder;
mod frame;
mod layout;
pub mod quantize;

pub use encoder::{Encoder, Status, Update};
