use bioscope_core::Vec3;
use bioscope_core::math::{PI, TAU};
use serde::{Deserialize, Serialize};

use super::motor::{Command, Feeling, sine_cosine};
use super::tables::FinSettings;

/// Angle of a fin whose edge is to the water.
const NEUTRAL: f32 = 0.5 * PI;
/// Bend from which the inner fin helps to turn.
const SHARP: f32 = 0.3;
/// By how much a fin is turned at most to climb, dive or balance.
const GREATEST: f32 = 0.25 * PI;

/// The pectoral fins: massless planes at an angle γ between their normal and the way ahead. π/2 is edge-on, 3π/4
/// lifts, π/4 sinks, π brakes (Tu, "Artificial Animals for Computer Animation", section 4.3.2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fins {
    /// Angles of the left and of the right fin, radians.
    pub angles: [f32; 2],
    /// Phase of their visible beat, radians.
    pub beat: f32,
    /// How far they beat, 0 (folded) to 1.
    pub spread: f32,
    pitch: f32,
    roll: f32,
    settled: bool,
}

impl Default for Fins {
    fn default() -> Self {
        let angles = [NEUTRAL; 2];
        Self { angles, beat: 0.0, spread: 0.0, pitch: 0.0, roll: 0.0, settled: false }
    }
}

impl Fins {
    /// Sets the fins as commanded and as pitch, roll and bend of the body ask for, and returns the force of the left and
    /// of the right one. With the bend comes how `slow` the fish is, 0 (cruises) to 1 (stands): the slow row with both against
    /// each other to turn, and beat them up and down to rise, dive and keep upright.
    pub(super) fn advance(
        &mut self,
        settings: &FinSettings,
        command: &Command,
        (feeling, [bend, slow]): (&Feeling, [f32; 2]),
        dt: f32,
    ) -> [Vec3; 2] {
        let oars = bend * slow;
        let (pitch, roll) = (feeling.frame.pitch(), feeling.frame.roll());
        let rates = if self.settled {
            [(pitch - self.pitch) / dt, (roll - self.roll) / dt]
        } else {
            [0.0; 2]
        };
        (self.pitch, self.roll, self.settled) = (pitch, roll, true);
        let effort = |[error, rate]: [f64; 2], from: f32, by: f32| {
            (error as f32 * from - rate as f32 * by).clamp(-1.0, 1.0) * GREATEST
        };
        let lift = effort(settings.pitch, command.climb - pitch, rates[0]);
        let lift = match command.climb {
            climb if climb > 0.0 => lift.max(0.0),
            climb if climb < 0.0 => lift.min(0.0),
            _ => lift,
        };
        let lean = -effort(settings.roll, -roll, rates[1]);
        let oar = settings.oar as f32 * slow;
        let trim = [lift * oar, lean * oar.max(settings.righting as f32)].map(|one| one / GREATEST);
        let brake = command.brake.clamp(0.0, 1.0);
        self.angles = [-lean, lean].map(|lean| {
            // To keep upright goes before climbing.
            let lift = lift * (1.0 - lean.abs() / GREATEST);
            let angle = NEUTRAL + lift + lean;
            angle + (PI - angle) * brake
        });
        self.stroke(command, oars, dt);
        let row = self.row(settings, command, feeling);
        let couple = feeling.frame.ahead * (settings.oar as f32 * oars);
        let area = settings.area as f32;
        let [left, right] = self.angles.map(|angle| force(area, angle, feeling) + row * 0.5);
        // Who hardly moves has no lift: it beats the fins down or up instead.
        let [left, right] = [left, right].map(|one| one + feeling.frame.up * trim[0]);
        let roll = feeling.frame.up * trim[1];
        let [left, right] = [left - roll, right + roll];
        // In a sharp turn the inner one is held against the water.
        let drag = force(area * settings.yaw as f32, PI, feeling);
        let [inner_left, inner_right] =
            [bend, -bend].map(|inner| ((inner - SHARP) / (1.0 - SHARP)).max(0.0));
        [left - couple + drag * inner_left, right + couple + drag * inner_right]
    }

    /// Rowing against the way ahead, harder the more speed backward lacks.
    fn row(&self, settings: &FinSettings, command: &Command, feeling: &Feeling) -> Vec3 {
        if command.backward <= 0.0 {
            return Vec3::ZERO;
        }
        let speed = -feeling.velocity.dot(feeling.frame.ahead);
        let lack = ((command.backward - speed) / command.backward).clamp(0.0, 1.0);
        -feeling.frame.ahead * (settings.oar as f32 * lack)
    }

    /// The beat that is seen: the more a fin is turned from edge-on the wider and faster, and never none.
    fn stroke(&mut self, command: &Command, oars: f32, dt: f32) {
        let turned = self.angles.map(|angle| (angle - NEUTRAL).abs() / GREATEST);
        let rowing = if command.backward > 0.0 { 1.0 } else { oars.abs() };
        let idle = if command.speed > 0.0 { 0.1 } else { 0.5 };
        let wanted = turned[0].max(turned[1]).max(rowing).max(idle).min(1.0);
        self.spread += (wanted - self.spread) * dt / (1.0 + dt);
        let beat = self.beat / TAU + (0.1 + 0.15 * self.spread) * dt;
        self.beat = (beat - beat.floor()) * TAU;
    }
}

/// −A |v| (n·v) n with n = cos γ ahead + sin γ up.
fn force(area: f32, angle: f32, feeling: &Feeling) -> Vec3 {
    let [sine, cosine] = sine_cosine(angle);
    let normal = feeling.frame.ahead * cosine + feeling.frame.up * sine;
    let speed = bioscope_core::math::sqrt(feeling.velocity.length_squared());
    normal * (-area * speed * normal.dot(feeling.velocity))
}
