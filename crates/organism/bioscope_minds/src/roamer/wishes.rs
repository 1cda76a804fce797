//! What the roamer wishes right now, given percepts and plan.

use std::borrow::Cow;

use bioscope_core::{Annotation, Id, Intention, Mark, NOTHING, Percepts, Random, Value, Vec3};

use super::plan::Activity;
use super::{Roamer, RoamerParameters};
use crate::arbitration::prioritized;
use crate::steering::{steer_aside, wander};

/// Least number of one species in view that make a school.
const SCHOOL: usize = 3;
/// Time in seconds over which a wandering whim returns ahead.
const WHIM_TIME: f32 = 3.0;
/// Tightest turn it plans for, in body lengths.
const TURN: f32 = 1.0;
/// Share of speed it keeps while gliding, and while hesitating.
const GLIDE: f32 = 0.7;
const PAUSE: f32 = 0.35;
/// How far the granted requests (at most 1 long) bend the heading away from straight ahead.
const BEND: f32 = 1.5;

/// A school in view.
pub struct School {
    /// The individual nearest to its middle.
    target: Id,
    /// Its middle, own frame, metres.
    center: Vec3,
}

/// The species with most individuals in view, if they are enough for a school.
pub fn school(percepts: &Percepts) -> Option<School> {
    let count = |species: &str| percepts.seen.iter().filter(|one| &*one.species == species).count();
    // The first of equals wins: the nearest, as sightings come nearest first.
    let (species, number) = percepts.seen.iter().fold(("", 0), |best, one| {
        let number = count(&one.species);
        if number > best.1 { (&*one.species, number) } else { best }
    });
    if number < SCHOOL {
        return None;
    }
    let members = || percepts.seen.iter().filter(|one| &*one.species == species);
    let center = members().map(|one| one.position).sum::<Vec3>() / number as f32;
    let target = members().min_by(|a, b| {
        let distance = |position: Vec3| position.distance_squared(center);
        distance(a.position).total_cmp(&distance(b.position))
    })?;
    Some(School { target: target.id, center })
}

impl Roamer {
    pub(super) fn wander(&mut self, dt: f32, random: &mut Random) {
        self.whim = wander(self.whim, self.parameters.restlessness, WHIM_TIME, dt, random);
    }

    /// Weighs the wishes, most urgent first, and says which won.
    pub(super) fn intention(
        &self,
        percepts: &Percepts,
        school: Option<&School>,
        annotations: &mut Vec<Annotation>,
    ) -> Intention {
        let engaged = self.plan.activity != Activity::Cruise && !self.plan.hesitates(percepts.time);
        let school = school.filter(|_| engaged);
        let requests = [
            self.avoid(percepts, annotations),
            self.level(percepts),
            self.turn_home(percepts),
            school.map_or(Vec3::ZERO, |school| sideways(school.center) * 0.8),
            self.cruise(percepts),
        ];
        let allocation = prioritized(&requests, 1.0);
        let behavior = match allocation.winner {
            Some(0 | 1) => "avoid",
            Some(2) => "turn home",
            _ => match (school, self.plan.activity) {
                (Some(_), Activity::Inspect) => "inspect",
                (Some(_), Activity::Dash) => "dash",
                _ => "cruise",
            },
        };
        let heading = (Vec3::Z + allocation.acceleration * BEND).normalize_or(Vec3::Z);
        let (speed, urgency) = self.pace(behavior, &requests, percepts);
        note(annotations, "heading", Vec3::ZERO, heading * percepts.body_length);
        if let Some(school) = school {
            note(annotations, "target", Vec3::ZERO, school.center);
        }
        Intention {
            behavior: Cow::Borrowed(behavior),
            heading,
            speed,
            urgency,
            gaze: school.map(|school| school.center),
            target: school.map(|school| school.target),
            ..Intention::default()
        }
    }

    /// Round what lies ahead.
    fn avoid(&self, percepts: &Percepts, annotations: &mut Vec<Annotation>) -> Vec3 {
        let Some(impact) = percepts.ahead else { return Vec3::ZERO };
        let length = percepts.body_length;
        let request =
            steer_aside(Vec3::Z, &impact, self.parameters.foresight * length, TURN * length);
        if request != Vec3::ZERO {
            note(annotations, "avoid", Vec3::Z * impact.distance, impact.aim);
        }
        // An aim dead ahead leaves the side open: turn to the left.
        let undecided = request == Vec3::ZERO && impact.distance < 2.0 * TURN * length;
        if undecided { Vec3::X } else { request }
    }

    /// Between surface and seabed: pitches away from whichever is too near, the more the nearer,
    /// and levels out first if it is on its way there.
    fn level(&self, percepts: &Percepts) -> Vec3 {
        let RoamerParameters { shallowest, deepest, altitude: height, .. } = &self.parameters;
        let up = percepts.attitude.inverse() * Vec3::Y;
        let climb = percepts.velocity.dot(up);
        let margin = percepts.body_length.max(1e-3);
        let altitude = match percepts.other.get("altitude") {
            Some(Value::Number(altitude)) => *altitude as f32,
            _ => f32::INFINITY,
        };
        let ahead = 1.5 * climb;
        let sinking = ((percepts.depth - ahead - deepest) / margin)
            .max((height - altitude - ahead) / margin)
            .clamp(0.0, 1.0);
        let rising = ((shallowest - percepts.depth + ahead) / margin).clamp(0.0, 1.0);
        (up * (sinking - rising)).with_z(0.0)
    }

    /// Back to the home range, the harder the farther outside; nothing inside.
    fn turn_home(&self, percepts: &Percepts) -> Vec3 {
        let range = self.parameters.home_range;
        let outside = (percepts.home.length() - range) / (0.25 * range);
        sideways(percepts.home) * outside.clamp(0.0, 0.9)
    }

    /// Along the wandering course, sooner to the sides than up and down, and back to the level.
    fn cruise(&self, percepts: &Percepts) -> Vec3 {
        let up = percepts.attitude.inverse() * Vec3::Y;
        let whim = Vec3::new(0.6 * self.whim.x, 0.2 * self.whim.y, 0.0);
        whim - (up * (0.5 * up.z)).with_z(0.0)
    }

    /// Speed in body lengths per second, and urgency.
    fn pace(&self, behavior: &str, requests: &[Vec3], percepts: &Percepts) -> (f32, f32) {
        let cruise = self.parameters.cruise_speed;
        match behavior {
            "dash" => (self.parameters.dash_speed, 1.0),
            "inspect" => (cruise * 0.9, 0.35),
            // Slower where the turn must be tight.
            "avoid" => (cruise * (1.0 - 0.4 * requests[0].length()), 0.6),
            _ if self.plan.hesitates(percepts.time) => (cruise * PAUSE, 0.15),
            _ if self.plan.gliding => (cruise * GLIDE, 0.15),
            _ => (cruise * (2.0 - GLIDE), 0.4),
        }
    }
}

/// The turn towards a point of the own frame: across the heading, up to 1 long; to the left for a
/// point straight behind.
fn sideways(point: Vec3) -> Vec3 {
    let direction = point.normalize_or(Vec3::Z);
    let across = direction.with_z(0.0);
    if direction.z >= 0.0 { across } else { across.try_normalize().unwrap_or(Vec3::X) }
}

fn note(annotations: &mut Vec<Annotation>, role: &'static str, from: Vec3, to: Vec3) {
    let mark = Mark::Line { from, to };
    annotations.push(Annotation { subject: NOTHING, role: role.into(), mark });
}
