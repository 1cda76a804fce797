use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Annotation, Error, Impact, Intention, Percepts, Quat, Random, Result, Vec3, state,
};
use bioscope_dynamics::{Current, CurrentParameters, Influence};
use bioscope_geometry::{Joint, Material, Mesh, Obstacle, Skin, Terrain, Transform};
use bioscope_minds::{Mind, Roamer};
use bioscope_motion::undulation::{Gait, Spine, Style};
use bioscope_motion::{Body, Swimmer, SwimmerParameters};
use bioscope_senses::{Hearing, LateralLine, Light, Sense, Sight, Touch};
use bioscope_world::{Population, Registry, World};
use proptest::prelude::*;
use rayon::ThreadPoolBuilder;

use super::*;

const DT: f64 = 1.0 / 60.0;

/// A body without anatomy that slides where its mind wants, at once.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
struct Puck {
    position: Vec3,
    attitude: Quat,
    velocity: Vec3,
}

impl Body for Puck {
    fn kind(&self) -> &str {
        "puck"
    }

    fn advance(&mut self, intention: &Intention, influence: &Influence, dt: f32) -> Result<()> {
        let heading = self.attitude * intention.heading.normalize_or(Vec3::Z);
        self.attitude = Quat::from_rotation_arc(Vec3::Z, heading);
        self.velocity = heading * intention.speed + influence.flow;
        self.position += self.velocity * dt;
        Ok(())
    }

    fn placement(&self) -> Transform {
        Transform::new(self.position, self.attitude, 1.0)
    }

    fn put(&mut self, position: Vec3, heading: Vec3) {
        self.position = position;
        self.attitude = Quat::from_rotation_arc(Vec3::Z, heading);
    }

    fn shift(&mut self, offset: Vec3) {
        self.position += offset;
    }

    fn velocity(&self) -> Vec3 {
        self.velocity
    }

    fn length(&self) -> f32 {
        1.0
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}

/// A mind that goes home, and fails when it has decided often enough.
#[derive(serde::Serialize, serde::Deserialize)]
struct Homing {
    decisions: u32,
    fails_at: u32,
}

impl Mind for Homing {
    fn name(&self) -> &str {
        "homing"
    }

    fn decide(
        &mut self,
        percepts: &Percepts,
        _random: &mut Random,
        _annotations: &mut Vec<Annotation>,
    ) -> Result<Intention> {
        self.decisions += 1;
        if self.decisions == self.fails_at {
            return Err(Error::value("decision", self.decisions, "no failure"));
        }
        Ok(Intention { heading: percepts.home, speed: 1.0, urgency: 0.5, ..Intention::default() })
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}

fn spine() -> Arc<Spine> {
    let gait = Gait { style: Style::Mackerel, waves: 1.0, cruise: 1.2 };
    Arc::new(Spine::new(0.6, gait, Spine::even_cuts(4), vec![1.0; 4], Vec::new()).unwrap())
}

fn look(kind: &str) -> Arc<Look> {
    let positions = vec![Vec3::Z * -0.3, Vec3::Z * 0.3];
    let mut mesh = Mesh { positions, ..Mesh::default() };
    let spine = (kind == "bending").then(spine);
    if let Some(spine) = &spine {
        let joints: Vec<Joint> = spine.joints();
        mesh.skin = Some(Skin { joints, indices: vec![[0; 4]; 2], weights: vec![[1.0; 4]; 2] });
    }
    Arc::new(Look {
        kind: kind.into(),
        description: Vec::new(),
        species: kind.into(),
        mesh: Arc::new(mesh),
        material: Arc::new(Material::default()),
        spine,
    })
}

fn kinds() -> Arc<Kinds> {
    let mut kinds = Kinds::default();
    kinds.add_look("rigid", |_| Ok(look("rigid")));
    kinds.add_look("bending", |_| Ok(look("bending")));
    kinds.add_body("puck", |bytes, _| Ok(Box::new(state::from_bytes::<Puck>("puck", bytes)?)));
    kinds.add_mind("homing", |bytes| Ok(Box::new(state::from_bytes::<Homing>("homing", bytes)?)));
    Arc::new(kinds)
}

fn registry() -> Registry {
    let mut registry = Registry::default();
    crate::add_animals(&mut registry, kinds());
    registry
}

fn senses() -> Vec<Box<dyn Sense>> {
    vec![
        Box::new(Sight::default()),
        Box::new(Touch::default()),
        Box::new(Hearing::default()),
        Box::new(LateralLine),
        Box::new(Light),
    ]
}

fn homing(fails_at: u32) -> Box<dyn Mind> {
    Box::new(Homing { decisions: 0, fails_at })
}

fn animal(mind: Box<dyn Mind>, swims: bool) -> Animal {
    let (body, look): (Box<dyn Body>, _) = if swims {
        let swimmer = Swimmer::new(spine(), 1.0, SwimmerParameters::default()).unwrap();
        (Box::new(swimmer), look("bending"))
    } else {
        (Box::new(Puck::default()), look("rigid"))
    };
    Animal { senses: senses(), mind, body, look, may_fail: false }
}

/// Six animals of both bodies and both minds between a seabed, a surface and a rock.
fn world() -> World {
    let mut world = World::new(11, DT).unwrap();
    world.environment.fill_with_water(0.0);
    let ground = Terrain::new([-20.0; 2], 40.0, 2, vec![-6.0; 4]).unwrap();
    world.environment.terrain = Some(Arc::new(ground));
    let center = Vec3::new(1.0, -3.0, 2.0);
    world.environment.obstacles.edit().push(Obstacle::Sphere { center, radius: 1.0 });
    let current = Current::new(Vec3::X, CurrentParameters::default());
    world.add_field(Box::new(current), None).unwrap();
    let animals = (0..6)
        .map(|index| {
            let mind = if index < 4 { Box::new(Roamer::default()) } else { homing(0) };
            animal(mind, index % 2 == 0)
        })
        .collect();
    let place = Some(Place { center: Vec3::Y * -3.0, radius: 5.0 });
    let options = AnimalsOptions { place, ..AnimalsOptions::default() };
    world.add(Box::new(Animals::new(animals, options, kinds()).unwrap()), None).unwrap();
    world
}

fn run(world: &mut World, ticks: usize) {
    for _ in 0..ticks {
        world.tick().unwrap();
    }
}

#[test]
fn one_mind_with_typed_in_percepts_turns_two_bodies() {
    let impact = Impact { distance: 0.8, aim: Vec3::new(1.0, 0.0, 0.8) };
    let percepts = Percepts {
        ahead: Some(impact),
        body_length: 0.6,
        depth: 3.0,
        velocity: Vec3::Z,
        dt: DT as f32,
        ..Percepts::default()
    };
    let mut mind = Roamer::default();
    let mut random = Random::new(1, 1, 1, bioscope_core::Purpose::new("test"));
    let intention = mind.decide(&percepts, &mut random, &mut Vec::new()).unwrap();
    let mut swimmer = Swimmer::new(spine(), 1.0, SwimmerParameters::default()).unwrap();
    let mut puck = Puck::default();
    let bodies: [&mut dyn Body; 2] = [&mut swimmer, &mut puck];
    for body in bodies {
        for _ in 0..20 {
            body.advance(&intention, &Influence::default(), DT as f32).unwrap();
        }
        let heading = body.placement().rotation() * Vec3::Z;
        assert!(heading.x > 0.05, "{} heads for {heading}", body.kind());
    }
}

#[test]
fn any_mind_drives_any_body_and_nobody_leaves_the_water() {
    let mut world = world();
    let begin: Vec<Transform> = places(&world);
    for _ in 0..900 {
        world.tick().unwrap();
        for transform in places(&world) {
            let place = transform.position;
            assert!(place.y < 0.0 && place.y > -6.0, "{place}");
            let rock = world.environment.obstacles[0].distance(place);
            assert!(rock > 0.05, "{rock} m from the middle of a body to the rock");
        }
    }
    for (before, after) in begin.iter().zip(places(&world)) {
        assert!(before.position.distance(after.position) > 0.3, "{before:?} {after:?}");
    }
    let bending = world.scene().batches.iter().find(|one| &*one.species == "bending").unwrap();
    assert_eq!((bending.ids.len(), bending.joint_count()), (3, 4));
    assert_ne!(bending.pose(0), bending.pose(1), "nobody swims in step");
}

fn places(world: &World) -> Vec<Transform> {
    world.scene().batches.iter().flat_map(|batch| batch.transforms.clone()).collect()
}

#[test]
fn a_failing_mind_stops_the_tick_and_leaves_the_world_at_the_last_one() {
    let mut world = world();
    let failing = Animal { may_fail: true, ..animal(homing(5), false) };
    let animals = Animals::new(vec![failing], AnimalsOptions::default(), kinds()).unwrap();
    world.add(Box::new(animals), Some("failing")).unwrap();
    run(&mut world, 4);
    let (hash, tick) = (world.state_hash().unwrap(), world.tick_count());
    assert!(world.tick().unwrap_err().to_string().contains("decision = 5"));
    assert_eq!((world.state_hash().unwrap(), world.tick_count()), (hash, tick));
}

#[test]
fn a_body_that_does_not_fit_its_look_is_refused() {
    let unfit = Animal { look: look("bending"), ..animal(homing(0), false) };
    let error = Animals::new(vec![unfit], AnimalsOptions::default(), kinds()).err().unwrap();
    assert!(error.to_string().contains("joints of body 'puck' = 0: expected 4"), "{error}");
}

#[test]
fn unknown_parts_in_a_file_are_named() {
    let bytes = world().save().unwrap();
    let mut registry = Registry::default();
    crate::add_animals(&mut registry, Arc::default());
    let error = World::restore(&bytes, &registry).err().unwrap().to_string();
    assert!(error.contains("unknown look 'bending'"), "{error}");
}

#[test]
fn parameters_of_all_parts_are_set_for_all() {
    let mut world = world();
    world.set("bending", "swimmer_top_speed", 0.5).unwrap();
    world.set("bending", "roamer_cruise_speed", 3.0).unwrap();
    let value = |world: &World, name: &str| {
        let all = &world.parameters()["bending"];
        all.iter().find(|(one, _)| one.name == name).map(|(_, value)| *value)
    };
    assert_eq!(value(&world, "swimmer_top_speed"), Some(0.5));
    assert_eq!(value(&world, "sight_field_of_view"), Some(300.0));
    assert!(world.set("bending", "swimmer_top_speed", -1.0).is_err());
    assert!(world.set("bending", "top_speed", 1.0).is_err());
    run(&mut world, 120);
    let batch = world.scene().batches.iter().find(|one| &*one.species == "bending").unwrap();
    let flow = 0.5;
    for velocity in &batch.velocities {
        assert!(velocity.length() < 0.5 * 0.7 + flow, "{velocity}");
    }
}

#[test]
fn an_animal_can_be_inspected() {
    let mut world = world();
    run(&mut world, 30);
    let id = world.scene().batches[0].ids[0];
    let (name, inspection) = world.inspect(id).unwrap();
    assert_eq!((name, inspection.species.as_str()), ("bending", "bending"));
    assert!(inspection.behavior.is_some() && inspection.eye.is_some());
    assert!(inspection.values.contains_key("speed_m_per_s"));
    assert!(inspection.percepts.contains_key("altitude"));
    assert_eq!(inspection.percepts["seen"], 5.0.into());
    assert!(world.inspect(9999).is_none());
    assert_eq!(world.statistics()["bending.count"], 6.0);
}

#[test]
fn dashing_and_turning_home_are_events_with_their_subjects() {
    let mut world = world();
    world.set("bending", "roamer_home_range", 1.0).unwrap();
    run(&mut world, 900);
    let mut counts = BTreeMap::new();
    for event in world.events() {
        *counts.entry((event.kind.to_string(), event.subject)).or_insert(0) += 1;
    }
    assert!(counts.keys().any(|(kind, _)| kind == "turned home"), "{counts:?}");
    assert!(counts.values().all(|&count| count <= 6), "{counts:?}");
}

#[test]
fn one_thread_and_two_give_the_same_state() {
    let hash = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = world();
            run(&mut world, 200);
            world.state_hash().unwrap()
        })
    };
    assert_eq!(hash(1), hash(2));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn continues_from_a_save_at_any_tick_as_if_nothing_had_happened(ticks in 0usize..150) {
        let mut one = world();
        run(&mut one, ticks);
        let bytes = one.save().unwrap();
        let mut two = World::restore(&bytes, &registry()).unwrap();
        prop_assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
        prop_assert_eq!(&one.scene().annotations, &two.scene().annotations);
        prop_assert_eq!(one.sounds(), two.sounds());
        run(&mut one, 40);
        run(&mut two, 40);
        prop_assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
        two.return_to(&bytes).unwrap();
        run(&mut two, 40);
        prop_assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
    }

    #[test]
    fn damaged_bytes_never_panic(position in 0usize..2000, value: u8) {
        let mut world = world();
        run(&mut world, 2);
        let mut bytes = world.populations()[0].population.save().unwrap();
        let position = position % bytes.len();
        bytes[position] = value;
        if let Ok(animals) = Animals::from_saved(&bytes, kinds()) {
            prop_assert!(animals.count() <= 6);
        }
    }
}
