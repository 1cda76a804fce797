use bioscope_core::{Error, Result, parameters};
use bioscope_lsystem::{LightMap, Settings};
use serde::{Deserialize, Serialize};

use crate::placement::Habitat;
use crate::plants::PlantsParameters;

/// Most plants of one stand.
const LARGEST_COUNT: usize = 20_000;
/// Longest text in bytes, and of all texts together.
const LONGEST_SOURCE: usize = 1 << 20;
const LONGEST_SOURCES: usize = 64 << 20;
/// Most surfaces of what the surroundings keep.
const MOST_LEVELS: usize = 8;
/// Most steps that plants may have grown before the world begins.
const LONGEST_START: u64 = 100_000;

parameters! {
    /// How fast a stand grows, spreads and answers the flow.
    pub struct StandParameters {
        /// Growth steps per second of world time.
        rate: f32 = 10.0, "1/s", 0.0..=1000.0, "choice";
        /// Share of the seeds that germinate where there is room.
        germination: f32 = 0.5, "1", 0.0..=1.0, "choice";
        /// How far from its mother a seed falls in still air (standard deviation).
        dispersal: f32 = 3.0, "m", 0.0..=1000.0, "choice";
        /// How fast seeds and leaves fall.
        falling: f32 = 1.1, "m/s", 0.05..=20.0, "choice; a maple's fruit falls at 1.1 m/s";
        /// How far the tips lean in a strong flow, 1 being a right angle to the stem's rest.
        flexibility: f32 = 0.2, "1", 0.0..=1.5, "choice";
        /// Speed of the flow that bends a plant by two thirds of what it can bend.
        yielding: f32 = 8.0, "m/s", 0.01..=50.0, "choice; about 0.3 in water and 8 in air";
        /// Time in which a plant of 1 m swings to and fro once; longer plants swing more slowly.
        period: f32 = 1.2, "s", 0.1..=30.0, "choice";
        /// How fast swinging dies away, 1 being without overshoot.
        damping: f32 = 0.3, "1", 0.05..=2.0, "choice";
        /// How much the ends of leaves flutter.
        flutter: f32 = 0.12, "rad", 0.0..=1.0, "choice";
    }
}

impl StandParameters {
    /// How the plants answer the flow.
    pub(super) fn sway(&self) -> PlantsParameters {
        PlantsParameters {
            flexibility: self.flexibility,
            yielding: self.yielding,
            period: self.period,
            damping: self.damping,
            flutter: self.flutter,
            // Trunks do not give way to what passes.
            parting: 0.0,
        }
    }
}

/// An environment: a built-in one by name, as [`bioscope_lsystem::built_in`] makes it, or a foreign one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Surroundings {
    /// Its name: `sky_light`.
    pub name: String,
    /// Whether it is none of the engine's: the stand is given it, and a saved one is brought back by its name.
    #[serde(default)]
    pub foreign: bool,
    /// Its settings.
    #[serde(default)]
    pub settings: Vec<(String, String)>,
    /// Light by place, where it needs that.
    #[serde(default)]
    pub map: Option<LightMap>,
}

/// What grows, how many, where, in which surroundings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StandOptions {
    /// Their species in the scene.
    pub species: String,
    /// Texts of the L-system, taken in turn: one, or one per plant with its own numbers.
    pub sources: Vec<String>,
    /// What errors in the text call it.
    pub file_name: String,
    /// Text of the palette that the turtle's color numbers mean; empty for the usual one.
    pub palette: String,
    /// How many plants there are at first.
    pub count: usize,
    /// How many there may be.
    pub most: usize,
    /// Where they grow.
    pub habitat: Habitat,
    /// Level distance that a plant keeps from others when it is planted or germinates, metres.
    pub room: f32,
    /// Metres per unit of the model.
    pub size: f32,
    /// Steps that they have grown before the world begins.
    pub start: u64,
    /// After how many steps a plant is complete; none takes the file's own number.
    pub steps: Option<u64>,
    /// Seeds germinate only in steps that are multiples of this, as in spring.
    pub season: u64,
    /// What surrounds them; none takes what the file asks for.
    pub environment: Option<Surroundings>,
    /// Where the middle of the surroundings is, metres; the middle of the plants if none.
    pub origin: Option<[f32; 3]>,
    /// Whether the plane of the turtle's drawing is the ground.
    pub lying: bool,
    /// Whether each plant looks in another direction.
    pub turned: bool,
    /// Symbol of modules that leave the plant as seeds; empty for none.
    pub seeds: String,
    /// Symbol of modules that leave the plant as fallen leaves; empty for none.
    pub litter: String,
    /// Shape to which every plant is cut, in metres from its own foot; empty for none.
    pub clip: Vec<(String, String)>,
    /// Whether what is new in a step unfolds while it lasts: for models of few large steps.
    pub unfold: bool,
    /// Amounts of what the surroundings keep (water in the soil) that are seen: as surfaces that one looks
    /// through in a deep field; a flat one is painted, blue at the greatest of them. Empty shows nothing.
    pub levels: Vec<f32>,
    /// How much their colors differ, 0 to 1.
    pub variety: f32,
    /// At most so many joints by which each bends.
    pub joints: u32,
    /// 0 (dry matt) to 1 (mirror) is 1 − roughness.
    pub roughness: f32,
    /// Share of light that comes through leaves from behind.
    pub translucency: f32,
    /// Speed of growth, and how they answer the flow.
    pub parameters: StandParameters,
}

impl Default for StandOptions {
    fn default() -> Self {
        Self {
            species: String::from("plant"),
            sources: Vec::new(),
            file_name: String::from("plant.l"),
            palette: String::new(),
            count: 12,
            most: 1000,
            habitat: Habitat { slope: [0.0, 35.0], ..Habitat::default() },
            room: 0.5,
            size: 1.0,
            start: 0,
            steps: None,
            season: 1,
            environment: None,
            origin: None,
            lying: false,
            turned: true,
            seeds: String::new(),
            litter: String::new(),
            clip: Vec::new(),
            unfold: false,
            levels: Vec::new(),
            variety: 0.2,
            joints: 12,
            roughness: 0.75,
            translucency: 0.35,
            parameters: StandParameters::default(),
        }
    }
}

impl StandOptions {
    /// Name of the environment if it is none of the engine's.
    pub(super) fn foreign(&self) -> Option<&str> {
        let asked = self.environment.as_ref().filter(|asked| asked.foreign);
        asked.map(|asked| asked.name.as_str())
    }

    /// Refuses what has no meaning or is too much.
    pub fn check(&self) -> Result<()> {
        self.habitat.check()?;
        if self.count > LARGEST_COUNT || self.most > LARGEST_COUNT {
            let found = self.count.max(self.most);
            return Err(Error::value("count", found, format!("up to {LARGEST_COUNT}")));
        }
        if self.sources.is_empty() {
            return Err(Error::value("sources", 0, "at least one text"));
        }
        let longest = self.sources.iter().map(String::len).max().unwrap_or(0);
        let all: usize = self.sources.iter().map(String::len).sum();
        if longest.max(self.palette.len()) > LONGEST_SOURCE || all > LONGEST_SOURCES {
            let found = format!("{longest} bytes, {all} together");
            return Err(Error::value("sources", found, format!("up to {LONGEST_SOURCE} bytes")));
        }
        if self.start > LONGEST_START || self.season == 0 {
            let found = format!("{}, {}", self.start, self.season);
            let expected = format!("up to {LONGEST_START} steps, at least 1");
            return Err(Error::value("start and season", found, expected));
        }
        if !(1..=255).contains(&self.joints) {
            return Err(Error::value("joints", self.joints, "1 to 255"));
        }
        self.check_sizes()
    }

    fn check_sizes(&self) -> Result<()> {
        if !(1e-6..=1e6).contains(&self.size) {
            return Err(Error::value("size", self.size, "metres per unit of the model"));
        }
        if !(self.room.is_finite() && self.room >= 0.0 && (0.0..=1.0).contains(&self.variety)) {
            let found = format!("{} m, {}", self.room, self.variety);
            return Err(Error::value("room and variety", found, "0 m or more, 0 to 1"));
        }
        if self.levels.len() > MOST_LEVELS
            || self.levels.iter().any(|&level| level.is_nan() || level <= 0.0)
        {
            let expected = format!("up to {MOST_LEVELS} amounts above 0");
            return Err(Error::value("levels", format!("{:?}", self.levels), expected));
        }
        if self.origin.is_some_and(|place| !place.iter().all(|part| part.is_finite())) {
            return Err(Error::value("origin", format!("{:?}", self.origin), "a place"));
        }
        Ok(())
    }
}

/// Settings of these pairs.
pub(super) fn settings(pairs: &[(String, String)]) -> Settings {
    let mut settings = Settings::default();
    pairs.iter().for_each(|(name, value)| settings.set(name, value));
    settings
}
