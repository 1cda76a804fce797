//! From the text of an L-system to shapes that can bend.

use std::sync::Arc;

use bioscope_core::{Error, Purpose, Random, Result, Vec3, math};
use bioscope_geometry::{Joint, Material, Mesh};
use bioscope_lsystem::{
    LSystem, Limits, MeshOptions, Palette, PlantShape, SkeletonOptions, Turtle, TurtleOptions,
};
use rayon::prelude::*;

use super::PlantsOptions;

const SHAPE: Purpose = Purpose::new("plant shape");
/// What growing one shape may use.
const LIMITS: Limits = Limits { modules: 2_000_000, bytes: 256 << 20, operations: 200_000_000 };
/// Most triangles of one shape.
const LARGEST_MESH: usize = 2_000_000;

/// All shapes of a stand.
#[derive(Default)]
pub(super) struct Shapes {
    pub variants: Vec<Shape>,
    pub material: Arc<Material>,
}

/// One grown shape.
pub(super) struct Shape {
    pub mesh: Arc<Mesh>,
    /// Per joint, parents first.
    pub joints: Vec<Bend>,
    /// Height above the root, metres.
    pub height: f32,
    /// Longest way from the root to a tip, metres.
    pub length: f32,
}

/// How one joint takes part in the sway.
pub(crate) struct Bend {
    /// Number of the parent joint, none for the root.
    pub parent: Option<usize>,
    /// Place at rest relative to the parent, mesh space, metres.
    pub offset: Vec3,
    /// 0 at the root, 1 at the tip of a chain.
    pub flexibility: f32,
    /// Cosine and sine of its own phase in the flutter.
    pub phase: [f32; 2],
}

impl Shapes {
    pub(super) fn grow(options: &PlantsOptions, seed: u64) -> Result<Self> {
        let system = LSystem::parse(&options.source, &options.file_name)?;
        let palette = if options.palette.is_empty() {
            Palette::default()
        } else {
            Palette::parse(&options.palette, &format!("colors of {}", options.file_name))?
        };
        let sides = system.constant("SIDES").map_or(6, |sides| sides.clamp(3.0, 24.0) as u32);
        let meshing = MeshOptions { sides, palette };
        let numbers = (0..options.variants).into_par_iter();
        let grown: Vec<Result<Shape>> = numbers
            .map(|number| {
                let own = Random::new(seed, number + 1, 0, SHAPE).bits();
                Shape::grow(&system, options, &meshing, u64::from(own))
            })
            .collect();
        let material = Material {
            name: options.species.clone(),
            color: [1.0; 3],
            roughness: options.roughness,
            translucency: options.translucency,
            two_sided: true,
            ..Material::default()
        };
        let variants = grown.into_iter().collect::<Result<_>>()?;
        Ok(Self { variants, material: Arc::new(material) })
    }
}

impl Shape {
    fn grow(
        system: &LSystem,
        options: &PlantsOptions,
        meshing: &MeshOptions,
        seed: u64,
    ) -> Result<Self> {
        let steps = u64::from(options.steps.unwrap_or(system.derivation_length()));
        let string = system.derive_within(steps, seed, &LIMITS)?;
        let string = system.appearance(&string, seed)?;
        let usual = TurtleOptions::default();
        let turtle = TurtleOptions { angle: system.angle().unwrap_or(usual.angle), ..usual };
        let skeleton = SkeletonOptions { joints: options.joints, ..SkeletonOptions::default() };
        let grown = Turtle::interpret(&string, &turtle)?.shape(meshing, &skeleton)?;
        let triangles = grown.mesh.triangles.len();
        if triangles > LARGEST_MESH {
            let what = format!("{}: a plant of {triangles} triangles", options.file_name);
            return Err(Error::Limit { what, limit: format!("{LARGEST_MESH} triangles") });
        }
        Ok(Self::bendable(grown))
    }

    fn bendable(grown: PlantShape) -> Self {
        let joints = Bend::of(&grown);
        let PlantShape { mesh, height, length, .. } = grown;
        Self { mesh: Arc::new(mesh.with_levels()), joints, height, length }
    }
}

impl Bend {
    /// How the joints of a plant take part in its sway.
    pub(crate) fn of(grown: &PlantShape) -> Vec<Self> {
        let joints = grown.mesh.skin.as_ref().map_or(&[][..], |skin| &skin.joints);
        let bend = |(number, (joint, &flexibility)): (usize, (&Joint, &f32))| {
            let parent = joint.parent.map(usize::from);
            let origin = parent.map_or(Vec3::ZERO, |one| joints[one].rest.position);
            // The golden angle keeps any two joints out of step.
            let phase = number as f32 * 2.399_963;
            Self {
                parent,
                offset: joint.rest.position - origin,
                flexibility: flexibility.clamp(0.0, 1.0),
                phase: [math::cos(phase), math::sin(phase)],
            }
        };
        joints.iter().zip(&grown.flexibility).enumerate().map(bend).collect()
    }
}
