//! A reef-like scene to measure with: ground, skinned fishes and plants, rocks, motes and bubbles.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use bioscope_core::{Purpose, Quat, Random, Vec3};
use bioscope_geometry::{
    Batch, Joint, Material, Medium, Mesh, Points, Scene, Skin, Sun, Terrain, Texture, Transform,
};

const PLACE: Purpose = Purpose::new("place");

/// The scene at a time in seconds.
pub fn scene(time: f64) -> Scene {
    let ground = ground();
    let mut scene = Scene { time, ..Scene::default() };
    scene.sun = Sun { direction: Vec3::new(0.35, 0.85, -0.4).normalize(), color: [4.2, 4.0, 3.6] };
    scene.medium = Medium {
        surface: Some(0.0),
        absorption: [0.32, 0.07, 0.03],
        scattering: [0.03; 3],
        glow: [0.015, 0.14, 0.27],
        caustics: 1.0,
        caustic_scale: 0.5,
        shafts: 0.8,
    };
    let sand = Material { color: [0.8, 0.72, 0.55], texture: Some(grain()), ..Material::default() };
    let mut seabed = Batch::new("seabed", "sand", Arc::new(ground.mesh(1.5)), Arc::new(sand));
    seabed.ids.push(1);
    seabed.transforms.push(Transform::IDENTITY);
    scene.batches.push(seabed);
    let mut id = 2;
    rocks(&mut scene, &ground, &mut id);
    plants(&mut scene, &ground, &mut id, time as f32);
    fishes(&mut scene, &mut id, time as f32);
    motes(&mut scene, &mut id);
    scene
}

fn ground() -> Terrain {
    let height = |column: usize, row: usize| {
        let (x, z) = (column as f32 * 0.3, row as f32 * 0.3);
        let waves =
            0.8 * (x * 0.35).sin() * (z * 0.27 + 1.0).cos() + 0.25 * (x * 0.9 + z * 0.6).sin();
        -6.0 + waves + 0.03 * (x * 5.0 + (z * 1.3).sin()).sin() + ((z - 24.0) / 14.0).powi(2) * 0.8
    };
    let heights = (0..160 * 160).map(|index| height(index % 160, index / 160));
    Terrain::new([-24.0, -24.0], 0.3, 160, heights.collect()).expect("a good grid")
}

fn grain() -> Arc<Texture> {
    let mut random = Random::new(5, 0, 0, PLACE);
    let pixels = (0..256 * 256).map(|_| {
        let gray = random.range(190.0, 255.0) as u8;
        [gray, gray, gray, 255]
    });
    Arc::new(Texture::new(256, 256, pixels.collect()))
}

/// A closed tube of rings of `sides` vertices; `ring` gives center and radii along x and y at a share
/// of the length.
fn tube(rings: usize, sides: usize, ring: impl Fn(f32) -> (Vec3, [f32; 2])) -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..rings {
        let along = step as f32 / (rings - 1) as f32;
        let (center, [wide, high]) = ring(along);
        for side in 0..=sides {
            let share = side as f32 / sides as f32;
            let (sine, cosine) = (share % 1.0 * TAU).sin_cos();
            mesh.positions.push(center + Vec3::new(sine * wide, cosine * high, 0.0));
            mesh.uvs.push([along, (share * 2.0 - 1.0).abs()]);
        }
    }
    let stride = sides as u32 + 1;
    for step in 0..rings as u32 - 1 {
        for side in 0..sides as u32 {
            let a = step * stride + side;
            let b = a + stride;
            mesh.triangles.extend([[a, a + 1, b], [a + 1, b + 1, b]]);
        }
    }
    mesh.compute_normals();
    mesh
}

fn joints(names: usize, place: impl Fn(usize) -> Vec3) -> Vec<Joint> {
    let parent = |joint: usize| joint.checked_sub(1).map(|parent| parent as u8);
    (0..names)
        .map(|joint| Joint {
            name: format!("j{joint}"),
            parent: parent(joint),
            rest: Transform::at(place(joint)),
        })
        .collect()
}

/// Binds each vertex to the two joints next to it; `along` is in joints.
fn bind(mesh: &mut Mesh, joints: Vec<Joint>, along: impl Fn(Vec3) -> f32) {
    let last = joints.len() - 1;
    let place = |&point: &Vec3| along(point).clamp(0.0, last as f32 - 1e-3);
    let places: Vec<f32> = mesh.positions.iter().map(place).collect();
    let indices = places.iter().map(|&place| [place as u8, place as u8 + 1, 0, 0]).collect();
    let weights =
        places.iter().map(|&place| [1.0 - place.fract(), place.fract(), 0.0, 0.0]).collect();
    mesh.skin = Some(Skin { joints, indices, weights });
}

fn rocks(scene: &mut Scene, ground: &Terrain, id: &mut u32) {
    for kind in 0..6 {
        let detail = 12 + kind * 4;
        let mut random = Random::new(11, kind as u32, 0, PLACE);
        let bumps: Vec<_> =
            (0..10).map(|_| (random.direction(), random.range(-0.2, 0.35))).collect();
        let mut mesh = tube(detail, detail + 6, |along| {
            let polar = along * PI;
            (Vec3::new(0.0, 0.0, polar.cos()), [polar.sin(); 2])
        });
        for point in &mut mesh.positions {
            let push = |sum: f32, (way, size): &(Vec3, f32)| {
                sum + size * (point.dot(*way) * 4.0).sin() * 0.35
            };
            *point *= bumps.iter().fold(1.0, push);
        }
        mesh.compute_normals();
        let warm = [[0.35, 0.3, 0.25], [0.5, 0.2, 0.25], [0.45, 0.35, 0.15]][kind % 3];
        let stone = Material { color: warm, texture: Some(grain()), ..Material::default() };
        let mut batch = Batch::new(
            format!("rock/{kind}"),
            "rock",
            Arc::new(mesh.with_levels()),
            Arc::new(stone),
        );
        for _ in 0..10 {
            let (x, z) = (random.range(-14.0, 14.0), random.range(-16.0, 12.0));
            let turn = Quat::from_axis_angle(random.direction(), random.range(0.0, 3.0));
            let base = Vec3::new(x, ground.height(x, z), z);
            batch.transforms.push(Transform::new(base, turn, random.range(0.25, 0.9)));
            batch.ids.push(*id);
            *id += 1;
        }
        scene.batches.push(batch);
    }
}

fn plants(scene: &mut Scene, ground: &Terrain, id: &mut u32, time: f32) {
    const JOINTS: usize = 8;
    let green = Material {
        color: [0.25, 0.4, 0.08],
        translucency: 0.5,
        roughness: 0.45,
        two_sided: true,
        ..Material::default()
    };
    let green = Arc::new(green);
    for kind in 0..10 {
        let mut random = Random::new(13, kind, 0, PLACE);
        let mut mesh = tube(24, 6, |along| (Vec3::new(0.0, 0.0, along * 2.0), [0.015; 2]));
        mesh.uvs.clear();
        for blade in 0..42 {
            let height = 0.15 + 1.8 * blade as f32 / 42.0;
            let turn = Quat::from_axis_angle(Vec3::Z, blade as f32 * 2.4)
                * Quat::from_axis_angle(Vec3::X, random.range(-0.9, -0.3));
            let mut leaf = Mesh::default();
            for step in 0..11 {
                let along = step as f32 / 10.0;
                let width = 0.05 * (along * PI * 0.95 + 0.1).sin();
                for side in [-1.0, 0.0, 1.0] {
                    let lift = 0.02 * (along * 9.0).sin() - 0.12 * along * along;
                    leaf.positions.push(Vec3::new(
                        side * width,
                        along * 0.45,
                        lift + 0.012 * side * side,
                    ));
                }
            }
            for step in 0..10 {
                let a = step * 3;
                leaf.triangles.extend([[a, a + 1, a + 3], [a + 1, a + 4, a + 3]]);
                leaf.triangles.extend([[a + 1, a + 2, a + 4], [a + 2, a + 5, a + 4]]);
            }
            leaf.compute_normals();
            mesh.append(
                &leaf,
                &Transform::new(Vec3::new(0.0, 0.0, height), turn, random.range(0.7, 1.2)),
            );
        }
        bind(&mut mesh, joints(JOINTS, |joint| Vec3::Z * joint as f32 * 0.28), |point| {
            point.z / 0.28
        });
        let mut batch =
            Batch::new(format!("kelp/{kind}"), "kelp", Arc::new(mesh.with_levels()), green.clone());
        batch.alive = true;
        for _ in 0..10 {
            let (x, z) = (random.range(-12.0, 12.0), random.range(-14.0, 10.0));
            let upright =
                Quat::from_rotation_x(-PI / 2.0) * Quat::from_rotation_z(random.range(0.0, TAU));
            let base = Vec3::new(x, ground.height(x, z), z);
            batch.transforms.push(Transform::new(base, upright, random.range(0.5, 1.3)));
            batch.ids.push(*id);
            *id += 1;
            sway(
                &mut batch.poses,
                JOINTS,
                |joint| 0.06 * joint.sqrt() * (time * 0.9 + x * 0.4 + joint * 0.5).sin() + 0.03,
                Vec3::Z * 0.28,
                Vec3::X,
            );
        }
        scene.batches.push(batch);
    }
}

/// Poses of a chain of joints `step` apart, each turned by an angle about `axis` against the one before.
fn sway(
    poses: &mut Vec<Transform>,
    count: usize,
    angle: impl Fn(f32) -> f32,
    step: Vec3,
    axis: Vec3,
) {
    let mut pose = Transform::IDENTITY;
    for joint in 0..count {
        if joint > 0 {
            let turn = Quat::from_axis_angle(axis, angle(joint as f32));
            pose = pose.compose(&Transform::new(step, turn, 1.0));
        }
        poses.push(pose);
    }
}

fn fish_skin() -> Arc<Texture> {
    let pixel = |x: f32, y: f32| {
        let belly = ((y - 0.35) * 3.0).clamp(0.0, 1.0);
        let stripe = if (x * 14.0).sin() > 0.55 && x > 0.2 && x < 0.85 { 0.35 } else { 1.0 };
        let eye = (x - 0.1).hypot((y - 0.4) * 0.45);
        let base = [60.0 + 180.0 * belly, 95.0 + 145.0 * belly, 130.0 + 105.0 * belly];
        let [red, green, blue] = match eye {
            ..0.014 => [5.0; 3],
            ..0.026 => [235.0, 225.0, 150.0],
            _ => [base[0] * stripe + 40.0 * (1.0 - stripe), base[1] * stripe, base[2] * stripe],
        };
        [red as u8, green as u8, blue as u8, 255]
    };
    let pixels = (0..256 * 128)
        .map(|index| pixel((index % 256) as f32 / 256.0, (index / 256) as f32 / 128.0));
    Arc::new(Texture::new(256, 128, pixels.collect()))
}

fn fishes(scene: &mut Scene, id: &mut u32, time: f32) {
    const JOINTS: usize = 6;
    let profile = |along: f32| (along.powf(0.55) * (1.0 - along).powf(0.8) * 1.9).max(0.004);
    let mut mesh = tube(18, 10, |along| {
        let radius = 0.22 * profile(along * 0.95);
        let tail = ((along - 0.82) / 0.18).max(0.0) * 0.14;
        (
            Vec3::new(0.0, 0.0, 0.5 - along),
            [(radius * 0.45 * (1.0 - along * 0.6)).max(0.002), radius + tail],
        )
    });
    bind(&mut mesh, joints(JOINTS, |joint| Vec3::Z * (0.5 - joint as f32 * 0.2)), |point| {
        (0.5 - point.z) * 5.0
    });
    let scales = Material {
        texture: Some(fish_skin()),
        color: [1.0; 3],
        specular: 0.3,
        roughness: 0.35,
        ..Material::default()
    };
    let mut batch =
        Batch::new("anchovy", "anchovy", Arc::new(mesh.with_levels()), Arc::new(scales));
    batch.alive = true;
    let mut random = Random::new(17, 0, 0, PLACE);
    for _ in 0..300 {
        let offset = random.in_ball() * Vec3::new(5.0, 1.3, 4.0);
        let heading = Quat::from_rotation_y(1.9 + random.range(-0.35, 0.35) - offset.x * 0.12);
        let place = Vec3::new(0.5, -3.2, -4.0) + offset;
        batch.transforms.push(Transform::new(place, heading, random.range(0.2, 0.3)));
        batch.ids.push(*id);
        batch.tints.push([random.range(0.9, 1.1), random.range(0.9, 1.1), random.range(0.85, 1.1)]);
        *id += 1;
        let phase = random.range(0.0, TAU) + time * 9.0;
        let start = Transform::at(Vec3::Z * 0.5);
        let first = batch.poses.len();
        let bend = |joint: f32| 0.09 * joint * 0.5 * (phase - joint * 1.1).sin();
        sway(&mut batch.poses, JOINTS, bend, Vec3::Z * -0.2, Vec3::Y);
        for pose in &mut batch.poses[first..] {
            *pose = start.compose(pose);
        }
    }
    scene.batches.push(batch);
}

fn motes(scene: &mut Scene, id: &mut u32) {
    for (name, radius, glassy) in [("plankton", 0.002, false), ("bubble", 0.012, true)] {
        let count = if glassy { 200 } else { 1800 };
        let mut random = Random::new(19, u32::from(glassy), 0, PLACE);
        let place = |_| {
            Vec3::new(random.range(-8.0, 8.0), random.range(-6.0, -0.5), random.range(-10.0, 6.0))
        };
        scene.points.push(Points {
            name: name.into(),
            species: name.into(),
            ids: (0..count).map(|index| *id + index).collect(),
            positions: (0..count).map(place).collect(),
            radii: vec![radius; count as usize],
            color: [0.9, 0.95, 0.9],
            opacity: 0.8,
            glassy,
        });
        *id += count;
    }
}
