use bioscope_core::Vec3;
use bioscope_world::Environment;

/// The way out of ground, solids and surface for a ball of `radius` metres at `position`; zero where it
/// touches nothing. Animals steer clear by themselves; this is what the world does if they fail.
pub(crate) fn way_out(position: Vec3, radius: f32, environment: &Environment) -> Vec3 {
    let mut out = position;
    let solids = &environment.obstacles;
    let mut near = solids.within(position - radius, position + radius);
    if near.any(|solid| radius - solid.distance(position) > 0.0) {
        // Out of one solid the way may lead into another one.
        for solid in solids.iter() {
            let depth = radius - solid.distance(out);
            if depth > 0.0 {
                out += solid.outward(out) * depth;
            }
        }
    }
    if let Some(surface) = environment.medium.surface {
        // Only those who live below it are kept below it.
        if position.y < surface + radius {
            out.y = out.y.min(surface - radius);
        }
    }
    if let Some(terrain) = &environment.terrain {
        out.y = out.y.max(terrain.height(out.x, out.z) + radius);
    }
    out - position
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bioscope_geometry::{Obstacle, Terrain};

    use super::*;

    #[test]
    fn the_way_out_of_rock_ground_and_water_is_as_long_as_need_be() {
        let mut environment = Environment::default();
        environment.fill_with_water(0.0);
        let ground = Terrain::new([-10.0; 2], 20.0, 2, vec![-5.0; 4]).unwrap();
        environment.terrain = Some(Arc::new(ground));
        let center = Vec3::new(0.0, -2.0, 0.0);
        environment.obstacles.edit().push(Obstacle::Sphere { center, radius: 1.0 });
        let out = |x: f32, y: f32| way_out(Vec3::new(x, y, 0.0), 0.2, &environment);
        assert_eq!(out(4.0, -3.0), Vec3::ZERO);
        assert!((out(0.9, -2.0) - Vec3::X * 0.3).length() < 1e-3);
        assert!((out(4.0, -4.9) - Vec3::Y * 0.1).length() < 1e-5);
        assert!((out(4.0, 0.1) - Vec3::Y * -0.3).length() < 1e-5);
        assert_eq!(out(4.0, 3.0), Vec3::ZERO, "birds stay in the air");
    }
}
