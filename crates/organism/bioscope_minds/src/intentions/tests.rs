use bioscope_core::{
    Act, Display, Impact, Percepts, Purpose, Quat, Random, Sex, Sighting, Value, Vec3,
};
use proptest::prelude::*;

use super::*;
use crate::nature::{Habits, Nature, Role, Temper};
use crate::{BehaviorNetwork, FreeFlow, Mind};

fn temper() -> Temper {
    Temper { stagger: 0.0, alarm_time: 0.0, ..Temper::default() }
}

fn nature(role: Role, school: bool) -> Nature {
    Nature {
        role,
        habits: Habits { school, ..Habits::default() },
        species: "clownfish".into(),
        enemies: vec!["shark".into()],
        food: vec!["plankton".into()],
        ..Nature::default()
    }
}

fn sighting(id: u32, species: &str, position: Vec3) -> Sighting {
    let heading = Vec3::Z;
    Sighting { id, species: species.into(), position, heading, size: 0.1, ..Sighting::default() }
}

fn mate(id: u32, position: Vec3) -> Sighting {
    let display = Display { sex: Sex::Female, act: Act::Courting, partner: 0 };
    Sighting { display, ..sighting(id, "clownfish", position) }
}

fn percepts() -> Percepts {
    Percepts {
        id: 1,
        dt: 1.0 / 30.0,
        velocity: Vec3::Z * 0.1,
        attitude: Quat::IDENTITY,
        body_length: 0.1,
        depth: 3.0,
        ..Percepts::default()
    }
}

fn rock() -> Impact {
    Impact { distance: 0.1, aim: Vec3::new(0.1, 0.0, 0.1) }
}

/// Decides for a number of ticks; what it intends in the last.
fn decide(mind: &mut dyn Mind, percepts: &Percepts, ticks: u64) -> bioscope_core::Intention {
    let mut last = None;
    for tick in 0..ticks {
        let mut random = Random::new(9, 1, tick, Purpose::new("test"));
        let mut now = percepts.clone();
        now.time += tick as f64 / 30.0;
        last = Some(mind.decide(&now, &mut random, &mut Vec::new()).unwrap());
    }
    last.unwrap()
}

#[test]
fn danger_goes_before_need_and_need_before_comfort() {
    let mut all = percepts();
    all.ahead = Some(rock());
    all.seen = vec![sighting(4, "shark", Vec3::X * 0.6), mate(5, Vec3::Z * 0.4)];
    all.smelled = vec![sighting(6, "plankton", Vec3::NEG_X * 0.2)];
    let mut mind = Intentions::new(nature(Role::Generic, false), temper());
    assert_eq!(decide(&mut mind, &all, 1).behavior, "avoid");
    all.ahead = None;
    let escape = decide(&mut mind, &all, 1);
    assert_eq!((&*escape.behavior, escape.target, escape.speed), ("escape", Some(4), 3.0));
    all.seen.remove(0);
    assert_eq!(decide(&mut mind, &all, 1).behavior, "eat");
    all.smelled.clear();
    all.seen.clear();
    all.fed = 9;
    assert_eq!(decide(&mut mind, &all, 1).behavior, "wander");
}

#[test]
fn moderate_fear_gathers_the_school_and_great_fear_breaks_it() {
    let at = |distance: f32, school: bool| {
        let mut now = percepts();
        now.seen =
            vec![sighting(3, "clownfish", Vec3::X * 0.2), sighting(4, "shark", Vec3::Z * distance)];
        let mut mind = Intentions::new(nature(Role::Prey, school), temper());
        decide(&mut mind, &now, 1).behavior.into_owned()
    };
    // D0 / f1 = 17.9 and D0 / f0 = 47.6 body lengths.
    assert_eq!([at(1.0, true), at(1.9, true)], ["escape", "school"]);
    assert_eq!([at(1.9, false), at(5.0, false)], ["escape", "eat"]);
}

#[test]
fn roles_lack_intentions() {
    let mut now = percepts();
    now.seen = vec![sighting(4, "shark", Vec3::Z * 0.5), mate(5, Vec3::X * 0.5)];
    now.fed = 9;
    let wants = |role: Role| {
        let mut mind = Intentions::new(nature(role, true), temper());
        decide(&mut mind, &now, 1);
        decide(&mut mind, &Percepts { fed: 0, ..now.clone() }, 420).behavior.into_owned()
    };
    assert_eq!(wants(Role::Pacifist), "mate", "libido of the sated has grown");
    assert_eq!(wants(Role::Prey), "escape");
    assert_eq!(wants(Role::Predator), "wander");
}

#[test]
fn what_an_obstacle_interrupts_is_gone_on_with_and_then_resists() {
    let mut feeding = percepts();
    feeding.smelled = vec![
        sighting(6, "plankton", Vec3::new(0.3, 0.0, 0.3)),
        sighting(7, "plankton", Vec3::new(-0.35, 0.0, 0.35)),
    ];
    let mut mind = Intentions::new(nature(Role::Pacifist, false), temper());
    assert_eq!(decide(&mut mind, &feeding, 3).target, Some(6));
    let blocked = Percepts { ahead: Some(rock()), ..feeding.clone() };
    assert_eq!(decide(&mut mind, &blocked, 5).behavior, "avoid");
    // Meanwhile the other morsel has come somewhat nearer.
    let mut later = feeding.clone();
    later.smelled[1].position *= 0.8;
    let resumed = decide(&mut mind, &later, 1);
    assert_eq!((&*resumed.behavior, resumed.target), ("eat", Some(6)));
    assert_eq!(mind.values()["resumed"], Value::Flag(true));
    // A target that is gone is forgotten.
    decide(&mut mind, &blocked, 1);
    later.smelled.remove(0);
    assert_eq!(decide(&mut mind, &later, 1).target, Some(7));
}

#[test]
fn a_courting_fish_takes_food_before_its_mouth_and_returns_to_the_same_mate() {
    let mut now = percepts();
    now.seen = vec![mate(5, Vec3::Z * 0.25), mate(8, Vec3::X * 0.35)];
    let mut mind = Intentions::new(nature(Role::Pacifist, false), temper());
    decide(&mut mind, &Percepts { fed: 5, ..now.clone() }, 1);
    let courting = decide(&mut mind, &now, 500);
    assert_eq!((&*courting.behavior, courting.target), ("mate", Some(5)));
    now.smelled = vec![sighting(6, "plankton", Vec3::new(0.02, 0.0, 0.08))];
    now.time = 20.0;
    assert_eq!(decide(&mut mind, &now, 1).behavior, "eat");
    now.smelled.clear();
    (now.fed, now.time) = (1, 20.1);
    let again = decide(&mut mind, &now, 1);
    assert_eq!((&*again.behavior, again.target), ("mate", Some(5)));
}

#[test]
fn a_resumed_behavior_is_handicapped_for_less() {
    // Libido wins over hunger by less than the inhibition; whether mating was resumed decides.
    let mut now = percepts();
    now.seen = vec![mate(5, Vec3::new(0.0, 0.068, 0.01))];
    let hunger_between = |interrupted: bool| {
        let tireless = Temper { fatigue_time: 1e5, ..temper() };
        let mut mind = Intentions::new(nature(Role::Pacifist, false), tireless);
        decide(&mut mind, &Percepts { fed: 4, ..now.clone() }, 1);
        assert_eq!(decide(&mut mind, &now, 300).behavior, "mate");
        if interrupted {
            decide(&mut mind, &Percepts { ahead: Some(rock()), ..now.clone() }, 1);
            assert_eq!(decide(&mut mind, &now, 1).behavior, "mate");
        }
        let mut tempting = now.clone();
        tempting.smelled = vec![sighting(6, "plankton", Vec3::Z * (0.048 + 0.0465))];
        let intention = decide(&mut mind, &tempting, 1);
        let Value::Number(hunger) = mind.values()["hunger"] else { panic!() };
        let Value::Number(libido) = mind.values()["libido"] else { panic!() };
        assert!(hunger > libido && hunger < libido + 0.2, "{hunger} {libido}");
        intention.behavior.into_owned()
    };
    assert_eq!([hunger_between(false), hunger_between(true)], ["eat", "mate"]);
}

#[test]
fn fatigue_lets_a_hungry_fish_without_food_do_other_things() {
    let share = |fatigue_time: f32| {
        let temper = Temper { fatigue_time, ..temper() };
        let mut mind = Intentions::new(nature(Role::Pacifist, false), temper);
        let mut others = 0;
        for tick in 0..3000u64 {
            let now = Percepts { time: tick as f64 / 30.0, ..percepts() };
            let mut random = Random::new(9, 1, tick, Purpose::new("test"));
            let intention = mind.decide(&now, &mut random, &mut Vec::new()).unwrap();
            others += i32::from(intention.behavior != "eat");
        }
        others
    };
    assert!(share(20.0) > 500);
    assert_eq!(share(1e5), 0);
}

#[test]
fn habits_decide_whether_to_stay() {
    let wants = |habits: Habits, light: f32| {
        let nature = Nature { habits, ..nature(Role::Pacifist, false) };
        let mut mind = Intentions::new(nature, temper());
        let now = Percepts { fed: 9, light, temperature: 24.0, ..percepts() };
        decide(&mut mind, &now, 1).behavior.into_owned()
    };
    let dark = Habits { dark: true, ..Habits::default() };
    assert_eq!([wants(dark, 0.9), wants(dark, 0.1)], ["leave", "wander"]);
    assert_eq!(wants(Habits { bright: true, dark: true, ..Habits::default() }, 0.5), "wander");
}

#[test]
fn displays_and_annotations_show_what_it_does() {
    let mut now = percepts();
    now.seen = vec![mate(5, Vec3::Z * 0.25)];
    let mut mind = Intentions::new(nature(Role::Pacifist, false), temper());
    decide(&mut mind, &Percepts { fed: 9, ..now.clone() }, 1);
    let intention = decide(&mut mind, &now, 420);
    assert_eq!(intention.display, Display { sex: Sex::Male, act: Act::Courting, partner: 5 });
    let mut notes = Vec::new();
    let mut random = Random::new(9, 1, 0, Purpose::new("test"));
    mind.decide(&now, &mut random, &mut notes).unwrap();
    let roles: Vec<_> = notes.iter().map(|note| note.role.as_ref()).collect();
    assert_eq!(roles, ["heading", "target"]);
}

fn minds() -> [Box<dyn Mind>; 3] {
    let nature = nature(Role::Generic, true);
    [
        Box::new(Intentions::new(nature.clone(), Temper::default())),
        Box::new(BehaviorNetwork::new(nature.clone(), Temper::default())),
        Box::new(FreeFlow::new(nature, Temper::default())),
    ]
}

fn restored(mind: &dyn Mind) -> bioscope_core::Result<Box<dyn Mind>> {
    let bytes = mind.save()?;
    Ok(match mind.name() {
        "intentions" => Box::new(Intentions::restore(&bytes)?),
        "behavior_network" => Box::new(BehaviorNetwork::restore(&bytes)?),
        _ => Box::new(FreeFlow::restore(&bytes)?),
    })
}

#[test]
fn parameters_are_checked_when_set_and_when_read_back() {
    for mut mind in minds() {
        let parameters = mind.parameters_mut().unwrap();
        assert!(parameters.set("appetite", -1.0).is_err());
        parameters.set("appetite", 3.0).unwrap();
        let back = restored(&*mind).unwrap();
        assert_eq!(back.parameters().unwrap().get("appetite"), Some(3.0));
    }
    let mut bytes = Intentions::default().save().unwrap();
    let place = bytes.windows(4).position(|four| four == 5f32.to_le_bytes()).unwrap();
    bytes[place..place + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(Intentions::restore(&bytes).is_err());
}

fn arbitrary_sighting() -> impl Strategy<Value = Sighting> {
    let numbers = prop::array::uniform3(-3f32..3.0);
    let species = prop::sample::select(vec!["clownfish", "shark", "plankton", "crab"]);
    (1u32..9, species, numbers, prop::array::uniform3(-1f32..1.0), 0usize..9, 0u32..3).prop_map(
        |(id, species, place, velocity, act, partner)| {
            let sex = if id % 2 == 0 { Sex::Female } else { Sex::Unknown };
            let display = Display { sex, act: Act::ALL[act], partner };
            let velocity = Vec3::from(velocity);
            let heading = velocity.normalize_or(Vec3::Z);
            let position = Vec3::from(place);
            Sighting { velocity, heading, display, ..sighting(id, species, position) }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn minds_are_deterministic_finite_and_go_on_from_their_bytes(
        scenes in prop::collection::vec(
            (prop::collection::vec(arbitrary_sighting(), 0..6),
             prop::option::of((0f32..0.5, prop::array::uniform3(-0.3f32..0.3))),
             0u32..3, 0f32..1.2),
            1..25,
        )
    ) {
        for mut mind in minds() {
            let mut copy: Option<Box<dyn Mind>> = None;
            for (tick, (seen, ahead, fed, light)) in scenes.iter().enumerate() {
                let ahead = ahead.map(|(distance, aim)| Impact { distance, aim: Vec3::from(aim) });
                let seen: Vec<Sighting> = seen.clone();
                let smelled = seen.iter().filter(|one| &*one.species == "plankton").cloned().collect();
                let time = tick as f64 / 30.0;
                let now = Percepts {
                    time, seen, smelled, ahead, fed: *fed, light: *light, solids: vec![Vec3::X * 0.1], ..percepts()
                };
                let random = || Random::new(4, 1, tick as u64, Purpose::new("test"));
                let wanted = mind.decide(&now, &mut random(), &mut Vec::new()).unwrap();
                prop_assert!(wanted.heading.is_finite() && wanted.speed.is_finite());
                prop_assert!((wanted.heading.length() - 1.0).abs() < 1e-3, "{:?}", wanted);
                prop_assert!((0.0..=1.0).contains(&wanted.brake) && (0.0..=1.0).contains(&wanted.mouth));
                if let Some(copy) = &mut copy {
                    let same = copy.decide(&now, &mut random(), &mut Vec::new()).unwrap();
                    prop_assert_eq!(&same, &wanted);
                }
                copy = Some(restored(&*mind).unwrap());
            }
        }
    }
}
