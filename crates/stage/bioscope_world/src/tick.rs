use std::sync::Arc;

use bioscope_core::Result;
use bioscope_geometry::Scene;

use crate::{Growth, Population, Publication, World};

impl World {
    /// Makes one tick: sense, decide, move, grow, publish, each for every population before the
    /// next begins. If a verb fails, the world is back at the last complete tick.
    pub fn tick(&mut self) -> Result<()> {
        let may_fail = self.populations.iter().any(|one| one.population.may_fail());
        let before = if may_fail { Some(self.save_state()?) } else { None };
        let outcome = self.five_verbs();
        if let (Err(_), Some(before)) = (&outcome, before) {
            self.restore_state(&before)?;
        }
        outcome
    }

    fn five_verbs(&mut self) -> Result<()> {
        let tick = self.tick + 1;
        self.each(tick, |population, view| population.sense(view))?;
        self.each(tick, |population, view| population.decide(view))?;
        self.each(tick, |population, view| population.advance(view))?;
        let moment = self.moment(tick);
        for resident in &mut self.populations {
            let mut growth = Growth {
                moment,
                scene: &self.scene,
                events: &self.latest,
                environment: &mut self.environment,
                next_id: &mut self.next_id,
            };
            resident.population.grow(&mut growth)?;
        }
        self.tick = tick;
        self.publish()?;
        self.events.extend_from_slice(&self.latest);
        Ok(())
    }

    /// One verb on every population; what they see is the published past.
    fn each(
        &mut self,
        tick: u64,
        mut verb: impl FnMut(&mut dyn Population, &crate::View) -> Result<()>,
    ) -> Result<()> {
        let mut populations = std::mem::take(&mut self.populations);
        let view = self.view(self.moment(tick));
        let outcome =
            populations.iter_mut().try_for_each(|one| verb(one.population.as_mut(), &view));
        self.populations = populations;
        outcome
    }

    /// Publishes the present state again, after a change from outside.
    pub fn publish_again(&mut self) -> Result<()> {
        self.publish()
    }

    /// Rebuilds scene, sounds and the tick's events from the state.
    pub(crate) fn publish(&mut self) -> Result<()> {
        let moment = self.moment(self.tick);
        let scene = Scene { tick: moment.tick, time: moment.time, ..Scene::default() };
        let mut publication = Publication { moment, scene, sounds: Vec::new(), events: Vec::new() };
        self.environment.publish(&mut publication.scene);
        publication.scene.rigs.clone_from(&self.rigs);
        for resident in &self.populations {
            resident.population.publish(&mut publication)?;
        }
        self.scene = Arc::new(publication.scene);
        self.sounds = publication.sounds;
        self.latest = publication.events;
        Ok(())
    }
}
