use bioscope_core::{Random, Vec3, math};

/// The next whim of a wanderer: a unit vector in its own frame that strays from `whim` by a random
/// walk of `restlessness` radians per square root of a second, and back ahead (+Z) with the time
/// constant `return_time` in seconds. Steering for it gives a lively path without jitter.
pub fn wander(
    whim: Vec3,
    restlessness: f32,
    return_time: f32,
    dt: f32,
    random: &mut Random,
) -> Vec3 {
    let stray = Vec3::new(random.normal(), random.normal(), random.normal());
    let back = math::relaxation(dt, return_time);
    let next = whim + (Vec3::Z - whim) * back + stray * (restlessness * math::sqrt(dt));
    next.normalize_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use bioscope_core::Purpose;

    use super::*;

    #[test]
    fn whims_change_gradually_stray_to_all_sides_and_come_back() {
        let (mut whim, mut mean, mut widest) = (Vec3::Z, Vec3::ZERO, 1f32);
        let ticks = 20_000;
        for tick in 0..ticks {
            let mut random = Random::new(3, 1, tick, Purpose::new("wander"));
            let next = wander(whim, 0.5, 1.0, 1.0 / 60.0, &mut random);
            assert!(next.angle_between(whim) < 0.5 && (next.length() - 1.0).abs() < 1e-5);
            whim = next;
            mean += whim / ticks as f32;
            widest = widest.min(whim.z);
        }
        assert!(mean.x.abs() < 0.06 && mean.y.abs() < 0.06 && mean.z > 0.7, "{mean}");
        assert!(widest < 0.6, "{widest}");
    }
}
