use bioscope_core::{Id, NOTHING, Random};
use serde::{Deserialize, Serialize};

use super::Fatigue;
use crate::attention::{Behavior, Situation};
use crate::drives::Drives;
use crate::nature::{Nature, Role, Temper};

/// Difference of hunger and libido that counts as none (choice: equal numbers almost never occur).
const TIE: f32 = 0.02;

/// An interrupted intention.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Kept {
    behavior: Behavior,
    target: Id,
    /// Whether a better opportunity rather than danger interrupted it.
    opportunity: bool,
}

/// What bears on the intention beside the situation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Circumstances {
    /// Something threatens to collide.
    pub threatened: bool,
    /// A courtship gets on, so that it does not tire.
    pub courting: bool,
}

/// The intention generator with its memory for one thing (Tu 1996, 6.3; the tree is rebuilt from her text).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Generator {
    /// The current intention.
    pub behavior: Behavior,
    /// Its target; [`NOTHING`] if it has none.
    pub target: Id,
    memory: Option<Kept>,
    /// Whether the current intention was taken up again after an interruption.
    pub resumed: bool,
    hungry: Fatigue,
    amorous: Fatigue,
}

impl Generator {
    /// The intention of this tick.
    pub fn intend(
        &mut self,
        situation: &Situation,
        circumstances: Circumstances,
        (nature, temper, drives): (&Nature, &Temper, &Drives),
        random: &mut Random,
    ) -> Behavior {
        let before = self.behavior;
        let dt = situation.percepts.dt;
        let Circumstances { threatened, courting } = circumstances;
        // Only what is followed in vain tires.
        let (fed, tiring) = (situation.percepts.fed > 0, temper.fatigue_time);
        self.hungry.advance(before == Behavior::Eat && !fed, dt, tiring);
        self.amorous.advance(before == Behavior::Mate && !courting, dt, tiring);
        if fed {
            self.hungry = Fatigue::default();
        }
        let next = if threatened {
            self.remember(&[Behavior::Eat, Behavior::Mate, Behavior::School]);
            Behavior::Avoid
        } else if let Some(next) = afraid(situation, nature, temper, drives) {
            self.remember(&[Behavior::Eat, Behavior::Mate]);
            next
        } else if let Some(next) = self.resume(situation) {
            return self.take(next);
        } else if let Some(next) = self.driven(situation, (nature, temper, drives), random) {
            next
        } else {
            idle(situation, nature, temper)
        };
        if next != before {
            (self.target, self.resumed) = (NOTHING, false);
        }
        self.behavior = next;
        self.reclaim(situation);
        self.behavior
    }

    /// Keeps the current intention in mind if it is one of these. While it avoids or escapes nothing is
    /// overwritten.
    fn remember(&mut self, worth: &[Behavior]) {
        if worth.contains(&self.behavior) {
            let (behavior, target) = (self.behavior, self.target);
            self.memory = Some(Kept { behavior, target, opportunity: false });
        }
    }

    /// What danger interrupted, if it can be gone on with; else it is forgotten.
    fn resume(&mut self, situation: &Situation) -> Option<Kept> {
        let kept = self.memory.take_if(|kept| !kept.opportunity)?;
        let possible = match kept.behavior {
            Behavior::School => situation.company(),
            _ => kept.target != NOTHING && situation.find(kept.target).is_some(),
        };
        possible.then_some(kept)
    }

    fn take(&mut self, kept: Kept) -> Behavior {
        (self.behavior, self.target, self.resumed) = (kept.behavior, kept.target, true);
        self.behavior
    }

    /// Goes back to the target from which a better opportunity led away.
    fn reclaim(&mut self, situation: &Situation) {
        let behavior = self.behavior;
        if let Some(kept) =
            self.memory.take_if(|kept| kept.opportunity && kept.behavior == behavior)
            && situation.find(kept.target).is_some()
        {
            self.take(kept);
        }
    }

    /// Eating or mating, if a drive is strong enough after tiredness and inhibition.
    fn driven(
        &mut self,
        situation: &Situation,
        (nature, temper, drives): (&Nature, &Temper, &Drives),
        random: &mut Random,
    ) -> Option<Behavior> {
        let threshold = temper.drive_threshold;
        let mut hunger = self.hungry.weaken(drives.hunger, threshold);
        let libido = if nature.role.courts() { drives.libido } else { 0.0 };
        let mut libido = self.amorous.weaken(libido, threshold);
        let gain = if self.resumed { temper.inhibition } else { 0.0 };
        match self.behavior {
            Behavior::Eat => libido -= gain,
            Behavior::Mate => hunger -= gain,
            _ => {}
        }
        if hunger.max(libido) <= threshold {
            return None;
        }
        let before =
            matches!(self.behavior, Behavior::Eat | Behavior::Mate).then_some(self.behavior);
        let next = if (hunger - libido).abs() > TIE {
            if hunger > libido { Behavior::Eat } else { Behavior::Mate }
        } else if let Some(before) = before {
            before
        } else if random.uniform() < 0.5 {
            Behavior::Eat
        } else {
            Behavior::Mate
        };
        let tempted = before.is_some_and(|before| before != next);
        let kept_for_next = self.memory.is_some_and(|kept| kept.behavior == next);
        if tempted && !kept_for_next && situation.find(self.target).is_some() {
            let (behavior, target) = (self.behavior, self.target);
            self.memory = Some(Kept { behavior, target, opportunity: true });
        }
        Some(next)
    }
}

/// What fear asks for, if it is strong enough: to school while the worst predator is still far, to escape
/// when it is near.
fn afraid(
    situation: &Situation,
    nature: &Nature,
    temper: &Temper,
    drives: &Drives,
) -> Option<Behavior> {
    if !nature.role.flees() || drives.fear <= temper.fear_threshold {
        return None;
    }
    // A predator that is felt but not seen is behind.
    let worst = situation.worst_enemy().map_or(drives.fear, |(_, fear)| fear);
    let bearable = worst < temper.panic_threshold && nature.habits.school;
    Some(if bearable { Behavior::School } else { Behavior::Escape })
}

/// What is done without need: schooling for company, leaving an uncomfortable place, wandering.
fn idle(situation: &Situation, nature: &Nature, temper: &Temper) -> Behavior {
    let sociable = nature.habits.school && temper.sociable > 0.5;
    if nature.role.flees() && sociable && situation.company() {
        Behavior::School
    } else if nature.role != Role::Predator && situation.discomfort(nature, temper) > 0.0 {
        Behavior::Leave
    } else {
        Behavior::Wander
    }
}
