use std::f32::consts::{FRAC_PI_6, PI};

use bioscope_core::{Vec3, math};

/// A motor skill that can be recommended or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skill {
    /// Turning left.
    Left,
    /// Turning right.
    Right,
    /// Swimming ahead.
    Forward,
    /// Backing away.
    Backward,
    /// Climbing.
    Ascend,
    /// Diving.
    Descend,
}

/// What is to be said for (positive) and against (negative) each skill: `M` of Tu 1996, 5.4, each value
/// being the mean of the recommendations plus the mean of the warnings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Preferences {
    /// Sum and number of recommendations, then of warnings, per skill.
    sums: [[(f32, u32); 2]; 6],
}

impl Preferences {
    /// Adds a reason for (`strength` > 0) or against a skill.
    pub fn add(&mut self, skill: Skill, strength: f32) {
        let (sum, count) = &mut self.sums[skill as usize][usize::from(strength < 0.0)];
        *sum += strength;
        *count += 1;
    }

    /// Adds a reason for or against all skills that lead towards a place of the own frame.
    pub fn add_at(&mut self, place: Vec3, strength: f32) {
        self.add(toward(place), strength);
        let climb = elevation(place);
        if climb.abs() > FRAC_PI_6 {
            self.add(if climb > 0.0 { Skill::Ascend } else { Skill::Descend }, strength);
        }
    }

    /// The preference for a skill.
    pub fn of(&self, skill: Skill) -> f32 {
        let mean = |(sum, count): (f32, u32)| if count > 0 { sum / count as f32 } else { 0.0 };
        let [recommended, warned] = self.sums[skill as usize];
        mean(recommended) + mean(warned)
    }

    /// The factor on a discouraged action's angle or speed: `min(1, 1.5 − τ)` for a preference of −τ
    /// (Tu 1996, 5.4), 1 for the others.
    pub fn compromise(&self, skill: Skill) -> f32 {
        (1.5 + self.of(skill).min(0.0)).min(1.0)
    }
}

/// The level skill that leads towards a place: ahead within 30 degrees, back beyond 150, else a turn.
fn toward(place: Vec3) -> Skill {
    let angle = azimuth(place);
    if angle.abs() < FRAC_PI_6 {
        Skill::Forward
    } else if angle.abs() > PI - FRAC_PI_6 {
        Skill::Backward
    } else if angle > 0.0 {
        Skill::Left
    } else {
        Skill::Right
    }
}

/// Angle about the own Y from straight ahead to a place, radians, positive to the left.
pub fn azimuth(place: Vec3) -> f32 {
    math::atan2(place.x, place.z)
}

/// Angle of a place over the own XZ plane, radians.
pub fn elevation(place: Vec3) -> f32 {
    math::atan2(place.y, math::sqrt(place.x * place.x + place.z * place.z))
}
