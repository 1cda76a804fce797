//! The shapes of line, hook and bait. The origin is the bend of the hook, where a fish hangs.

use std::sync::Arc;

use bioscope_core::{Vec3, math};
use bioscope_geometry::{Mesh, Transform};

use crate::scenery::tube;

/// Height of the hook's eye over its bend, metres.
const SHANK: f32 = 0.05;
/// Radius of the bend, metres.
const BEND: f32 = 0.014;
/// Radius of the wire, metres.
const WIRE: f32 = 0.0018;
/// Length of the line over the hook, metres: out of the water at any depth.
const LENGTH: f32 = 60.0;
/// Length of the bait, metres.
const BAIT: f32 = 0.05;

/// Line and hook: a cord of this thickness (metres) that ends in a bent wire with a barb.
pub(super) fn line_and_hook(thickness: f32) -> Arc<Mesh> {
    let cord = tube(&[Vec3::Y * SHANK, Vec3::Y * (SHANK + LENGTH)], &[0.5 * thickness; 2], 6, 1.0);
    let mut path = vec![Vec3::new(0.0, SHANK, 0.0), Vec3::new(0.0, BEND, 0.0)];
    const STEPS: usize = 10;
    path.extend((1..=STEPS).map(|step| {
        let angle = math::PI * (1.0 + step as f32 / STEPS as f32);
        Vec3::new(BEND * (1.0 + math::cos(angle)), BEND * (1.0 + math::sin(angle)), 0.0)
    }));
    path.push(Vec3::new(2.0 * BEND, 1.9 * BEND, 0.0));
    let mut radii = vec![WIRE; path.len() - 1];
    radii.push(0.2 * WIRE);
    let hook = tube(&path, &radii, 8, 1.0);
    let barb = tube(
        &[Vec3::new(2.0 * BEND, 1.8 * BEND, 0.0), Vec3::new(1.6 * BEND, 1.3 * BEND, 0.0)],
        &[0.7 * WIRE, 0.2 * WIRE],
        6,
        1.0,
    );
    let mut mesh = Mesh::default();
    for (part, tone) in [(&cord, [0.75, 0.8, 0.72]), (&hook, [0.42; 3]), (&barb, [0.42; 3])] {
        let mut part = part.clone();
        part.colors = vec![tone; part.positions.len()];
        mesh.append(&part, &Transform::IDENTITY);
    }
    Arc::new(mesh)
}

/// The bait: a curled worm on the bend.
pub(super) fn bait() -> Arc<Mesh> {
    const STEPS: usize = 8;
    let along = |step: usize| step as f32 / STEPS as f32;
    let path: Vec<Vec3> = (0..=STEPS)
        .map(|step| {
            let angle = math::PI * (0.8 + 1.6 * along(step));
            let reach = BAIT / math::PI;
            Vec3::new(
                reach * math::cos(angle) + BEND,
                reach * math::sin(angle),
                0.004 * along(step),
            )
        })
        .collect();
    let radii: Vec<f32> =
        (0..=STEPS).map(|step| 0.0062 * math::sin(0.3 + 2.6 * along(step))).collect();
    Arc::new(tube(&path, &radii, 8, 1.0))
}
