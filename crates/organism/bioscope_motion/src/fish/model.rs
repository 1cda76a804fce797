use std::sync::{Arc, OnceLock};

use bioscope_core::{Error, Result};
use bioscope_dynamics::spring_body::fish::{FishShape, FishTissue, fish};
use bioscope_dynamics::spring_body::{Integrator, Mechanics, Medium};
use serde::{Deserialize, Serialize};

use super::tables::{FinSettings, SwimTable, TurnTable};

/// All numbers of a muscle-driven fish as they stand in a file: body, water, and the calibrated tables of its motor
/// controllers. Lengths are in body lengths, masses in body masses, times in time units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FishDesign {
    /// What it is, in a sentence.
    pub about: String,
    /// Step of integration for which the tables hold.
    pub step: f64,
    /// Method of integration.
    pub integrator: Integrator,
    /// Shape at rest.
    pub shape: FishShape,
    /// Masses, stiffness, muscles.
    pub tissue: FishTissue,
    /// Water.
    pub medium: Medium,
    /// Strokes for all speeds.
    pub swim: SwimTable,
    /// Bends for all angles.
    pub turn: TurnTable,
    /// Pectoral fins.
    pub fins: FinSettings,
}

impl FishDesign {
    /// Reads a design from TOML; `file` is named in error messages.
    ///
    /// # Errors
    /// For missing, unknown and impossible values.
    pub fn parse(text: &str, file: &str) -> Result<Self> {
        let design: Self =
            toml::from_str(text).map_err(|error| Error::format(file, error.message()))?;
        let wrong = |error: Error| Error::format(file, error.to_string());
        design.medium.checked().map_err(wrong)?;
        design.swim.check().map_err(wrong)?;
        design.turn.check().map_err(wrong)?;
        design.fins.check().map_err(wrong)?;
        if !(1e-4..=1.0).contains(&design.step) {
            return Err(wrong(Error::value("step", design.step, "0.0001 to 1 time unit")));
        }
        Ok(design)
    }
}

/// A design that was built: what all fishes of a kind share.
#[derive(Clone, Debug)]
pub struct FishModel {
    /// The numbers it was built from.
    pub design: FishDesign,
    /// Body and water.
    pub mechanics: Mechanics,
}

impl FishModel {
    /// Builds a design.
    ///
    /// # Errors
    /// For impossible shapes and constants.
    pub fn new(design: FishDesign) -> Result<Self> {
        let anatomy = fish(&design.shape, &design.tissue)?;
        let medium = design.medium.checked()?;
        let mechanics = Mechanics { anatomy, medium, integrator: design.integrator };
        Ok(Self { design, mechanics })
    }

    /// The ready-made design of this name: `calibrated` or `published`; built once.
    ///
    /// # Errors
    /// For other names.
    pub fn named(name: &str) -> Result<Arc<Self>> {
        static READY: OnceLock<Vec<(&str, Arc<FishModel>)>> = OnceLock::new();
        let build = |name, text| {
            let design = FishDesign::parse(text, name).expect("ready-made designs are tested");
            let model = Self::new(design).expect("ready-made designs are tested");
            (name, Arc::new(model))
        };
        let ready = READY.get_or_init(|| PRESETS.map(|(name, text)| build(name, text)).to_vec());
        let found = ready.iter().find(|(known, _)| *known == name);
        found.map(|(_, model)| Arc::clone(model)).ok_or_else(|| Error::Unknown {
            kind: "preset",
            name: name.to_owned(),
            known: PRESETS.map(|(name, _)| name.to_owned()).to_vec(),
        })
    }

    /// Mass in kilograms of a fish of this length in metres, which weighs as much as the water it takes the place of.
    pub fn mass(&self, length: f64) -> f64 {
        const WATER: f64 = 1000.0;
        WATER * self.mechanics.anatomy.volume() * length.powi(3)
    }

    /// Distance of the center of mass from the snout at rest, body lengths.
    pub fn center(&self) -> f64 {
        let anatomy = &self.mechanics.anatomy;
        -anatomy.nodes.iter().zip(&anatomy.masses).map(|(node, mass)| node[2] * mass).sum::<f64>()
    }
}

const PRESETS: [(&str, &str); 2] = [
    ("calibrated", include_str!("../../tables/calibrated.toml")),
    ("published", include_str!("../../tables/published.toml")),
];
