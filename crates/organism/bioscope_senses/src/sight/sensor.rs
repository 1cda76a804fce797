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
    /// Those of what moves, and of what stays where it is.
    #[serde(skip)]
    shortlists: [Shortlist; 2],
}

/// Something within range and field of view.
#[derive(Clone, Copy)]
struct Candidate<'a> {
    /// What moves before what [`STAYS`], the nearest first, then by identity.
    rank: u64,
    /// Metres from the eye.
    distance: f32,
    thing: &'a Thing,
}

/// Rank of what stays where it is, which is of less interest.
const STAYS: u64 = 1 << 63;

impl<'a> Candidate<'a> {
    fn new(thing: &'a Thing, distance: f32, stays: bool) -> Self {
        // Distances are not negative, so that their bits rise with them.
        let nearness = u64::from(distance.to_bits()) << 32 | u64::from(thing.id);
        Self { rank: if stays { STAYS | nearness } else { nearness }, distance, thing }
    }
}

impl Sight {
    /// Sight this good.
    pub fn new(parameters: SightParameters) -> Self {
        Self { parameters, shortlists: Default::default() }
    }

    /// Adds everything within range and field of view: what moves, or what stays where it is.
    fn look_for<'a>(
        &mut self,
        stays: bool,
        (surroundings, eye): (&Surroundings<'a>, Vec3),
        candidates: &mut Vec<Candidate<'a>>,
    ) {
        let range = self.parameters.range.min(visibility(surroundings.medium));
        let half_angle = (0.5 * self.parameters.field_of_view).min(180.0).to_radians();
        let least_cosine = math::cos(half_angle);
        let least_size = 2.0 * math::tan(0.5 * self.parameters.acuity.to_radians());
        let heading = surroundings.heading();
        let reach = Reach { range, least: least_size.max(1e-9) };
        let (outlook, [of_movers, of_stays]) = (surroundings.outlook, &mut self.shortlists);
        let (register, shortlist) =
            if stays { (outlook.stays(), of_stays) } else { (outlook.movers(), of_movers) };
        shortlist.near(
            register,
            (eye, reach),
            |_| true,
            |thing| {
                let offset = thing.position - eye;
                let distance = offset.length();
                let seen = distance <= reach.of(thing.size)
                    && offset.dot(heading) >= least_cosine * distance
                    && thing.id != surroundings.id;
                if seen {
                    candidates.push(Candidate::new(thing, distance, stays));
                }
            },
        );
    }

    /// Those that are attended to: the nearest that are not hidden, what moves before what stays.
    fn attended<'a>(&mut self, surroundings: &Surroundings<'a>, eye: Vec3) -> Vec<Candidate<'a>> {
        let attention = self.parameters.attention as usize;
        // Some more than are attended to, for those that turn out to be hidden.
        let enough = attention + attention / 2 + 8;
        let mut candidates = Vec::with_capacity(2 * enough);
        self.look_for(false, (surroundings, eye), &mut candidates);
        // Among many that move nobody heeds what stays.
        let many = candidates.len() >= enough;
        if !many {
            self.look_for(true, (surroundings, eye), &mut candidates);
        }
        if candidates.len() > enough {
            candidates.select_nth_unstable_by_key(enough - 1, |one| one.rank);
        }
        let first = enough.min(candidates.len());
        let mut visible = Vec::with_capacity(attention.min(first));
        attend(&mut candidates[..first], (surroundings, eye), (attention, &mut visible));
        if visible.len() < attention {
            if many {
                self.look_for(true, (surroundings, eye), &mut candidates);
            }
            attend(&mut candidates[first..], (surroundings, eye), (attention, &mut visible));
        }
        visible.sort_unstable_by_key(|one| one.rank & !STAYS);
        visible
    }
}

/// Adds the first of the candidates that are not hidden, until there are `attention`.
fn attend<'a>(
    candidates: &mut [Candidate<'a>],
    (surroundings, eye): (&Surroundings, Vec3),
    (attention, visible): (usize, &mut Vec<Candidate<'a>>),
) {
    if candidates.is_empty() {
        return;
    }
    candidates.sort_unstable_by_key(|one| one.rank);
    let near = near_solids(surroundings);
    let farthest = candidates.iter().map(|one| one.distance).fold(near, f32::max);
    let cover = Cover::new(surroundings, eye, farthest);
    let shows = |Candidate { thing, .. }: &&Candidate| {
        !cover.hides(thing.position, axis(surroundings, thing), thing.size)
    };
    let missing = attention - visible.len();
    visible.extend(candidates.iter().filter(shows).take(missing));
}

/// Distance in metres from which solids are noticed on all sides.
fn near_solids(surroundings: &Surroundings) -> f32 {
    NEAR_SOLIDS * surroundings.body_length
}

/// Where a thing looks: a unit vector in the world; zero for what stays and has no front.
fn axis(surroundings: &Surroundings, thing: &Thing) -> Vec3 {
    let batch = &surroundings.scene().batches[thing.group as usize];
    if batch.velocities.is_empty() {
        return Vec3::ZERO;
    }
    batch.transforms[thing.member as usize].rotation() * Vec3::Z
}

/// Notes what is seen of a thing in place of what was seen of another one.
fn see(surroundings: &Surroundings, thing: &Thing, sighting: &mut Sighting) {
    let batch = &surroundings.scene().batches[thing.group as usize];
    let member = thing.member as usize;
    let velocity = batch.velocities.get(member).copied().unwrap_or_default();
    let tint = Vec3::from(batch.tints.get(member).copied().unwrap_or([1.0; 3]));
    sighting.id = thing.id;
    sighting.is_of(&batch.species);
    sighting.position = surroundings.own_point(thing.position);
    sighting.velocity = surroundings.own_vector(velocity);
    sighting.heading = surroundings.own_vector(axis(surroundings, thing));
    sighting.size = thing.size;
    sighting.color = (Vec3::from(batch.material.color) * tint).to_array();
    sighting.display = batch.displays.get(member).copied().unwrap_or_default();
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
        let visible = self.attended(surroundings, eye);
        percepts.seen.resize_with(visible.len(), Sighting::default);
        for (sighting, one) in percepts.seen.iter_mut().zip(&visible) {
            see(surroundings, one.thing, sighting);
        }
        let solids = Cover::new(surroundings, eye, near_solids(surroundings));
        percepts.solids.clear();
        percepts.solids.extend(solids.nearest_points().map(|point| surroundings.own_point(point)));
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
