use std::sync::Arc;

use bioscope_core::{Error, Result, state};
use bioscope_dynamics::spring_body::fish::{MUSCLES, NODES};
use bioscope_dynamics::spring_body::{Real, Triple};
use serde::{Deserialize, Serialize};

use super::individual::{Group, Individual};
use super::{FishModel, Swimmers};

const PART: &str = "muscle-driven fish";

/// One fish, complete.
#[derive(Serialize, Deserialize)]
struct Saved {
    time_unit: f64,
    individual: Individual,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    contraction: Vec<f64>,
}

impl Swimmers<f32> {
    /// The complete state of a fish that is kept alone; its model is not part of it.
    ///
    /// # Errors
    /// If there is not exactly one.
    pub fn save_one(&self) -> Result<Vec<u8>> {
        let [Group { body, members }] = &self.groups[..] else {
            return Err(Error::value("fishes", self.len(), "one that is kept alone"));
        };
        Ok(state::to_bytes(&Saved {
            time_unit: self.time_unit,
            individual: members[0].clone(),
            position: first(&body.position),
            velocity: first(&body.velocity),
            contraction: body.contraction.iter().map(|one| one.lane(0)).collect(),
        }))
    }

    /// The fish that [`save_one`](Self::save_one) stored.
    ///
    /// # Errors
    /// For damaged bytes.
    pub fn restore_one(model: Arc<FishModel>, bytes: &[u8]) -> Result<Self> {
        let saved: Saved = state::from_bytes(PART, bytes)?;
        let counts = [saved.position.len(), saved.velocity.len(), saved.contraction.len()];
        if counts != [NODES, NODES, MUSCLES] || saved.time_unit.is_nan() || saved.time_unit <= 0.0 {
            return Err(Error::format(PART, "not a fish of 23 nodes and 12 muscles"));
        }
        let mut group = Group::new(&model);
        set_first(&mut group.body.position, &saved.position);
        set_first(&mut group.body.velocity, &saved.velocity);
        for (mine, value) in group.body.contraction.iter_mut().zip(saved.contraction) {
            mine.set_lane(0, value);
        }
        group.members.push(saved.individual);
        Ok(Self { model, time_unit: saved.time_unit, groups: vec![group], count: 1 })
    }
}

fn first(nodes: &[Triple<f32>]) -> Vec<[f64; 3]> {
    nodes.iter().map(|node| node.map(|axis| axis.lane(0))).collect()
}

fn set_first(nodes: &mut [Triple<f32>], values: &[[f64; 3]]) {
    for (axis, value) in nodes.iter_mut().flatten().zip(values.iter().flatten()) {
        axis.set_lane(0, *value);
    }
}
