//! What can be seen from a point of view: color, depth and identity, by a z-buffer on the CPU. The same
//! code serves animals' eyes (thousands of tiny views per second) and pictures for people.
//!
//! [`Rasterizer::prepare`] makes a [`Scene`](crate::Scene) ready once per tick; [`Prepared::look`] and
//! [`Prepared::look_many`] look at it. [`View::developed`] turns a view into bytes for a screen.
//!
//! | file | question it answers |
//! |---|---|
//! | `assets` | what is worked out once per mesh and texture |
//! | `prepare` | what do all views of one tick share |
//! | `pose` | where are the vertices of an instance |
//! | `lens` | which ray belongs to which pixel, and back |
//! | `cover` | which triangle does each sample see |
//! | `look` | how does one view come about |
//! | `shade` | what color is the point that a sample sees |
//! | `light` | the formulae of light, shared with the page's shaders |
//! | `waves` | the surface of the water and its caustics |
//! | `shadow`, `shafts`, `spots`, `texture`, `veils` | as they say |

mod arithmetic;
mod assets;
mod cover;
mod lens;
mod light;
mod look;
mod pose;
mod prepare;
mod shade;
mod shadow;
mod shafts;
mod spots;
mod texture;
mod veils;
mod view;
mod waves;

pub use assets::Rasterizer;
pub use prepare::{Options, Prepared, prepare};
pub use view::View;

#[cfg(test)]
mod tests;
