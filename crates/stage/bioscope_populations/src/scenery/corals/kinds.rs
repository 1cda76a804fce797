use std::sync::Arc;

use bioscope_core::{Error, Result};
use bioscope_geometry::{Material, Mesh, Texture};
use serde::{Deserialize, Serialize};

use super::{massive, slender};
use crate::scenery::forms::with_details;
use crate::scenery::textures;

/// The growth forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum CoralKind {
    /// Domes with winding grooves.
    Brain,
    /// Massive colonies of rounded lobes.
    Lobes,
    /// Thin plates on a stalk.
    Table,
    /// Bushes of forking branches.
    Bush,
    /// Clusters of tube sponges.
    Tubes,
    /// Sea fans, across the current.
    Fan,
    /// Sheaves of sea whips.
    Whips,
}

impl CoralKind {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Brain, Self::Lobes, Self::Table, Self::Bush, Self::Tubes, Self::Fan, Self::Whips];

    /// Species in the scene, and name in options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Brain => "brain_coral",
            Self::Lobes => "lobed_coral",
            Self::Table => "table_coral",
            Self::Bush => "staghorn_coral",
            Self::Tubes => "tube_sponge",
            Self::Fan => "sea_fan",
            Self::Whips => "sea_whip",
        }
    }

    /// The kind of this name.
    pub fn named(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| Error::Unknown {
            kind: "coral",
            name: name.to_owned(),
            known: Self::ALL.iter().map(|one| one.name().to_owned()).collect(),
        })
    }

    /// Usual width, or height if it is slender, metres.
    pub(super) fn size(self) -> f32 {
        match self {
            Self::Brain => 0.62,
            Self::Lobes => 0.95,
            Self::Table => 1.35,
            Self::Bush => 0.75,
            Self::Tubes => 0.6,
            Self::Fan => 0.95,
            Self::Whips => 1.0,
        }
    }

    /// How much it leans with the ground, 0 (upright) to 1 (square to the ground).
    pub(super) fn leaning(self) -> f32 {
        match self {
            Self::Brain | Self::Lobes => 0.7,
            Self::Tubes | Self::Bush => 0.45,
            Self::Table | Self::Fan | Self::Whips => 0.2,
        }
    }

    /// How deep it sits in steep ground, relative to other kinds.
    pub(super) fn sinking(self) -> f32 {
        match self {
            Self::Brain | Self::Lobes => 1.0,
            Self::Table => 0.5,
            Self::Bush | Self::Tubes | Self::Fan | Self::Whips => 0.3,
        }
    }

    /// Radius and height of the solid that fishes steer round, in sizes; none for what gives way.
    pub(super) fn solid(self) -> Option<(f32, f32)> {
        match self {
            Self::Brain => Some((0.48, 0.4)),
            Self::Lobes => Some((0.45, 0.5)),
            Self::Table => Some((0.42, 0.5)),
            Self::Bush => Some((0.4, 0.6)),
            Self::Tubes => Some((0.25, 0.9)),
            Self::Fan | Self::Whips => None,
        }
    }

    /// Linear colors of which each colony has one.
    pub(super) fn palette(self) -> &'static [[f32; 3]] {
        match self {
            Self::Brain => {
                &[[0.86, 0.58, 0.10], [0.78, 0.44, 0.20], [0.46, 0.66, 0.14], [0.82, 0.36, 0.44]]
            }
            Self::Lobes => {
                &[[0.98, 0.66, 0.10], [0.92, 0.44, 0.52], [0.66, 0.60, 0.18], [0.84, 0.50, 0.26]]
            }
            Self::Table => {
                &[[0.82, 0.58, 0.24], [0.62, 0.46, 0.74], [0.56, 0.62, 0.22], [0.92, 0.46, 0.36]]
            }
            Self::Bush => {
                &[[1.00, 0.64, 0.16], [0.60, 0.46, 0.82], [1.00, 0.80, 0.46], [1.0, 0.42, 0.46]]
            }
            Self::Tubes => &[[0.72, 0.22, 0.84], [1.0, 0.72, 0.06], [1.0, 0.34, 0.08]],
            Self::Fan => &[[0.78, 0.18, 0.66], [1.0, 0.28, 0.12], [1.0, 0.68, 0.12]],
            Self::Whips => &[[1.0, 0.16, 0.10], [1.0, 0.46, 0.08], [0.95, 0.86, 0.70]],
        }
    }

    /// One of its shapes.
    pub(super) fn shape(self, seed: u32) -> Arc<Mesh> {
        let build: fn(u32, u32) -> Mesh = match self {
            Self::Brain => massive::brain,
            Self::Lobes => massive::lobes,
            Self::Table => massive::table,
            Self::Bush => slender::bush,
            Self::Tubes => massive::tubes,
            Self::Fan => slender::fan,
            Self::Whips => slender::whips,
        };
        let details = if matches!(self, Self::Brain | Self::Lobes) { 3 } else { 4 };
        with_details(details, |detail| build(seed, detail))
    }

    pub(super) fn material(self) -> Arc<Material> {
        let cut = self == Self::Fan;
        Arc::new(Material {
            name: self.name().to_owned(),
            color: [1.0; 3],
            texture: self.texture(),
            cutout: cut,
            two_sided: matches!(self, Self::Fan | Self::Table | Self::Tubes),
            translucency: if cut { 0.3 } else { 0.0 },
            roughness: 0.8,
            ..Material::default()
        })
    }

    fn texture(self) -> Option<Arc<Texture>> {
        match self {
            Self::Brain => Some(textures::meanders()),
            Self::Lobes | Self::Table | Self::Bush => Some(textures::polyps()),
            Self::Tubes => Some(textures::sponge()),
            Self::Fan => Some(textures::fan()),
            Self::Whips => None,
        }
    }
}
