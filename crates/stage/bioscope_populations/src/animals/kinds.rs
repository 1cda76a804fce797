use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Result};
use bioscope_minds::{Mind, Roamer};
use bioscope_motion::undulation::Spine;
use bioscope_motion::{Body, MuscleSwimmer, Swimmer};
use bioscope_senses::{Eye, Hearing, LateralLine, Light, Sense, Sight, Smell, Touch, restore};

use super::Look;

type Build<T> = BTreeMap<String, Box<dyn Fn(&[u8]) -> Result<T> + Send + Sync>>;
type BuildBody = Box<dyn Fn(&[u8], &Look) -> Result<Box<dyn Body>> + Send + Sync>;

/// Constructors of the parts of animals by kind, with which saved animals are brought back.
pub struct Kinds {
    senses: Build<Box<dyn Sense>>,
    minds: Build<Box<dyn Mind>>,
    bodies: BTreeMap<String, BuildBody>,
    looks: Build<Arc<Look>>,
}

impl Default for Kinds {
    /// Knows the parts of the engine.
    fn default() -> Self {
        let mut kinds = Self {
            senses: BTreeMap::new(),
            minds: BTreeMap::new(),
            bodies: BTreeMap::new(),
            looks: BTreeMap::new(),
        };
        kinds.add_sense("sight", |bytes| Ok(Box::new(restore::<Sight>("sight", bytes)?)));
        kinds.add_sense("touch", |bytes| Ok(Box::new(restore::<Touch>("touch", bytes)?)));
        kinds.add_sense("hearing", |bytes| Ok(Box::new(restore::<Hearing>("hearing", bytes)?)));
        kinds.add_sense("smell", |bytes| Ok(Box::new(restore::<Smell>("smell", bytes)?)));
        kinds.add_sense("eye", |bytes| Ok(Box::new(restore::<Eye>("eye", bytes)?)));
        kinds.add_sense("light", |bytes| Ok(Box::new(restore::<Light>("light", bytes)?)));
        kinds.add_sense("lateral_line", |bytes| {
            Ok(Box::new(restore::<LateralLine>("lateral_line", bytes)?))
        });
        kinds.add_mind("roamer", |bytes| Ok(Box::new(Roamer::restore(bytes)?)));
        for kind in crate::fish::MINDS {
            kinds.add_mind(kind, move |bytes| crate::fish::mind(kind, bytes));
        }
        kinds.add_body("swimmer", |bytes, look| {
            Ok(Box::new(Swimmer::restore(spine(look)?, bytes)?))
        });
        kinds.add_body("muscle_swimmer", |bytes, look| {
            Ok(Box::new(MuscleSwimmer::restore(spine(look)?, bytes)?))
        });
        kinds.add_look("fish", crate::fish::look_from);
        kinds
    }
}

impl Kinds {
    /// Teaches how to build a sense of this kind from its saved state.
    pub fn add_sense(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8]) -> Result<Box<dyn Sense>> + Send + Sync + 'static,
    ) {
        self.senses.insert(kind.to_owned(), Box::new(build));
    }

    /// Teaches how to build a mind of this kind from its saved state.
    pub fn add_mind(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8]) -> Result<Box<dyn Mind>> + Send + Sync + 'static,
    ) {
        self.minds.insert(kind.to_owned(), Box::new(build));
    }

    /// Teaches how to build a body of this kind from its saved state and the look of its animal.
    pub fn add_body(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8], &Look) -> Result<Box<dyn Body>> + Send + Sync + 'static,
    ) {
        self.bodies.insert(kind.to_owned(), Box::new(build));
    }

    /// Teaches how to build a look of this kind from its description.
    pub fn add_look(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8]) -> Result<Arc<Look>> + Send + Sync + 'static,
    ) {
        self.looks.insert(kind.to_owned(), Box::new(build));
    }

    pub(super) fn sense(&self, kind: &str, bytes: &[u8]) -> Result<Box<dyn Sense>> {
        find("sense", kind, &self.senses)?(bytes)
    }

    pub(super) fn mind(&self, kind: &str, bytes: &[u8]) -> Result<Box<dyn Mind>> {
        find("mind", kind, &self.minds)?(bytes)
    }

    pub(super) fn body(&self, kind: &str, bytes: &[u8], look: &Look) -> Result<Box<dyn Body>> {
        find("body", kind, &self.bodies)?(bytes, look)
    }

    pub(super) fn look(&self, kind: &str, bytes: &[u8]) -> Result<Arc<Look>> {
        find("look", kind, &self.looks)?(bytes)
    }
}

/// What a body swims with.
fn spine(look: &Look) -> Result<Arc<Spine>> {
    look.spine.clone().ok_or_else(|| {
        Error::format("body", format!("a '{}' has no spine to swim with", look.species))
    })
}

fn find<'a, T>(part: &'static str, kind: &str, known: &'a BTreeMap<String, T>) -> Result<&'a T> {
    known.get(kind).ok_or_else(|| Error::Unknown {
        kind: part,
        name: kind.to_owned(),
        known: known.keys().cloned().collect(),
    })
}
