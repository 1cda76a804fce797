//! Who belongs to the flock.

use bioscope_core::{Error, Id, Purpose, Random, Result, Vec3, math};

use super::{Flock, Scratch};
use crate::FlockParameters;

const SCATTER: Purpose = Purpose::new("flock scatter");
const PACE: Purpose = Purpose::new("flock pace");

/// Where a flock begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// Anywhere in a box.
    Box {
        /// Its middle, metres.
        center: Vec3,
        /// Half its sides, metres.
        half: Vec3,
    },
    /// Anywhere in an ellipsoid along the world's axes.
    Ellipsoid {
        /// Its middle, metres.
        center: Vec3,
        /// Half its axes, metres.
        half: Vec3,
    },
}

impl Region {
    /// The cube about the origin that holds `count` points at `density` points per cubic metre.
    pub fn of_density(count: usize, density: f32) -> Self {
        let half_side = 0.5 * math::pow(count as f32 / density, 1.0 / 3.0);
        Self::Box { center: Vec3::ZERO, half: Vec3::splat(half_side) }
    }

    fn draw(self, random: &mut Random) -> Vec3 {
        match self {
            Self::Box { center, half } => {
                let mut side = || random.range(-1.0, 1.0);
                center + half * Vec3::new(side(), side(), side())
            }
            Self::Ellipsoid { center, half } => center + half * random.in_ball(),
        }
    }
}

impl Flock {
    /// A flock of these identities at random places of `region`, heading anywhere at cruise speed.
    /// Place and heading of each depend on seed and identity only.
    pub fn scattered(
        ids: impl IntoIterator<Item = Id>,
        region: Region,
        seed: u64,
        parameters: FlockParameters,
    ) -> Result<Self> {
        let mut flock = Self::new(parameters, seed)?;
        for id in ids {
            let mut random = Random::new(seed, id, 0, SCATTER);
            let position = region.draw(&mut random);
            let speed = flock.parameters.cruise_speed * flock.parameters.body_length;
            let velocity = random.direction() * speed * flock.pace(id);
            flock.push(id, position, velocity)?;
        }
        Ok(flock)
    }

    /// Adds a member at this place (metres) with this velocity (m/s).
    pub fn push(&mut self, id: Id, position: Vec3, velocity: Vec3) -> Result<()> {
        for (name, value) in [("position", position), ("velocity", velocity)] {
            if !value.is_finite() {
                return Err(Error::value(name, value, "finite numbers"));
            }
        }
        let heading = velocity.normalize_or(Vec3::Z);
        let pace = self.pace(id);
        let members = &mut self.members;
        members.ids.push(id);
        members.positions.push(position);
        members.velocities.push(velocity);
        members.drifts.push(Vec3::ZERO);
        members.headings.push(heading);
        members.ups.push(upright(heading));
        members.alarms.push(0.0);
        members.paces.push(pace);
        self.scratch = Scratch::default();
        Ok(())
    }

    /// Removes the member with this identity and says whether there was one; the others keep
    /// their order.
    pub fn remove(&mut self, id: Id) -> bool {
        let members = &mut self.members;
        let Some(index) = members.ids.iter().position(|&one| one == id) else { return false };
        members.ids.remove(index);
        for array in [
            &mut members.positions,
            &mut members.velocities,
            &mut members.drifts,
            &mut members.headings,
            &mut members.ups,
        ] {
            array.remove(index);
        }
        members.alarms.remove(index);
        members.paces.remove(index);
        self.scratch = Scratch::default();
        true
    }

    /// Moves a member to where a body of its own has got to: place (metres), velocity through the medium (m/s), and the unit
    /// vectors in which it looks and its back points. Members fly the way they look, so of the velocity only what lies ahead
    /// is taken over: else one that slips sideways or has just started would look elsewhere as soon as its body leaves it.
    pub fn put(&mut self, index: usize, position: Vec3, velocity: Vec3, [heading, up]: [Vec3; 2]) {
        let (length, top) = (self.parameters.body_length, self.parameters.top_speed());
        let slowest = (self.parameters.minimum_speed * length).min(top);
        let members = &mut self.members;
        members.positions[index] = position;
        members.velocities[index] = heading * velocity.dot(heading).clamp(slowest, top);
        members.headings[index] = heading;
        members.ups[index] = up;
    }

    /// By which this individual's cruise speed is multiplied.
    fn pace(&self, id: Id) -> f32 {
        let spread = self.parameters.speed_spread;
        1.0 + spread * Random::new(self.seed, id, 0, PACE).range(-1.0, 1.0)
    }
}

/// Up for a body that looks along `heading`: as near to the world's up as can be.
fn upright(heading: Vec3) -> Vec3 {
    let up = Vec3::Y - heading * heading.y;
    up.try_normalize().unwrap_or_else(|| heading.any_orthonormal_vector())
}
