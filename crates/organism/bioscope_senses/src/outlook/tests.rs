use std::collections::BTreeSet;

use bioscope_core::Vec3;
use proptest::prelude::*;

use super::cells::{Cells, Kind, Thing};

fn thing(id: u32, position: Vec3, size: f32) -> Thing {
    Thing { position, size, id, kind: Kind::Point, group: 0, member: id }
}

proptest! {
    #[test]
    fn nothing_within_reach_is_missed(
        places in prop::collection::vec((prop::array::uniform3(-60f32..60.0), 1e-3f32..8.0), 0..80),
        center in prop::array::uniform3(-80f32..80.0),
        least in 0.02f32..0.5,
        range in 0f32..90.0,
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
        Cells::new(things.clone()).near(center, reach, |one| {
            assert!(one.position.distance(center) > reach(one.size) || found.insert(one.id));
        });
        prop_assert_eq!(found, expected);
    }
}

#[test]
fn a_crowd_far_away_is_not_visited() {
    let crowd =
        (0..10_000).map(|id| thing(id, Vec3::new(500.0 + (id % 100) as f32, 0.0, 0.0), 0.1));
    let cells = Cells::new(crowd.chain([thing(10_000, Vec3::Z, 0.1)]).collect());
    let mut visited = 0;
    cells.near(Vec3::ZERO, |size| 15.0 * size, |_| visited += 1);
    assert_eq!(visited, 1);
}

#[test]
fn senseless_sizes_and_places_do_no_harm() {
    let odd = [f32::NAN, f32::INFINITY, 0.0, -1.0];
    let things = odd.iter().map(|&one| thing(1, Vec3::splat(one), one)).collect();
    let mut visited = 0;
    Cells::new(things).near(Vec3::ZERO, |_| f32::INFINITY, |_| visited += 1);
    assert_eq!(visited, 4);
}
