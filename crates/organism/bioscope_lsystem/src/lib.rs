//! L-systems: parametric, stochastic, bracketed, conditional and context-sensitive, in the
//! notation of cpfg, and the turtle that turns their strings into shapes.
//!
//! [`LSystem::parse`] reads a model, [`LSystem::derive`] rewrites its axiom to a [`ModuleString`].
//!
//! Sources: P. Prusinkiewicz and A. Lindenmayer, *The Algorithmic Beauty of Plants* (1990), for
//! the formalism and the turtle; the cpfg program for the dialect. Angles in texts are degrees.

mod context;
mod derivation;
mod diagnostic;
mod environment;
mod files;
mod functions;
mod geometry;
mod interpretation;
mod lexer;
mod machine;
mod model;
mod parser;
mod preprocessor;
mod source;
mod string;
mod turtle;

pub use derivation::{
    Derivation, DerivationError, DerivationOptions, Fragment, Limits, Lineage, Placed, Progress,
    Shown,
};
pub use diagnostic::{Diagnostic, Diagnostics, Place};
pub use environment::{
    Amounts, Collision, Competition, Density, DensityVoxels, Environment, EnvironmentError,
    Following, LeafBalls, Letter, LightMap, Limbs, Mailbox, Obstacles, PatchLight, Pipe, Pole,
    Pruning, Reply, Request, Settings, ShadowVoxels, Shape, SkyLight, SoilWater, built_in,
    environment_names, read_environment,
};
pub use files::{
    Animation, ContourShape, ContourVertex, Curve, EnvironmentFile, Function, FunctionTable,
    Interval, Shapes, SurfaceShape, Tessellation, TextureFile, View, ViewCamera, ViewLight,
    read_color_map, read_materials,
};
pub use functions::Functions;
pub use geometry::{Held, MeshOptions, Palette, PlantShape, SkeletonOptions};
pub use interpretation::{
    Anchor, Axis, Ball, Basis, Contour, Disc, Interpretation, Label, Patch, Polygon, Segment,
    Surface,
};
pub use model::{Alphabet, LSystem, ModuleKind};
pub use string::ModuleString;
pub use turtle::{
    Between, Conventions, Frame, Movement, Pose, SharedPart, SharedPlant, Turtle, TurtleOptions,
};
