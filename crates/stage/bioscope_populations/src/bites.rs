//! Who ends in whose mouth.
//!
//! A mouth that closes on something publishes a [`BITTEN`] event. In the next tick the population that
//! the bitten one belongs to lets go of it and publishes that it was [`EATEN`] (food) or [`CAUGHT`] (prey), by
//! which the eater learns that it has fed. Of several who bite the same, the first is fed.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Event, Id, Value, Vec3};
use bioscope_world::Moment;
use serde::{Deserialize, Serialize};

/// A mouth (the event's object) has closed on something (its subject).
pub const BITTEN: &str = "bitten";
/// Food (the event's subject) is gone into its object.
pub const EATEN: &str = "eaten";
/// Prey (the event's subject) is gone into its object.
pub const CAUGHT: &str = "caught";
/// An animal (the event's subject) hangs on a hook (its object).
pub const HOOKED: &str = "hooked";

/// One who is gone, and into whom.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Gone {
    pub who: Id,
    pub into: Id,
    /// Of which species it was: nobody can look that up any more.
    pub species: Arc<str>,
}

impl Gone {
    /// The event that tells of it; `kind` is [`EATEN`] or [`CAUGHT`].
    pub fn event(&self, kind: &'static str, moment: &Moment) -> Event {
        Event {
            tick: moment.tick,
            time: moment.time,
            kind: Cow::Borrowed(kind),
            subject: self.who,
            object: Some(self.into),
            data: of_species(&self.species),
        }
    }
}

/// What an event tells of one who is gone.
pub(crate) fn of_species(species: &str) -> BTreeMap<String, Value> {
    BTreeMap::from([(String::from("species"), species.into())])
}

/// Who was bitten in the last tick, and by whom first.
pub(crate) fn bitten(events: &[Event]) -> BTreeMap<Id, Id> {
    let mut biters = BTreeMap::new();
    for event in events.iter().filter(|event| event.kind == BITTEN) {
        if let Some(biter) = event.object {
            biters.entry(event.subject).or_insert(biter);
        }
    }
    biters
}

/// The ball (`position`, `radius`, metres) that an event speaks of.
pub(crate) fn ball(event: &Event) -> Option<(Vec3, f32)> {
    let (Value::Numbers(place), Value::Number(radius)) =
        (event.data.get("position")?, event.data.get("radius")?)
    else {
        return None;
    };
    let [x, y, z] = place[..] else { return None };
    let (center, radius) = (Vec3::new(x as f32, y as f32, z as f32), *radius as f32);
    (center.is_finite() && radius.is_finite() && radius > 0.0).then_some((center, radius))
}

#[cfg(test)]
mod tests {
    use bioscope_core::{Result, Vec3};
    use bioscope_world::{Growth, Population, Publication, View, World};

    use super::*;
    use crate::drifters::{Plankton, PlanktonOptions};
    use crate::fish::{FishSchool, FishSchoolOptions, FishSpecies};

    /// Two mouths that close on the first of everything.
    #[derive(Default)]
    struct Mouths {
        ids: Vec<Id>,
        bites: Vec<Gone>,
    }

    impl Population for Mouths {
        fn kind(&self) -> &str {
            "mouths"
        }

        fn settle(&mut self, growth: &mut Growth) -> Result<()> {
            self.ids = growth.identities(2)?;
            Ok(())
        }

        fn decide(&mut self, view: &View) -> Result<()> {
            let batches = view.scene.batches.iter().filter_map(|one| one.ids.first());
            let points = view.scene.points.iter().filter_map(|one| one.ids.first());
            let bite = |&who: &Id| {
                self.ids.iter().map(move |&into| Gone { who, into, species: Arc::from("") })
            };
            self.bites = batches.chain(points).flat_map(bite).collect();
            Ok(())
        }

        fn publish(&self, publication: &mut Publication) -> Result<()> {
            let moment = publication.moment;
            publication.events.extend(self.bites.iter().map(|one| one.event(BITTEN, &moment)));
            Ok(())
        }

        fn count(&self) -> usize {
            self.ids.len()
        }

        fn save(&self) -> Result<Vec<u8>> {
            Ok(Vec::new())
        }

        fn restore(&mut self, _bytes: &[u8]) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn the_bitten_are_gone_once_and_feed_the_first_mouth() {
        let mut world = World::new(3, 0.05).unwrap();
        world.environment.fill_with_water(0.0);
        let species = FishSpecies::named("anchovy").unwrap();
        let school = FishSchoolOptions::new(species, 5, Vec3::Y * -3.0);
        world.add(Box::new(FishSchool::new(school).unwrap()), None).unwrap();
        let plankton = PlanktonOptions { count: 20, ..PlanktonOptions::default() };
        world.add(Box::new(Plankton::new(plankton).unwrap()), None).unwrap();
        world.add(Box::<Mouths>::default(), None).unwrap();
        let first_mouth = 26;
        for _ in 0..4 {
            world.tick().unwrap();
        }
        let told = |kind: &str| {
            let events = world.events().iter().filter(|event| event.kind == kind);
            events.map(|event| (event.subject, event.object)).collect::<Vec<_>>()
        };
        let (caught, eaten) = (told(CAUGHT), told(EATEN));
        assert_eq!(caught.len(), 5 - world.populations()[0].population.count());
        assert!(caught.len() >= 2 && eaten.len() >= 2, "{caught:?} {eaten:?}");
        let mut gone: Vec<Id> = caught.iter().chain(&eaten).map(|one| one.0).collect();
        gone.dedup();
        assert_eq!(gone.len(), caught.len() + eaten.len());
        assert!(caught.iter().chain(&eaten).all(|one| one.1 == Some(first_mouth)));
        assert_eq!(world.populations()[1].population.count(), 20);
    }
}
