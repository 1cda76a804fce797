//! Shapes and what can be seen of them: meshes, terrain, obstacles, spatial indexes, the [`Scene`] and the
//! rasterizer that serves as every animal's retina.
//!
//! Metres, right-handed, Y up, linear colour. Bodies look along their own +Z (so +X is their left);
//! cameras look along their own −Z.

mod camera;
mod key;
pub mod mesh;
mod noise;
mod obstacle;
pub mod rasterizer;
mod relief;
mod rig;
pub mod scene;
mod solids;
mod terrain;
mod transform;

pub use camera::{Camera, Projection};
pub use key::Key;
pub use mesh::{Joint, Mesh, Skin};
pub use noise::{Cell, Noise};
pub use obstacle::Obstacle;
pub use rasterizer::{Options, Prepared, Rasterizer, View, prepare};
pub use relief::{Mound, ReefRelief};
pub use rig::{Motion, Rig};
pub use scene::{Batch, Material, Medium, Mouth, Points, Scene, Sky, Sun, Texture};
pub use solids::Solids;
pub use terrain::Terrain;
pub use transform::Transform;
