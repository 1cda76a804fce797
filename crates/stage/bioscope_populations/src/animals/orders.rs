//! What animals can be told from outside: to be more or fewer, to be elsewhere, to differ, to obey somebody
//! instead of their mind.

use bioscope_core::{Error, Id, Intention, Parameters, Result, Vec3};
use bioscope_world::{Growth, Order, Steering, no_such_order};

use super::individual::Individual;
use super::settings;
use super::{Animals, population};

/// What a steered animal is said to do.
const STEERED: &str = "steered";

impl Animals {
    pub(super) fn follow(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        match order {
            Order::Number(count) => self.number(*count, growth),
            Order::Remove(id) => {
                let index = self.index(*id)?;
                self.individuals.remove(index);
                Ok(())
            }
            Order::Place { id, position, scale } => {
                if *scale != 1.0 {
                    return Err(no_such_order("animals", order));
                }
                let one = &mut self.find(*id)?.parts.body;
                let ahead = one.placement().rotation() * Vec3::Z;
                one.put(*position, ahead);
                Ok(())
            }
            Order::Trait { id, name, value } => {
                let parameter = self.described(name)?;
                parameter.check(*value)?;
                let one = self.find(*id)?;
                settings::set_one(one, name, *value)
            }
            Order::Steer { id, steering } => {
                self.find(*id)?.record.steering = *steering;
                Ok(())
            }
        }
    }

    fn index(&self, id: Id) -> Result<usize> {
        let index = self.individuals.iter().position(|one| one.id == id);
        index.ok_or_else(|| Error::value("id", id, "an animal of this population"))
    }

    fn find(&mut self, id: Id) -> Result<&mut Individual> {
        let index = self.index(id)?;
        Ok(&mut self.individuals[index])
    }

    /// Lets the youngest go, or newcomers come: made as the first of them were, with the parameters that those
    /// now have.
    fn number(&mut self, count: usize, growth: &mut Growth) -> Result<()> {
        population::check_count(count)?;
        let missing = count.saturating_sub(self.individuals.len());
        self.individuals.truncate(count);
        if missing == 0 {
            return Ok(());
        }
        if self.patterns.is_empty() {
            return Err(Error::value("number", count, "0, as there is none to take after"));
        }
        let patterns =
            self.patterns.iter().cycle().skip(self.individuals.len() % self.patterns.len());
        let newcomers = patterns.take(missing).map(|pattern| self.rebuild(pattern.clone()));
        let mut newcomers = newcomers.collect::<Result<Vec<_>>>()?;
        let known: Vec<_> = self.descriptions().into_iter().map(|one| one.name).collect();
        for newcomer in &mut newcomers {
            for name in known.iter().filter(|name| !settings::is_innate(name)) {
                if let Some(value) = self.get(name) {
                    settings::set_one(newcomer, name, value)?;
                }
            }
        }
        let ids = growth.identities(missing)?;
        for (mut newcomer, id) in newcomers.into_iter().zip(ids) {
            population::be_born(&mut newcomer, id, &self.options, growth);
            self.individuals.push(newcomer);
        }
        Ok(())
    }
}

/// What is commanded in place of what a mind wants.
pub(super) fn commanded(
    steering: &Steering,
    wanted: &Intention,
    mouthful: Option<Id>,
) -> Intention {
    let Steering { turn, pitch, speed, brake, mouth } = *steering;
    let (sine, level) = (bioscope_core::math::sin(pitch), bioscope_core::math::cos(pitch));
    let (aside, ahead) = (bioscope_core::math::sin(turn), bioscope_core::math::cos(turn));
    Intention {
        behavior: STEERED.into(),
        heading: Vec3::new(level * aside, sine, level * ahead),
        speed,
        urgency: (speed.abs() / 4.0).min(1.0),
        brake,
        mouth,
        target: mouthful,
        display: bioscope_core::Display { act: Default::default(), partner: 0, ..wanted.display },
        ..Intention::default()
    }
}
