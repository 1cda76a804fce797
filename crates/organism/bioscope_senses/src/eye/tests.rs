use std::sync::Arc;

use bioscope_core::{Percepts, Quat, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Batch, Material, Medium, Mesh, Projection, Scene, Sky, Sun, Transform};
use proptest::prelude::*;

use super::{Eye, EyeParameters, eye_camera};
use crate::{Memory, Outlook, Sense, Surroundings};

proptest! {
    #[test]
    fn the_eye_looks_where_the_body_looks(
        x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0, angle in -3f32..3.0
    ) {
        let axis = Vec3::new(x, y, z);
        prop_assume!(axis.length() > 0.1);
        let attitude = Quat::from_axis_angle(axis.normalize(), angle);
        let camera = eye_camera(&Transform::new(Vec3::X, attitude, 3.0), 0.5, 9.0);
        prop_assert!((camera.forward() - attitude * Vec3::Z).length() < 1e-5);
        prop_assert!((camera.rotation * Vec3::Y - attitude * Vec3::Y).length() < 1e-5);
        prop_assert!((camera.position - Vec3::X - camera.forward() * 0.22).length() < 1e-5);
        let Projection::Fisheye { field_of_view } = camera.projection else { panic!("a fish-eye") };
        prop_assert!(field_of_view <= 300f32.to_radians());
    }
}

/// A wall of two triangles ahead, in the light of a sky `light` times as bright.
fn wall(light: f32) -> Scene {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 4.0);
    let mesh = Mesh {
        positions: vec![corner(-9.0, -9.0), corner(9.0, -9.0), corner(0.0, 9.0)],
        normals: vec![Vec3::NEG_Z; 3],
        triangles: vec![[0, 2, 1]],
        ..Mesh::default()
    };
    let material = Material { two_sided: true, ..Material::default() };
    let mut batch = Batch::new("wall", "wall", Arc::new(mesh), Arc::new(material));
    batch.ids = vec![5];
    batch.transforms = vec![Transform::IDENTITY];
    let mut scene = Scene { batches: vec![batch], ..Scene::default() };
    scene.sun.color = scene.sun.color.map(|one| one * light);
    let brighter = |color: [f32; 3]| color.map(|one| one * light);
    let Sky { zenith, horizon, nadir } = Sky::default();
    scene.sky =
        Sky { zenith: brighter(zenith), horizon: brighter(horizon), nadir: brighter(nadir) };
    scene
}

fn noticed(scene: &Scene) -> Percepts {
    let (memory, medium) = (Memory::default(), Medium::default());
    let outlook = Outlook::new(scene, &memory);
    let surroundings = Surroundings {
        id: 1,
        position: Vec3::ZERO,
        attitude: Quat::IDENTITY,
        velocity: Vec3::ZERO,
        body_length: 0.5,
        home: Vec3::ZERO,
        outlook: &outlook,
        sounds: &[],
        influence: Influence::default(),
        obstacles: &crate::tests::OPEN,
        terrain: None,
        medium: &medium,
        sun: Sun::default(),
        temperature: 20.0,
        time: 0.0,
        dt: 1.0 / 60.0,
    };
    let mut percepts = Percepts::default();
    Eye::new(EyeParameters { width: 33.0, height: 17.0, ..EyeParameters::default() })
        .sense(&surroundings, &mut percepts)
        .unwrap();
    percepts
}

#[test]
fn the_retina_shows_whom_how_far_and_how_bright() {
    let percepts = noticed(&wall(1.0));
    let retina = percepts.retina.unwrap();
    assert_eq!((retina.width, retina.height, retina.color.len()), (33, 17, 33 * 17));
    let middle = 8 * 33 + 16;
    assert_eq!(retina.identity[middle], 5);
    assert!((retina.range[middle] - (4.0 - 0.22)).abs() < 0.05, "{}", retina.range[middle]);
    assert!(retina.range[0].is_infinite() && retina.identity[0] == 0, "outside the round view");
    let twice = noticed(&wall(2.0)).light;
    assert!((twice / percepts.light - 2.0).abs() < 0.01, "{twice} {}", percepts.light);
}
