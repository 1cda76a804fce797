use std::f32::consts::{FRAC_PI_4, PI};

use bioscope_core::{Sighting, Vec3};
use serde::{Deserialize, Serialize};

use super::Command;
use crate::attention::{Preferences, Situation, Skill, azimuth, elevation};
use crate::nature::Temper;

/// What Tu's rules for escaping ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evasion {
    /// A turn to the left.
    Left,
    /// A turn to the right.
    Right,
    /// A turn about, by 180 degrees.
    About,
    /// Straight on at full speed.
    Proceed,
}

/// The table of rules (Tu 1996, 6.4.4), complete: which action answers a predator at this distance (`close`
/// or far), bearing and heading. Limits chosen: in front within 45 degrees, behind beyond 135; the same
/// heading within 45 degrees, perpendicular between 45 and 135.
pub fn evasion(predator: &Sighting, own_velocity: Vec3, close: bool) -> Evasion {
    let bearing = azimuth(predator.position);
    let leftward = |yes: bool| if yes { Evasion::Right } else { Evasion::Left };
    let (front, behind) = (bearing.abs() < FRAC_PI_4, bearing.abs() > PI - FRAC_PI_4);
    // A predator that rests heads where it looks.
    let course = predator.velocity.try_normalize().unwrap_or(predator.heading);
    let heading = azimuth(course).abs();
    let across = course != Vec3::ZERO && (FRAC_PI_4..=PI - FRAC_PI_4).contains(&heading);
    let along = course != Vec3::ZERO && heading < FRAC_PI_4;
    let moves_left = course.x > 0.0;
    if !close {
        return match (front, behind) {
            (true, _) => Evasion::About,
            (_, true) => Evasion::Proceed,
            _ => leftward(bearing > 0.0),
        };
    }
    let approaching = (predator.velocity - own_velocity).dot(predator.position) < 0.0;
    if front {
        if across { leftward(moves_left) } else { Evasion::About }
    } else if behind {
        if along && approaching {
            leftward(bearing > 0.0)
        } else if across {
            leftward(moves_left)
        } else {
            Evasion::Proceed
        }
    } else {
        leftward(bearing > 0.0)
    }
}

/// The routine escaping: does what the rules say, always at full speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Escape {
    /// Side over which it turns about, +1 left, −1 right, 0 not decided.
    side: f32,
}

impl Escape {
    /// Forgets the side.
    pub fn rest(&mut self) {
        self.side = 0.0;
    }

    /// What to do about this predator. Turns are by the angle that leads straight away from it.
    pub fn command(
        &mut self,
        predator: &Sighting,
        situation: &Situation,
        preferences: &Preferences,
        temper: &Temper,
    ) -> Command {
        let limit = 0.5 * temper.fear_distance * situation.length;
        let close = predator.position.length() < limit;
        let rule = evasion(predator, situation.percepts.velocity, close);
        let away = PI - azimuth(predator.position).abs();
        let turn = match rule {
            Evasion::Left => away.max(FRAC_PI_4) * preferences.compromise(Skill::Left),
            Evasion::Right => -away.max(FRAC_PI_4) * preferences.compromise(Skill::Right),
            Evasion::About => self.about(predator, preferences) * PI,
            Evasion::Proceed => 0.0,
        };
        if rule == Evasion::Proceed {
            self.rest();
        }
        let pitch = (-0.5 * elevation(predator.position)).clamp(-0.6, 0.6);
        Command {
            turn: turn.clamp(-3.1, 3.1),
            pitch,
            speed: temper.full_speed,
            ..Command::default()
        }
    }

    /// The side over which to turn about: once chosen, kept.
    fn about(&mut self, predator: &Sighting, preferences: &Preferences) -> f32 {
        if self.side == 0.0 {
            let (left, right) = (preferences.of(Skill::Left), preferences.of(Skill::Right));
            let away = if predator.position.x > 0.0 { -1.0 } else { 1.0 };
            self.side = if left != right { (left - right).signum() } else { away };
        }
        self.side
    }
}
