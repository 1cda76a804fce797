use std::f32::consts::{FRAC_PI_2, FRAC_PI_6};

use bioscope_core::{Impact, Random, Sighting, Vec3};
use serde::{Deserialize, Serialize};

use super::Command;
use crate::attention::{Preferences, Situation, Skill, Threat, azimuth, elevation};
use crate::nature::Temper;

/// Speed at which another comes nearer from which it is dodged with all strength, body lengths per second.
const PRESSING: f32 = 0.6;

/// The routines avoiding-static-obstacle and avoiding-fish (Tu 1996, 6.4.1; details chosen).
///
/// The fish turns to the side at which it passes sooner, unless there is something to be said against that
/// side and not against the other; between equal sides the preferences decide, then chance. It keeps to
/// its side until the threat is gone. A discouraged turn is weakened. Where both sides are bad it brakes
/// and backs away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Avoidance {
    /// Side that it turns to, +1 left, −1 right, 0 not decided.
    side: f32,
}

impl Avoidance {
    /// Forgets the side.
    pub fn rest(&mut self) {
        self.side = 0.0;
    }

    /// What to do about a threat.
    pub fn command(
        &mut self,
        threat: &Threat,
        situation: &Situation,
        preferences: &Preferences,
        temper: &Temper,
        random: &mut Random,
    ) -> Command {
        match threat {
            Threat::Solid(impact) => self.solid(impact, situation, preferences, temper, random),
            Threat::Animal(other) => self.animal(other, situation, preferences, temper, random),
        }
    }

    fn solid(
        &mut self,
        impact: &Impact,
        situation: &Situation,
        preferences: &Preferences,
        temper: &Temper,
        random: &mut Random,
    ) -> Command {
        let length = situation.length;
        let aim = impact.aim;
        let climb = elevation(aim);
        let nearness = 1.0 - (impact.distance / ((temper.antenna + 1.0) * length)).clamp(0.0, 1.0);
        let speed = temper.cruise_speed * (1.0 - 0.6 * nearness);
        // Over or under it, where that is the way past or the preferences ask for it.
        if climb.abs() > azimuth(aim).abs().max(FRAC_PI_6) {
            let skill = if climb > 0.0 { Skill::Ascend } else { Skill::Descend };
            let pitch = climb * preferences.compromise(skill);
            return Command { pitch, speed, ..Command::default() };
        }
        self.choose(azimuth(aim), 0.12, preferences, random);
        let natural = azimuth(aim) * self.side > 0.0;
        // Sharper the nearer it is; on the far side of its silhouette a wider turn is needed.
        let angle = if natural { azimuth(aim).abs() } else { 0.6 * FRAC_PI_2 };
        let angle = angle.max(FRAC_PI_6) * (0.8 + nearness);
        let command =
            self.turn(angle.min(FRAC_PI_2), speed, preferences, impact.distance < 0.6 * length);
        Command { pitch: 0.5 * climb, ..command }
    }

    fn animal(
        &mut self,
        other: &Sighting,
        situation: &Situation,
        preferences: &Preferences,
        temper: &Temper,
        random: &mut Random,
    ) -> Command {
        let place = other.position;
        let relative = other.velocity - situation.percepts.velocity;
        // It passes behind what crosses, else turns away from the side it is on.
        let crossing = other.velocity.x.abs() > 0.5 * other.velocity.length() && place.z > 0.0;
        let natural = if crossing { -other.velocity.x } else { -place.x };
        self.choose(natural, 0.05 * situation.length, preferences, random);
        let rate = -relative.dot(place.normalize_or_zero()) / situation.length;
        let closing = rate > 0.0;
        if place.z < -0.2 * situation.length && !closing {
            return Command::ahead(temper.cruise_speed);
        }
        let gap = (place.length() / situation.length).clamp(0.2, 1.5);
        // Who swims alongside is given way to a little, who comes up fast at once.
        let angle = (0.15 + 0.75 * (rate / PRESSING).clamp(0.0, 1.0)) / gap;
        let slower = if place.z > 0.0 && closing { 0.6 } else { 1.0 };
        let blocked = place.z > 0.0 && place.length() < 0.35 * situation.length;
        let command =
            self.turn(angle.min(FRAC_PI_2), temper.cruise_speed * slower, preferences, blocked);
        Command { pitch: (-elevation(place)).clamp(-0.4, 0.4), ..command }
    }

    /// Decides for a side: `natural` is positive where left suits, undecided within `narrow`.
    fn choose(
        &mut self,
        natural: f32,
        narrow: f32,
        preferences: &Preferences,
        random: &mut Random,
    ) {
        let (left, right) = (preferences.of(Skill::Left), preferences.of(Skill::Right));
        if self.side != 0.0 {
            let (kept, other) = if self.side > 0.0 { (left, right) } else { (right, left) };
            // Changes its mind only where the way is barred and the other is not.
            if kept < 0.0 && other >= 0.0 {
                self.side = -self.side;
            }
            return;
        }
        self.side = if (left < 0.0) != (right < 0.0) {
            if right < 0.0 { 1.0 } else { -1.0 }
        } else if natural.abs() > narrow {
            natural.signum()
        } else if left != right {
            (left - right).signum()
        } else if random.uniform() < 0.5 {
            1.0
        } else {
            -1.0
        };
    }

    /// A turn to its side; backs away where it is `close` and both sides are barred.
    fn turn(&self, angle: f32, speed: f32, preferences: &Preferences, close: bool) -> Command {
        let skill = if self.side > 0.0 { Skill::Left } else { Skill::Right };
        let barred = preferences.of(Skill::Left) < 0.0 && preferences.of(Skill::Right) < 0.0;
        let factor = preferences.compromise(skill);
        if close && barred {
            return Command {
                turn: self.side * angle,
                speed: -0.5 * speed,
                brake: 1.0,
                ..Command::default()
            };
        }
        let brake = if close { 0.6 } else { 0.0 };
        Command { turn: self.side * angle * factor, speed, brake, ..Command::default() }
    }
}

/// The way back into the home range and to the level, for those who wander: zero where there is none to go.
pub(super) fn homeward(situation: &Situation, temper: &Temper) -> Vec3 {
    let home = situation.percepts.home;
    let outside = (home.length() - temper.home_range) / (0.25 * temper.home_range);
    home.normalize_or_zero() * outside.clamp(0.0, 1.0)
}
