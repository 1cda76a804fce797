use bioscope_core::{Error, Id, Result, Vec3};
use serde::{Deserialize, Serialize};

/// What those who live in a population can be told from outside, between two ticks.
///
/// Orders are inputs like parameters: recorded, and repeated to the bit by a replay. A population
/// obeys those that make sense for it and refuses the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Be this many: the youngest go, or others like the first come.
    Number(usize),
    /// This one goes.
    Remove(Id),
    /// This one is put elsewhere.
    Place {
        /// Which one.
        id: Id,
        /// Where to, metres.
        position: Vec3,
        /// Its size relative to the present one.
        scale: f32,
    },
    /// A parameter of this one alone is set.
    Trait {
        /// Which one.
        id: Id,
        /// The parameter's name, as the population describes it.
        name: String,
        /// Its new value.
        value: f64,
    },
    /// This one does what it is told instead of what its mind wants, until it is told `None`.
    Steer {
        /// Which one.
        id: Id,
        /// What it is to do.
        steering: Option<Steering>,
    },
}

/// Motor commands of somebody who has taken the place of an animal's mind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steering {
    /// Angle to turn by, radians, positive to the left.
    pub turn: f32,
    /// Angle to climb at, radians, negative to dive.
    pub pitch: f32,
    /// Body lengths per second; negative to back away.
    pub speed: f32,
    /// How hard to brake, 0 (not) to 1 (at once).
    pub brake: f32,
    /// How far to open the mouth, 0 to 1.
    pub mouth: f32,
}

impl Order {
    /// Refuses numbers that are not finite or make no sense for anybody.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Place { position, scale, .. } => {
                if !position.is_finite() || position.abs().max_element() > 1e5 {
                    return Err(Error::value("place", position, "metres within 100 km"));
                }
                within("scale", *scale, 0.05, 20.0)
            }
            Self::Steer { steering: Some(steering), .. } => {
                let half = std::f32::consts::FRAC_PI_2;
                within("turn", steering.turn, -2.0 * half, 2.0 * half)?;
                within("pitch", steering.pitch, -half, half)?;
                within("speed", steering.speed, -20.0, 40.0)?;
                within("brake", steering.brake, 0.0, 1.0)?;
                within("mouth", steering.mouth, 0.0, 1.0)
            }
            _ => Ok(()),
        }
    }
}

fn within(name: &str, value: f32, low: f32, high: f32) -> Result<()> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(Error::value(name, value, format!("{low} to {high}")))
}
