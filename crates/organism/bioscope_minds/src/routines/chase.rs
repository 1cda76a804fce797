use std::f32::consts::FRAC_PI_6;

use bioscope_core::{Vec3, math};

use super::Command;
use crate::attention::{azimuth, elevation};
use crate::nature::Temper;

/// Rate of turning that a slow fish keeps up, radians per second (measured of the muscle-driven body: 2.1 and more).
const NIMBLE: f32 = 1.8;
/// Steepness of the way to a target, rise per level, from which it lies above or below rather than aside.
const OVERHEAD: f32 = 2.5;

/// A target that moves, and how to go for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chase {
    /// Where it is relative to what shall reach it (mouth or middle), own frame, metres.
    pub target: Vec3,
    /// How it moves through the water, own frame, metres per second.
    pub velocity: Vec3,
    /// Deviation that is swum through without a turn, `σ`, radians.
    pub tolerance: f32,
    /// How much farther to turn, per radian that the target moves on while being reached; 0 not to
    /// intercept.
    pub lead: f32,
    /// Distance at which to arrive at the target's own speed, metres; 0 to run into it.
    pub stop: f32,
}

/// Follows a target: the subroutine chasing-target (Tu 1996, 6.4.2; its figure is lost).
///
/// It turns by the whole deviation `E` where that exceeds the tolerance, else swims, faster when far; climbs
/// or dives by the target's elevation; brakes where it would overshoot. A hunter turns beyond a target that
/// moves away to the side it is on, by `lead` times the angle that it covers until it is reached, at most 30
/// degrees (choice). Nor does it circle what lies within the circle that it swims at its pace: it slows down, with
/// spread fins if need be, until its circle passes through the target. `own_speed` is through the water.
pub fn chase(chase: &Chase, length: f32, own_speed: f32, temper: &Temper) -> Command {
    let distance = chase.target.length();
    let cruise = temper.cruise_speed * length;
    // As fast as the target, and faster by half the gap per quarter second.
    let along = chase.velocity.dot(chase.target.normalize_or_zero()).max(0.0);
    let gap = (distance - chase.stop).max(0.0);
    let bearing = bearing(chase.target);
    // What moves may come into reach by itself.
    let circle = chase.velocity.length() + circling(chase.target);
    let tight = if bearing > chase.tolerance { circle } else { f32::INFINITY };
    let wanted = (along + 2.0 * gap).min(tight).min(temper.full_speed * length).max(0.15 * cruise);
    let mut command =
        Command { speed: wanted / length, pitch: elevation(chase.target), ..Command::default() };
    let deviation = deviation(chase.target);
    if deviation.abs() > chase.tolerance {
        command.turn = deviation + overshoot(chase, wanted) * deviation.signum();
        // A target behind is turned to before it is swum after.
        command.speed *= if deviation.abs() > 1.2 { 0.6 } else { 1.0 };
    }
    let braking = 0.5 * own_speed * own_speed / length;
    let overshoots = chase.stop > 0.0 && gap < braking;
    if own_speed > wanted + 0.3 * length && (overshoots || own_speed > tight) {
        command.brake = ((own_speed - wanted) / cruise.max(1e-3)).min(1.0);
    }
    command
}

/// Angle between straight ahead and a place, radians.
fn bearing(place: Vec3) -> f32 {
    math::atan2(math::sqrt(place.x * place.x + place.y * place.y), place.z)
}

/// By what it is to be turned to a place: not at all to one straight above or below.
fn deviation(place: Vec3) -> f32 {
    let level = math::sqrt(place.x * place.x + place.z * place.z);
    if place.y.abs() > OVERHEAD * level { 0.0 } else { azimuth(place) }
}

/// The speed, metres per second, at which the circle through a place, tangent to the way ahead, is swum at the rate of
/// turning that is possible; for what is behind, that at which half a circle leads to it.
fn circling(place: Vec3) -> f32 {
    let sine = if place.z > 0.0 { math::sin(bearing(place)) } else { 1.0 };
    NIMBLE * place.length() / (2.0 * sine.max(1e-3))
}

/// How far beyond a target that moves away aside to turn, radians, swimming at this speed in metres per second.
fn overshoot(chase: &Chase, speed: f32) -> f32 {
    let distance = chase.target.length().max(1e-3);
    let left = Vec3::Y.cross(chase.target.with_y(0.0).normalize_or(Vec3::Z));
    let aside = chase.velocity.dot(left);
    let moved = (aside * (distance / speed.max(1e-3)) / distance).abs();
    let away = aside * azimuth(chase.target) > 0.0;
    if away { (chase.lead * moved).min(FRAC_PI_6) } else { 0.0 }
}
