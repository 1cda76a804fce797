//! Meshes without cracks, and skeletons that bind them.

use std::collections::BTreeMap;

use bioscope_core::Vec3;
use bioscope_geometry::Mesh;
use bioscope_lsystem::{
    Interpretation, LSystem, MeshOptions, Palette, PlantShape, SkeletonOptions, Turtle,
    TurtleOptions,
};
use proptest::prelude::*;

fn draw(text: &str, steps: u64) -> Interpretation {
    let system = LSystem::parse(text, "test.l").unwrap_or_else(|reports| panic!("{reports}"));
    Turtle::interpret(&system.derive(steps, 3).unwrap(), &TurtleOptions::default()).unwrap()
}

fn word(word: &str) -> Interpretation {
    draw(&format!("axiom: {word}\nZ --> Z"), 0)
}

fn shape(interpretation: &Interpretation) -> PlantShape {
    interpretation.shape(&MeshOptions::default(), &SkeletonOptions::default()).unwrap()
}

type Edge = [[u32; 3]; 2];

/// How often each edge is run through in one direction, vertices at one place taken as one.
fn directed_edges(mesh: &Mesh) -> BTreeMap<Edge, i32> {
    let place = |index: u32| mesh.positions[index as usize].to_array().map(f32::to_bits);
    let mut edges = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([place(from), place(to)]).or_insert(0) += 1;
        }
    }
    edges
}

fn assert_sound(mesh: &Mesh) {
    let count = mesh.positions.len();
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < count));
    assert_eq!((mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()), (count, count, count));
    for normal in &mesh.normals {
        assert!((normal.length() - 1.0).abs() < 1e-4, "normal {normal}");
    }
}

#[test]
fn a_bent_tapering_cylinder_is_watertight() {
    let stem = "!(0.4)F+(20)!(0.3)F&(30)!(0.3)F/(50)+(40)!(0.2)F!(0.1)F";
    let mesh = word(stem).mesh(&MeshOptions::default());
    assert_sound(&mesh);
    let edges = directed_edges(&mesh);
    for (edge, count) in &edges {
        assert_eq!((*count, edges.get(&[edge[1], edge[0]])), (1, Some(&1)), "{edge:?}");
    }
}

#[test]
fn branches_are_open_only_at_their_base() {
    let mesh = word("!(0.4)FF[+(50)!(0.2)FF]F").mesh(&MeshOptions::default());
    let edges = directed_edges(&mesh);
    let open: Vec<&Edge> =
        edges.keys().filter(|edge| !edges.contains_key(&[edge[1], edge[0]])).collect();
    // The branch is half as wide and has six of the eight sides.
    assert_eq!(open.len(), 6);
    let inside = |place: [u32; 3]| {
        Vec3::from_array(place.map(f32::from_bits)).distance(Vec3::Y * 2.0) < 0.11
    };
    assert!(open.iter().all(|edge| inside(edge[0])));
}

#[test]
fn normals_point_out_of_a_cylinder_and_into_a_tube() {
    let mesh = word("!(1)F(2)F(2)").mesh(&MeshOptions { sides: 12, ..MeshOptions::default() });
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        if position.y > 0.1 && position.y < 3.9 {
            let outward = Vec3::new(position.x, 0.0, position.z).normalize();
            assert!(normal.dot(outward) > 0.99, "{position} {normal}");
        }
    }
    let tube = word("!(1)F(2)F(2)!(0.8)F(0.01)F(-1)F(-1)").mesh(&MeshOptions::default());
    let inner = tube.positions.iter().zip(&tube.normals).filter(|(position, _)| {
        (position.y - 2.01).abs() < 0.01 && Vec3::new(position.x, 0.0, position.z).length() < 0.41
    });
    let inner: Vec<f32> = inner
        .map(|(position, normal)| normal.dot(Vec3::new(position.x, 0.0, position.z).normalize()))
        .collect();
    assert!(!inner.is_empty() && inner.iter().all(|&dot| dot < -0.99), "{inner:?}");
}

#[test]
fn triangles_face_as_their_normals_do() {
    let mesh = word("!(1)F&(20)F+(20)!(0.5)F@O(1)").mesh(&MeshOptions::default());
    for &[a, b, c] in &mesh.triangles {
        let [p, q, r] = [a, b, c].map(|index| mesh.positions[index as usize]);
        let mean: Vec3 = [a, b, c].iter().map(|&index| mesh.normals[index as usize]).sum();
        assert!((q - p).cross(r - p).dot(mean) > -1e-6);
    }
}

#[test]
fn texture_runs_along_and_colors_follow_the_palette() {
    let palette = Palette::parse("1 0 0 1 # blue\n2 1 0 0", "two.colors").unwrap();
    let mesh = word("!(1);(1)F;(2)FF").mesh(&MeshOptions { sides: 6, palette });
    for ((position, uv), color) in mesh.positions.iter().zip(&mesh.uvs).zip(&mesh.colors) {
        if position.y > 0.0 && position.y <= 3.0 && uv[0] != 0.5 {
            assert!((uv[1] - position.y / std::f32::consts::PI).abs() < 1e-5);
        }
        if position.y >= 1.5 {
            assert_eq!(*color, [1.0, 0.0, 0.0]);
        }
    }
    let error = Palette::parse("1 0 0\n", "bad.colors").unwrap_err().to_string();
    assert!(error.starts_with("bad.colors:1:1: expected a number"), "{error}");
}

const TREE: &str = "axiom: !(0.2)F(1)A(6)\n\
    A(n) : n > 0 --> !(0.02*n)F(0.5)[+(30)B(n)][-(40)B(n)]/(137)A(n-1)\n\
    B(n) : n > 1 --> !(0.01*n)F(0.3)~l(0.2)B(n-1)";

#[test]
fn skeletons_are_well_formed() {
    let plant = shape(&draw(TREE, 12));
    let skin = plant.mesh.skin.as_ref().unwrap();
    let count = skin.joints.len();
    assert!((2..=20).contains(&count));
    assert_eq!((plant.flexibility.len(), plant.paths.len()), (count, count));
    for (number, joint) in skin.joints.iter().enumerate() {
        assert!(joint.parent.map_or(number == 0, |parent| usize::from(parent) < number));
    }
    assert_eq!(skin.weights.len(), plant.mesh.positions.len());
    for (indices, weights) in skin.indices.iter().zip(&skin.weights) {
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!(weights.iter().all(|&weight| weight >= 0.0));
        assert!(indices.iter().all(|&index| usize::from(index) < count));
    }
    assert!((plant.length - 4.0).abs() < 0.3, "{}", plant.length);
}

/// Along a stem each joint is more flexible than its parent, and neighboring rings have nearly
/// the same weights.
#[test]
fn stems_bend_more_and_smoothly_towards_the_tip() {
    let plant = shape(&word(&"!(0.1)F(0.05)".repeat(60)));
    assert!(plant.flexibility.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", plant.flexibility);
    assert_eq!((plant.flexibility[0], plant.flexibility[19]), (0.0, 1.0));
    let skin = plant.mesh.skin.unwrap();
    let weight = |vertex: usize, joint: u8| {
        let pairs = skin.indices[vertex].iter().zip(&skin.weights[vertex]);
        pairs.filter(|(index, _)| **index == joint).map(|(_, weight)| weight).sum::<f32>()
    };
    for vertex in 18..plant.mesh.positions.len() - 20 {
        for joint in 1..20 {
            assert!((weight(vertex, joint) - weight(vertex + 9, joint)).abs() < 0.35);
        }
    }
}

#[test]
fn nothing_has_a_shape_too() {
    let plant = shape(&word("+"));
    assert_eq!((plant.mesh.triangles.len(), plant.flexibility.len(), plant.height), (0, 1, 0.0));
    let options = SkeletonOptions { joints: 0, ..SkeletonOptions::default() };
    assert!(word("F").shape(&MeshOptions::default(), &options).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Any walk of the turtle gives a sound mesh and skin.
    #[test]
    fn any_walk_has_a_sound_mesh(steps in prop::collection::vec(0usize..32, 1..80), chains in 0u32..8, joints in 1u32..30) {
        const STEPS: [&str; 32] = [
            "F", "F(0.2)", "F(-1)", "f(0.3)", "G", "+(40)", "-(170)", "&(90)", "/(30)", "|", "[", "]",
            "[", "]", "!(0)", "!(0.3)", "#", ";", "{", "}", "~l(0.4)", "@O(0.1)", "@#(1)", "@#(2)",
            "F(1.0e38)", "F(0.000000000000001)", "!(1.0e38)", "@O(1.0e38)", "~l(1.0e38)", "f(-1.0e30)",
            "@M(1.0e38,0,0)", "@R(0,0,0,0,0,0)",
        ];
        let walk: String = steps.iter().map(|&step| STEPS[step]).collect();
        let options = SkeletonOptions { joints, chains, shortest: 0.1 };
        let plant = word(&walk).shape(&MeshOptions::default(), &options).unwrap();
        assert_sound(&plant.mesh);
        let skin = plant.mesh.skin.unwrap();
        prop_assert!(skin.joints.len() <= joints as usize);
        for weights in &skin.weights {
            prop_assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-4);
        }
    }
}
