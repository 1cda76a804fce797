use serde::{Deserialize, Serialize};

use crate::attention::Behavior;

/// What can be the case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predicate {
    /// Something threatens to collide.
    Threatened,
    /// A predator is feared.
    Afraid,
    /// Own kind or a leader is in view.
    CompanySeen,
    /// Food is seen or smelled.
    FoodNoticed,
    /// A possible mate is in view.
    MateSeen,
    /// Light or temperature are not to its liking.
    Uncomfortable,
}

/// Truth of all predicates.
pub type Facts = [bool; 6];

/// How much each node's goal is wanted, 0 to 1.
pub type Wants = [f32; NODES];

/// A behavior with what it needs, what it may bring about, and what it must not go along with.
struct Node {
    behavior: Behavior,
    needs: Option<Predicate>,
    brings: Option<Predicate>,
    conflicts: &'static [usize],
}

/// How many nodes there are.
pub const NODES: usize = 9;

const ESCAPE: usize = 1;
const SCHOOL: usize = 2;
const FEED: usize = 3;
const FORAGE: usize = 4;
const COURT: usize = 5;
const SEEK: usize = 6;
const LEAVE: usize = 7;
const WANDER: usize = 8;

const NETWORK: [Node; NODES] = [
    node(
        Behavior::Avoid,
        Some(Predicate::Threatened),
        None,
        &[ESCAPE, SCHOOL, FEED, COURT, WANDER],
    ),
    node(Behavior::Escape, Some(Predicate::Afraid), None, &[SCHOOL, FEED, COURT, WANDER]),
    node(Behavior::School, Some(Predicate::CompanySeen), None, &[FEED, COURT]),
    node(Behavior::Eat, Some(Predicate::FoodNoticed), None, &[COURT, SEEK]),
    node(Behavior::Eat, None, Some(Predicate::FoodNoticed), &[COURT]),
    node(Behavior::Mate, Some(Predicate::MateSeen), None, &[FEED, FORAGE]),
    node(Behavior::Mate, None, Some(Predicate::MateSeen), &[FEED]),
    node(Behavior::Leave, Some(Predicate::Uncomfortable), None, &[WANDER]),
    node(Behavior::Wander, None, None, &[LEAVE]),
];

const fn node(
    behavior: Behavior,
    needs: Option<Predicate>,
    brings: Option<Predicate>,
    conflicts: &'static [usize],
) -> Node {
    Node { behavior, needs, brings, conflicts }
}

/// Activation that a true predicate gives, `φ` (Maes 1989: 20).
const FROM_FACTS: f32 = 20.0;
/// Activation that a wanted goal gives, `γ` (Maes 1989: 70).
const FROM_WANTS: f32 = 70.0;
/// Activation that a protected goal or a conflict takes, `δ` (Maes 1989: 50).
const TAKEN: f32 = 50.0;
/// Mean activation, `π` (Maes 1989: 20).
const MEAN: f32 = 20.0;
/// Threshold of activation, `θ` (Maes 1989: 45), and by what it falls while nothing reaches it.
const THRESHOLD: f32 = 45.0;
const FALL: f32 = 0.9;
/// Spreading steps per decision: the network settles within a few ticks (choice).
pub const STEPS: usize = 6;

/// Activations of the network.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    activation: [f32; NODES],
    threshold: f32,
    winner: usize,
}

impl Default for Network {
    fn default() -> Self {
        Self { activation: [MEAN; NODES], threshold: THRESHOLD, winner: WANDER }
    }
}

impl Network {
    /// Spreads activation once and returns the behavior that wins.
    pub fn step(&mut self, facts: &Facts, wants: &Wants) -> Behavior {
        let executable = |one: usize| NETWORK[one].needs.is_none_or(|need| facts[need as usize]);
        let before = self.activation;
        let mut next = before;
        for one in 0..NODES {
            let node = &NETWORK[one];
            if node.needs.is_some_and(|need| facts[need as usize]) {
                next[one] += FROM_FACTS;
            }
            next[one] += FROM_WANTS * wants[one];
            for (other, target) in NETWORK.iter().enumerate() {
                if other == one {
                    continue;
                }
                // Forward, to those that this one may soon make executable.
                if executable(one) && brings(node, target, facts) {
                    next[other] += before[one] * FROM_FACTS / FROM_WANTS;
                }
                // Backward, to those that may make this one executable.
                if !executable(one) && brings(target, node, facts) {
                    next[other] += before[one];
                }
            }
            for &other in node.conflicts {
                let stronger = before[one] > before[other];
                if executable(one) && stronger {
                    next[other] -= before[one] * TAKEN / FROM_WANTS;
                }
            }
        }
        self.settle(next);
        self.choose(executable)
    }

    /// Cuts off below zero and scales to the mean.
    fn settle(&mut self, next: [f32; NODES]) {
        let cut = next.map(|one| one.max(0.0));
        let sum: f32 = cut.iter().sum();
        let scale = if sum > 0.0 { NODES as f32 * MEAN / sum } else { 0.0 };
        self.activation = cut.map(|one| one * scale);
    }

    fn choose(&mut self, executable: impl Fn(usize) -> bool) -> Behavior {
        let able = (0..NODES).filter(|&one| executable(one));
        let best =
            able.reduce(
                |best, one| {
                    if self.activation[one] > self.activation[best] { one } else { best }
                },
            );
        match best.filter(|&best| self.activation[best] >= self.threshold) {
            Some(best) => (self.winner, self.threshold) = (best, THRESHOLD),
            None => {
                self.threshold *= FALL;
                if !executable(self.winner) {
                    self.winner = WANDER;
                }
            }
        }
        NETWORK[self.winner].behavior
    }
}

fn brings(one: &Node, other: &Node, facts: &Facts) -> bool {
    one.brings.is_some_and(|fact| other.needs == Some(fact) && !facts[fact as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(facts: Facts, wants: Wants) -> Behavior {
        let mut network = Network::default();
        (0..40).map(|_| network.step(&facts, &wants)).last().unwrap()
    }

    #[test]
    fn the_most_wanted_executable_behavior_wins() {
        let wants = |pairs: &[(usize, f32)]| {
            let mut wants = [0.0; NODES];
            pairs.iter().for_each(|&(node, want)| wants[node] = want);
            wants
        };
        let nothing = [false; 6];
        let mut food = nothing;
        food[Predicate::FoodNoticed as usize] = true;
        assert_eq!(settled(nothing, wants(&[(WANDER, 0.2)])), Behavior::Wander);
        assert_eq!(settled(food, wants(&[(FEED, 0.9), (WANDER, 0.2)])), Behavior::Eat);
        let mut danger = food;
        danger[Predicate::Afraid as usize] = true;
        let both = wants(&[(FEED, 0.9), (ESCAPE, 1.0)]);
        assert_eq!(settled(danger, both), Behavior::Escape);
        // Nothing to eat in sight: hunger flows backward from feeding to foraging.
        assert_eq!(settled(nothing, wants(&[(FEED, 0.9), (WANDER, 0.1)])), Behavior::Eat);
    }

    #[test]
    fn activation_keeps_its_mean_and_the_threshold_falls_until_somebody_wins() {
        let mut network = Network::default();
        for _ in 0..30 {
            network.step(&[false; 6], &[0.0; NODES]);
        }
        let mean = network.activation.iter().sum::<f32>() / NODES as f32;
        assert!((mean - MEAN).abs() < 1e-3, "{mean}");
    }
}
