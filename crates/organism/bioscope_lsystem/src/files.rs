//! The files that belong to a cpfg model: views, animations, functions, surfaces, contours, color
//! maps, materials and environment files.
//!
//! All readers accept any bytes: what they cannot use is reported with file and line, and they
//! never read more than their limits. Files that a view names must lie in its folder or below.

mod animation;
mod colors;
mod contour;
mod environment;
mod function;
mod surface;
mod table;
mod text;
mod view;

use std::{collections::BTreeMap, sync::Arc};

pub use animation::{Animation, Interval};
pub use colors::{read_color_map, read_materials};
pub use contour::{ContourShape, ContourVertex, Curve};
pub use environment::EnvironmentFile;
pub use function::Function;
pub use surface::{SurfaceShape, Tessellation};
pub use table::FunctionTable;
pub use view::{TextureFile, View, ViewCamera, ViewLight};

pub(crate) use text::{Text, numbers};

/// Surfaces and contours that strings name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shapes {
    /// Surfaces by the letter after `~`.
    pub surfaces: BTreeMap<char, Arc<SurfaceShape>>,
    /// Contours by the number in `@#`.
    pub contours: BTreeMap<i32, Arc<ContourShape>>,
}
