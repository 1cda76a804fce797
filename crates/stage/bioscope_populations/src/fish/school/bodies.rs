//! The bodies of a school that replays captured motion: muscles for those near an observer, replay for the many.
//!
//! A replayed fish goes where the flock goes and is bent as the muscle-driven one was when it swam at that speed at that
//! moment of its beat (Terzopoulos, "Artificial Life for Computer Graphics", 1999: synthetic motion capture with
//! levels of detail). The fishes nearest to the observer are computed by muscles, springs and water; they take the flock's heading and speed
//! for orders, and the flock takes over where they get to, but not how their trunks turn: a flock that steered a body of which
//! it knows every swing would answer each with a turn that comes too late. Who comes near goes on from the very nodes of its replay; who
//! leaves goes on the way it swam, keeps what differs from its replay and loses it within a second.

use std::sync::{Arc, OnceLock};

use bioscope_core::{Error, Id, Intention, Result, Vec3, state};
use bioscope_crowds::Flock;
use bioscope_dynamics::Influence;
use bioscope_dynamics::spring_body::fish::NODES;
use bioscope_geometry::Transform;
use bioscope_motion::fish::{FishModel, Repertoire, pose_from_nodes};
use bioscope_motion::undulation::Spine;
use bioscope_motion::{Body, MuscleSwimmer};
use bioscope_world::Environment;
use serde::{Deserialize, Serialize};

use super::SchoolParameters;
use super::fish::Fish;
use crate::animals::way_out;

/// How much farther away a muscle-driven fish may be than a replayed one before they change places.
const LOYALTY: f32 = 1.25;
/// Seconds in which a fish that leaves its muscles takes on its replay.
const FADE: f32 = 1.0;
/// Cosine and sine of the greatest angle, 60 degrees, by which the heading that the flock wants leads that of a body.
const LEAD: [f32; 2] = [0.5, 0.866_025_4];

/// The captured motion of the calibrated fish, captured once.
pub(super) struct Capture {
    pub model: Arc<FishModel>,
    pub repertoire: Repertoire,
}

/// The capture that all schools share.
pub(super) fn capture() -> Result<&'static Capture> {
    static CAPTURE: OnceLock<Capture> = OnceLock::new();
    if let Some(capture) = CAPTURE.get() {
        return Ok(capture);
    }
    let model = FishModel::named("calibrated")?;
    let repertoire = Repertoire::capture(&model)?;
    Ok(CAPTURE.get_or_init(|| Capture { model, repertoire }))
}

/// A fish that is computed by its muscles.
struct Driven {
    id: Id,
    body: MuscleSwimmer,
}

/// What still differs from its replay in a fish that was computed by its muscles.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Fading {
    id: Id,
    /// Seconds left.
    left: f32,
    /// Difference of the nodes, body lengths.
    rest: [Vec3; NODES],
}

/// Those of a school's bodies that are more than replay; see the [module](self).
#[derive(Default)]
pub(super) struct Bodies {
    driven: Vec<Driven>,
    fading: Vec<Fading>,
}

/// What a school is beside these bodies.
pub(super) struct Members<'a> {
    pub flock: &'a mut Flock,
    pub fishes: &'a mut [Fish],
    pub spine: &'a Arc<Spine>,
    /// Length of the species, metres.
    pub length: f32,
    pub flows: &'a [Vec3],
}

/// How fast the tail of a fish of this pace beats, and its speed in the capture's units.
fn beat_of(capture: &Capture, spine: &Spine, speed: f32) -> (f32, f32) {
    let swim = &capture.model.design.swim;
    let time_unit = swim.cruise / f64::from(spine.gait().cruise);
    let speed = f64::from(speed) * time_unit;
    let frequency = swim.stroke(speed).frequency / time_unit;
    (frequency as f32, speed as f32)
}

/// The heading that is wanted, but no farther from the present one than a body can be expected to turn; unit vectors.
fn leading(wanted: Vec3, present: Vec3) -> Vec3 {
    let along = wanted.dot(present);
    if along >= LEAD[0] {
        return wanted;
    }
    let aside = (wanted - present * along).normalize_or(present.any_orthonormal_vector());
    (present * LEAD[0] + aside * LEAD[1]).normalize()
}

impl Bodies {
    /// Which bodies there are and where, by index in the school: a driven body, or a difference that fades.
    fn index(&self, flock: &Flock) -> Vec<(usize, usize)> {
        let place = |id: Id| flock.ids().iter().position(|&one| one == id);
        let all = self.driven.iter().enumerate();
        all.filter_map(|(slot, one)| Some((place(one.id)?, slot))).collect()
    }

    /// Forgets fishes that are no more.
    pub fn forget(&mut self, gone: Id) {
        self.driven.retain(|one| one.id != gone);
        self.fading.retain(|one| one.id != gone);
    }

    /// Lets those near the observer take up their muscles and those that are far leave them, then moves all.
    pub fn advance(
        &mut self,
        members: &mut Members,
        parameters: &SchoolParameters,
        environment: &Environment,
        dt: f32,
    ) -> Result<()> {
        let capture = capture()?;
        for (fish, velocity) in members.fishes.iter_mut().zip(members.flock.velocities()) {
            let speed = velocity.length() / (members.length * fish.scale);
            fish.beat = (fish.beat + beat_of(capture, members.spine, speed).0 * dt).fract();
        }
        self.fading.iter_mut().for_each(|one| one.left -= dt);
        self.fading.retain(|one| one.left > 0.0);
        self.choose(members, parameters, capture)?;
        self.swim(members, environment, dt)
    }

    fn choose(
        &mut self,
        members: &mut Members,
        parameters: &SchoolParameters,
        capture: &Capture,
    ) -> Result<()> {
        let SchoolParameters { observer_x, observer_y, observer_z, .. } = *parameters;
        let observer = Vec3::new(observer_x, observer_y, observer_z);
        let places = members.flock.positions();
        let mut order: Vec<(f32, usize)> =
            places.iter().enumerate().map(|(at, place)| (place.distance(observer), at)).collect();
        for (at, _) in self.index(members.flock) {
            order[at].0 /= LOYALTY;
        }
        let wanted = (parameters.driven as usize).min(order.len());
        if wanted > 0 && wanted < order.len() {
            order
                .select_nth_unstable_by(wanted - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        let mut near: Vec<usize> = order[..wanted].iter().map(|&(_, at)| at).collect();
        near.sort_unstable();
        for (at, slot) in self.index(members.flock).into_iter().rev() {
            if near.binary_search(&at).is_err() {
                let Driven { id, body } = self.driven.remove(slot);
                let course = body.heading();
                let up = body.placement().rotation() * Vec3::Y;
                let up = (up - course * up.dot(course)).normalize_or(Vec3::Y);
                let velocity = body.velocity() - members.flows[at];
                let position = members.flock.positions()[at];
                members.flock.put(at, position, velocity, [course, up]);
                members.fishes[at].beat = body.phase();
                let mut rest = self.looks(members, capture, at);
                let back = members.flock.rotation(at).inverse() * body.placement().rotation();
                let shown = body.local_nodes();
                rest.iter_mut().zip(shown).for_each(|(one, shown)| *one = back * shown - *one);
                self.fading.push(Fading { id, left: FADE, rest });
            }
        }
        for at in near {
            let id = members.flock.ids()[at];
            if self.driven.iter().all(|one| one.id != id) {
                let body = self.take_up(members, capture, at)?;
                self.fading.retain(|one| one.id != id);
                self.driven.push(Driven { id, body });
            }
        }
        Ok(())
    }

    /// Nodes of a replayed fish in its placement, body lengths.
    fn looks(&self, members: &Members, capture: &Capture, at: usize) -> [Vec3; NODES] {
        let fish = &members.fishes[at];
        let speed = members.flock.velocities()[at].length() / (members.length * fish.scale);
        self.nodes(capture, members.spine, (members.flock.ids()[at], speed, fish.beat))
    }

    fn nodes(
        &self,
        capture: &Capture,
        spine: &Spine,
        (id, speed, beat): (Id, f32, f32),
    ) -> [Vec3; NODES] {
        let mut nodes = capture.repertoire.beat(beat_of(capture, spine, speed).1, beat);
        if let Some(fading) = self.fading.iter().find(|one| one.id == id) {
            let share = fading.left / FADE;
            let weight = share * share * (3.0 - 2.0 * share);
            nodes.iter_mut().zip(&fading.rest).for_each(|(node, rest)| *node += *rest * weight);
        }
        nodes
    }

    fn take_up(&self, members: &Members, capture: &Capture, at: usize) -> Result<MuscleSwimmer> {
        let length = members.length * members.fishes[at].scale;
        let (place, rotation) = (members.flock.positions()[at], members.flock.rotation(at));
        let nodes = self.looks(members, capture, at).map(|node| place + rotation * node * length);
        let velocity = members.flock.velocities()[at] + members.flows[at];
        let beat = members.fishes[at].beat;
        MuscleSwimmer::going_on(members.spine.clone(), length, &nodes, (rotation, velocity), beat)
    }

    /// Moves the muscle-driven ones as the flock wants to go, and the flock to where they get.
    fn swim(&mut self, members: &mut Members, environment: &Environment, dt: f32) -> Result<()> {
        let places = self.index(members.flock);
        for &(at, slot) in &places {
            let body = &mut self.driven[slot].body;
            let heading = body.placement().rotation().inverse() * members.flock.headings()[at];
            let speed = members.flock.velocities()[at].length() / body.length();
            let intention = Intention { heading, speed, ..Intention::default() };
            let influence = Influence { flow: members.flows[at], ..Influence::default() };
            body.obey(&intention, &influence, dt)?;
        }
        let mut bodies: Vec<_> = self.driven.iter_mut().map(|one| &mut one.body).collect();
        MuscleSwimmer::advance_together(&mut bodies, dt);
        for (at, slot) in places {
            let body = &mut self.driven[slot].body;
            let reach = 0.25 * body.length();
            body.shift(way_out(body.placement().position, reach, environment));
            let flock = &mut *members.flock;
            let wanted = leading(flock.headings()[at], body.heading());
            let up = flock.ups()[at];
            let up = (up - wanted * up.dot(wanted)).normalize_or(Vec3::Y);
            let speed = flock.velocities()[at].length();
            flock.put(at, body.placement().position, wanted * speed, [wanted, up]);
        }
        Ok(())
    }

    /// Poses a fish: the joints of its spine, and where it is if it is driven by muscles.
    pub fn pose(
        &self,
        spine: &Spine,
        (id, fish, speed): (Id, &Fish, f32),
        out: &mut [Transform],
    ) -> Option<Transform> {
        if let Some(driven) = self.driven.iter().find(|one| one.id == id) {
            driven.body.pose(out);
            return Some(driven.body.placement());
        }
        let capture = capture().ok()?;
        let nodes = self.nodes(capture, spine, (id, speed, fish.beat));
        pose_from_nodes(spine, &capture.model.design.shape, &nodes, &fish.swim, out);
        None
    }

    /// How many are computed by their muscles.
    pub fn driven(&self) -> usize {
        self.driven.len()
    }

    pub fn save(&self) -> Result<Vec<u8>> {
        let driven = self.driven.iter().map(|one| Ok((one.id, one.body.save()?)));
        Ok(state::to_bytes(&(driven.collect::<Result<Vec<_>>>()?, &self.fading)))
    }

    pub fn restore(spine: &Arc<Spine>, bytes: &[u8]) -> Result<Self> {
        let (driven, fading): (Vec<(Id, Vec<u8>)>, Vec<Fading>) =
            state::from_bytes("bodies of a school", bytes)?;
        let driven = driven.into_iter().map(|(id, bytes)| {
            Ok(Driven { id, body: MuscleSwimmer::restore(spine.clone(), &bytes)? })
        });
        let driven = driven.collect::<Result<Vec<_>>>()?;
        if !fading.iter().all(|one| one.rest.iter().all(|node| node.is_finite())) {
            return Err(Error::format("bodies of a school", "places that are not finite"));
        }
        Ok(Self { driven, fading })
    }
}
