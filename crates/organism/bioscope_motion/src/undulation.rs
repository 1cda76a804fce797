//! Swimming by undulation: a wave of bending that travels along a spine from head to tail.
//!
//! The envelope of the sideways motion of a steadily swimming fish of length 1, at distance x from
//! the snout, is A(x) = 0.02 − 0.08 x + 0.16 x² for a mackerel-like swimmer (after Videler & Hess
//! 1984) and 0.0367 + 0.0323 x + 0.0310 x² for an eel-like one (after Hultmark et al. 2007), with about
//! one wave on the body.
//! Tail beat f, tail amplitude A (peak to peak) and speed U keep the Strouhal number f A / U within
//! 0.2–0.45 (Triantafyllou et al. 1993; Taylor et al. 2003).

use bioscope_core::{Error, Quat, Result, Vec3, math};
use bioscope_geometry::{Joint, Transform};
use serde::{Deserialize, Serialize};

mod hinges;

pub(crate) use hinges::pose_hinges;
pub use hinges::{Hinge, Part};

/// Share of the body length, from the snout, at which the origin of a body lies: about the centre of mass.
pub const ORIGIN: f32 = 0.42;

/// Strouhal number of a fish that barely moves, and at twice its cruising speed.
const STROUHAL: [f32; 2] = [0.33, 0.27];
/// Share of the full amplitude that remains at the slowest swimming.
const SLOWEST_AMPLITUDE: f32 = 0.6;
/// By how much the amplitude wanders, so that nobody beats like a metronome.
const WANDER: f32 = 0.15;
/// Strokes per second of a fin that rows at up to one body length per second; in proportion to the speed above (choice).
const ROWING: f32 = 0.8;
/// Turn from which the inner fin rows backward, radians per second, and share of gliding or braking from which both do (choice).
const ROWED_TURN: f32 = 0.4;
const BRAKING: f32 = 0.6;
/// Seconds in which the mouth opens (choice).
const GAPE_TIME: f32 = 0.12;
/// Greatest bend of each half of the body in radians.
const GREATEST_BEND: f32 = 0.6;

/// How the sideways motion grows along the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// A still head and a strong tail.
    Mackerel,
    /// The whole body undulates.
    Eel,
}

impl Style {
    /// Amplitude (half of peak to peak) in body lengths at `x` body lengths from the snout.
    pub fn amplitude(self, x: f32) -> f32 {
        match self {
            Self::Mackerel => 0.02 - 0.08 * x + 0.16 * x * x,
            Self::Eel => 0.0367 + 0.0323 * x + 0.0310 * x * x,
        }
    }
}

/// How a body swims.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gait {
    /// Growth of the amplitude along the body.
    pub style: Style,
    /// Waves on the body.
    pub waves: f32,
    /// Speed of easy swimming in body lengths per second.
    pub cruise: f32,
}

impl Gait {
    /// Share of the full amplitude used for steady swimming at `speed` body lengths per second: 1 from
    /// cruising speed upward.
    pub fn share(&self, speed: f32) -> f32 {
        math::mix(SLOWEST_AMPLITUDE, 1.0, math::smoothstep(0.0, self.cruise, speed))
    }

    /// Tail beats per second in steady swimming at `speed` body lengths per second.
    pub fn tail_beat(&self, speed: f32) -> f32 {
        let fast = math::smoothstep(0.0, 2.0 * self.cruise, speed);
        let strouhal = math::mix(STROUHAL[0], STROUHAL[1], fast);
        strouhal * speed.max(0.0) / (2.0 * self.style.amplitude(1.0) * self.share(speed))
    }
}

/// A row of rigid links from snout to tail, with hinged fins and a jaw. At rest it lies along Z of the mesh, snout at +Z.
/// Its joints are the fore ends of the links, in order, and then the hinges.
#[derive(Clone, Debug)]
pub struct Spine {
    length: f32,
    gait: Gait,
    /// Ends of the links as shares of the length: 0, …, 1.
    cuts: Vec<f32>,
    /// Share of the body's mass in each link.
    masses: Vec<f32>,
    /// Sideways motion of each link end in body lengths: factors of the sine and cosine of the phase.
    wave: Vec<[f32; 2]>,
    hinges: Vec<Hinge>,
}

impl Spine {
    /// A spine of `length` metres cut at `cuts` (shares of the length from 0 at the snout to 1, rising) into
    /// links of these `masses` (any unit, not all zero). Fails on fewer than two links or more than 32.
    pub fn new(
        length: f32,
        gait: Gait,
        cuts: Vec<f32>,
        masses: Vec<f32>,
        hinges: Vec<Hinge>,
    ) -> Result<Self> {
        check(length, gait, &cuts, &masses)?;
        let total: f32 = masses.iter().sum();
        let masses: Vec<f32> = masses.into_iter().map(|mass| mass / total).collect();
        let wave = wave(gait, &cuts, &masses);
        Ok(Self { length, gait, cuts, masses, wave, hinges })
    }

    /// Where to cut a body into this many links: the skull is one stiff link, the rest are equal.
    pub fn even_cuts(links: usize) -> Vec<f32> {
        const SKULL: f32 = 0.2;
        let trunk = (links.max(2) - 1) as f32;
        let rest = (0..links.max(2)).map(|link| SKULL + (1.0 - SKULL) * link as f32 / trunk);
        std::iter::once(0.0).chain(rest).collect()
    }

    /// Metres from snout to tail.
    pub fn length(&self) -> f32 {
        self.length
    }

    /// How it swims.
    pub fn gait(&self) -> Gait {
        self.gait
    }

    /// Number of poses that [`spine_pose`] writes: links and hinges.
    pub fn joint_count(&self) -> usize {
        self.masses.len() + self.hinges.len()
    }

    /// Where the links begin and the last ends, as shares of the length: 0, …, 1.
    pub fn cuts(&self) -> &[f32] {
        &self.cuts
    }

    /// Number of links.
    pub fn link_count(&self) -> usize {
        self.masses.len()
    }

    /// Position in the mesh, along Z, of the point this share of the length from the snout, metres.
    pub fn along(&self, share: f32) -> f32 {
        (ORIGIN - share) * self.length
    }

    /// The joints at rest, for the skin of a mesh.
    pub fn joints(&self) -> Vec<Joint> {
        let links = self.cuts[..self.masses.len()].iter().enumerate().map(|(link, &cut)| Joint {
            name: format!("spine_{link}"),
            parent: link.checked_sub(1).map(|parent| parent as u8),
            rest: Transform::at(Vec3::new(0.0, 0.0, self.along(cut))),
        });
        let hinges = self.hinges.iter().enumerate().map(|(number, hinge)| Joint {
            name: hinge.name(number),
            parent: Some(self.carrier(hinge) as u8),
            rest: Transform::at(hinge.position),
        });
        links.chain(hinges).collect()
    }

    /// Joints and weights for a point of the skin this share of the length from the snout. Two links share
    /// the skin round their common end, so it bends without kinks; the skull stays stiff.
    pub fn weights(&self, share: f32) -> ([u8; 4], [f32; 4]) {
        for link in 1..self.masses.len() {
            let [fore, cut, hind] = [self.cuts[link - 1], self.cuts[link], self.cuts[link + 1]];
            let reach = 0.5 * (cut - fore).min(hind - cut);
            if share < cut + reach {
                let weight = math::smoothstep(cut - reach, cut + reach, share);
                return ([link as u8 - 1, link as u8, 0, 0], [1.0 - weight, weight, 0.0, 0.0]);
            }
        }
        ([self.masses.len() as u8 - 1, 0, 0, 0], [1.0, 0.0, 0.0, 0.0])
    }

    /// The link that carries a hinge.
    fn carrier(&self, hinge: &Hinge) -> usize {
        let share = ORIGIN - hinge.position.z / self.length;
        self.cuts[1..].iter().position(|&cut| share < cut).unwrap_or(self.masses.len() - 1)
    }
}

fn check(length: f32, gait: Gait, cuts: &[f32], masses: &[f32]) -> Result<()> {
    let positive = |name: &str, value: f32| {
        let fine = value.is_finite() && value > 0.0;
        fine.then_some(()).ok_or_else(|| Error::value(name, value, "a positive number"))
    };
    positive("spine length", length)?;
    positive("waves on the body", gait.waves)?;
    positive("cruising speed", gait.cruise)?;
    if !(2..=32).contains(&masses.len()) || cuts.len() != masses.len() + 1 {
        let counts = format!("{} masses, {} cuts", masses.len(), cuts.len());
        return Err(Error::value("spine links", counts, "2 to 32 masses and one cut more"));
    }
    if cuts[0] != 0.0 || cuts[masses.len()] != 1.0 || !cuts.windows(2).all(|two| two[0] < two[1]) {
        return Err(Error::value("spine cuts", format!("{cuts:?}"), "numbers rising from 0 to 1"));
    }
    if masses.iter().any(|mass| !(mass.is_finite() && *mass >= 0.0)) {
        return Err(Error::value("link masses", format!("{masses:?}"), "no negative number"));
    }
    positive("mass of the body", masses.iter().sum())
}

/// Sideways motion of the link ends, scaled so that the tail keeps the amplitude of the law after the
/// recoil (the mean over the mass) has been taken out.
fn wave(gait: Gait, cuts: &[f32], masses: &[f32]) -> Vec<[f32; 2]> {
    let law: Vec<[f32; 2]> = cuts
        .iter()
        .map(|&x| {
            let (amplitude, angle) = (gait.style.amplitude(x), math::TAU * gait.waves * x);
            [amplitude * math::cos(angle), -amplitude * math::sin(angle)]
        })
        .collect();
    let mean = |part: usize| -> f32 {
        law.windows(2)
            .zip(masses)
            .map(|(ends, mass)| 0.5 * (ends[0][part] + ends[1][part]) * mass)
            .sum()
    };
    let tail = law[cuts.len() - 1];
    let (sine, cosine) = (tail[0] - mean(0), tail[1] - mean(1));
    let gain = gait.style.amplitude(1.0) / math::sqrt(sine * sine + cosine * cosine);
    law.into_iter().map(|[sine, cosine]| [sine * gain, cosine * gain]).collect()
}

/// What the body is doing while it swims: all that a pose depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SwimState {
    /// Phase of the tail beat, radians in 0..2π. Give every individual its own.
    pub phase: f32,
    /// Slow phase of the wandering of the amplitude, radians in 0..2π.
    pub mood: f32,
    /// Amplitude of the wave as a share of the full law (0 glides).
    pub amplitude: f32,
    /// Bend of the fore and of the hind half in radians, positive to the left.
    pub bend: [f32; 2],
    /// Vertical bend of each half in radians, positive lifts the head.
    pub lift: f32,
    /// Phase of the beat of the pair fins, radians in 0..2π.
    pub fan: f32,
    /// How far the pair fins beat, 0 (folded) to 1.
    pub fanning: f32,
    /// Phases of the left and of the right fin that rows, radians in 0..2π.
    pub oars: [f32; 2],
    /// How far the mouth is open, 0 to 1.
    pub mouth: f32,
}

/// How a body moves at the moment, in its own lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stroke {
    /// Forward speed, body lengths per second.
    pub speed: f32,
    /// Forward acceleration, body lengths per second squared.
    pub acceleration: f32,
    /// Turn to the left, radians per second.
    pub turn: f32,
    /// Lift of the head, radians per second.
    pub lift: f32,
    /// How hard it means to brake, 0 to 1.
    pub brake: f32,
}

impl SwimState {
    /// Goes on by `dt` seconds: beats follow the speed, a start beats harder, slowing down glides, and the
    /// head leads the turn while the hind half follows as fast as the body passes the place.
    pub fn advance(&mut self, gait: Gait, stroke: &Stroke, dt: f32) {
        let speed = stroke.speed.max(0.0);
        let start = stroke.acceleration.max(0.0);
        let pushed = speed + 0.25 * start.min(4.0 * gait.cruise);
        let angle = math::TAU * gait.tail_beat(pushed) * dt;
        self.phase = wrap(self.phase + angle);
        self.mood = wrap(self.mood + angle * 0.137);

        let glide = (-stroke.acceleration / (0.6 * speed + 0.2)).clamp(0.0, 1.0);
        let wander = 1.0 + WANDER * math::sin(self.mood);
        let amplitude = gait.share(pushed) * wander * (1.0 - 0.85 * glide);
        self.amplitude += (amplitude - self.amplitude) * math::relaxation(dt, 0.15);

        let along = speed.max(0.5 * gait.cruise);
        let bend = GREATEST_BEND * soft(0.5 * stroke.turn / along / GREATEST_BEND);
        self.bend[0] += (bend - self.bend[0]) * math::relaxation(dt, 0.15 / along);
        self.bend[1] += (self.bend[0] - self.bend[1]) * math::relaxation(dt, 0.5 / along);
        let lift = 0.3 * soft(0.5 * stroke.lift / along / 0.3);
        self.lift += (lift - self.lift) * math::relaxation(dt, 0.2);

        let slow = 1.0 - math::smoothstep(0.2 * gait.cruise, 1.2 * gait.cruise, speed);
        let fanning = slow.max(0.8 * glide).max(0.1);
        self.fanning += (fanning - self.fanning) * math::relaxation(dt, 0.25);
        self.fan = wrap(self.fan + math::TAU * (1.2 + 0.4 * gait.cruise) * dt);
        self.row(speed, stroke.turn, glide.max(stroke.brake) > BRAKING, dt);
    }

    /// Fins that row go round faster the faster the fish swims, forward; backward the inner one in a turn, and
    /// both to brake.
    pub fn row(&mut self, speed: f32, turn: f32, brakes: bool, dt: f32) {
        let step = math::TAU * ROWING.max(ROWING * speed) * dt;
        for (phase, side) in self.oars.iter_mut().zip([1.0, -1.0]) {
            let backward = brakes || turn * side > ROWED_TURN;
            *phase = wrap(*phase + if backward { -step } else { step });
        }
    }

    /// Opens the mouth as far as wanted, 0 to 1, as fast as it goes.
    pub fn gape(&mut self, wanted: f32, dt: f32) {
        let wanted = if wanted.is_finite() { wanted.clamp(0.0, 1.0) } else { 0.0 };
        let change = dt / GAPE_TIME;
        self.mouth += (wanted - self.mouth).clamp(-change, change);
    }
}

/// Close to x for small x, never beyond ±1.
fn soft(x: f32) -> f32 {
    x / (1.0 + x.abs())
}

fn wrap(angle: f32) -> f32 {
    let turns = angle / math::TAU;
    (turns - turns.floor()) * math::TAU
}

/// Writes the poses of all joints in mesh space (`out.len()` must be [`Spine::joint_count`]): links first,
/// then fins. No link changes its length, and the centre of mass stays where it is at rest.
pub fn spine_pose(spine: &Spine, swim: &SwimState, out: &mut [Transform]) {
    assert_eq!(out.len(), spine.joint_count(), "poses of a spine");
    let (sine, cosine) = (math::sin(swim.phase), math::cos(swim.phase));
    let sideways =
        |end: usize| swim.amplitude * (spine.wave[end][0] * sine + spine.wave[end][1] * cosine);
    let mut point = Vec3::new(spine.length * sideways(0), 0.0, spine.along(0.0));
    let mut drift = Vec3::ZERO;
    for (link, pose) in out[..spine.link_count()].iter_mut().enumerate() {
        let (fore, hind) = (spine.cuts[link], spine.cuts[link + 1]);
        let slope = (sideways(link) - sideways(link + 1)) / (hind - fore);
        let (bend, lift) = curve(swim, 0.5 * (fore + hind));
        let rotation = turn_then_lift(slope, bend, lift);
        *pose = Transform::new(point, rotation, 1.0);
        let step = rotation * Vec3::new(0.0, 0.0, (hind - fore) * spine.length);
        let rest = Vec3::new(0.0, 0.0, spine.along(0.5 * (fore + hind)));
        drift += (point - 0.5 * step - rest) * spine.masses[link];
        point -= step;
    }
    for pose in &mut out[..spine.link_count()] {
        pose.position -= drift;
    }
    pose_hinges(spine, swim, out);
}

/// Yaw and lift that a turn adds at this share of the length.
fn curve(swim: &SwimState, x: f32) -> (f32, f32) {
    let place = if x < ORIGIN { (ORIGIN - x) / ORIGIN } else { (ORIGIN - x) / (1.0 - ORIGIN) };
    let bend = if x < ORIGIN { swim.bend[0] } else { swim.bend[1] };
    (bend * place, swim.lift * place)
}

/// Rotation about Y by the angle of this sine and by `bend` (to the left), then about the own X so that the
/// head rises by `lift`.
fn turn_then_lift(sine: f32, bend: f32, lift: f32) -> Quat {
    // Half angles by their tangents: square roots are all that is needed.
    let sine = sine.clamp(-0.95, 0.95);
    let wave = sine / (1.0 + math::sqrt(1.0 - sine * sine));
    let (bend, lift) = (half_tangent(bend), half_tangent(lift));
    let turn = Quat::from_xyzw(0.0, wave + bend, 0.0, 1.0 - wave * bend);
    (turn * Quat::from_xyzw(-lift, 0.0, 0.0, 1.0)).normalize()
}

/// Tangent of half an angle of up to about one radian (three terms of the series).
fn half_tangent(angle: f32) -> f32 {
    let half = 0.5 * angle;
    let square = half * half;
    half * (1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0)))
}

#[cfg(test)]
mod tests;
