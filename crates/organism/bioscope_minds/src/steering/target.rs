use bioscope_core::Vec3;

use super::Moving;

/// Towards `target` (metres) at full speed (`maximum_speed` in m/s).
pub fn seek(mover: Moving, target: Vec3, maximum_speed: f32) -> Vec3 {
    (target - mover.position).normalize_or_zero() * maximum_speed - mover.velocity
}

/// Away from `target` at full speed, if it is nearer than `panic_radius` metres; else nothing.
pub fn flee(mover: Moving, target: Vec3, maximum_speed: f32, panic_radius: f32) -> Vec3 {
    let away = mover.position - target;
    if away.length_squared() >= panic_radius * panic_radius {
        return Vec3::ZERO;
    }
    away.normalize_or(Vec3::Y) * maximum_speed - mover.velocity
}

/// Towards the point where `quarry` will be when it can be reached.
pub fn pursue(mover: Moving, quarry: Moving, maximum_speed: f32) -> Vec3 {
    seek(mover, predicted(mover, quarry, maximum_speed), maximum_speed)
}

/// Away from the point where `hunter` will be when it can arrive here, if it is nearer than
/// `panic_radius` metres now; else nothing.
pub fn evade(mover: Moving, hunter: Moving, maximum_speed: f32, panic_radius: f32) -> Vec3 {
    if mover.position.distance_squared(hunter.position) >= panic_radius * panic_radius {
        return Vec3::ZERO;
    }
    flee(mover, predicted(mover, hunter, maximum_speed), maximum_speed, f32::INFINITY)
}

/// Where `other` will be after T = c · distance / maximum speed. The factor c runs from 0.5 (it
/// comes head-on: soon met) over 1 (it crosses) to 2 (it runs away: a long chase).
fn predicted(mover: Moving, other: Moving, maximum_speed: f32) -> Vec3 {
    let between = other.position - mover.position;
    let receding = between.normalize_or_zero().dot(other.velocity.normalize_or_zero());
    let factor = if receding > 0.0 { 1.0 + receding } else { 1.0 + 0.5 * receding };
    other.position + other.velocity * (factor * between.length() / maximum_speed)
}

/// Towards `target`, slowing down within `slowing_radius` metres so as to stop there.
pub fn arrive(mover: Moving, target: Vec3, maximum_speed: f32, slowing_radius: f32) -> Vec3 {
    let way = target - mover.position;
    let speed = maximum_speed * (way.length() / slowing_radius).min(1.0);
    way.normalize_or_zero() * speed - mover.velocity
}

/// The acceleration (m/s²) that, solved anew every step, brings the mover to the place of `goal`
/// with the velocity of `goal` in `remaining` seconds: a = 6 (p₁ − p) / T² − (4 v + 2 v₁) / T.
pub fn rendezvous(mover: Moving, goal: Moving, remaining: f32) -> Vec3 {
    let time = remaining.max(1e-3);
    (goal.position - mover.position) * (6.0 / (time * time))
        - (4.0 * mover.velocity + 2.0 * goal.velocity) / time
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arbitration::request;

    const SPEED: f32 = 2.0;
    const DT: f32 = 0.02;

    fn step(mover: &mut Moving, wish: Vec3) {
        mover.velocity += request(wish, 4.0, 1.0) * 4.0 * DT;
        mover.velocity = mover.velocity.clamp_length_max(SPEED);
        mover.position += mover.velocity * DT;
    }

    fn start() -> Moving {
        Moving { position: Vec3::ZERO, velocity: Vec3::new(-1.0, 0.5, 0.0) }
    }

    #[test]
    fn seeking_nears_and_fleeing_leaves_steadily_after_turning_in() {
        let target = Vec3::new(8.0, 1.0, -3.0);
        let (mut seeker, mut fugitive) = (start(), start());
        let mut last = (f32::INFINITY, 0.0);
        for tick in 0..200 {
            let wish = seek(seeker, target, SPEED);
            step(&mut seeker, wish);
            let wish = flee(fugitive, target, SPEED, 100.0);
            step(&mut fugitive, wish);
            let now = (seeker.position.distance(target), fugitive.position.distance(target));
            if tick > 60 {
                assert!(now.0 < last.0 && now.1 > last.1, "tick {tick}: {now:?} after {last:?}");
            }
            last = now;
        }
        assert_eq!(flee(start(), target, SPEED, 5.0), Vec3::ZERO);
    }

    #[test]
    fn pursuit_intercepts_a_crossing_quarry_sooner_than_seeking() {
        let catch = |wish: fn(Moving, Moving, f32) -> Vec3| {
            let mut hunter = start();
            let velocity = Vec3::new(0.0, 0.0, 1.4);
            let mut quarry = Moving { position: Vec3::new(10.0, 0.0, -6.0), velocity };
            (0..2000).find(|_| {
                quarry.position += quarry.velocity * DT;
                let wish = wish(hunter, quarry, SPEED);
                step(&mut hunter, wish);
                hunter.position.distance(quarry.position) < 0.2
            })
        };
        let pursuing = catch(pursue).expect("pursuit catches");
        let seeking = catch(|hunter, quarry, speed| seek(hunter, quarry.position, speed));
        assert!(seeking.is_none_or(|ticks| pursuing + 10 < ticks), "{pursuing} {seeking:?}");
    }

    #[test]
    fn evasion_leaves_the_line_of_a_charge_better_than_fleeing() {
        let hunter = Moving { position: Vec3::new(0.0, 0.0, -4.0), velocity: Vec3::Z * 3.0 };
        let mover = Moving { position: Vec3::X * 0.5, velocity: Vec3::ZERO };
        let aside = |wish: Vec3| wish.normalize().x;
        let (evading, fleeing) =
            (evade(mover, hunter, SPEED, 9.0), flee(mover, hunter.position, SPEED, 9.0));
        assert!(aside(evading) > aside(fleeing) + 0.1, "{evading} {fleeing}");
        assert_eq!(evade(mover, hunter, SPEED, 3.0), Vec3::ZERO);
    }

    #[test]
    fn arrival_stops_at_the_target() {
        let target = Vec3::new(5.0, -2.0, 3.0);
        let mut mover = start();
        for _ in 0..1000 {
            let wish = arrive(mover, target, SPEED, 2.0);
            step(&mut mover, wish);
        }
        assert!(mover.position.distance(target) < 0.01 && mover.velocity.length() < 0.01);
    }

    #[test]
    fn a_rendezvous_is_kept_in_place_velocity_and_time() {
        let goal =
            Moving { position: Vec3::new(4.0, 2.0, 6.0), velocity: Vec3::new(0.0, 1.0, -1.0) };
        let mut mover = start();
        let (dt, ticks) = (0.002, 1500);
        for tick in 0..ticks {
            let acceleration = rendezvous(mover, goal, (ticks - tick) as f32 * dt);
            mover.position += mover.velocity * dt + acceleration * (0.5 * dt * dt);
            mover.velocity += acceleration * dt;
        }
        assert!(mover.position.distance(goal.position) < 0.01, "{mover:?}");
        assert!(mover.velocity.distance(goal.velocity) < 0.05, "{mover:?}");
    }
}
