//! The world and its tick.
//!
//! A [`World`] advances time; [`Population`]s live in it; observers read its published scene,
//! sounds and events and change nothing. The tick knows two contracts, [`Population`] and
//! [`Field`](bioscope_dynamics::Field), and names no species.

mod common;
mod environment;
mod input;
mod order;
mod population;
mod publication;
mod registry;
mod save;
mod tick;
mod world;

pub use common::Common;
pub use environment::{Environment, EnvironmentParameters};
pub use input::{Change, Input, Recording};
pub use order::{Order, Steering};
pub use population::{Growth, Inspection, Moment, Population, View, no_such_order};
pub use publication::Publication;
pub use registry::Registry;
pub use world::World;
