use std::f32::consts::FRAC_PI_6;

use bioscope_core::Vec3;

use super::Command;
use crate::attention::{azimuth, elevation};
use crate::nature::Temper;

/// A target that moves, and how to go for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chase {
    /// Where it is relative to what shall reach it (mouth or middle), own frame, metres.
    pub target: Vec3,
    /// How it moves, own frame, metres per second.
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
/// degrees (choice).
pub fn chase(chase: &Chase, length: f32, own_speed: f32, temper: &Temper) -> Command {
    let distance = chase.target.length();
    let deviation = azimuth(chase.target);
    let full = temper.full_speed * length;
    let gap = (distance - chase.stop).max(0.0);
    // As fast as the target, and faster by half the gap per quarter second.
    let along = chase.velocity.dot(chase.target.normalize_or_zero());
    let wanted = (along.max(0.0) + 2.0 * gap).min(full).max(0.15 * temper.cruise_speed * length);
    let mut command =
        Command { speed: wanted / length, pitch: elevation(chase.target), ..Command::default() };
    if deviation.abs() > chase.tolerance {
        let level = chase.target.with_y(0.0).normalize_or(Vec3::Z);
        let left = Vec3::Y.cross(level);
        let aside = chase.velocity.dot(left);
        let reach_time = distance / wanted.max(1e-3);
        let moved = (aside * reach_time / distance.max(1e-3)).abs();
        let away = aside * deviation > 0.0;
        let beyond = if away { (chase.lead * moved).min(FRAC_PI_6) } else { 0.0 };
        command.turn = deviation + beyond * deviation.signum();
        // A target behind is turned to before it is swum after.
        command.speed *= if deviation.abs() > 1.2 { 0.6 } else { 1.0 };
    }
    let braking = 0.5 * own_speed * own_speed / length;
    if chase.stop > 0.0 && own_speed > wanted + 0.3 * length && gap < braking {
        command.brake = ((own_speed - wanted) / (temper.cruise_speed * length).max(1e-3)).min(1.0);
    }
    command
}
