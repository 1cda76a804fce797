//! The binding: convert, call, convert back. The public API with its documentation is the Python
//! package `bioscope`; this module is `bioscope._engine`.

use pyo3::prelude::*;

mod acoustics;
mod arrays;
mod camera;
mod environments;
mod error;
mod field;
mod fish_mind;
mod flock;
mod lsystem;
mod material;
mod mathematics;
mod mesh;
mod mind;
mod png;
mod population;
mod publication;
mod rasterizer;
mod rig;
mod scene;
mod shoal;
mod skin;
mod stream;
mod tank;
mod turtle;
mod values;
mod view;
mod world;

/// The engine of the Python package `bioscope`.
#[pymodule]
mod _engine {
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use super::acoustics::SoundTrack;
    #[pymodule_export]
    use super::camera::Camera;
    #[pymodule_export]
    use super::environments::{
        Environment, amounts_sheet, amounts_surface, derive_in, environment_names,
    };
    #[pymodule_export]
    use super::field::{Field, current};
    #[pymodule_export]
    use super::fish_mind::FishMind;
    #[pymodule_export]
    use super::flock::Flock;
    #[pymodule_export]
    use super::lsystem::{LSystem, ModuleString};
    #[pymodule_export]
    use super::material::Material;
    #[pymodule_export]
    use super::mathematics::{
        arc_sine, arc_tangent, cosine, exponential, hyperbolic_tangent, power, sine,
    };
    #[pymodule_export]
    use super::mesh::Mesh;
    #[pymodule_export]
    use super::mind::fish_with_minds;
    #[pymodule_export]
    use super::png::{decode_png, encode_png};
    #[pymodule_export]
    use super::population::{Resident, fish_species, resident};
    #[pymodule_export]
    use super::publication::Publication;
    #[pymodule_export]
    use super::rasterizer::Rasterizer;
    #[pymodule_export]
    use super::scene::{Batch, Points, Scene};
    #[pymodule_export]
    use super::shoal::Shoal;
    #[pymodule_export]
    use super::stream::Encoder;
    #[pymodule_export]
    use super::tank::Tank;
    #[pymodule_export]
    use super::turtle::{AnimateFile, Interpretation, ViewFile, interpret, read_colors, share};
    #[pymodule_export]
    use super::view::View;
    #[pymodule_export]
    use super::world::World;
}
