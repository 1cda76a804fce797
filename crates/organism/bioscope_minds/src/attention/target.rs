use bioscope_core::{Id, NOTHING, Vec3};

use super::{Preferences, Skill, azimuth};

/// Candidates whose choice preferences may change.
const CONSIDERED: usize = 3;

/// One of several things to be gone for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Whose identity.
    pub id: Id,
    /// Where it is, own frame, metres.
    pub position: Vec3,
    /// How desirable it is, 0 to 1.
    pub desirability: f32,
    /// What it costs to reach it, in body lengths.
    pub cost: f32,
}

/// The target of choice (Tu 1996, 5.4 and 6.3.2): the most desirable, unless a motor preference weighted with
/// `weight` makes up for less desirability; the `current` one is kept unless the other is cheaper by more
/// than `persistence` body lengths.
pub fn choose(
    candidates: &mut [Candidate],
    preferences: &Preferences,
    current: Id,
    (weight, persistence): (f32, f32),
) -> Option<Candidate> {
    candidates.sort_by(|a, b| b.desirability.total_cmp(&a.desirability).then(a.id.cmp(&b.id)));
    let first = *candidates.first()?;
    // Twice the weight is the most that preferences between -1 and 1 can make up for.
    let clear =
        candidates.len() == 1 || first.desirability - candidates[1].desirability > 2.0 * weight;
    let best = if clear { first } else { preferred(candidates, preferences, weight) };
    let kept = candidates.iter().find(|one| one.id == current && current != NOTHING);
    match kept {
        Some(kept) if kept.cost - best.cost <= persistence => Some(*kept),
        _ => Some(best),
    }
}

fn preferred(candidates: &[Candidate], preferences: &Preferences, weight: f32) -> Candidate {
    let score = |one: &Candidate| {
        let angle = azimuth(one.position);
        let skill = if angle.abs() < std::f32::consts::FRAC_PI_6 {
            Skill::Forward
        } else if angle > 0.0 {
            Skill::Left
        } else {
            Skill::Right
        };
        one.desirability + weight * preferences.of(skill)
    };
    let mut best = candidates[0];
    for one in &candidates[1..candidates.len().min(CONSIDERED)] {
        if score(one) > score(&best) {
            best = *one;
        }
    }
    best
}
