use std::collections::BTreeSet;

use bioscope_core::Vec3;
use proptest::prelude::*;

use super::cells::{Cells, Thing};
use super::{Reach, Register, Shortlist};

fn thing(id: u32, position: Vec3, size: f32) -> Thing {
    Thing { position, size, id, group: 0, member: id }
}

proptest! {
    #[test]
    fn nothing_within_reach_is_missed(
        places in prop::collection::vec((prop::array::uniform3(-60f32..60.0), 1e-3f32..8.0), 0..80),
        center in prop::array::uniform3(-80f32..80.0),
        least in 0.02f32..0.5,
        range in 0f32..90.0,
        least_edge in 0f32..9.0,
    ) {
        let things: Vec<_> = places
            .iter()
            .enumerate()
            .map(|(id, &(place, size))| thing(id as u32, Vec3::from(place), size))
            .collect();
        let center = Vec3::from(center);
        let reach = |size: f32| range.min(size / least);
        let within = |one: &&Thing| one.position.distance(center) <= reach(one.size);
        let expected: BTreeSet<u32> = things.iter().filter(within).map(|one| one.id).collect();
        let mut found = BTreeSet::new();
        Cells::new(&things, least_edge).near(center, reach, |index| {
            let one = &things[index as usize];
            assert!(one.position.distance(center) > reach(one.size) || found.insert(one.id));
        });
        prop_assert_eq!(found, expected);
    }
}

#[test]
fn a_crowd_far_away_is_not_visited() {
    let crowd =
        (0..10_000).map(|id| thing(id, Vec3::new(500.0 + (id % 100) as f32, 0.0, 0.0), 0.1));
    let things: Vec<_> = crowd.chain([thing(10_000, Vec3::Z, 0.1)]).collect();
    let cells = Cells::new(&things, 0.0);
    let mut visited = 0;
    cells.near(Vec3::ZERO, |size| 15.0 * size, |_| visited += 1);
    assert_eq!(visited, 1);
}

#[test]
fn senseless_sizes_and_places_do_no_harm() {
    let odd = [f32::NAN, f32::INFINITY, 0.0, -1.0];
    let things: Vec<_> = odd.iter().map(|&one| thing(1, Vec3::splat(one), one)).collect();
    let mut visited = 0;
    Cells::new(&things, 0.0).near(Vec3::ZERO, |_| f32::INFINITY, |_| visited += 1);
    assert_eq!(visited, 4);
}

/// What happens to a crowd from one survey to the next.
#[derive(Clone, Debug)]
enum Happening {
    /// All drift by this share of their own ways.
    Drift(f32),
    /// One is elsewhere at once.
    Jump(usize, [f32; 3]),
    /// Another one comes in the place of one.
    Replacement(usize, [f32; 3]),
    /// One grows by this factor.
    Growth(usize, f32),
    /// One is gone; those after it move up.
    Death(usize),
    /// One comes at the end.
    Birth([f32; 3]),
    /// The one who looks is elsewhere at once.
    Leap([f32; 3]),
    /// It looks at nothing for a time.
    Pause,
}

fn happening() -> impl Strategy<Value = Happening> {
    let place = || prop::array::uniform3(-20f32..20.0);
    prop_oneof![
        12 => (0f32..2.0).prop_map(Happening::Drift),
        1 => (0usize..1000, place()).prop_map(|(who, to)| Happening::Jump(who, to)),
        1 => (0usize..1000, place()).prop_map(|(who, to)| Happening::Replacement(who, to)),
        1 => (0usize..1000, 0.2f32..4.0).prop_map(|(who, by)| Happening::Growth(who, by)),
        1 => (0usize..1000).prop_map(Happening::Death),
        1 => place().prop_map(Happening::Birth),
        1 => place().prop_map(Happening::Leap),
        2 => Just(Happening::Pause),
    ]
}

/// A crowd through which one swims that looks for what is near.
struct Crowd {
    things: Vec<Thing>,
    ways: Vec<Vec3>,
    place: Vec3,
    way: Vec3,
    next: u32,
}

impl Crowd {
    fn happen(&mut self, happening: &Happening) {
        let index = |who: usize, things: &[Thing]| who % things.len().max(1);
        match *happening {
            Happening::Drift(share) => {
                for (thing, way) in self.things.iter_mut().zip(&self.ways) {
                    thing.position += *way * share;
                }
                self.place += self.way * share;
            }
            Happening::Jump(who, to) => {
                let who = index(who, &self.things);
                self.things.iter_mut().skip(who).take(1).for_each(|one| one.position = to.into());
            }
            Happening::Replacement(who, to) => {
                let who = index(who, &self.things);
                for one in self.things.iter_mut().skip(who).take(1) {
                    (one.id, one.position) = (self.next, to.into());
                    self.next += 1;
                }
            }
            Happening::Growth(who, by) => {
                let who = index(who, &self.things);
                self.things.iter_mut().skip(who).take(1).for_each(|one| one.size *= by);
            }
            Happening::Death(who) => {
                let who = index(who, &self.things);
                if who < self.things.len() {
                    self.things.remove(who);
                }
            }
            Happening::Birth(at) => {
                self.things.push(thing(self.next, at.into(), 0.4));
                self.ways.push(Vec3::from(at) * 0.01);
                self.next += 1;
            }
            Happening::Leap(to) => self.place = to.into(),
            Happening::Pause => {}
        }
        (0..).zip(&mut self.things).for_each(|(member, one)| one.member = member);
    }

    fn near(&self, reach: Reach) -> BTreeSet<u32> {
        let within = |one: &&Thing| one.position.distance(self.place) <= reach.of(one.size);
        self.things.iter().filter(within).map(|one| one.id).collect()
    }
}

proptest! {
    /// Tu 1996, section 5.4: the list of potentially visible objects gives what looking at all objects does.
    #[test]
    fn a_shortlist_finds_what_looking_at_all_finds(
        crowd in prop::collection::vec(
            (prop::array::uniform3(-20f32..20.0), prop::array::uniform3(-0.1f32..0.1), 0.05f32..1.0),
            1..60,
        ),
        way in prop::array::uniform3(-0.2f32..0.2),
        story in prop::collection::vec(happening(), 1..60),
        least in 0.0f32..0.3,
        range in 2f32..15.0,
    ) {
        let members = || (0..).zip(&crowd);
        let mut crowd = Crowd {
            things: members().map(|(id, one)| thing(id, one.0.into(), one.2)).collect(),
            ways: members().map(|(_, one)| one.1.into()).collect(),
            place: Vec3::ZERO,
            way: way.into(),
            next: 1000,
        };
        let reach = Reach { range, least };
        let mut register = Register::new(crowd.things.clone(), 0.0);
        let mut shortlist = Shortlist::default();
        for happening in &story {
            crowd.happen(happening);
            register = register.followed_by(crowd.things.clone());
            if matches!(happening, Happening::Pause) {
                continue;
            }
            let mut found = BTreeSet::new();
            shortlist.near(&register, (crowd.place, reach), |_| true, |one| {
                let near = one.position.distance(crowd.place) <= reach.of(one.size);
                assert!(!near || found.insert(one.id), "once each");
            });
            prop_assert_eq!(found, crowd.near(reach));
        }
    }
}

#[test]
fn a_shortlist_is_short_and_holds_while_all_are_slow() {
    let grid =
        |index: u32| Vec3::new((index % 20) as f32, (index / 400) as f32, (index / 20 % 20) as f32);
    let mut things: Vec<_> = (0..8000).map(|index| thing(index, grid(index), 0.1)).collect();
    let (mut register, mut shortlist) = (Register::new(things.clone(), 0.0), Shortlist::default());
    let reach = Reach { range: 2.0, least: 0.0 };
    let mut visited = Vec::new();
    for tick in 0..100 {
        things.iter_mut().for_each(|one| one.position.x += 0.01);
        if tick == 50 {
            // One that breaks the bound costs nobody else a new list.
            things[7].position = Vec3::new(10.5, 10.0, 10.0);
        }
        register = register.followed_by(things.clone());
        let (mut count, mut met) = (0, false);
        shortlist.near(
            &register,
            (Vec3::splat(10.0), reach),
            |_| true,
            |one| {
                count += 1;
                met |= one.id == 7;
            },
        );
        visited.push((count, met));
    }
    assert!(visited.iter().all(|one| (27..200).contains(&one.0)), "{visited:?}");
    let changes = visited.windows(2).filter(|two| two[0].0 != two[1].0).count();
    assert!(changes < 30, "{changes} of 100");
    assert_eq!((visited[49].1, visited[50].1), (false, true));
}
