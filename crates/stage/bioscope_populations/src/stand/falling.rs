//! What has left its plant: seeds and leaves on their way to the ground.

use bioscope_core::{Id, Purpose, Result, Vec3, math};
use bioscope_world::Growth;
use serde::{Deserialize, Serialize};

use super::Stand;
use super::plant::Shed;
use crate::placement::site;

const FALL: Purpose = Purpose::new("stand fall");
/// How long a leaf lies on the ground, seconds.
const LYING: f64 = 12.0;
/// How fast what lies there shrinks away at the end, seconds.
const FADING: f64 = 2.0;
/// Most seeds and leaves on their way and on the ground.
const MOST: usize = 6000;

/// A seed or a leaf that falls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Falling {
    pub id: Id,
    pub is_seed: bool,
    /// The text that a seed grows from.
    pub source: u32,
    pub from: Vec3,
    pub to: Vec3,
    /// World time at which it left, seconds.
    pub begun: f64,
    /// How long it falls, seconds.
    pub duration: f32,
}

impl Falling {
    pub fn has_landed(&self, now: f64) -> bool {
        now >= self.begun + f64::from(self.duration)
    }

    /// How much of its size is left.
    pub fn presence(&self, now: f64) -> f32 {
        if self.is_seed {
            return 1.0;
        }
        let end = self.begun + f64::from(self.duration) + LYING;
        ((end - now) / FADING).clamp(0.0, 1.0) as f32
    }

    /// Where it is.
    pub fn place(&self, now: f64) -> Vec3 {
        let share = ((now - self.begun) / f64::from(self.duration.max(1e-3))).clamp(0.0, 1.0);
        let straight = self.from.lerp(self.to, share as f32);
        // It rocks from side to side, and comes to rest on the ground.
        let beat = (now - self.begun) as f32 * 3.1 + self.id as f32;
        let rocking = 0.12 * (1.0 - share as f32) * math::sin(beat).min(share as f32 * 9.0);
        straight + Vec3::new(rocking, 0.0, rocking * math::cos(self.id as f32))
    }
}

impl Stand {
    /// Lets go of what the plants have shed.
    pub(super) fn let_fall(&mut self, shed: &[(u32, Shed)], growth: &mut Growth) -> Result<()> {
        if shed.is_empty() {
            return Ok(());
        }
        let ids = growth.identities(shed.len())?;
        let points: Vec<Vec3> = shed.iter().map(|one| one.1.from).collect();
        let flows = growth.environment.influence(&points, growth.moment.time)?;
        let parameters = &self.state.options.parameters;
        for (((source, one), id), flow) in shed.iter().zip(ids).zip(flows) {
            let mut random = growth.moment.random(id, FALL);
            let reach =
                if one.is_seed { parameters.dispersal } else { 0.15 * parameters.dispersal };
            let terrain = growth.environment.terrain.as_deref();
            let under = site([one.from.x, one.from.z], terrain).position.y;
            let duration = ((one.from.y - under) / parameters.falling).max(0.05);
            let drift = flow.flow * (0.6 * duration);
            let x = one.from.x + drift.x + reach * random.normal();
            let z = one.from.z + drift.z + reach * random.normal();
            let to = site([x, z], terrain).position;
            let Shed { is_seed, from } = *one;
            let begun = growth.moment.time;
            let source = *source;
            self.state.falling.push(Falling { id, is_seed, source, from, to, begun, duration });
        }
        let excess = self.state.falling.len().saturating_sub(MOST);
        self.state.falling.drain(..excess);
        Ok(())
    }

    /// Lets go of leaves that have lain long enough.
    pub(super) fn clear_ground(&mut self, now: f64) {
        self.state.falling.retain(|one| one.presence(now) > 0.0);
    }
}
