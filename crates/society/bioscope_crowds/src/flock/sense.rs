//! What each member notices.

use bioscope_core::{Purpose, Random, Vec3, math};
use bioscope_minds::arbitration::request;
use bioscope_minds::steering::{Moving, evade, steer_aside};
use rayon::prelude::*;

use super::neighbors::{Neighborhood, Perception, Sorted};
use super::{Flock, Members, Scratch};
use crate::avoid::{Course, Obstacles, look_ahead};
use crate::columns::{gather_rows, moving};
use crate::{FlockParameters, Surroundings};

/// Members that one task handles; small enough to share 300 between two threads.
const TASK: usize = 128;
const JOSTLE: Purpose = Purpose::new("flock jostle");

/// What one member notices of the others and of its surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Percept {
    /// Crowding: Σ w (pᵢ − pⱼ) / d, weights with distances in body lengths.
    pub crowding: Vec3,
    /// Mean velocity of the neighbors against the own, by weight, metres per second.
    pub motion: Vec3,
    /// Middle of the neighbors against the own place, by weight, metres.
    pub middle: Vec3,
    /// How many neighbors there are.
    pub neighbors: u32,
    /// Request to pass the first obstacle ahead.
    pub obstacle: Vec3,
    /// Request to stay between ground and surface.
    pub bounds: Vec3,
    /// Request to flee.
    pub flight: Vec3,
    /// Alarm that the threats in view cause, 0 to 1.
    pub alarm: f32,
}

/// What all members share while they sense.
struct Scope<'a> {
    flock: &'a Flock,
    surroundings: &'a Surroundings<'a>,
    obstacles: Obstacles,
    /// How everybody looks; the place is each one's own.
    perception: Perception,
    /// By which weights in metres are multiplied to have them in body lengths.
    scale: f32,
    /// Distance from the middle of a cell within which its members may meet an obstacle.
    reach: f32,
}

/// What one thread works with: neighbors and obstacles of the cell at hand.
#[derive(Default)]
struct Locality {
    neighborhood: Neighborhood,
    obstacles: Vec<u32>,
}

impl Flock {
    /// Lets all members notice their neighbors and surroundings as of the last tick.
    pub fn sense(&mut self, surroundings: &Surroundings) {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.grid.build(&self.members.positions, self.parameters.radius_metres());
        let Members { positions, velocities, .. } = &self.members;
        gather_rows(&mut scratch.rows, positions, velocities, scratch.grid.order());
        let scope = Scope::new(self, surroundings);
        let mut percepts = std::mem::take(&mut scratch.percepts);
        percepts.resize(self.len(), Percept::default());
        percepts.par_chunks_mut(TASK).enumerate().for_each_init(
            Locality::default,
            |locality, (task, percepts)| {
                for (offset, percept) in percepts.iter_mut().enumerate() {
                    *percept = scope.percept(task * TASK + offset, &scratch, locality);
                }
            },
        );
        scratch.percepts = percepts;
        self.scratch = scratch;
    }

    /// What a member noticed in the last [`sense`](Self::sense); none before the first.
    pub fn percept(&self, index: usize) -> Option<&Percept> {
        let slot = *self.scratch.grid.slots().get(index)?;
        self.scratch.percepts.get(slot as usize)
    }
}

impl<'a> Scope<'a> {
    fn new(flock: &'a Flock, surroundings: &'a Surroundings<'a>) -> Self {
        let parameters = &flock.parameters;
        let FlockParameters { exponent, body_length, maximum_neighbors, .. } = *parameters;
        let most = maximum_neighbors as usize;
        // The medium may carry faster than members fly; half a cell's diagonal is √3 / 2 edges.
        let flow = surroundings.flow.iter().fold(0_f32, |most, flow| most.max(flow.length()));
        let speed = parameters.top_speed() + flow;
        let sight = look_ahead(speed, parameters.thrust(), body_length);
        Self {
            flock,
            surroundings,
            obstacles: Obstacles::new(surroundings.obstacles),
            perception: Perception {
                place: Vec3::ZERO,
                radius: parameters.radius_metres(),
                exponent,
                least: 0.5 * body_length,
                most: if most == 0 { usize::MAX } else { most },
            },
            scale: math::pow(body_length, exponent),
            reach: sight + parameters.clearance * body_length + 0.9 * parameters.radius_metres(),
        }
    }

    fn percept(&self, slot: usize, scratch: &Scratch, locality: &mut Locality) -> Percept {
        let [place, velocity] = moving(&scratch.rows[slot]);
        let index = scratch.grid.order()[slot] as usize;
        let cell = scratch.grid.cell(place);
        if locality.neighborhood.enter(&scratch.grid, cell) {
            let middle =
                Vec3::from_array(cell.map(|one| one as f32 + 0.5)) * self.perception.radius;
            self.obstacles.near(middle, self.reach, &mut locality.obstacles);
        }
        let sorted = Sorted { positions: scratch.grid.positions(), rows: &scratch.rows };
        let mut percept = self.company(sorted, [place, velocity], &mut locality.neighborhood);
        if percept.crowding == Vec3::INFINITY {
            percept.crowding = self.jostle(index);
        }
        if !locality.obstacles.is_empty() {
            let motion = velocity + self.flock.members.drifts[index];
            percept.obstacle = self.obstacle(index, place, motion, &locality.obstacles);
        }
        percept.bounds = self.bounds(place, velocity);
        (percept.flight, percept.alarm) = self.flight(Moving { position: place, velocity });
        percept
    }

    /// What it notices of its neighbors; infinite crowding if one is in the very same place.
    fn company(
        &self,
        sorted: Sorted,
        [place, velocity]: [Vec3; 2],
        neighborhood: &mut Neighborhood,
    ) -> Percept {
        let sums = neighborhood.sums(sorted, &Perception { place, ..self.perception });
        let crowding = if sums.coincident { Vec3::INFINITY } else { -sums.crowding * self.scale };
        if sums.count == 0 {
            return Percept { crowding, ..Percept::default() };
        }
        let share = 1.0 / sums.weight;
        Percept {
            crowding,
            motion: sums.motion * share - velocity,
            middle: sums.toward * share,
            neighbors: sums.count as u32,
            ..Percept::default()
        }
    }

    /// A push anywhere, for two in the very same place.
    fn jostle(&self, index: usize) -> Vec3 {
        let tick = self.surroundings.time.to_bits() & ((1 << 48) - 1);
        Random::new(self.flock.seed, self.flock.members.ids[index], tick, JOSTLE).direction() * 4.0
    }

    fn obstacle(&self, index: usize, place: Vec3, motion: Vec3, near: &[u32]) -> Vec3 {
        let parameters = &self.flock.parameters;
        let (speed, thrust) = (motion.length(), parameters.thrust());
        let course = Course {
            position: place,
            heading: motion.try_normalize().unwrap_or(self.flock.members.headings[index]),
            reach: look_ahead(speed, thrust, parameters.body_length),
            length: parameters.body_length,
            clearance: parameters.clearance * parameters.body_length,
        };
        let Some(impact) = self.obstacles.first_impact(&course, near) else { return Vec3::ZERO };
        steer_aside(course.heading, &impact, course.reach, speed * speed / thrust)
    }

    /// Away from ground and surface, the harder the nearer it is or will be within the time of a
    /// turn.
    fn bounds(&self, place: Vec3, velocity: Vec3) -> Vec3 {
        let FlockParameters { body_length, ground_clearance, .. } = self.flock.parameters;
        let clearance = ground_clearance * body_length;
        let turn = self.flock.parameters.maximum_speed / self.flock.parameters.maximum_acceleration;
        let mut push = Vec3::ZERO;
        for time in [0.0, 0.5, 1.0] {
            let there = place + velocity * (turn * time);
            if let Some(terrain) = self.surroundings.terrain {
                let height = there.y - terrain.height(there.x, there.z);
                if height < clearance {
                    push += terrain.normal(there.x, there.z) * ((clearance - height) / clearance);
                }
            }
            if let Some(surface) = self.surroundings.surface {
                let depth = surface - there.y;
                push -= Vec3::Y * ((clearance - depth) / clearance).max(0.0);
            }
        }
        push.clamp_length_max(1.0)
    }

    /// The request to flee from all threats that are near enough, and the alarm they cause.
    fn flight(&self, mover: Moving) -> (Vec3, f32) {
        let parameters = &self.flock.parameters;
        let panic_radius = parameters.flight_distance * parameters.body_length;
        let (mut flight, mut alarm) = (Vec3::ZERO, 0_f32);
        for threat in self.surroundings.threats {
            let hunter = Moving { position: threat.position, velocity: threat.velocity };
            let wish = evade(mover, hunter, parameters.top_speed(), panic_radius);
            if wish == Vec3::ZERO {
                continue;
            }
            // All there is from half the distance on.
            let distance = mover.position.distance(threat.position);
            let urgency = (2.0 - 2.0 * distance / panic_radius).min(1.0);
            flight += request(wish, parameters.thrust(), urgency);
            alarm = alarm.max(urgency);
        }
        (flight.clamp_length_max(1.0), alarm)
    }
}
