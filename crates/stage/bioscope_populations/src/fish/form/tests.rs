use std::collections::BTreeMap;

use bioscope_geometry::Transform;
use bioscope_motion::undulation::{SwimState, spine_pose};
use proptest::prelude::*;

use super::*;

fn bodies() -> impl Iterator<Item = (Arc<FishSpecies>, Body)> {
    FishSpecies::names().into_iter().map(|name| {
        let species = FishSpecies::named(name).unwrap(); // the library knows its own names
        let body = Body::new(&species);
        (species, body)
    })
}

fn levels(mesh: &Mesh) -> Vec<&Mesh> {
    std::iter::once(mesh).chain(mesh.levels.iter().map(|(_, level)| &**level)).collect()
}

fn level(species: &FishSpecies, number: usize) -> Level {
    match species.detail {
        Detail::Plain => PLAIN[number],
        Detail::Fine => FINE[number],
    }
}

/// Six times the volume: positive if the triangles face outward.
fn volume(mesh: &Mesh) -> f32 {
    mesh.triangles
        .iter()
        .map(|one| {
            let [a, b, c] = one.map(|index| mesh.positions[index as usize]);
            a.dot(b.cross(c))
        })
        .sum()
}

/// How often each directed edge occurs, vertices at the same point being one.
fn edges(mesh: &Mesh) -> BTreeMap<[[u32; 3]; 2], usize> {
    let point =
        |index: u32| mesh.positions[index as usize].to_array().map(|one| (one + 0.0).to_bits());
    let mut edges = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if point(from) != point(to) {
                *edges.entry([point(from), point(to)]).or_insert(0) += 1;
            }
        }
    }
    edges
}

#[test]
fn every_trunk_is_watertight_and_faces_outward() {
    for (species, body) in bodies() {
        for number in 0..4 {
            let mesh = trunk_mesh(&body.trunk, body.atlas.trunk, level(&species, number));
            let edges = edges(&mesh);
            for ([from, to], count) in &edges {
                assert_eq!((*count, edges.get(&[*to, *from])), (1, Some(&1)), "{}", species.name);
            }
            assert!(volume(&mesh) > 0.0, "{}", species.name);
            for (point, normal) in mesh.positions.iter().zip(&mesh.normals) {
                assert!(normal.x * point.x >= -1e-4, "{}: {point} {normal}", species.name);
            }
        }
    }
}

#[test]
fn eyes_face_outward() {
    for (species, body) in bodies() {
        let eye = eye_mesh(&species.eye, &body.trunk, body.atlas.eye, 12);
        assert!(eye.normals.iter().all(|normal| normal.x > 0.0), "{}", species.name);
        let (normal, _) = body.trunk.frame(species.eye.place);
        let bulge = (eye.positions[eye.positions.len() - 1] - body.trunk.point(species.eye.place))
            .dot(normal);
        assert!((bulge / (species.eye.bulge * species.eye.radius) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn meshes_are_whole_and_have_the_joints_of_the_spine() {
    for (species, body) in bodies() {
        let mesh = body.meshes(&species);
        let counts: Vec<usize> = levels(&mesh).iter().map(|one| one.triangles.len()).collect();
        let [low, high] = if species.detail == Detail::Plain { [500, 900] } else { [2000, 3500] };
        assert!((low..=high).contains(&counts[0]), "{}: {counts:?}", species.name);
        assert!(
            counts.windows(2).all(|two| 2 * two[1] <= two[0] + 60),
            "{}: {counts:?}",
            species.name
        );
        assert!(mesh.levels.windows(2).all(|two| two[0].0 > two[1].0), "finest first");
        for one in levels(&mesh) {
            whole(one, &body.spine);
        }
        let (low, high) = mesh.bounds();
        let long = high.z - low.z;
        assert!((long / species.length - 1.0).abs() < 0.03, "{}: {long} m", species.name);
    }
}

fn whole(mesh: &Mesh, spine: &Spine) {
    let count = mesh.positions.len();
    assert_eq!((mesh.normals.len(), mesh.uvs.len()), (count, count));
    assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < count));
    assert!(mesh.positions.iter().all(|point| point.is_finite()));
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    assert!(mesh.uvs.iter().flatten().all(|part| (0.0..=1.0).contains(part)));
    let skin = mesh.skin.as_ref().expect("a fish bends");
    assert_eq!(
        (skin.joints.len(), skin.indices.len(), skin.weights.len()),
        (spine.joint_count(), count, count)
    );
    assert!(skin.weights.iter().all(|weights| (weights.iter().sum::<f32>() - 1.0).abs() < 1e-5));
    assert!(skin.indices.iter().flatten().all(|&joint| usize::from(joint) < skin.joints.len()));
}

#[test]
fn bending_hardly_stretches_the_skin() {
    for (species, body) in bodies() {
        let mesh = body.meshes(&species);
        let swim = SwimState { phase: 1.0, amplitude: 1.0, bend: [0.3, 0.3], ..Default::default() };
        let bent = posed(&mesh, &body.spine, &swim);
        let ridge = |points: &[Vec3]| -> f32 {
            let Level { rings, sides, .. } = level(&species, 0);
            (1..rings)
                .map(|ring| points[2 * sides * ring].distance(points[2 * sides * (ring - 1)]))
                .sum()
        };
        let stretch = ridge(&bent) / ridge(&mesh.positions);
        assert!((stretch - 1.0).abs() < 0.02, "{}: {stretch}", species.name);
    }
}

/// The skin of a mesh in the pose of `swim`.
fn posed(mesh: &Mesh, spine: &Spine, swim: &SwimState) -> Vec<Vec3> {
    let skin = mesh.skin.as_ref().expect("a fish bends");
    let mut poses = vec![Transform::IDENTITY; spine.joint_count()];
    spine_pose(spine, swim, &mut poses);
    let place = |vertex: usize| {
        let parts = skin.indices[vertex].iter().zip(skin.weights[vertex]);
        parts
            .map(|(&joint, weight)| {
                let joint = usize::from(joint);
                let pose = poses[joint].compose(&skin.joints[joint].rest.inverse());
                pose.point(mesh.positions[vertex]) * weight
            })
            .sum()
    };
    (0..mesh.positions.len()).map(place).collect()
}

#[test]
fn mouths_close_without_a_gap_and_open_downward() {
    for (species, body) in bodies().filter(|(species, _)| species.detail == Detail::Fine) {
        let mesh = body.meshes(&species);
        let shut = posed(&mesh, &body.spine, &SwimState::default());
        for (point, rest) in shut.iter().zip(&mesh.positions) {
            assert!(point.distance(*rest) < 1e-4 * species.length, "{}", species.name);
        }
        let wide = SwimState { mouth: 1.0, ..SwimState::default() };
        let open = posed(&mesh, &body.spine, &wide);
        let (mut gape, mut moved) = (0.0f32, 0);
        for (open, shut) in open.iter().zip(&shut) {
            let way = *open - *shut;
            gape = gape.max(-way.y / species.length);
            moved += usize::from(way.length() > 1e-4 * species.length);
            assert!(way.x.abs() < 1e-5 * species.length, "{}: the jaw goes straight", species.name);
        }
        assert!((0.005..0.1).contains(&gape), "{}: {gape} of the length", species.name);
        assert!((8..400).contains(&moved), "{}: {moved} vertices", species.name);
    }
}

#[test]
fn only_the_lips_part() {
    for (species, body) in bodies().filter(|(species, _)| species.detail == Detail::Fine) {
        let finest = level(&species, 0);
        let trunk = trunk_mesh(&body.trunk, body.atlas.trunk, finest);
        let count = trunk.triangles.len();
        let slit = Slit::new(&species.mouth, &body.trunk, finest).expect("fine enough");
        let cut = slit.cut(trunk, [0.0; 2]);
        let mesh = &cut.mesh;
        assert_eq!(cut.jaw.len(), mesh.positions.len());
        // Vertices at one place go together, except where a lower lip parts from an upper one.
        let mut parted = 0;
        for first in 0..mesh.positions.len() {
            for other in first + 1..mesh.positions.len() {
                let apart = (cut.jaw[first] - cut.jaw[other]).abs() > 1e-6;
                parted += usize::from(apart && mesh.positions[first] == mesh.positions[other]);
            }
        }
        assert!(parted >= 3, "{}: {parted}", species.name);
        let outside = Mesh { triangles: mesh.triangles[..count].to_vec(), ..mesh.clone() };
        let edges = edges(&outside);
        for ([from, to], times) in &edges {
            assert_eq!((*times, edges.get(&[*to, *from])), (1, Some(&1)), "{}", species.name);
        }
    }
}

#[test]
fn forms_are_painted_and_made_once() {
    let species = FishSpecies::named("anchovy").unwrap(); // the library knows it
    let form = species.form();
    assert!(Arc::ptr_eq(&form, &FishSpecies::named("anchovy").unwrap().form()));
    let texture = form.material.texture.as_ref().expect("a painted fish");
    let level = |at: f32, level: f32| -> u32 {
        let column = at * texture.width as f32;
        let row = 3.0 + (1.0 - level) * 154.0;
        let pixel = texture.pixels[row as usize * texture.width as usize + column as usize];
        pixel[..3].iter().map(|&part| u32::from(part)).sum()
    };
    assert!(level(0.6, 0.95) + 150 < level(0.6, 0.1), "the back is darker than the belly");
    let again = FishForm::new(&species);
    let repainted = again.material.texture.as_ref().expect("a painted fish");
    assert_eq!(texture.pixels, repainted.pixels, "the same picture every time");
    let holes = texture.pixels.iter().filter(|pixel| pixel[3] == 0).count();
    assert!((50..20_000).contains(&holes), "fins are frayed: {holes}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_accepted_species_gives_a_whole_mesh(
        length in 0.01f32..5.0, heights in prop::collection::vec(0.001f32..0.4, 5),
        widths in prop::collection::vec(0.001f32..0.4, 5), full in 1.2f32..5.0, widest in 0.15f32..0.85,
        edge in prop::collection::vec((-0.2f32..1.3, -0.8f32..0.8), 2..9), bow in -0.5f32..0.5,
        thickness in 0f32..0.1, flare in -10f32..100.0, eye in (0.005f32..0.4, 0f32..1.0, 0.001f32..0.1),
    ) {
        let text = FishSpecies::named("anthias").unwrap().text().to_owned(); // the library knows it
        let mut species = FishSpecies::parse(&text, "anthias").unwrap(); // and can read it
        species.length = length;
        species.outline.at = vec![0.0, 0.1, 0.3, 0.6, 0.8];
        species.outline.back = heights.clone();
        species.outline.belly = heights;
        species.outline.width = widths;
        species.outline.fullness = vec![full; 5];
        species.outline.widest = vec![widest; 5];
        species.eye.place = [eye.0, eye.1];
        species.eye.radius = eye.2;
        let edge: Vec<[f32; 2]> = edge.into_iter().map(|(at, y)| [at, y]).collect();
        if let Some(tail) = &mut species.tail {
            (tail.edge, tail.look.bow) = (edge.clone(), bow);
        }
        for fin in &mut species.fins {
            (fin.edge, fin.look.bow, fin.look.thickness) = (edge.clone(), bow, thickness);
        }
        for pair in &mut species.pairs {
            (pair.edge, pair.flare) = (edge.clone(), flare);
        }
        let body = Body::new(&species);
        for mesh in levels(&body.meshes(&species)) {
            whole(mesh, &body.spine);
        }
    }
}
