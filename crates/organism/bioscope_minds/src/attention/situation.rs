use bioscope_core::{Id, Percepts, Sighting, Vec3};

use crate::drives::{Stirring, fear_of};
use crate::nature::{Nature, Relation, Role, Temper};

/// How far the mouth lies ahead of the middle, body lengths.
pub(crate) const MOUTH: f32 = 0.48;

/// Something to eat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morsel<'a> {
    /// What is seen or smelled of it.
    pub sighting: &'a Sighting,
    /// Its distance from the mouth, metres.
    pub distance: f32,
    /// What it costs to get it, metres: the distance, for prey with the surcharges of Tu 1996, 6.5.1.
    pub cost: f32,
}

/// The percepts of one tick, sorted by what they are to the fish.
#[derive(Clone, Debug)]
pub struct Situation<'a> {
    /// As the senses gave them.
    pub percepts: &'a Percepts,
    /// Own length, metres; never zero.
    pub length: f32,
    /// Predators in view with the fear of each.
    pub enemies: Vec<(&'a Sighting, f32)>,
    /// Food seen or smelled.
    pub food: Vec<Morsel<'a>>,
    /// Those of the other sex with which it might mate.
    pub mates: Vec<&'a Sighting>,
    /// Own kind in view within the radius of a school, nearest first.
    pub school: Vec<&'a Sighting>,
    /// Number and mean place of its own kind in view beyond that radius.
    pub strays: (u32, Vec3),
    /// Whom it follows, if it sees one.
    pub leader: Option<&'a Sighting>,
    /// How the water moves over ground, own frame, metres per second; at rest where no flow is felt.
    pub water: Vec3,
    /// What each of those in view is to it, in their order.
    relations: Vec<Relation>,
}

impl<'a> Situation<'a> {
    /// Sorts the percepts of a fish of this nature.
    pub fn new(percepts: &'a Percepts, nature: &Nature, temper: &Temper) -> Self {
        let length = percepts.body_length.max(1e-3);
        let relations = percepts.seen.iter().map(|one| nature.relation(&one.species)).collect();
        let felt = percepts.flow != Vec3::ZERO;
        let water = if felt { percepts.velocity + percepts.flow } else { Vec3::ZERO };
        let mut situation = Self {
            percepts,
            length,
            enemies: Vec::new(),
            food: Vec::new(),
            mates: Vec::new(),
            school: Vec::new(),
            strays: (0, Vec3::ZERO),
            leader: None,
            water,
            relations,
        };
        for (index, one) in percepts.seen.iter().enumerate() {
            situation.sort_in(one, situation.relations[index], nature, temper);
        }
        situation.strays.1 /= situation.strays.0.max(1) as f32;
        for one in &percepts.smelled {
            if !situation.food.iter().any(|known| known.sighting.id == one.id) {
                let morsel = situation.morsel(one, Role::Prey, temper);
                situation.food.push(morsel);
            }
        }
        situation
    }

    fn sort_in(&mut self, one: &'a Sighting, relation: Relation, nature: &Nature, temper: &Temper) {
        let distance = one.position.length() / self.length;
        if relation == Relation::Enemy && nature.role != Role::Predator {
            self.enemies.push((one, fear_of(distance, temper)));
        }
        if relation == Relation::Food {
            let morsel = self.morsel(one, nature.role, temper);
            self.food.push(morsel);
        }
        if relation == Relation::Kin && distance <= temper.school_radius {
            self.school.push(one);
        } else if relation == Relation::Kin {
            self.strays.0 += 1;
            self.strays.1 += one.position;
        }
        if nature.role.courts() && nature.might_mate(one) {
            self.mates.push(one);
        }
        if self.leader.is_none() && nature.follows(&one.species) {
            self.leader = Some(one);
        }
    }

    fn morsel(&self, sighting: &'a Sighting, role: Role, temper: &Temper) -> Morsel<'a> {
        let from_mouth = sighting.position - self.mouth();
        let distance = from_mouth.length();
        let cost = if role == Role::Predator {
            let schools = sighting.display.act == bioscope_core::Act::Schooling;
            let bearing = from_mouth.angle_between(Vec3::Z);
            let bearing = if bearing.is_finite() { bearing } else { 0.0 };
            let surcharge = temper.school_cost * f32::from(u8::from(schools))
                + temper.turn_cost * bearing / std::f32::consts::PI;
            distance * (1.0 + surcharge)
        } else {
            distance
        };
        Morsel { sighting, distance, cost }
    }

    /// All in view with what each is to the fish, nearest first.
    pub fn others(&self) -> impl Iterator<Item = (Relation, &'a Sighting)> + '_ {
        self.relations.iter().copied().zip(&self.percepts.seen)
    }

    /// Where the mouth is, own frame, metres.
    pub fn mouth(&self) -> Vec3 {
        Vec3::Z * (MOUTH * self.length)
    }

    /// A velocity over ground as one through the water, own frame, metres per second.
    pub fn through_water(&self, velocity: Vec3) -> Vec3 {
        velocity - self.water
    }

    /// Own speed through the water, metres per second.
    pub fn own_speed(&self) -> f32 {
        self.through_water(self.percepts.velocity).length()
    }

    /// The predator that is feared most, with that fear.
    pub fn worst_enemy(&self) -> Option<(&'a Sighting, f32)> {
        let all = self.enemies.iter().copied();
        all.reduce(|worst, one| if one.1 > worst.1 { one } else { worst })
    }

    /// Whether anybody is in view with whom to school.
    pub fn company(&self) -> bool {
        self.leader.is_some() || !self.school.is_empty() || self.strays.0 > 0
    }

    /// What is seen or smelled of one individual.
    pub fn find(&self, id: Id) -> Option<&'a Sighting> {
        let smelled = || self.percepts.smelled.iter().find(|one| one.id == id);
        self.percepts.seen.iter().find(|one| one.id == id).or_else(smelled)
    }

    /// What all this does to the drives.
    pub fn stirring(&self) -> Stirring {
        let nearest = |distances: &mut dyn Iterator<Item = f32>| {
            distances.reduce(f32::min).map(|distance| distance / self.length)
        };
        Stirring {
            dt: self.percepts.dt,
            fed: self.percepts.fed,
            food: nearest(&mut self.food.iter().map(|one| one.distance)),
            mate: nearest(&mut self.mates.iter().map(|one| one.position.length())),
            fear: self.enemies.iter().map(|one| one.1).sum(),
        }
    }

    /// How far light and temperature are from what its habits like, 0 being content; brightness counts in
    /// full daylights, temperature in tens of degrees.
    pub fn discomfort(&self, nature: &Nature, temper: &Temper) -> f32 {
        let (habits, percepts) = (&nature.habits, self.percepts);
        let mut discomfort = 0.0;
        if habits.bright != habits.dark {
            let lack = if habits.bright {
                temper.bright - percepts.light
            } else {
                percepts.light - temper.dark
            };
            discomfort += lack.max(0.0);
        }
        if habits.warm != habits.cold {
            let warmth = percepts.temperature;
            let lack = if habits.warm { temper.warm - warmth } else { warmth - temper.cold };
            discomfort += 0.1 * lack.max(0.0);
        }
        discomfort
    }
}
