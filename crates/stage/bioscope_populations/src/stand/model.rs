//! The texts of a stand, read.

use bioscope_core::{Error, Result};
use bioscope_lsystem::{
    Derivation, DerivationOptions, Environment, LSystem, Letter, Limits, Lineage, Mailbox,
    MeshOptions, Palette, Progress, Shape, TurtleOptions, built_in,
};

use super::StandOptions;
use super::options::settings;

/// What one plant may use in a step.
const LIMITS: Limits = Limits { modules: 2_000_000, bytes: 64 << 20, operations: 50_000_000 };

/// One text, read, and how its plants are drawn.
pub(super) struct Model {
    pub system: LSystem,
    pub turtle: TurtleOptions,
    pub meshing: MeshOptions,
    /// Codes of the modules that leave the plant: seeds, and litter.
    pub seeds: Vec<u8>,
    pub litter: Vec<u8>,
}

/// All texts of a stand, and the shape to which its plants are cut.
pub(super) struct Models {
    pub list: Vec<Model>,
    pub clip: Option<Shape>,
}

impl Models {
    pub fn read(options: &StandOptions) -> Result<Self> {
        let palette = if options.palette.is_empty() {
            Palette::default()
        } else {
            Palette::parse(&options.palette, &format!("colors of {}", options.file_name))?
        };
        let read = |text: &String| Model::read(text, options, &palette);
        let list = options.sources.iter().map(read).collect::<Result<_>>()?;
        let clip =
            (!options.clip.is_empty()).then(|| Shape::from_settings(&settings(&options.clip)));
        if clip == Some(Shape::Union(Vec::new())) {
            return Err(Error::value(
                "clip",
                format!("{:?}", options.clip),
                "a ball, box, cone, …",
            ));
        }
        Ok(Self { list, clip })
    }

    /// The model of the plant of this number.
    pub fn of(&self, source: u32) -> &Model {
        &self.list[source as usize % self.list.len()]
    }
}

/// The environment that a stand shares: what its options or its text ask for.
pub(super) fn environment(options: &StandOptions) -> Result<Option<Box<dyn Environment>>> {
    let refused = |error| Error::format("environment", format!("{error}"));
    if let Some(asked) = &options.environment {
        if asked.name.is_empty() {
            return Ok(None);
        }
        if asked.foreign {
            return Err(missing(&asked.name));
        }
        let settings = settings(&asked.settings);
        return built_in(&asked.name, &settings, asked.map.clone()).map(Some).map_err(refused);
    }
    let Some(source) = options.sources.first() else { return Ok(None) };
    let system = LSystem::parse(source, &options.file_name)?;
    match system.environment() {
        // Files are not read: a saved world must not depend on them.
        Some(words) if words.trim().ends_with(".e") => Err(Error::format(
            "environment",
            format!("{words}: an environment file; give the environment to the stand"),
        )),
        Some(words) => DerivationOptions::environment_of(words).map(Some).map_err(refused),
        None => Ok(None),
    }
}

/// What is said where an environment is needed that is none of the engine's.
pub(super) fn missing(name: &str) -> Error {
    Error::format("environment", format!("{name} is none of the engine's; give it to the stand"))
}

impl Model {
    fn read(text: &str, options: &StandOptions, palette: &Palette) -> Result<Self> {
        let system = LSystem::parse(text, &options.file_name)?;
        let usual = TurtleOptions::default();
        let turtle = TurtleOptions { angle: system.angle().unwrap_or(usual.angle), ..usual };
        let sides = system.constant("SIDES").map_or(6, |sides| sides.clamp(3.0, 24.0) as u32);
        let meshing = MeshOptions { sides, palette: palette.clone() };
        let codes = |symbol: &str| {
            let kinds = system.alphabet().kinds().iter().enumerate();
            let own = kinds.filter(|(_, kind)| !symbol.is_empty() && &*kind.symbol == symbol);
            own.map(|(code, _)| code as u8).collect()
        };
        let (seeds, litter) = (codes(&options.seeds), codes(&options.litter));
        Ok(Self { turtle, meshing, seeds, litter, system })
    }

    /// A plant that begins with the axiom, and what it asks.
    pub fn germinate(&self, seed: u64) -> Result<(Progress, Vec<Letter>)> {
        let mailbox = Mailbox::default();
        let derivation = Derivation::with_options(&self.system, self.options(seed, &mailbox))?;
        Ok((derivation.progress(), mailbox.take()))
    }

    /// A plant one step later, what it asks, and what has become of its modules if that is `traced`.
    pub fn advance(
        &self,
        seed: u64,
        progress: &Progress,
        traced: bool,
    ) -> Result<(Progress, Vec<Letter>, Lineage)> {
        let mailbox = Mailbox::default();
        let options = self.options(seed, &mailbox);
        let mut derivation = Derivation::resume(&self.system, options, progress)?;
        let lineage = if traced {
            derivation.advance_traced()?
        } else {
            derivation.advance()?;
            Lineage::default()
        };
        Ok((derivation.progress(), mailbox.take(), lineage))
    }

    fn options(&self, seed: u64, mailbox: &Mailbox) -> DerivationOptions {
        DerivationOptions {
            seed: Some(seed),
            limits: LIMITS,
            threads: false,
            environment: Some(Box::new(mailbox.clone())),
            turtle: self.turtle.clone(),
            ..DerivationOptions::default()
        }
    }
}
