use bioscope_core::{Impact, Vec3};

use super::Moving;

/// The request to pass beside an obstacle straight ahead: the part across `heading` (unit length)
/// of the way to the aim, 0 at a distance of `reach` growing to 1 at `turn_radius` (the tightest
/// turn at the present speed, v² / greatest acceleration) and nearer; lengths in metres.
pub fn steer_aside(heading: Vec3, impact: &Impact, reach: f32, turn_radius: f32) -> Vec3 {
    let across = impact.aim - heading * impact.aim.dot(heading);
    let room = (reach - turn_radius).max(f32::EPSILON);
    let urgency = ((reach - impact.distance) / room).clamp(0.0, 1.0);
    across.normalize_or_zero() * urgency
}

/// The request to let others pass on crossing courses. Of all `others` whose nearest approach lies
/// within `horizon` seconds and brings the centres within `clearance` metres (twice the radius),
/// the soonest is answered by an acceleration across the own velocity, away from where the other
/// will be then, the stronger the sooner.
pub fn give_way(mover: Moving, others: &[Moving], clearance: f32, horizon: f32) -> Vec3 {
    let soonest = others
        .iter()
        .filter_map(|other| approach(mover, *other, clearance, horizon))
        .min_by(|a, b| a.time.total_cmp(&b.time));
    let Some(Approach { time, offset }) = soonest else { return Vec3::ZERO };
    let ahead = mover.velocity.normalize_or(Vec3::Z);
    let across = -(offset - ahead * offset.dot(ahead));
    // Head-on neither side is nearer; both keep to their own left of the vertical plane.
    let aside =
        across.try_normalize().unwrap_or_else(|| Vec3::Y.cross(ahead).normalize_or(Vec3::X));
    aside * (1.0 - time / horizon)
}

struct Approach {
    /// Seconds until it.
    time: f32,
    /// From here to the other at that moment, metres.
    offset: Vec3,
}

/// τ = −(Δp · Δv) / |Δv|², if it is to come within the horizon and too near.
fn approach(mover: Moving, other: Moving, clearance: f32, horizon: f32) -> Option<Approach> {
    let between = other.position - mover.position;
    let relative = other.velocity - mover.velocity;
    let time = -between.dot(relative) / relative.length_squared();
    let offset = between + relative * time;
    let near = offset.length_squared() < clearance * clearance;
    (time > 0.0 && time < horizon && near).then_some(Approach { time, offset })
}

#[cfg(test)]
mod tests {
    use bioscope_core::{Purpose, Random};

    use super::*;
    use crate::{arbitration, steering};

    #[test]
    fn steering_aside_is_lateral_and_grows_from_reach_to_turn_radius() {
        let strength = |distance| {
            let impact = Impact { distance, aim: Vec3::new(2.0, 0.0, distance) };
            let request = steer_aside(Vec3::Z, &impact, 9.0, 3.0);
            assert!(request.y == 0.0 && request.z.abs() < 1e-6 && request.x >= 0.0);
            request.x
        };
        assert_eq!([9.0, 6.0, 3.0, 1.0].map(strength), [0.0, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn no_way_is_given_to_those_who_pass_clear_or_recede() {
        let mover = Moving { position: Vec3::ZERO, velocity: Vec3::Z };
        let clear = Moving { position: Vec3::new(3.0, 0.0, 5.0), velocity: -Vec3::Z };
        let behind = Moving { position: -Vec3::Z, velocity: Vec3::ZERO };
        let beside = Moving { position: Vec3::X * 0.5, velocity: Vec3::Z };
        assert_eq!(give_way(mover, &[clear, behind, beside], 1.0, 4.0), Vec3::ZERO);
    }

    /// Fifty walkers on a plane, half going east and half going north, through the same square.
    /// Returns the number of ticks in which two overlapped, summed over pairs.
    fn crossing(aware: bool) -> usize {
        const RADIUS: f32 = 0.3;
        let mut random = Random::new(5, 0, 0, Purpose::new("crossing"));
        let mut walkers: Vec<(Moving, Vec3)> = Vec::new();
        while walkers.len() < 50 {
            let (along, across) = (random.range(-40.0, -8.0), random.range(-8.0, 8.0));
            let east = walkers.len().is_multiple_of(2);
            let (position, heading) = if east {
                (Vec3::new(along, 0.0, across), Vec3::X)
            } else {
                (Vec3::new(across, 0.0, along), Vec3::Z)
            };
            if walkers.iter().all(|(other, _)| other.position.distance(position) > 1.5) {
                walkers.push((Moving { position, velocity: heading * 1.3 }, heading));
            }
        }
        let mut overlaps = 0;
        for _ in 0..1500 {
            let before: Vec<Moving> = walkers.iter().map(|(walker, _)| *walker).collect();
            for (index, (walker, heading)) in walkers.iter_mut().enumerate() {
                let near: Vec<Moving> = (0..before.len())
                    .filter(|&other| other != index)
                    .map(|other| before[other])
                    .filter(|other| other.position.distance(walker.position) < 8.0)
                    .collect();
                let way =
                    if aware { give_way(*walker, &near, 4.0 * RADIUS, 4.0) } else { Vec3::ZERO };
                let on = steering::seek(*walker, walker.position + *heading, 1.3);
                let on = arbitration::request(on, 3.0, 1.0);
                let request = arbitration::prioritized(&[way, on], 1.0).acceleration;
                walker.velocity = (walker.velocity + request * (3.0 / 30.0)).clamp_length_max(1.6);
                walker.velocity.y = 0.0;
                walker.position += walker.velocity / 30.0;
            }
            for (index, (one, _)) in walkers.iter().enumerate() {
                let close = |other: &&(Moving, Vec3)| {
                    other.0.position.distance(one.position) < 2.0 * RADIUS
                };
                overlaps += walkers[..index].iter().filter(close).count();
            }
        }
        overlaps
    }

    #[test]
    fn fifty_walkers_on_crossing_courses_never_overlap() {
        assert!(crossing(false) > 20, "blind walkers collide, so the course is a test");
        assert_eq!(crossing(true), 0);
    }
}
