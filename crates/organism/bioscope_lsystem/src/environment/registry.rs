//! Environments by name.

use std::path::Path;

use super::collision::{Collision, Competition};
use super::guides::{Obstacles, Pole, Pruning};
use super::limbs::Limbs;
use super::patch_light::{LightMap, PatchLight};
use super::settings::Settings;
use super::shadow::{Density, DensityVoxels, ShadowVoxels};
use super::sky_light::SkyLight;
use super::soil::SoilWater;
use super::takenaka::LeafBalls;
use super::{Environment, EnvironmentError};
use crate::EnvironmentFile;

/// Most bytes of an environment file or a specification.
const LARGEST: u64 = 16 << 20;

const NAMES: [&str; 21] = [
    "sky_light",
    "patch_light",
    "leaf_discs",
    "collision",
    "soil_water",
    "neighborhood",
    "neighbourhood",
    "community",
    "pole",
    "obstacles",
    "limbs",
    "pruning",
    "shadow_voxels",
    "chiba",
    "clover",
    "honda81",
    "ecosystem",
    "takenaka",
    "density",
    "density3d",
    "soil",
];

/// Names of the environments that [`built_in`] knows, besides `shadowpyramid`.
pub fn environment_names() -> &'static [&'static str] {
    &NAMES
}

/// The environment of this name, as built in or as a field program of cpfg.
///
/// `map` is the light of `clover` and `patch_light` where that is a picture.
pub fn built_in(
    name: &str,
    settings: &Settings,
    map: Option<LightMap>,
) -> Result<Box<dyn Environment>, EnvironmentError> {
    Ok(match name {
        "sky_light" => Box::new(SkyLight::from_settings(settings)?),
        "chiba" => Box::new(SkyLight::chiba(settings)?),
        "patch_light" => match map {
            Some(map) => Box::new(PatchLight::new(map, settings.number(&["tau"], 0.0))),
            None => Box::new(PatchLight::from_settings(settings)?),
        },
        "clover" => Box::new(PatchLight::clover(settings, map)?),
        "leaf_discs" | "collision" => Box::new(Collision::from_settings(settings)?),
        "honda81" => Box::new(Competition::honda81(settings)?),
        "ecosystem" => Box::new(Competition::ecosystem(settings)?),
        "neighborhood" | "neighbourhood" => Box::new(Competition::neighborhood(settings)?),
        "community" => Box::new(Competition::community(settings)?),
        "soil_water" => Box::new(SoilWater::from_settings(settings)?),
        "soil" => Box::new(SoilWater::soil(settings)?),
        "takenaka" => Box::new(LeafBalls::from_settings(settings)?),
        "density" => Box::new(Density::from_settings(settings)?),
        "density3d" => Box::new(DensityVoxels::from_settings(settings)?),
        "shadowpyramid" | "shadow_voxels" => Box::new(ShadowVoxels::from_settings(settings)?),
        "pole" => Box::new(Pole::from_settings(settings)?),
        "limbs" => Box::new(Limbs::from_settings(settings)?),
        "obstacles" => Box::new(Obstacles::from_settings(settings)?),
        "pruning" => Box::new(Pruning::from_settings(settings)?),
        _ => {
            return Err(EnvironmentError::Refused {
                name: name.into(),
                reason: format!("no such environment is built in; known: {}", NAMES.join(", ")),
            });
        }
    })
}

/// The environment that an environment file (.e) and the specification beside it describe.
///
/// The program that the file names is never run: what it would do is built in.
pub fn read_environment(path: &Path) -> bioscope_core::Result<Box<dyn Environment>> {
    use std::io::Read;
    let name = path.to_string_lossy().into_owned();
    let broken = |place: &str, error: &dyn std::fmt::Display| {
        bioscope_core::Error::format(place, error.to_string())
    };
    let read = |path: &Path| -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        std::fs::File::open(path)?.take(LARGEST).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read(path).map_err(|error| broken(&name, &error))?;
    let file = EnvironmentFile::parse(&bytes, &name)?;
    let settings = match &file.specification {
        None => Settings::default(),
        Some(specification) => {
            let beside = path
                .parent()
                .unwrap_or(Path::new(""))
                .join(Path::new(specification).file_name().unwrap_or_default());
            let bytes = read(&beside).map_err(|error| broken(&beside.to_string_lossy(), &error))?;
            Settings::parse(&bytes, &beside.to_string_lossy())?
        }
    };
    built_in(&file.program, &settings, None).map_err(|error| broken(&name, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_an_environment() {
        for name in NAMES {
            let mut settings = Settings::default();
            if name == "limbs" {
                settings.set("limb", "0 0 0 0 1 0 0.1 0.1");
            }
            if name == "soil" {
                settings.set("array", "1 1 1 0 1 0.5");
            }
            assert!(built_in(name, &settings, None).is_ok(), "{name}");
        }
        let mut wrong = Settings::default();
        wrong.set("rno", "3");
        let error = built_in("leaf_discs", &wrong, None).err().unwrap().to_string();
        assert!(error.contains("no setting 'rno'"), "{error}");
        assert!(built_in("moon", &Settings::default(), None).is_err());
    }
}
