use bioscope_core::{Random, math};
use serde::{Deserialize, Serialize};

use super::stimulus;
use crate::nature::Temper;

/// Mental state of a fish, and what it remembers of meals and matings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drives {
    /// Hunger `H`, 0 to 1.
    pub hunger: f32,
    /// Libido `L`, 0 to 1.
    pub libido: f32,
    /// Fear `F`, 0 to 1.
    pub fear: f32,
    /// Food eaten since the last full digestion, `n^e`.
    pub eaten: f32,
    /// Steps since the last meal.
    since_meal: f32,
    /// Steps since the last mating.
    since_mating: f32,
    began: bool,
}

/// What moves the drives in one tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stirring {
    /// Seconds since the last.
    pub dt: f32,
    /// Things swallowed.
    pub fed: u32,
    /// Distance of the nearest food, body lengths.
    pub food: Option<f32>,
    /// Distance of the nearest possible mate, body lengths.
    pub mate: Option<f32>,
    /// Sum of the fears of all predators in view; see [`fear_of`].
    pub fear: f32,
}

impl Drives {
    /// Lets time pass and takes in what there is.
    pub fn advance(&mut self, stirring: &Stirring, temper: &Temper, random: &mut Random) {
        if !self.began {
            self.began = true;
            self.eaten = temper.stagger * random.range(0.0, 1.5) * temper.appetite;
            self.since_mating = temper.stagger * random.uniform() / temper.libido_growth.max(1e-6);
        }
        let steps = stirring.dt * temper.pace;
        self.since_mating += steps;
        self.since_meal = if stirring.fed > 0 { 0.0 } else { self.since_meal + steps };
        self.eaten += stirring.fed as f32;
        let undigested = 1.0 - temper.digestion * self.since_meal;
        if undigested <= 0.0 {
            self.eaten = 0.0;
        }
        let pull = |distance: Option<f32>, near: f32, far: f32| {
            distance.map_or(0.0, |distance| stimulus(distance, near, far))
        };
        let food = pull(stirring.food, temper.food_near, temper.food_far);
        let full = self.eaten * undigested.max(0.0) / temper.appetite;
        self.hunger = (1.0 - full + temper.food_weight * food).clamp(0.0, 1.0);
        let mate = pull(stirring.mate, temper.mate_near, temper.mate_far);
        let urge = temper.libido_growth * self.since_mating * (1.0 - self.hunger);
        self.libido = (urge + temper.mate_weight * mate).clamp(0.0, 1.0);
        let calmed = self.fear * (1.0 - math::relaxation(stirring.dt, temper.alarm_time));
        // A sum over nobody is minus zero; which of two zeros is the greater, machines disagree about.
        self.fear = stirring.fear.min(1.0).max(calmed) + 0.0;
    }

    /// Takes note of having mated.
    pub fn mated(&mut self) {
        self.since_mating = 0.0;
        self.libido = 0.0;
    }
}

/// Fear of one predator at `distance` body lengths.
pub fn fear_of(distance: f32, temper: &Temper) -> f32 {
    (temper.fear_distance / distance.max(1e-3)).min(1.0)
}
