use bioscope_core::Vec3;

use super::{Moving, seek};

/// Along the polyline `path` (metres) in the order of its points, no farther from it than `radius`
/// metres: if the place `foresight` seconds ahead is farther off, or leads backwards, seeks the
/// point of the path that lies that far on; else nothing. Also nothing for fewer than two points.
pub fn follow_path(
    mover: Moving,
    path: &[Vec3],
    radius: f32,
    foresight: f32,
    maximum_speed: f32,
) -> Vec3 {
    if path.len() < 2 {
        return Vec3::ZERO;
    }
    let predicted = mover.position + mover.velocity * foresight;
    let (_, here) = nearest_on(path, mover.position);
    let (there, along) = nearest_on(path, predicted);
    let onward = maximum_speed * foresight;
    let within = predicted.distance_squared(there) <= radius * radius;
    if within && along > here + 0.1 * onward {
        return Vec3::ZERO;
    }
    seek(mover, point_at(path, here + onward), maximum_speed)
}

/// Along a wall at `offset` metres from it. `wall` is the point of the wall nearest to the place
/// `foresight` seconds ahead, `normal` its unit normal there, towards the free side.
pub fn follow_wall(
    mover: Moving,
    (wall, normal): (Vec3, Vec3),
    offset: f32,
    foresight: f32,
    maximum_speed: f32,
) -> Vec3 {
    let along = mover.velocity - normal * mover.velocity.dot(normal);
    let onward = along.normalize_or_zero() * (maximum_speed * foresight);
    let here = mover.position + onward;
    let level = here + normal * (offset - (here - wall).dot(normal));
    seek(mover, level, maximum_speed)
}

/// The point of a polyline nearest to a place, and its distance along the line from the start.
fn nearest_on(path: &[Vec3], place: Vec3) -> (Vec3, f32) {
    let (mut best, mut length) = ((f32::INFINITY, path[0], 0.0), 0.0);
    for pair in path.windows(2) {
        let way = pair[1] - pair[0];
        let share = (place - pair[0]).dot(way) / way.length_squared().max(1e-12);
        let share = share.clamp(0.0, 1.0);
        let point = pair[0] + way * share;
        let square = point.distance_squared(place);
        if square < best.0 {
            best = (square, point, length + share * way.length());
        }
        length += way.length();
    }
    (best.1, best.2)
}

/// The point at a distance along a polyline, continued straight beyond its end.
fn point_at(path: &[Vec3], distance: f32) -> Vec3 {
    let mut left = distance;
    for (index, pair) in path.windows(2).enumerate() {
        let length = pair[0].distance(pair[1]);
        let last = index + 2 == path.len();
        if left <= length || last {
            return pair[0] + (pair[1] - pair[0]).normalize_or_zero() * left;
        }
        left -= length;
    }
    path[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arbitration::request;

    const SPEED: f32 = 1.5;
    const DT: f32 = 0.02;

    fn step(mover: &mut Moving, wish: Vec3) {
        mover.velocity += request(wish, 6.0, 1.0) * 6.0 * DT;
        mover.velocity = mover.velocity.clamp_length_max(SPEED);
        mover.position += mover.velocity * DT;
    }

    #[test]
    fn a_path_with_corners_is_followed_to_its_end_within_the_radius() {
        let path =
            [Vec3::ZERO, Vec3::X * 10.0, Vec3::new(14.0, 0.0, 8.0), Vec3::new(4.0, 3.0, 14.0)];
        let mut mover = Moving { position: Vec3::new(0.0, 0.0, 0.2), velocity: Vec3::Z };
        let (mut ticks, mut last) = (0, 0.0);
        while last < 29.0 && ticks < 3000 {
            let wish = follow_path(mover, &path, 0.5, 0.5, SPEED);
            step(&mut mover, wish);
            let (nearest, along) = nearest_on(&path, mover.position);
            assert!(mover.position.distance(nearest) < 0.8, "{mover:?} at tick {ticks}");
            assert!(along > last - 0.3, "goes back at tick {ticks}");
            (last, ticks) = (along, ticks + 1);
        }
        assert!(last >= 29.0 && ticks < 2000, "{last} m after {ticks} ticks");
        assert_eq!(follow_path(mover, &path[..1], 0.5, 0.5, SPEED), Vec3::ZERO);
    }

    #[test]
    fn a_round_wall_is_followed_at_its_distance() {
        let (radius, offset) = (8.0, 1.0);
        let mut mover = Moving { position: Vec3::X * 12.0, velocity: Vec3::new(-1.0, 0.0, 1.0) };
        for tick in 0..2000 {
            let predicted = mover.position + mover.velocity * 0.4;
            let normal = predicted.normalize();
            let wish = follow_wall(mover, (normal * radius, normal), offset, 0.4, SPEED);
            step(&mut mover, wish);
            if tick > 500 {
                let distance = mover.position.length() - radius;
                assert!((distance - offset).abs() < 0.3, "{distance} m at tick {tick}");
                assert!(mover.velocity.length() > 0.8 * SPEED, "stops at tick {tick}");
            }
        }
    }
}
