use bioscope_core::{Error, Result, parameters};
use serde::{Deserialize, Serialize};

use crate::placement::Habitat;

/// Most plants, and most shapes, of one stand.
const LARGEST_COUNT: usize = 100_000;
const MOST_VARIANTS: u32 = 64;
/// Longest L-system text in bytes.
const LONGEST_SOURCE: usize = 1 << 20;

parameters! {
    /// How plants answer the flow.
    pub struct PlantsParameters {
        /// How far the tips lean in a strong flow, 1 being a right angle to the stem's rest.
        flexibility: f32 = 0.7, "1", 0.0..=1.5, "choice";
        /// Speed of the flow that bends a plant by two thirds of what it can bend.
        yielding: f32 = 0.3, "m/s", 0.01..=50.0, "choice; about 0.3 in water and 8 in air";
        /// Time in which a plant of 1 m swings to and fro once; longer plants swing more slowly.
        period: f32 = 2.4, "s", 0.1..=30.0, "choice";
        /// How fast swinging dies away, 1 being without overshoot.
        damping: f32 = 0.55, "1", 0.05..=2.0, "choice";
        /// How much the ends of leaves flutter.
        flutter: f32 = 0.16, "rad", 0.0..=1.0, "choice";
        /// How far animals that pass push it aside, 1 being out of their way.
        parting: f32 = 1.0, "1", 0.0..=4.0, "Tu 1996, 7.1.2; its size is a choice";
    }
}

/// What grows, how many, where, and how they differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PlantsOptions {
    /// Their species in the scene.
    pub species: String,
    /// Text of the L-system.
    pub source: String,
    /// What errors in the text call it.
    pub file_name: String,
    /// Text of the palette that the turtle's color numbers mean; empty for the usual one.
    pub palette: String,
    /// Derivation steps; none takes the file's own number.
    pub steps: Option<u32>,
    /// How many plants.
    pub count: usize,
    /// Where they grow.
    pub habitat: Habitat,
    /// Level distance that a plant of size 1 keeps from others, metres.
    pub room: f32,
    /// Least and greatest size, relative to the shape that the text describes.
    pub size: [f32; 2],
    /// How many distinct shapes are grown.
    pub variants: u32,
    /// How much their colors differ, 0 (not) to 1.
    pub variety: f32,
    /// At most so many joints by which each bends.
    pub joints: u32,
    /// 0 (dry matt) to 1 (mirror) is 1 − roughness.
    pub roughness: f32,
    /// Share of light that comes through leaves from behind.
    pub translucency: f32,
    /// How they answer the flow.
    pub parameters: PlantsParameters,
}

impl Default for PlantsOptions {
    fn default() -> Self {
        Self {
            species: String::from("plant"),
            source: String::new(),
            file_name: String::from("plant.l"),
            palette: String::new(),
            steps: None,
            count: 40,
            habitat: Habitat { slope: [0.0, 35.0], patchiness: 0.5, ..Habitat::default() },
            room: 0.12,
            size: [0.6, 1.15],
            variants: 8,
            variety: 0.25,
            joints: 20,
            roughness: 0.6,
            translucency: 0.35,
            parameters: PlantsParameters::default(),
        }
    }
}

impl PlantsOptions {
    /// Refuses what has no meaning or is too much.
    pub fn check(&self) -> Result<()> {
        self.habitat.check()?;
        if self.count > LARGEST_COUNT {
            return Err(Error::value("count", self.count, format!("up to {LARGEST_COUNT}")));
        }
        if !(1..=MOST_VARIANTS).contains(&self.variants) {
            return Err(Error::value("variants", self.variants, format!("1 to {MOST_VARIANTS}")));
        }
        if !(1..=255).contains(&self.joints) {
            return Err(Error::value("joints", self.joints, "1 to 255"));
        }
        if self.source.len() > LONGEST_SOURCE || self.palette.len() > LONGEST_SOURCE {
            let found = format!("{} bytes", self.source.len().max(self.palette.len()));
            return Err(Error::value("source", found, format!("up to {LONGEST_SOURCE} bytes")));
        }
        let [small, large] = self.size;
        if !(small > 0.0 && small <= large && large <= 1e3) {
            let found = format!("[{small}, {large}]");
            return Err(Error::value("size", found, "least and greatest relative size"));
        }
        if !(self.room.is_finite() && self.room >= 0.0 && (0.0..=1.0).contains(&self.variety)) {
            let found = format!("{} m, {}", self.room, self.variety);
            return Err(Error::value("room and variety", found, "0 m or more, 0 to 1"));
        }
        Ok(())
    }
}
