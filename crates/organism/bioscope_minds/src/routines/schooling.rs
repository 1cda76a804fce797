use std::f32::consts::PI;

use bioscope_core::{Sighting, Vec3};

use super::{Chase, Command, chase};
use crate::attention::{Situation, azimuth, elevation};
use crate::nature::Temper;

/// Deviation from the way to its school that a chase swims through (Tu 1996, 6.5.2), halved: choice.
const TOLERANCE: f32 = PI / 10.0;
/// Sharpest turn in formation, radians: a sharper one breaks its stroke and leaves it behind.
const SHARPEST: f32 = 0.6;
/// Neighbors whose common course counts in full. With fewer it counts less, else two who swim opposite ways take up each
/// other's course over and over and circle on the spot.
const AGREEING: f32 = 3.0;
/// By how much it is faster per body length that it is behind its leader, body lengths per second.
const HURRY: f32 = 0.25;
/// Speed from which a course shows, body lengths per second.
const COURSE: f32 = 0.2;
/// Neighbors that it heeds, the nearest first.
const HEEDED: usize = 7;
/// Share of the spacing by which a gap may be wider before it is closed.
const SLACK: f32 = 0.3;
/// Distance of the nearest neighbor beyond which it hurries to the school, body lengths.
const APART: f32 = 2.0;

/// The routine schooling (Tu 1996, 6.5.2; its figure is lost): with nobody near it chases its leader or the
/// middle of those it sees; else it matches the mean course and speed of its neighbors, closes gaps wider than
/// the wanted spacing and opens narrower ones, keeps their depth, brakes when it overtakes and hurries when
/// it falls behind. The leader, if in view, counts as the neighbor that shows the way.
///
/// In formation it corrects every deviation in full (choice): the motor controllers are gentle with small ones and take
/// away the swing of the beat by themselves, so a tolerance here leaves bodies of muscles drifting apart.
pub fn school(situation: &Situation, temper: &Temper) -> Option<Command> {
    let length = situation.length;
    let nearest = situation.school.first().map(|one| one.position.length());
    let follow = |target: Vec3, velocity: Vec3| {
        let stop = temper.spacing * length;
        let velocity = situation.through_water(velocity);
        let goal = Chase { target, velocity, tolerance: TOLERANCE, lead: 0.0, stop };
        Some(chase(&goal, length, situation.own_speed(), temper))
    };
    match (nearest, situation.leader) {
        (None, None) if situation.strays.0 == 0 => None,
        (None, None) => follow(situation.strays.1, situation.water),
        (None, Some(leader)) => follow(leader.position, leader.velocity),
        (Some(distance), _) if distance > APART * length => {
            let (middle, velocity) = mean(&situation.school);
            follow(middle, velocity)
        }
        (Some(_), leader) => Some(in_formation(situation, leader, temper)),
    }
}

fn in_formation(situation: &Situation, leader: Option<&Sighting>, temper: &Temper) -> Command {
    let length = situation.length;
    let neighbors = &situation.school[..situation.school.len().min(HEEDED)];
    let (middle, velocity) = mean(neighbors);
    let ways = neighbors.iter().map(|one| way(one, situation));
    let course = ways.sum::<Vec3>() / (neighbors.len() as f32).max(AGREEING);
    // Towards each neighbor that is much farther than the spacing, away from those that are nearer.
    let spacing = temper.spacing * length;
    let pull = |place: Vec3| {
        let excess = place.length() / spacing - 1.0;
        let weight = 0.5 * (excess - SLACK).clamp(0.0, 2.0) + 5.0 * excess.min(0.0);
        place.normalize_or_zero() * weight
    };
    let gaps =
        neighbors.iter().map(|one| pull(one.position)).sum::<Vec3>() / neighbors.len() as f32;
    let (mut wanted, mut pace) = (course + gaps, situation.through_water(velocity).length());
    let (strays, place) = situation.strays;
    if strays > 0 {
        // Two parts of a school close: the smaller turns more, and hurries if it is behind.
        let share = strays as f32 / (strays as usize + situation.school.len()) as f32;
        wanted += place.normalize_or_zero() * (0.8 * share);
        pace *= 1.0 + 0.5 * share * place.normalize_or_zero().z.max(-0.5);
    }
    if let Some(leader) = leader {
        let behind = leader.position.length() / length - 2.0 * temper.spacing;
        let to_leader = leader.position.normalize_or_zero();
        wanted += way(leader, situation) * 0.5 + to_leader * (0.2 * behind).clamp(0.0, 1.0);
        pace = 0.5 * (pace + situation.through_water(leader.velocity).length());
        pace += HURRY * length * (behind * to_leader.z).clamp(0.0, 4.0);
    }
    let along = middle.z / length;
    let speed = pace / length + (along + gaps.z).clamp(-1.0, 1.5);
    let speed = speed.clamp(0.3 * temper.cruise_speed, temper.full_speed);
    let overtakes = along < -0.8 && situation.own_speed() > 1.2 * pace;
    Command {
        turn: azimuth(wanted).clamp(-SHARPEST, SHARPEST),
        pitch: elevation(wanted + Vec3::Y * (0.3 * middle.y / length)).clamp(-0.8, 0.8),
        speed,
        brake: if overtakes { 0.4 } else { 0.0 },
        mouth: 0.0,
    }
}

/// Where another is going, unit length: its course rather than its head, which swings with the tail.
fn way(one: &Sighting, situation: &Situation) -> Vec3 {
    let velocity = situation.through_water(one.velocity);
    if velocity.length() > COURSE * one.size { velocity.normalize_or_zero() } else { one.heading }
}

/// Mean place and velocity.
fn mean(all: &[&Sighting]) -> (Vec3, Vec3) {
    let share = 1.0 / all.len().max(1) as f32;
    let place: Vec3 = all.iter().map(|one| one.position).sum();
    let velocity: Vec3 = all.iter().map(|one| one.velocity).sum();
    (place * share, velocity * share)
}
