use bioscope_core::{Parameters, Percepts, Result, Sighting, Vec3, math, parameters, state};
use bioscope_geometry::{Camera, Medium, Transform};
use serde::{Deserialize, Serialize};

use super::cover::Cover;
use crate::eye::{eye_camera, eye_position};
use crate::outlook::{Reach, Shortlist, Thing};
use crate::{Sense, Surroundings};

/// −ln of the least contrast that is seen, 2 percent (Koschmieder 1924).
const HAZE: f32 = 3.912;
/// Distance in body lengths from which solids are noticed on all sides.
const NEAR_SOLIDS: f32 = 5.0;

parameters! {
    /// How well an animal sees.
    pub struct SightParameters {
        /// Distance up to which it sees in clear air.
        range: f32 = 30.0, "m", 0.0..=1000.0, "choice";
        /// Whole angle in which it sees, centered on the direction it looks in.
        field_of_view: f32 = 300.0, "deg", 1.0..=360.0, "Tu and Terzopoulos 1994";
        /// Least angle under which a thing is noticed.
        acuity: f32 = 0.25, "deg", 0.0..=30.0, "choice";
        /// How many things it attends to at once, the nearest first.
        attention: f32 = 24.0, "1", 0.0..=1000.0, "choice";
    }
}

impl SightParameters {
    /// The sight of an artificial fish: everything within 15 times its own size, after Tu 1996, 5.2.
    pub fn fish() -> Self {
        Self { range: 1000.0, acuity: 3.8183, ..Self::default() }
    }
}

/// Sight of living things; see the [module](self) for what is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    parameters: SightParameters,
    #[serde(skip)]
    shortlist: Shortlist,
}

/// Something within range and field of view.
#[derive(Clone, Copy)]
struct Candidate {
    /// Whether it stays where it is: of less interest.
    stays: bool,
    distance: f32,
    thing: Thing,
}

impl Sight {
    /// Sight this good.
    pub fn new(parameters: SightParameters) -> Self {
        Self { parameters, shortlist: Shortlist::default() }
    }

    /// Everything within range and field of view.
    fn candidates(&mut self, surroundings: &Surroundings, eye: Vec3) -> Vec<Candidate> {
        let range = self.parameters.range.min(visibility(surroundings.medium));
        let half_angle = (0.5 * self.parameters.field_of_view).min(180.0).to_radians();
        let least_cosine = math::cos(half_angle);
        let least_size = 2.0 * math::tan(0.5 * self.parameters.acuity.to_radians());
        let heading = surroundings.heading();
        let batches = &surroundings.scene().batches;
        let reach = Reach { range, least: least_size.max(1e-9) };
        let mut candidates = Vec::new();
        let instances = surroundings.outlook.instances();
        self.shortlist.near(
            instances,
            (eye, reach),
            |_| true,
            |thing| {
                let offset = thing.position - eye;
                let distance = offset.length();
                let seen = distance <= reach.of(thing.size)
                    && offset.dot(heading) >= least_cosine * distance
                    && thing.id != surroundings.id;
                if seen {
                    let stays = batches[thing.group as usize].velocities.is_empty();
                    candidates.push(Candidate { stays, distance, thing: *thing });
                }
            },
        );
        candidates
    }

    /// Those that are attended to: the nearest that are not hidden.
    fn attended(&mut self, surroundings: &Surroundings, eye: Vec3) -> (Vec<Candidate>, Vec<Vec3>) {
        let attention = self.parameters.attention as usize;
        let mut candidates = self.candidates(surroundings, eye);
        // Some more than are attended to, for those that turn out to be hidden.
        let enough = attention + attention / 2 + 8;
        if candidates.len() > enough {
            candidates.select_nth_unstable_by(enough - 1, order);
        }
        let first = enough.min(candidates.len());
        candidates[..first].sort_unstable_by(order);
        let near = NEAR_SOLIDS * surroundings.body_length;
        let farthest =
            |some: &[Candidate]| some.iter().map(|one| one.distance).fold(near, f32::max);
        let mut cover = Cover::new(surroundings, eye, farthest(&candidates[..first]));
        let solids = cover.nearest_points(near);
        let mut visible = Vec::with_capacity(attention.min(first));
        for index in 0..candidates.len() {
            if visible.len() == attention {
                break;
            }
            if index == first {
                candidates[first..].sort_unstable_by(order);
                cover = Cover::new(surroundings, eye, farthest(&candidates[first..]));
            }
            let one = candidates[index];
            if !cover.hides(one.thing.position, axis(surroundings, &one.thing), one.thing.size) {
                visible.push(one);
            }
        }
        visible.sort_unstable_by(|a, b| order(&Candidate { stays: b.stays, ..*a }, b));
        (visible, solids)
    }
}

/// What moves first, then the nearest.
fn order(a: &Candidate, b: &Candidate) -> std::cmp::Ordering {
    let order = a.stays.cmp(&b.stays).then(a.distance.total_cmp(&b.distance));
    order.then(a.thing.id.cmp(&b.thing.id))
}

/// Where a thing looks: a unit vector in the world; zero for what stays and has no front.
fn axis(surroundings: &Surroundings, thing: &Thing) -> Vec3 {
    let batch = &surroundings.scene().batches[thing.group as usize];
    if batch.velocities.is_empty() {
        return Vec3::ZERO;
    }
    batch.transforms[thing.member as usize].rotation() * Vec3::Z
}

/// What is seen of a thing.
fn sighting(surroundings: &Surroundings, thing: &Thing) -> Sighting {
    let batch = &surroundings.scene().batches[thing.group as usize];
    let member = thing.member as usize;
    let velocity = batch.velocities.get(member).copied().unwrap_or_default();
    let tint = Vec3::from(batch.tints.get(member).copied().unwrap_or([1.0; 3]));
    Sighting {
        id: thing.id,
        species: batch.species.clone(),
        position: surroundings.own_point(thing.position),
        velocity: surroundings.own_vector(velocity),
        heading: surroundings.own_vector(axis(surroundings, thing)),
        size: thing.size,
        color: (Vec3::from(batch.material.color) * tint).to_array(),
        display: batch.displays.get(member).copied().unwrap_or_default(),
    }
}

/// Distance in metres at which haze leaves too little contrast to see, in the clearest color.
fn visibility(medium: &Medium) -> f32 {
    let channels = medium.absorption.iter().zip(&medium.scattering);
    let least = channels.map(|(absorbed, scattered)| absorbed + scattered);
    HAZE / least.fold(f32::INFINITY, f32::min).max(1e-6)
}

impl Sense for Sight {
    fn kind(&self) -> &str {
        "sight"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        let placement = Transform::new(surroundings.position, surroundings.attitude, 1.0);
        let eye = eye_position(&placement, surroundings.body_length);
        let (visible, solids) = self.attended(surroundings, eye);
        percepts.seen.clear();
        percepts.seen.extend(visible.iter().map(|one| sighting(surroundings, &one.thing)));
        percepts.solids.clear();
        percepts.solids.extend(solids.iter().map(|&point| surroundings.own_point(point)));
        Ok(())
    }

    fn eye(&self, placement: &Transform, body_length: f32) -> Option<Camera> {
        Some(eye_camera(placement, body_length, self.parameters.field_of_view.to_radians()))
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
