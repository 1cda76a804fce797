//! Laws of the whole: what is seen agrees with exact rays, light with its law, and nothing depends on
//! threads.

use std::f32::consts::PI;
use std::sync::Arc;

use bioscope_core::{Quat, Vec3};
use proptest::prelude::*;

use super::{Options, Rasterizer, View, prepare};
use crate::{
    Batch, Camera, Joint, Material, Mesh, Points, Projection, Scene, Skin, Terrain, Texture,
    Transform,
};

/// Cameras of both kinds at one place.
pub(super) fn lenses(position: Vec3, target: Vec3) -> [Camera; 3] {
    let camera = Camera::looking_at(position, target, 1.1);
    let round = |degrees: f32| Camera {
        projection: Projection::Fisheye { field_of_view: degrees.to_radians() },
        ..camera
    };
    [camera, round(170.0), round(300.0)]
}

pub(super) fn eyes_and_pictures() -> [Options; 2] {
    [Options::eye(), Options::picture()]
}

/// A unit ball of this many rows.
fn ball(rows: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let columns = rows * 2;
    for row in 0..=rows {
        for column in 0..columns {
            let polar = row as f32 / rows as f32 * PI;
            let azimuth = column as f32 / columns as f32 * 2.0 * PI;
            let ring = if row % rows == 0 { 0.0 } else { polar.sin() };
            let point = Vec3::new(ring * azimuth.sin(), polar.cos(), ring * azimuth.cos());
            mesh.positions.push(point);
            mesh.uvs.push([column as f32 / columns as f32, row as f32 / rows as f32]);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let corner = |down: usize, aside: usize| {
                ((row + down) * columns + (column + aside) % columns) as u32
            };
            mesh.triangles.push([corner(0, 0), corner(1, 0), corner(0, 1)]);
            mesh.triangles.push([corner(0, 1), corner(1, 0), corner(1, 1)]);
        }
    }
    mesh.normals = mesh.positions.clone();
    mesh
}

/// A square in the plane z = 0 that faces +z.
fn square(half: f32) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x * half, y * half, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|[x, y]| [0.5 + 0.5 * x, 0.5 - 0.5 * y]).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

fn batch(mesh: Mesh, material: Material, places: &[(u32, Transform)]) -> Batch {
    let mut batch = Batch::new("thing", "thing", Arc::new(mesh), Arc::new(material));
    for &(id, transform) in places {
        batch.ids.push(id);
        batch.transforms.push(transform);
    }
    batch
}

fn scene(batches: Vec<Batch>) -> Scene {
    Scene { batches, ..Scene::default() }
}

fn water(scene: &mut Scene) {
    scene.medium.surface = Some(0.0);
    scene.medium.absorption = [0.32, 0.07, 0.03];
    scene.medium.scattering = [0.03; 3];
    scene.medium.glow = [0.02, 0.15, 0.3];
}

/// Some balls and points in rippling water.
pub(super) fn ball_scene() -> Scene {
    let texture =
        Texture::new(4, 4, (0..16).map(|index| [index * 16, 200, 90, 255 - index]).collect());
    let material =
        Material { texture: Some(Arc::new(texture)), specular: 0.3, ..Material::default() };
    let places: Vec<_> = (0..12)
        .map(|index| {
            let place = Vec3::new(
                (index % 4) as f32 - 1.5,
                -2.0 - (index / 4) as f32 * 0.7,
                -(index as f32) * 0.3,
            );
            (index + 1, Transform::new(place, Quat::IDENTITY, 0.45))
        })
        .collect();
    let mut scene = scene(vec![batch(ball(14), material, &places)]);
    water(&mut scene);
    scene.medium.caustics = 1.0;
    scene.medium.shafts = 1.0;
    scene.points.push(Points {
        name: "bubbles".into(),
        species: "bubble".into(),
        ids: (100..120).collect(),
        positions: (0..20).map(|index| Vec3::new(index as f32 * 0.1 - 1.0, -1.5, 1.0)).collect(),
        radii: vec![0.03; 20],
        color: [1.0; 3],
        opacity: 0.9,
        glassy: true,
    });
    scene
}

/// The exact ray of a pixel, worked out from the definition of the projections.
fn exact_ray(camera: &Camera, size: [usize; 2], column: usize, row: usize) -> Option<Vec3> {
    let x = column as f32 + 0.5 - size[0] as f32 / 2.0;
    let y = size[1] as f32 / 2.0 - row as f32 - 0.5;
    let ray = match camera.projection {
        Projection::Perspective { field_of_view } => {
            Vec3::new(x, y, -(size[1] as f32 / 2.0) / (field_of_view / 2.0).tan()).normalize()
        }
        Projection::Fisheye { field_of_view } => {
            let turn = x.hypot(y) / (size[0].min(size[1]) as f32 / 2.0) * field_of_view / 2.0;
            if turn > field_of_view / 2.0 {
                return None;
            }
            let around = y.atan2(x);
            Vec3::new(turn.sin() * around.cos(), turn.sin() * around.sin(), -turn.cos())
        }
    };
    Some(camera.rotation * ray)
}

/// Distance to a ball along a ray, and by how much the ray clears or cuts it.
fn meet(center: Vec3, radius: f32, eye: Vec3, ray: Vec3) -> (Option<f32>, f32) {
    let along = (center - eye).dot(ray);
    let miss = (center - eye - ray * along).length();
    let hit =
        (miss < radius && along > 0.0).then(|| along - (radius * radius - miss * miss).sqrt());
    (hit, (miss - radius).abs())
}

#[test]
fn depth_and_identity_agree_with_rays_cast_at_balls_and_a_plane() {
    let balls = [
        (7, Vec3::new(0.0, 0.2, -3.0), 0.8),
        (9, Vec3::new(1.1, 0.0, -4.0), 0.7),
        (4, Vec3::new(-1.0, 1.0, 2.0), 0.6),
    ];
    let places =
        balls.map(|(id, center, radius)| (id, Transform::new(center, Quat::IDENTITY, radius)));
    let flat = Transform::new(Vec3::Y * -1.0, Quat::from_rotation_x(-PI / 2.0), 1.0);
    let scene = scene(vec![
        batch(ball(44), Material::default(), &places),
        batch(square(50.0), Material::default(), &[(2, flat)]),
    ]);
    let prepared = prepare(&scene, &Options { detail: 4.0, ..Options::eye() });
    for camera in lenses(Vec3::new(0.1, 0.0, 0.2), Vec3::new(0.2, -0.1, -3.0)) {
        let size = [72, 60];
        let view = prepared.look(&camera, size[0], size[1]);
        let mut compared = 0;
        for index in 0..size[0] * size[1] {
            let Some(ray) = exact_ray(&camera, size, index % size[0], index / size[0]) else {
                assert_eq!((view.identity[index], view.depth[index]), (0, f32::INFINITY));
                continue;
            };
            let floor = (-1.0 - camera.position.y) / ray.y;
            let mut nearest = if floor > 0.0 { (floor, 2) } else { (f32::INFINITY, 0) };
            let mut doubtful = ray.y.abs() < 0.03;
            for (id, center, radius) in balls {
                let (hit, clearance) = meet(center, radius, camera.position, ray);
                doubtful |= clearance < 0.03;
                if let Some(distance) = hit.filter(|&distance| distance < nearest.0) {
                    nearest = (distance, id);
                }
            }
            if doubtful {
                continue;
            }
            compared += 1;
            assert_eq!(view.identity[index], nearest.1, "{camera:?} pixel {index}");
            let same = view.depth[index] == nearest.0
                || (view.depth[index] / nearest.0 - 1.0).abs() < 0.006;
            assert!(same, "{} {} at {index}", view.depth[index], nearest.0);
        }
        assert!(compared > 2000, "{compared}");
    }
}

#[test]
fn nearer_things_cover_exactly_their_share() {
    let near = (5, Transform::new(Vec3::new(-0.5, 0.0, -2.0), Quat::IDENTITY, 0.5));
    let far = (6, Transform::new(Vec3::new(0.0, 0.0, -4.0), Quat::IDENTITY, 2.0));
    for places in [[near, far], [far, near]] {
        let scene = scene(vec![batch(square(1.0), Material::default(), &places)]);
        let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, PI / 2.0);
        let view = prepare(&scene, &Options::eye()).look(&camera, 64, 64);
        let count = |id: u32| view.identity.iter().filter(|&&seen| seen == id).count();
        // The far square covers half of the picture's sides, the near one the left half's middle.
        assert_eq!((count(5), count(6), count(0)), (16 * 16, 32 * 32 - 16 * 16, 64 * 64 - 32 * 32));
    }
}

#[test]
fn no_light_comes_through_between_triangles() {
    let mut room = ball(12);
    room.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let scene = scene(vec![batch(room, Material::default(), &[(3, Transform::IDENTITY)])]);
    for options in eyes_and_pictures() {
        let prepared = prepare(&scene, &options);
        for step in 0..12 {
            let turn = step as f32 * 0.7;
            let place = Vec3::new(turn.sin(), turn.cos(), (turn * 2.0).sin()) * 0.5;
            for camera in lenses(place, place + Vec3::new(turn.cos(), 0.3, turn.sin())) {
                let view = prepared.look(&camera, 48, 48);
                for index in 0..48 * 48 {
                    let seen = exact_ray(&camera, [48, 48], index % 48, index / 48).is_some();
                    let rim = options.smooth
                        && camera.projection != lenses(Vec3::ZERO, Vec3::X)[0].projection;
                    assert!(
                        !seen || rim || view.identity[index] == 3,
                        "a gap at {index} from {place}"
                    );
                }
            }
        }
    }
}

#[test]
fn ground_in_tiles_shows_no_gaps_between_levels() {
    let height =
        |index: usize| ((index % 100) as f32 * 0.2).sin() * ((index / 100) as f32 * 0.17).cos();
    let ground = Terrain::new([-25.0, -25.0], 0.5, 100, (0..10_000).map(height).collect())
        .unwrap()
        .mesh(1.0);
    assert!(ground.triangles.len() > 8192, "large enough for tiles");
    let mut rasterizer = Rasterizer::default();
    let scene = scene(vec![batch(ground, Material::default(), &[(8, Transform::IDENTITY)])]);
    let prepared = rasterizer.prepare(&scene, &Options::eye());
    for step in 0..6 {
        let place = Vec3::new(step as f32 * 2.0 - 5.0, 2.0 + step as f32, 1.0);
        let camera = Camera::looking_at(place, place + Vec3::new(0.1, -1.0, 0.3), 1.0);
        let view = prepared.look(&camera, 96, 96);
        assert!(view.identity.iter().all(|&id| id == 8), "a gap from {place}");
        let below = view.depth[48 * 96 + 48];
        assert!((below - place.y).abs() < 1.6, "{below} above ground at {place}");
    }
}

#[test]
fn a_plate_in_water_fades_by_the_law_of_absorption() {
    let mut scene = scene(vec![]);
    water(&mut scene);
    scene.sun.direction = Vec3::Y;
    let look = |distance: f32, scene: &mut Scene| {
        let place = Transform::at(Vec3::new(0.0, -4.0, -distance));
        scene.batches = vec![batch(
            square(20.0),
            Material { specular: 0.0, roughness: 1.0, ..Material::default() },
            &[(1, place)],
        )];
        let camera = Camera::looking_at(Vec3::new(0.0, -4.0, 0.0), Vec3::new(0.0, -4.0, -1.0), 0.2);
        let view = prepare(scene, &Options::eye()).look(&camera, 9, 9);
        view.color[4 * 9 + 4]
    };
    let near = look(0.05, &mut scene);
    for distance in [1.0, 3.0, 10.0] {
        let seen = look(distance, &mut scene);
        for channel in 0..3 {
            let absorption = scene.medium.absorption[channel];
            let extinction = absorption + scene.medium.scattering[channel];
            let glow = scene.medium.glow[channel] * (-absorption * 4.0).exp();
            let own = (near[channel] - glow * (1.0 - (-extinction * 0.05).exp()))
                / (-extinction * 0.05).exp();
            let expected = own * (-extinction * distance).exp()
                + glow * (1.0 - (-extinction * distance).exp());
            assert!(
                (seen[channel] / expected - 1.0).abs() < 1e-3,
                "{} {expected} at {distance} m",
                seen[channel]
            );
        }
    }
}

#[test]
fn water_is_brighter_above_than_below_and_darker_in_the_deep() {
    let mut scene = scene(vec![]);
    water(&mut scene);
    let prepared = prepare(&scene, &Options::eye());
    let blue = |height: f32, way: Vec3| {
        let eye = Vec3::Y * height;
        prepared.look(&Camera::looking_at(eye, eye + way, 0.3), 3, 3).color[4][2]
    };
    let [up, level, down] = [1.0, 0.0, -1.0].map(|rise| blue(-3.0, Vec3::new(0.0, rise, -0.9)));
    assert!(up > level && level > down, "{up} {level} {down}");
    assert!(blue(-30.0, Vec3::NEG_Z) < 0.5 * level);
    // The window to the sky is 97 degrees wide: bright inside, dark outside.
    let [inside, outside] = [40.0f32, 62.0].map(|degrees| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        blue(-1.0, Vec3::new(-sine, cosine, 0.0))
    });
    assert!(inside > 1.3 * outside, "{inside} {outside}");
}

/// A bar along z with two joints, bound smoothly.
fn jointed() -> Mesh {
    let mut mesh = ball(10);
    let weights =
        mesh.positions.iter().map(|point| [0.5 + 0.5 * point.z, 0.5 - 0.5 * point.z, 0.0, 0.0]);
    let rest = |z: f32| Transform::new(Vec3::Z * z, Quat::from_rotation_y(0.4), 1.0);
    let joint = |name: &str, z: f32| Joint { name: name.into(), parent: None, rest: rest(z) };
    mesh.skin = Some(Skin {
        joints: vec![joint("front", 0.5), joint("back", -0.5)],
        indices: vec![[0, 1, 0, 0]; mesh.positions.len()],
        weights: weights.collect(),
    });
    mesh
}

#[test]
fn joints_at_rest_change_nothing_and_moved_joints_move_the_skin() {
    let place = Transform::new(Vec3::new(0.0, 0.0, -3.0), Quat::from_rotation_x(0.3), 0.7);
    let mesh = jointed();
    let rest: Vec<_> =
        mesh.skin.iter().flat_map(|skin| skin.joints.iter().map(|joint| joint.rest)).collect();
    let mut posed = batch(mesh, Material::default(), &[(1, place)]);
    let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.0);
    let look =
        |batch: &Batch| prepare(&scene(vec![batch.clone()]), &Options::eye()).look(&camera, 64, 64);
    let rigid = look(&posed);
    posed.poses = rest.clone();
    let resting = look(&posed);
    assert_eq!(rigid.identity, resting.identity);
    for (a, b) in rigid.depth.iter().zip(&resting.depth) {
        assert!(a == b || (a - b).abs() < 1e-4, "{a} {b}");
    }
    let aside = Transform::at(Vec3::X * 0.8);
    posed.poses = rest.iter().map(|pose| aside.compose(pose)).collect();
    let moved = look(&posed);
    let column = |view: &View| {
        let columns =
            (0..64 * 64).filter(|&index| view.identity[index] == 1).map(|index| index % 64);
        let (sum, count) = columns.fold((0, 0), |(sum, count), column| (sum + column, count + 1));
        sum as f32 / count as f32
    };
    let expected = 0.8 * 0.7 * 32.0 / 0.5f32.tan() / 3.0;
    assert!((column(&moved) - column(&rigid) - expected).abs() < 1.0, "{expected}");
}

#[test]
fn things_stand_in_each_others_sunlight() {
    let floor = Transform::new(Vec3::ZERO, Quat::from_rotation_x(-PI / 2.0), 1.0);
    let balls = [(2, Transform::new(Vec3::Y * 2.0, Quat::IDENTITY, 0.5))];
    let mut scene = scene(vec![
        batch(square(6.0), Material::default(), &[(1, floor)]),
        batch(ball(20), Material::default(), &balls),
    ]);
    scene.sun.direction = Vec3::new(1.0, 2.0, 0.0).normalize();
    let camera = Camera::looking_at(Vec3::new(0.0, 5.0, 6.0), Vec3::ZERO, 0.6);
    let brightness = |options: &Options, place: Vec3| {
        let view =
            prepare(&scene, options).look(&Camera::looking_at(camera.position, place, 0.05), 3, 3);
        assert_eq!(view.identity[4], 1);
        view.color[4].iter().sum::<f32>()
    };
    let shaded = Vec3::new(-1.0, 0.0, 0.0);
    let [lit, dark] =
        [Vec3::new(1.5, 0.0, 0.0), shaded].map(|place| brightness(&Options::picture(), place));
    assert!(dark < 0.6 * lit, "{dark} {lit}");
    let without = brightness(&Options { shadows: false, ..Options::picture() }, shaded);
    assert!((without / lit - 1.0).abs() < 0.05, "{without} {lit}");
}

#[test]
fn small_points_fade_but_stay() {
    let mut scene = ball_scene();
    scene.batches.clear();
    scene.points[0].glassy = false;
    scene.points[0].positions = vec![Vec3::new(0.0, -2.0, 0.0)];
    let empty = Scene { points: vec![], ..scene.clone() };
    let trace = |scene: &Scene, distance: f32| {
        let eye = Vec3::new(0.0, -2.0, distance);
        let view = prepare(scene, &Options::eye()).look(
            &Camera::looking_at(eye, eye - Vec3::Z, 0.6),
            33,
            33,
        );
        let sum = view.color.iter().flatten().sum::<f32>();
        (sum, view.identity.iter().filter(|&&id| id == 100).count())
    };
    let strengths = [0.5, 1.5, 4.0].map(|distance| {
        let ((with, _), (without, _)) = (trace(&scene, distance), trace(&empty, distance));
        (with - without).abs()
    });
    assert!(strengths.is_sorted_by(|a, b| a > b) && strengths[2] > 0.0, "{strengths:?}");
    assert!(trace(&scene, 0.3).1 > 4);
    assert_eq!(trace(&scene, 4.0).1, 0);
}

#[test]
fn holes_in_a_texture_show_what_is_behind() {
    let pixels =
        (0..64).map(|index| [255, 255, 255, if index % 8 < 4 { 255 } else { 0 }]).collect();
    let leaf = Material {
        texture: Some(Arc::new(Texture::new(8, 8, pixels))),
        cutout: true,
        ..Material::default()
    };
    let scene = scene(vec![
        batch(square(1.0), leaf, &[(1, Transform::at(Vec3::Z * -2.0))]),
        batch(square(4.0), Material::default(), &[(2, Transform::at(Vec3::Z * -3.0))]),
    ]);
    let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 2.0 * (0.5f32).atan());
    let view = prepare(&scene, &Options::eye()).look(&camera, 32, 32);
    for (index, &id) in view.identity.iter().enumerate() {
        assert_eq!(id, if index % 32 < 16 { 1 } else { 2 }, "pixel {index}");
    }
}

#[test]
fn backs_show_only_on_two_sided_materials() {
    let turned = Transform::new(Vec3::Z * -2.0, Quat::from_rotation_y(PI), 1.0);
    for two_sided in [false, true] {
        let scene = scene(vec![batch(
            square(5.0),
            Material { two_sided, ..Material::default() },
            &[(1, turned)],
        )]);
        for camera in lenses(Vec3::ZERO, Vec3::NEG_Z) {
            let view = prepare(&scene, &Options::eye()).look(&camera, 9, 9);
            assert_eq!(view.identity[40], u32::from(two_sided));
        }
    }
}

#[test]
fn results_do_not_depend_on_threads_or_on_what_was_prepared_before() {
    let scene = ball_scene();
    let cameras = lenses(Vec3::new(0.3, -2.0, 3.0), Vec3::new(0.0, -2.2, 0.0));
    let all = |threads: usize, options: &Options| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut rasterizer = Rasterizer::default();
            rasterizer.prepare(&scene, options);
            let prepared = rasterizer.prepare(&scene, options);
            let mut views = prepared.look_many(&cameras, 64, 64);
            views.push(prepared.look(&cameras[0], 200, 150));
            views
        })
    };
    for options in eyes_and_pictures() {
        let one = all(1, &options);
        assert_eq!(one, all(2, &options));
        assert_eq!(one[0], prepare(&scene, &options).look(&cameras[0], 64, 64));
    }
}

#[test]
fn empty_pictures_and_scenes_are_no_trouble() {
    let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.0);
    for options in eyes_and_pictures() {
        let prepared = prepare(&Scene::default(), &options);
        assert!(prepared.look(&camera, 0, 0).color.is_empty());
        assert!(prepared.look(&camera, 0, 7).color.is_empty());
        assert_eq!(prepared.look(&camera, 5, 3).depth, [f32::INFINITY; 15]);
        assert!(prepared.look_many(&[], 8, 8).is_empty());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn nothing_panics_and_light_stays_finite(
        corners in prop::collection::vec(prop::array::uniform3(-3f32..3.0), 3..20),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..24), 0..30),
        place in prop::array::uniform3(-3f32..3.0), turn in prop::array::uniform4(-1f32..1.0),
        angle in 0f32..7.0, wide: bool, smooth: bool, in_water: bool, near in -1f32..2.0, broken in 0usize..8,
    ) {
        let mut positions: Vec<Vec3> = corners.into_iter().map(Vec3::from).collect();
        match broken {
            0 => positions[0] = Vec3::NAN,
            1 => positions[1].x = f32::INFINITY,
            2 => positions[1] = positions[0],
            _ => {}
        }
        let mesh = Mesh { positions, triangles, ..Mesh::default() };
        let mut scene = scene(vec![batch(mesh, Material { two_sided: wide, ..Material::default() }, &[(1, Transform::IDENTITY)])]);
        if in_water {
            water(&mut scene);
        }
        let projection = if wide { Projection::Fisheye { field_of_view: angle } } else { Projection::Perspective { field_of_view: angle } };
        let camera = Camera { position: place.into(), rotation: Quat::from_array(turn), projection, near, far: 50.0 };
        let options = if smooth { Options { shadows: false, ..Options::picture() } } else { Options::eye() };
        let view = prepare(&scene, &options).look(&camera, 24, 17);
        for (color, &depth) in view.color.iter().zip(&view.depth) {
            prop_assert!(color.iter().all(|channel| channel.is_finite() && *channel >= 0.0), "{color:?}");
            prop_assert!(depth > 0.0);
        }
        prop_assert_eq!(view.developed(1.0).len(), 24 * 17 * 3);
    }
}
