use bioscope_core::{Impact, Parameters, Percepts, Result, Value, Vec3, parameters, state};
use bioscope_geometry::{Obstacle, Terrain};
use serde::{Deserialize, Serialize};

use crate::{Sense, Surroundings};

/// Name of the height above ground among further percepts.
const ALTITUDE: &str = "altitude";
/// Samples of the ground along the feeler.
const GROUND_SAMPLES: u16 = 24;

parameters! {
    /// How far an animal feels ahead.
    pub struct TouchParameters {
        /// Least length of the feeler.
        reach: f32 = 5.0, "BL", 0.0..=100.0, "Reynolds 1988, choice";
        /// Time of travel that it covers.
        foresight: f32 = 2.5, "s", 0.0..=60.0, "choice";
        /// Half the width that must be free.
        clearance: f32 = 0.35, "BL", 0.0..=10.0, "choice";
        /// Distance from the obstacle at which to pass.
        margin: f32 = 1.0, "BL", 0.0..=20.0, "Reynolds 1988";
    }
}

/// The feeler; see the [module](self).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Touch {
    parameters: TouchParameters,
}

impl Touch {
    /// A feeler of these measures.
    pub fn new(parameters: TouchParameters) -> Self {
        Self { parameters }
    }
}

impl Sense for Touch {
    fn kind(&self) -> &str {
        "touch"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        percepts.ahead = impact_ahead(surroundings, &self.parameters);
        let Vec3 { x, y, z } = surroundings.position;
        let altitude = surroundings.terrain.map(|terrain| Value::from(y - terrain.height(x, z)));
        match (altitude, percepts.other.get_mut(ALTITUDE)) {
            (Some(altitude), Some(known)) => *known = altitude,
            (Some(altitude), None) => {
                percepts.other.insert(String::from(ALTITUDE), altitude);
            }
            (None, _) => {
                percepts.other.remove(ALTITUDE);
            }
        }
        Ok(())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}

/// The nearest obstacle, ground or surface straight ahead within reach, with the point beside it to
/// steer for, in the own frame.
pub fn impact_ahead(surroundings: &Surroundings, measures: &TouchParameters) -> Option<Impact> {
    let length = surroundings.body_length;
    let origin = surroundings.position;
    let heading = surroundings.heading();
    let clearance = measures.clearance * length;
    let travel = surroundings.velocity.length() * measures.foresight;
    let reach = (measures.reach * length).max(travel);

    let mut nearest: Option<(f32, Obstacle)> = None;
    let mut meet = |solid: &Obstacle| {
        if let Some(distance) = approach(&solid.inflated(clearance), origin, heading, reach)
            && nearest.is_none_or(|(least, _)| distance < least)
        {
            nearest = Some((distance, *solid));
        }
    };
    // Boxes and cylinders grow by more than the clearance towards their corners.
    let (end, margin) = (origin + heading * reach, 2.0 * clearance);
    let way = (origin.min(end) - margin, origin.max(end) + margin);
    surroundings.obstacles.within(way.0, way.1).for_each(&mut meet);
    if let Some(surface) = surroundings.medium.surface.filter(|surface| origin.y < *surface) {
        meet(&Obstacle::Plane { point: Vec3::Y * surface, normal: Vec3::NEG_Y });
    }
    if let Some(terrain) = surroundings.terrain {
        let slope = ground_ahead(terrain, origin, heading, reach, clearance);
        slope.iter().for_each(&mut meet);
    }
    let (distance, solid) = nearest?;
    let aim = solid.beside(origin, heading, distance, measures.margin * length);
    Some(Impact { distance, aim: surroundings.own_point(aim) })
}

/// Distance to a solid along a heading; none for one that the animal has already grazed and is
/// about to leave.
fn approach(solid: &Obstacle, origin: Vec3, heading: Vec3, reach: f32) -> Option<f32> {
    let distance = solid.hit(origin, heading, reach)?;
    let step = 1e-2;
    let leaving = distance == 0.0
        && solid.distance(origin + heading * step) >= solid.distance(origin) - 0.1 * step;
    (!leaving).then_some(distance)
}

/// The ground that a course meets, as the plane that touches it there.
fn ground_ahead(
    terrain: &Terrain,
    origin: Vec3,
    heading: Vec3,
    reach: f32,
    clearance: f32,
) -> Option<Obstacle> {
    let end = origin + heading * reach;
    let (low, high) = (origin.min(end), origin.max(end));
    if low.y - clearance >= terrain.bound([low.x, low.z], [high.x, high.z]) {
        return None;
    }
    let meets = (0..=GROUND_SAMPLES)
        .map(|step| origin + heading * (reach * f32::from(step) / f32::from(GROUND_SAMPLES)));
    // Ground that the course leaves or follows is no obstacle, however near.
    let point = meets.into_iter().find(|point| {
        point.y - clearance < terrain.height(point.x, point.z)
            && heading.dot(terrain.normal(point.x, point.z)) < -0.05
    })?;
    let on_ground = Vec3::new(point.x, terrain.height(point.x, point.z), point.z);
    Some(Obstacle::Plane { point: on_ground, normal: terrain.normal(point.x, point.z) })
}
