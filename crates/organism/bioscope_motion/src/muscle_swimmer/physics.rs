use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use bioscope_core::{Result, parameters};

use crate::fish::FishModel;

/// Most models of changed physics that are kept ready.
const KEPT: usize = 64;

parameters! {
    /// How body and water differ from those for which the motor controllers were calibrated (the physics panel of Tu,
    /// "Artificial Animals for Computer Animation", 1996, appendix on the graphical interface).
    pub struct MusclePhysics {
        /// Thickness of the fluid: 0 is air, in which no beat of the tail gives a push; 1 is water, more is oil.
        water: f32 = 1.0, "1", 0.0..=4.0, "Tu 1996, 4.1.3";
        /// Mass of all nodes, relative to the calibrated.
        mass: f32 = 1.0, "1", 0.2..=5.0, "choice";
        /// Stiffness of all springs, relative to the calibrated.
        stiffness: f32 = 1.0, "1", 0.1..=5.0, "choice";
        /// Viscosity of all springs, relative to the calibrated.
        viscosity: f32 = 1.0, "1", 0.0..=20.0, "choice";
    }
}

impl MusclePhysics {
    /// The model of this preset under this physics. Fishes of equal physics share one, so that they are computed side
    /// by side.
    ///
    /// # Errors
    /// For unknown presets.
    pub fn model(&self, preset: &str) -> Result<Arc<FishModel>> {
        if *self == Self::default() {
            return FishModel::named(preset);
        }
        static READY: Mutex<VecDeque<(String, MusclePhysics, Arc<FishModel>)>> =
            Mutex::new(VecDeque::new());
        let mut ready = READY.lock().unwrap_or_else(PoisonError::into_inner);
        let same = ready.iter().find(|(name, physics, _)| name == preset && physics == self);
        if let Some((_, _, model)) = same {
            return Ok(Arc::clone(model));
        }
        let model = Arc::new(self.build(preset)?);
        if ready.len() == KEPT {
            ready.pop_front();
        }
        ready.push_back((preset.to_owned(), self.clone(), Arc::clone(&model)));
        Ok(model)
    }

    fn build(&self, preset: &str) -> Result<FishModel> {
        let mut design = FishModel::named(preset)?.design.clone();
        let [water, mass, stiffness, viscosity] =
            [self.water, self.mass, self.stiffness, self.viscosity].map(f64::from);
        // Forces are given per body mass: more mass is less of every force.
        design.tissue.stiffness = design.tissue.stiffness.map(|one| one * stiffness / mass);
        design.tissue.damping *= viscosity / mass;
        design.tissue.guard *= stiffness / mass;
        design.medium.thickness *= water / mass;
        FishModel::new(design)
    }
}
