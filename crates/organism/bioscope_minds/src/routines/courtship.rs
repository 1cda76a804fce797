use std::f32::consts::{FRAC_PI_3, TAU};

use bioscope_core::{Act, Id, NOTHING, Percepts, Sex, Sighting, Vec3, math};
use serde::{Deserialize, Serialize};

use super::{Chase, Command, chase};
use crate::attention::{Candidate, Preferences, Situation, choose};
use crate::nature::{Nature, Relation, Temper};

/// Deviation from the partner swum through without a turn, radians (choice).
const TOLERANCE: f32 = std::f32::consts::FRAC_PI_6;
/// Seconds without sight or heed of the partner after which it is given up.
const PATIENCE: f64 = 4.0;
/// The same once they circle: who is followed closely has its follower behind, out of sight.
const PATIENCE_IN_PAIR: f64 = 15.0;
/// Seconds after which a stage that does not come to its end is begun anew.
const STAGE_LIMIT: f64 = 40.0;
/// Seconds for which it shows that it has spawned.
const AFTERGLOW: f64 = 3.0;
/// Seconds of a loop that lead away from the female.
const LOOP_TIME: f64 = 0.8;
/// Where a partner out of sight is sought, radians from straight ahead.
const BEHIND: f32 = 2.6;
/// Deviation of a tail on the other side from which it is reached by going on round, radians.
const ROUND: f32 = 1.2;
/// Seconds for which those who rejected it are not courted again.
const GRUDGE: f64 = 20.0;
/// Most of those.
const GRUDGES: usize = 8;

/// Where a courtship stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Stage {
    /// Looks for a partner.
    #[default]
    Seek,
    /// Follows one that does not want to mate yet.
    Follow,
    /// A male loops before one that wants another.
    Display,
    /// He loops before her, she hovers and bobs her head.
    Loop,
    /// Each chases the other's tail.
    Circle,
    /// She rises to spawn, he follows her abdomen.
    Ascend,
    /// He touches her abdomen from below, backs off, touches again.
    Nuzzle,
}

/// The routine mating with its subroutines looping, circling, ascending and nuzzling: a fixed action pattern
/// as a machine of states (Tu 1996, 6.5.3; numbers of loops and touches after Terzopoulos, Tu and
/// Grzeszczuk 1994 and the film).
///
/// Each of a pair runs its own machine and knows of the other only what it shows. Repaired: the author's
/// male need only be near the point before the female's head; as one that is there would stay, he swims a
/// loop after each arrival.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Courtship {
    /// Whom it courts.
    pub partner: Id,
    /// Where that stands.
    pub stage: Stage,
    /// World time at which the stage began, seconds.
    since: f64,
    /// World time at which the partner was last seen, and at which it last courted back.
    seen: f64,
    heeded: f64,
    /// Side on which it was last seen, +1 left, −1 right.
    side: f32,
    /// World time up to which it swims a loop or backs off.
    busy_until: f64,
    /// Loops or touches so far.
    pub count: u32,
    /// Angle turned through while circling, radians, and the bearing in the world up to which it was counted.
    turned: f32,
    bearing: Option<f32>,
    /// Sense in which they circle, +1 to the left, −1 to the right; 0 not decided.
    sense: f32,
    /// World time up to which it shows that it has spawned.
    spawned_until: f64,
    /// Those who would not have it, and until when they are avoided.
    rejected: Vec<(Id, f64)>,
}

impl Courtship {
    /// What it shows of its courtship.
    pub fn act(&self, time: f64, courting: bool) -> Act {
        if time < self.spawned_until {
            return Act::Spawned;
        }
        match self.stage {
            _ if !courting => Act::Other,
            Stage::Seek | Stage::Follow | Stage::Display | Stage::Loop => Act::Courting,
            Stage::Circle => Act::Circling,
            Stage::Ascend => Act::Ascending,
            Stage::Nuzzle => Act::Nuzzling,
        }
    }

    /// Goes on courting; nothing if there is nobody to court. Whether both have spawned comes with it.
    pub fn advance(
        &mut self,
        situation: &Situation,
        nature: &Nature,
        temper: &Temper,
        preferences: &Preferences,
    ) -> (Option<Command>, bool) {
        let now = situation.percepts.time;
        self.rejected.retain(|&(_, until)| now < until);
        self.select(situation, nature, temper, preferences);
        if self.stage == Stage::Circle {
            self.count_turns(situation.percepts);
        }
        let Some(partner) = situation.find(self.partner).filter(|_| self.partner != NOTHING) else {
            if self.partner != NOTHING && now - self.seen > self.patience() {
                self.begin(NOTHING, now);
            }
            let command = self.unseen(situation, nature, temper);
            return ((self.partner != NOTHING).then_some(command), false);
        };
        self.side = if partner.position.x < 0.0 { -1.0 } else { 1.0 };
        self.seen = now;
        self.transit(partner, situation, nature, temper);
        let female = nature.habits.female;
        let command = match self.stage {
            Stage::Seek => return (None, false),
            Stage::Follow => follow(partner, situation, temper),
            Stage::Display | Stage::Loop if female => hover(now),
            Stage::Display | Stage::Loop => self.swim_loop(partner, situation, temper),
            Stage::Circle => self.circle(partner, situation, temper),
            Stage::Ascend if female => rise(situation, temper),
            Stage::Nuzzle if female => hover(now),
            Stage::Ascend => {
                toward(abdomen(partner, situation), partner.velocity, situation, temper)
            }
            Stage::Nuzzle => self.nuzzle(partner, situation, temper),
        };
        let spawned = self.stage == Stage::Nuzzle
            && if female {
                partner.display.act == Act::Spawned
            } else {
                self.count >= temper.touches as u32
            };
        if spawned {
            self.spawned_until = now + AFTERGLOW;
            self.begin(NOTHING, now);
        }
        (Some(command), spawned)
    }

    /// What it does while its partner is out of sight for a moment: she goes on with what she did, he turns to
    /// where she was.
    fn unseen(&mut self, situation: &Situation, nature: &Nature, temper: &Temper) -> Command {
        let (female, now) = (nature.habits.female, situation.percepts.time);
        if female && self.stage == Stage::Ascend {
            if situation.percepts.depth <= temper.spawning_depth {
                self.enter(Stage::Nuzzle, now);
            }
            return rise(situation, temper);
        }
        if female && matches!(self.stage, Stage::Loop | Stage::Nuzzle) {
            return hover(now);
        }
        let side = if self.sense == 0.0 { self.side } else { self.sense };
        Command { turn: BEHIND * side, ..Command::ahead(0.7 * temper.cruise_speed) }
    }

    /// Whether it has a partner of whom it knew a moment ago.
    pub fn lasts(&self, now: f64) -> bool {
        self.partner != NOTHING && now - self.seen <= self.patience()
    }

    fn patience(&self) -> f64 {
        if self.stage >= Stage::Circle { PATIENCE_IN_PAIR } else { PATIENCE }
    }

    fn begin(&mut self, partner: Id, now: f64) {
        self.partner = partner;
        let stage = if partner == NOTHING { Stage::Seek } else { Stage::Follow };
        self.enter(stage, now);
        self.seen = now;
    }

    fn enter(&mut self, stage: Stage, now: f64) {
        (self.stage, self.since) = (stage, now);
        (self.count, self.turned, self.busy_until) = (0, 0.0, 0.0);
        (self.bearing, self.sense) = (None, 0.0);
    }

    fn give_up(&mut self, now: f64) {
        self.rejected.push((self.partner, now + GRUDGE));
        if self.rejected.len() > GRUDGES {
            self.rejected.remove(0);
        }
        self.begin(NOTHING, now);
    }

    /// Chooses a partner, or another one: the male by species and nearness, the female by species and size
    /// (weights 0.6 and 0.4: choice). Once they loop only a better male that courts her changes her mind.
    fn select(
        &mut self,
        situation: &Situation,
        nature: &Nature,
        temper: &Temper,
        preferences: &Preferences,
    ) {
        if self.stage > Stage::Loop || (self.stage == Stage::Loop && !nature.habits.female) {
            return;
        }
        let in_view = situation.mates.iter().any(|one| one.id == self.partner);
        if self.stage == Stage::Loop && !in_view && self.lasts(situation.percepts.time) {
            // He loops behind her for a moment.
            return;
        }
        let largest = situation.mates.iter().map(|one| one.size).fold(1e-6, f32::max);
        let own = situation.percepts.id;
        let mut candidates: Vec<Candidate> = Vec::new();
        for one in &situation.mates {
            let courts_me = one.display.act.mating() && one.display.partner == own;
            if self.rejected.iter().any(|(id, _)| *id == one.id)
                || (self.stage == Stage::Loop && one.id != self.partner && !courts_me)
            {
                continue;
            }
            let distance = one.position.length() / situation.length;
            let merit = match nature.sex() {
                Sex::Female => one.size / largest,
                _ => (1.0 - distance / temper.sight_range).max(0.0),
            };
            let same = if nature.relation(&one.species) == Relation::Kin { 0.6 } else { 0.0 };
            let desirability = same + 0.4 * merit;
            candidates.push(Candidate {
                id: one.id,
                position: one.position,
                desirability,
                cost: distance,
            });
        }
        // A female does not weigh distance, so nearness must not keep her.
        let weights = match nature.sex() {
            Sex::Female => (0.0, -1000.0),
            _ => (temper.preference_weight, temper.persistence),
        };
        if let Some(chosen) = choose(&mut candidates, preferences, self.partner, weights)
            && chosen.id != self.partner
        {
            self.begin(chosen.id, situation.percepts.time);
        }
    }

    /// Goes from stage to stage as the partner's display and the own counts ask for.
    fn transit(
        &mut self,
        partner: &Sighting,
        situation: &Situation,
        nature: &Nature,
        temper: &Temper,
    ) {
        let now = situation.percepts.time;
        let shown = partner.display;
        let wants = shown.act.mating() && shown.act != Act::Spawned;
        let mine = wants && shown.partner == situation.percepts.id;
        let female = nature.habits.female;
        let near = partner.position.length() < 1.5 * situation.length;
        if mine {
            self.heeded = now;
        }
        let another = wants && !mine && shown.partner != NOTHING;
        let next = match self.stage {
            Stage::Seek | Stage::Follow | Stage::Display if mine => Stage::Loop,
            Stage::Seek | Stage::Follow if another => {
                if female {
                    // He wants another: she looks for somebody else.
                    return self.give_up(now);
                }
                Stage::Display
            }
            Stage::Seek => Stage::Follow,
            Stage::Display if now - self.since > f64::from(temper.display_time) => {
                return self.give_up(now);
            }
            Stage::Display if !wants => Stage::Follow,
            Stage::Loop | Stage::Circle | Stage::Ascend if another => return self.give_up(now),
            stage if stage > Stage::Display && now - self.heeded > self.patience() => Stage::Follow,
            Stage::Loop if !female && self.count > temper.loops as u32 => Stage::Circle,
            Stage::Loop if female && shown.act == Act::Circling => Stage::Circle,
            Stage::Circle if female && self.turned.abs() >= TAU * temper.turns => Stage::Ascend,
            Stage::Circle if !female && shown.act >= Act::Ascending => Stage::Ascend,
            Stage::Ascend if female && situation.percepts.depth <= temper.spawning_depth => {
                Stage::Nuzzle
            }
            Stage::Ascend if !female && shown.act == Act::Nuzzling && near => Stage::Nuzzle,
            stage if stage > Stage::Display && now - self.since > STAGE_LIMIT => Stage::Follow,
            stage => stage,
        };
        if next != self.stage {
            self.enter(next, now);
        }
    }

    /// Looping: chases a point before and above her head that moves up and down, and swims a loop away from it
    /// after each arrival.
    fn swim_loop(&mut self, partner: &Sighting, situation: &Situation, temper: &Temper) -> Command {
        let now = situation.percepts.time;
        if now < self.busy_until {
            let away = Command { turn: 1.0, pitch: 0.5, ..Command::default() };
            return Command { speed: temper.cruise_speed, ..away };
        }
        let up = situation.percepts.attitude.inverse() * Vec3::Y;
        let swing = math::sin(math::TAU * ((now / 2.0).fract() as f32));
        let before = partner.heading * (0.5 * partner.size + 0.35 * situation.length);
        let point = partner.position + before + up * (0.2 * (1.0 + swing) * partner.size);
        if point.distance(situation.mouth()) < 0.35 * situation.length {
            self.count += 1;
            self.busy_until = now + LOOP_TIME;
        }
        toward(point - situation.mouth(), partner.velocity, situation, temper)
    }

    /// Circling: chases the partner's tail, on and on to the same side. Both see alike which side that is: the one to
    /// which each goes round the other as it begins.
    fn circle(&mut self, partner: &Sighting, situation: &Situation, temper: &Temper) -> Command {
        if self.sense == 0.0 {
            let relative = partner.velocity - situation.percepts.velocity;
            self.sense = if partner.position.cross(relative).y < 0.0 { -1.0 } else { 1.0 };
        }
        let tail = partner.position - partner.heading * (0.5 * partner.size);
        let command = toward(tail, partner.velocity, situation, temper);
        if command.turn * self.sense >= 0.0 {
            return command;
        }
        // On the other side: goes on, or, where it is behind, round.
        let turn = if command.turn.abs() > ROUND { ROUND * self.sense } else { 0.0 };
        Command { turn, ..command }
    }

    /// Adds up the angle turned through.
    fn count_turns(&mut self, percepts: &Percepts) {
        let ahead = percepts.attitude * Vec3::Z;
        let bearing = math::atan2(ahead.x, ahead.z);
        if let Some(before) = self.bearing {
            let turn = bearing - before;
            let whole = if turn > math::PI {
                -TAU
            } else if turn < -math::PI {
                TAU
            } else {
                0.0
            };
            self.turned += turn + whole;
        }
        self.bearing = Some(bearing);
    }

    /// Nuzzling: up to her abdomen from below until the mouth touches it, then back.
    fn nuzzle(&mut self, partner: &Sighting, situation: &Situation, temper: &Temper) -> Command {
        let now = situation.percepts.time;
        if now < self.busy_until {
            return Command { speed: -0.6 * temper.cruise_speed, ..Command::default() };
        }
        let target = abdomen(partner, situation) - situation.mouth();
        if target.length() < 0.2 * situation.length {
            self.count += 1;
            self.busy_until = now + f64::from(temper.back_off);
        }
        let mut command = toward(target, partner.velocity, situation, temper);
        command.speed = command.speed.min(0.8 * temper.cruise_speed);
        command
    }
}

/// A point under the middle of the partner, own frame.
fn abdomen(partner: &Sighting, situation: &Situation) -> Vec3 {
    let up = situation.percepts.attitude.inverse() * Vec3::Y;
    partner.position - up * (0.2 * partner.size)
}

fn follow(partner: &Sighting, situation: &Situation, temper: &Temper) -> Command {
    approach(partner.position, partner.velocity, situation.length, situation, temper)
}

fn toward(target: Vec3, velocity: Vec3, situation: &Situation, temper: &Temper) -> Command {
    approach(target, velocity, 0.0, situation, temper)
}

fn approach(
    target: Vec3,
    velocity: Vec3,
    stop: f32,
    situation: &Situation,
    temper: &Temper,
) -> Command {
    // The partner waits or is gone after: only what leads away from here counts, not that it bobs and sways.
    let way = target.normalize_or_zero();
    let velocity = way * situation.through_water(velocity).dot(way).max(0.0);
    let goal = Chase { target, velocity, tolerance: TOLERANCE, lead: 0.0, stop };
    chase(&goal, situation.length, situation.own_speed(), temper)
}

/// Stays where it is and bobs its head.
fn hover(now: f64) -> Command {
    let swing = math::sin(math::TAU * (now.fract() as f32));
    Command { pitch: 0.15 * swing, brake: 0.8, ..Command::default() }
}

/// Swims up fast.
fn rise(situation: &Situation, temper: &Temper) -> Command {
    let up = situation.percepts.attitude.inverse() * Vec3::Y;
    let climb = Command::toward(up + Vec3::Z * 0.6, 0.7 * temper.full_speed);
    Command { turn: 0.0, pitch: climb.pitch.min(FRAC_PI_3), ..climb }
}
