use bioscope_core::{Error, Result, Vec3, math};
use bioscope_dynamics::spring_body::fish::MUSCLES;
use serde::{Deserialize, Serialize};

use super::fins::Fins;
use super::frame::{Frame, wrapped};
use super::model::FishDesign;
use super::turning::Turn;

/// What a fish is to do; all parts at once. Lengths in body lengths, times in time units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Speed of swimming through the water; 0 glides.
    pub speed: f32,
    /// Heading to go on in, as a change of the present one, radians, positive to the left; none to leave it to
    /// turns that were begun before. To be given anew in each tick.
    pub steer: Option<f32>,
    /// Climb, radians, negative to descend.
    pub climb: f32,
    /// How far the pectoral fins are spread against the water, 0 to 1.
    pub brake: f32,
    /// Speed of rowing backward.
    pub backward: f32,
}

impl Command {
    /// Refuses numbers that mean nothing.
    pub fn checked(self) -> Result<Self> {
        let named = [
            ("speed", self.speed),
            ("steer", self.steer.unwrap_or(0.0)),
            ("climb", self.climb),
            ("brake", self.brake),
            ("backward", self.backward),
        ];
        for (name, value) in named {
            if !value.is_finite() {
                return Err(Error::value(name, value, "a finite number"));
            }
        }
        Ok(self)
    }
}

/// What the motor controllers of one fish remember: the swim-MC, the turn-MCs, and those of the fins, which all act
/// in the same step (Tu, "Artificial Animals for Computer Animation", section 4.3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motor {
    /// What it was told.
    pub command: Command,
    /// Whether heading and speed are watched. Without, every controller runs blindly, as in the source.
    pub feedback: bool,
    /// Phase of the anterior swim segment in beats, 0 to 1.
    pub phase: f32,
    /// Beats per time unit at present.
    pub frequency: f32,
    /// Amplitudes of the two swim segments at present.
    pub amplitudes: [f32; 2],
    /// Bend of the turning segments, −1 to 1, positive to the left.
    pub bend: f32,
    /// The turn that goes on, if it is done blindly.
    pub turn: Option<Turn>,
    /// Whether a turn goes on that is watched.
    rounding: bool,
    /// Pectoral fins.
    pub fins: Fins,
    /// Angle that is still to be turned, radians, positive to the left.
    to_turn: f32,
    /// How the beat swings the trunk about its heading, with the cosine and with the sine of the phase, radians.
    swing: [f32; 2],
    /// Heading and speed without the beat, and the rate of turning.
    heading: f32,
    pace: f32,
    turning: f32,
    settled: bool,
}

/// What a body feels of its own motion.
#[derive(Clone, Copy, Debug)]
pub struct Feeling {
    /// Its frame.
    pub frame: Frame,
    /// Velocity of its center through the water, body lengths per time unit.
    pub velocity: Vec3,
}

/// What the muscles and fins do in a step.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Wanted contraction of each muscle, 0 to 1.
    pub contraction: [f32; MUSCLES],
    /// Force of the left and of the right pectoral fin.
    pub fins: [Vec3; 2],
}

/// Bend per radian that is still to be turned after the next time units.
const STEERING: f32 = 4.0;
const LOOKAHEAD: f32 = 1.5;
/// Angle, radians, below which the bend is gentler, as the beat alone may swing the trunk by as much, and the deepest bend:
/// in a turn by a given angle, and while led by a mind that corrects itself.
const ALONE: (f32, f32) = (0.15, 1.0);
const LED: (f32, f32) = (0.3, 0.85);
/// Rise of the back up to which nothing is bent to turn, and from which all: a bend turns about the back, so one that leans
/// over or points up steeply would roll and somersault (choice; without, fishes leaned over for 5 to 13 % of a film).
const UPRIGHT: [f32; 2] = [0.3, 0.9];
/// Radians, and radians per time unit, within which a watched turn is done.
const ARRIVED: [f32; 2] = [0.08, 0.03];
/// Extra stroke per lack of speed.
const START: f32 = 2.0;
/// Time constants: of the stroke's changes, of heading, swing and rate of turning as they are felt, and of the average of
/// speed over a beat, time units.
const EASE: f32 = 0.8;
const HEADING: f32 = 1.0;
const SWING: f32 = 5.0;
const TURNING: f32 = 0.5;
const PACE: f32 = 2.0;

impl Default for Motor {
    fn default() -> Self {
        Self {
            command: Command::default(),
            feedback: true,
            phase: 0.0,
            frequency: 0.0,
            amplitudes: [0.0; 2],
            bend: 0.0,
            turn: None,
            rounding: false,
            fins: Fins::default(),
            to_turn: 0.0,
            swing: [0.0; 2],
            heading: 0.0,
            pace: 0.0,
            turning: 0.0,
            settled: false,
        }
    }
}

impl Motor {
    /// Begins a turn by this angle in radians, positive to the left. Done blindly it follows the steering map, angles beyond
    /// which are turned in equal parts, and ends a turn that goes on; watched it is added to what is still to be turned.
    pub fn begin_turn(&mut self, design: &FishDesign, angle: f32) {
        if self.feedback {
            self.to_turn += angle;
            self.rounding = true;
        } else {
            self.turn = Some(Turn::new(&design.turn, angle));
        }
    }

    /// Takes up a new command, once per tick.
    pub fn obey(&mut self, command: Command) {
        self.command = command;
        if let Some(steer) = command.steer {
            self.turn = None;
            self.rounding = false;
            self.to_turn = steer;
        }
    }

    /// Whether a turn still goes on.
    pub fn is_turning(&self) -> bool {
        self.turn.is_some() || self.rounding
    }

    /// By how much the beat turns the trunk from its heading now, radians.
    pub fn sway(&self) -> f32 {
        let [sine, cosine] = sine_cosine(self.phase * math::TAU);
        self.swing[0] * cosine + self.swing[1] * sine
    }

    /// Heading without the swing of the beat, radians.
    pub fn heading(&self) -> f32 {
        self.heading
    }

    /// Begins with this heading, radians.
    pub(super) fn face(&mut self, heading: f32) {
        self.heading = heading;
    }

    /// Beats at once as for this speed in body lengths per time unit, at this share of a beat.
    pub(crate) fn beat_at(&mut self, design: &FishDesign, speed: f32, phase: f32) {
        let stroke = design.swim.stroke(f64::from(speed));
        self.frequency = stroke.frequency as f32;
        self.amplitudes = stroke.amplitudes.map(|amplitude| amplitude as f32);
        self.phase = phase - phase.floor();
    }

    /// Goes on by `dt` time units.
    pub fn advance(&mut self, design: &FishDesign, feeling: &Feeling, dt: f32) -> Effort {
        self.feel(feeling, dt);
        let turning = self.turn_or_hold(design, feeling.frame.up.y, dt);
        self.beat(design, dt);
        let slow = (1.0 - self.pace / design.swim.cruise as f32).clamp(0.0, 1.0);
        let effort = [self.bend, slow];
        let fins = self.fins.advance(&design.fins, &self.command, (feeling, effort), dt);
        Effort { contraction: self.contraction(design, turning), fins }
    }

    fn feel(&mut self, feeling: &Feeling, dt: f32) {
        let yaw = feeling.frame.yaw();
        let pace = feeling.velocity.dot(feeling.frame.ahead);
        if !self.settled {
            (self.heading, self.pace, self.settled) = (yaw, pace, true);
        }
        // What repeats with the beat is no turn: it is learned and taken away before the heading is judged.
        let strange = wrapped(yaw - self.sway() - self.heading);
        let quiet = 1.0 - self.bend.abs();
        let learned = 2.0 * dt / SWING * strange * quiet;
        let [sine, cosine] = sine_cosine(self.phase * math::TAU);
        self.swing = [self.swing[0] + learned * cosine, self.swing[1] + learned * sine];
        let change = strange * dt / (HEADING + dt);
        self.heading = wrapped(self.heading + change);
        self.to_turn -= change;
        self.turning += (change / dt - self.turning) * dt / (TURNING + dt);
        self.pace += (pace - self.pace) * dt / (PACE + dt);
    }

    /// Sets the bend of one whose back points up by `rise` (1: upright); returns whether a turn-MC has the anterior swim
    /// segment.
    fn turn_or_hold(&mut self, design: &FishDesign, rise: f32, dt: f32) -> bool {
        if let Some(turn) = &mut self.turn {
            self.bend = turn.advance(&design.turn, self.bend, dt);
            if turn.is_done() {
                self.turn = None;
            }
            return true;
        }
        // Who swims faster turns faster with the same bend.
        let authority = (self.pace / design.swim.cruise as f32).max(1.0);
        // Who glides lets the muscles rest, unless told where to go.
        let led = self.command.speed > 0.0 || self.rounding || self.command.steer.is_some();
        let held = self.feedback && led;
        let lack = if held { self.to_turn - LOOKAHEAD * self.turning } else { 0.0 };
        let (small, deepest) = if self.rounding { ALONE } else { LED };
        let upright = (rise - UPRIGHT[0]) / (UPRIGHT[1] - UPRIGHT[0]);
        let deepest = deepest * upright.clamp(0.0, 1.0);
        let wanted = STEERING * lack * (lack.abs() / small).min(1.0) / authority;
        if self.to_turn.abs() < ARRIVED[0] && self.turning.abs() < ARRIVED[1] {
            self.rounding = false;
        }
        let change = design.turn.rate as f32 * dt;
        self.bend += (wanted.clamp(-deepest, deepest) - self.bend).clamp(-change, change);
        false
    }

    /// The oscillator of the swim-MC: one phase for both segments, so that their lag stays.
    fn beat(&mut self, design: &FishDesign, dt: f32) {
        let wanted = self.command.speed.max(0.0);
        let lack = if self.feedback && wanted > 0.0 { wanted - self.pace } else { 0.0 };
        let stroke = design.swim.stroke(f64::from((wanted + START * lack).max(0.3 * wanted)));
        let share = dt / (EASE + dt);
        self.frequency += (stroke.frequency as f32 - self.frequency) * share;
        for (amplitude, wanted) in self.amplitudes.iter_mut().zip(stroke.amplitudes) {
            *amplitude += (wanted as f32 - *amplitude) * share;
        }
        let phase = self.phase + self.frequency * dt;
        self.phase = phase - phase.floor();
    }

    /// Contractions of all muscles: the beat within what the bend leaves free.
    fn contraction(&self, design: &FishDesign, turning: bool) -> [f32; MUSCLES] {
        let lag = design.swim.lag as f32;
        let beats = [triangle(self.phase), triangle(self.phase - lag)];
        let quiet = if turning { 1.0 - self.bend.abs() } else { 1.0 };
        let segments = [
            (0.0, 0.0, self.bend),
            (self.amplitudes[0] * quiet, beats[0], self.bend),
            (self.amplitudes[1], beats[1], self.bend * design.turn.tail as f32),
        ];
        let mut contraction = [0.0; MUSCLES];
        for (segment, (amplitude, beat, bend)) in segments.into_iter().enumerate() {
            let free = amplitude * (1.0 - bend.abs());
            let left = bend.max(0.0) + free * (0.5 + 0.5 * beat);
            let right = (-bend).max(0.0) + free * (0.5 - 0.5 * beat);
            let muscles = &mut contraction[4 * segment..4 * segment + 4];
            muscles.copy_from_slice(&[left, left, right, right]);
        }
        contraction
    }
}

/// A triangle wave of period 1 between −1 and 1, rising through 0 at 0: muscles contract at an even rate.
fn triangle(phase: f32) -> f32 {
    let phase = phase - phase.floor();
    1.0 - (4.0 * (phase - 0.25 - (phase - 0.25 + 0.5).floor())).abs().min(2.0)
}

/// The parameters {r, s} of the source for an amplitude and a frequency: the lowest normalized length of a
/// muscle, and its change per step.
pub fn published_parameters(amplitude: f64, frequency: f64, step: f64) -> [f64; 2] {
    [1.0 - amplitude, 2.0 * amplitude * frequency * step]
}

/// Sine and cosine of a fin's angle.
pub(super) fn sine_cosine(angle: f32) -> [f32; 2] {
    [math::sin(angle), math::cos(angle)]
}
