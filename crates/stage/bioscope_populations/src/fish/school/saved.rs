use std::sync::Arc;

use bioscope_core::{Error, Result, Vec3, state};
use bioscope_crowds::Flock;
use serde::{Deserialize, Serialize};

use super::bodies::Bodies;
use super::course::Course;
use super::fish::Fish;
use super::population::Scratch;
use super::{FishSchool, FishSchoolOptions, SchoolParameters};
use crate::bites::Gone;
use crate::fish::FishSpecies;

const PART: &str = "school of fish";

#[derive(Serialize, Deserialize)]
struct State {
    species: String,
    species_text: String,
    count: usize,
    center: Vec3,
    half: Vec3,
    home: Option<Vec3>,
    parameters: SchoolParameters,
    flock: Vec<u8>,
    fishes: Vec<Fish>,
    bodies: Vec<u8>,
    course: Course,
    groups: usize,
    regrouped_from: Option<usize>,
    wishes: Vec<Vec3>,
    caught: Vec<Gone>,
}

impl FishSchool {
    /// The school that `save` stored.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state: State = state::from_bytes(PART, bytes)?;
        let species = FishSpecies::named_or_parsed(&state.species, &state.species_text)?;
        let flock = Flock::restore(&state.flock)?;
        if flock.len() != state.fishes.len() {
            let found = format!("{} places for {} fishes", flock.len(), state.fishes.len());
            return Err(Error::format(PART, found));
        }
        let options = FishSchoolOptions {
            species,
            count: state.count,
            center: state.center,
            half: state.half,
            home: state.home,
            flock: flock.parameters.clone(),
            parameters: state.parameters,
        };
        options.check()?;
        let form = options.species.form();
        let spine = Arc::new(form.spine.clone());
        Ok(Self {
            bodies: Bodies::restore(&spine, &state.bodies)?,
            form,
            spine,
            flock,
            fishes: state.fishes,
            course: state.course,
            groups: state.groups,
            regrouped_from: state.regrouped_from,
            wishes: state.wishes,
            caught: state.caught,
            scratch: Scratch::default(),
            options,
        })
    }

    pub(super) fn to_saved(&self) -> Result<Vec<u8>> {
        let options = &self.options;
        Ok(state::to_bytes(&State {
            species: options.species.name.clone(),
            species_text: options.species.text().to_owned(),
            count: options.count,
            center: options.center,
            half: options.half,
            home: options.home,
            parameters: options.parameters.clone(),
            flock: self.flock.save(),
            fishes: self.fishes.clone(),
            bodies: self.bodies.save()?,
            course: self.course,
            groups: self.groups,
            regrouped_from: self.regrouped_from,
            wishes: self.wishes.clone(),
            caught: self.caught.clone(),
        }))
    }
}
