//! Geometric flight: velocity from acceleration, path from velocity, roll from both.

use bioscope_core::{Error, Result, Vec3, math};
use rayon::prelude::*;

use super::Flock;
use crate::Surroundings;

/// Speed in body lengths per second below which a member keeps looking where it looked.
const STILL: f32 = 1e-4;

/// How much sooner the terrified reach their (then greatest) cruise speed, as a share; a choice.
const HASTE: f32 = 4.0;

/// What changes of one member.
struct Flier<'a> {
    position: &'a mut Vec3,
    velocity: &'a mut Vec3,
    heading: &'a mut Vec3,
    up: &'a mut Vec3,
}

impl Flock {
    /// Flies on for `dt` seconds with the accelerations decided on:
    /// v ← v + dt (a − c (v − v_cruise ẑ)), speed within its limits, ẑ along v, p ← p + dt v, and Y
    /// leaning so that the acceleration across the path and gravity's are felt along it. The
    /// medium carries everybody along.
    pub fn advance(&mut self, dt: f32, surroundings: &Surroundings) -> Result<()> {
        if !(dt.is_finite() && dt >= 0.0) {
            return Err(Error::value("dt", dt, "seconds, not negative"));
        }
        let flow = surroundings.flow;
        if !flow.is_empty() && flow.len() != self.len() {
            let expected = format!("one for each of the {} members, or none", self.len());
            return Err(Error::value("flow", format!("{} vectors", flow.len()), expected));
        }
        let mut members = std::mem::take(&mut self.members);
        members.drifts.clear();
        members.drifts.extend_from_slice(flow);
        members.drifts.resize(members.ids.len(), Vec3::ZERO);
        let flight = Flight::new(self, dt, surroundings);
        let calm = 1.0 - math::relaxation(dt, self.parameters.alarm_time);
        (
            &mut members.positions,
            &mut members.velocities,
            &mut members.headings,
            &mut members.ups,
            &mut members.alarms,
            &members.drifts,
            &members.paces,
        )
            .into_par_iter()
            .with_min_len(512)
            .enumerate()
            .for_each(
                |(index, (position, velocity, heading, up, alarm, &drift, &pace))| {
                    let decision = self.decision(index);
                    *alarm = (*alarm * calm).max(decision.alarm);
                    let flier = Flier { position, velocity, heading, up };
                    flight.step(flier, decision.acceleration, (pace, *alarm), drift);
                },
            );
        self.members = members;
        Ok(())
    }
}

/// What all members share while they fly, in metres and seconds.
struct Flight<'a> {
    surroundings: &'a Surroundings<'a>,
    dt: f32,
    thrust: f32,
    top: f32,
    slowest: f32,
    cruise: f32,
    damping: f32,
    leveling: f32,
    gravity: f32,
    bank: f32,
    /// Share of the way to the right roll that is covered in this tick.
    leaning: f32,
    still: f32,
    clearance: f32,
}

impl<'a> Flight<'a> {
    fn new(flock: &Flock, dt: f32, surroundings: &'a Surroundings<'a>) -> Self {
        let parameters = &flock.parameters;
        let length = parameters.body_length;
        Self {
            surroundings,
            dt,
            thrust: parameters.thrust(),
            top: parameters.top_speed(),
            slowest: (parameters.minimum_speed * length).min(parameters.top_speed()),
            cruise: parameters.cruise_speed * length,
            damping: parameters.damping,
            leveling: parameters.leveling,
            gravity: parameters.gravity,
            bank: parameters.bank,
            leaning: math::relaxation(dt, parameters.bank_time),
            still: STILL * length,
            clearance: parameters.clearance * length,
        }
    }

    fn step(&self, flier: Flier, request: Vec3, (pace, alarm): (f32, f32), drift: Vec3) {
        let Flier { position, velocity, heading, up } = flier;
        let cruise = math::mix(self.cruise * pace, self.top, alarm).min(self.top);
        let damping = self.damping * (1.0 + HASTE * alarm);
        let mut acceleration = request * self.thrust - (*velocity - *heading * cruise) * damping;
        acceleration.y -= velocity.y * self.leveling;
        let wanted = *velocity + acceleration * self.dt;
        let speed = wanted.length();
        let ahead = if speed > self.still { wanted / speed } else { *heading };
        *velocity = ahead * speed.clamp(self.slowest, self.top);
        *up = self.lean(*up, *heading, ahead, acceleration);
        *heading = ahead;
        *position += (*velocity + drift) * self.dt;
        self.confine(position, velocity);
    }

    /// Carries `up` along the turn from `from` to `to` without roll, then leans into the turn.
    fn lean(&self, up: Vec3, from: Vec3, to: Vec3, acceleration: Vec3) -> Vec3 {
        let halfway = from + to;
        let carried = up - halfway * (to.dot(up) / (1.0 + from.dot(to)).max(1e-6));
        let felt = acceleration * self.bank + Vec3::Y * self.gravity;
        let across = felt - to * felt.dot(to);
        let target = across.try_normalize().unwrap_or(carried);
        let leaning = carried + (target - carried) * self.leaning;
        let leaning = leaning - to * leaning.dot(to);
        leaning.try_normalize().unwrap_or_else(|| to.any_orthonormal_vector())
    }

    /// What steering could not prevent: nobody enters an obstacle or the ground or leaves through the
    /// surface.
    fn confine(&self, position: &mut Vec3, velocity: &mut Vec3) {
        for solid in self.surroundings.obstacles {
            let depth = self.clearance - solid.distance(*position);
            if depth > 0.0 {
                let outward = solid.outward(*position);
                *position += outward * depth;
                *velocity -= outward * velocity.dot(outward).min(0.0);
            }
        }
        if let Some(surface) = self.surroundings.surface {
            let ceiling = surface - self.clearance;
            if position.y > ceiling {
                position.y = ceiling;
                velocity.y = velocity.y.min(0.0);
            }
        }
        if let Some(terrain) = self.surroundings.terrain {
            let floor = terrain.height(position.x, position.z) + self.clearance;
            if position.y < floor {
                position.y = floor;
                velocity.y = velocity.y.max(0.0);
            }
        }
    }
}
