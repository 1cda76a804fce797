use bioscope_core::{Id, Impact, NOTHING, Sighting, Vec3};

use super::Situation;
use crate::nature::{Relation, Temper};

/// How far the eye and the feeler's root lie ahead of the middle, body lengths.
const SNOUT: f32 = 0.45;
/// Others smaller than this share of the own length are pushed aside, not steered round.
const NEGLIGIBLE: f32 = 0.2;
/// Points of another's centre line that are looked at.
const CENTER_LINE: usize = 7;

/// The collision sensitivity region: a box in the own frame in which others threaten to collide (Tu 1996,
/// section 5.5). Large for timid, small for bold fishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Reach ahead, behind and aside, body lengths.
    pub reach: [f32; 3],
    /// Factor on it for the partner, which one wants to touch.
    pub partner: (Id, f32),
}

impl Region {
    /// The region of a fish of this temper, shrunk by `factor` (in formation), and to the body towards a
    /// partner.
    pub fn new(temper: &Temper, factor: f32, partner: Id) -> Self {
        let size = temper.timidity * factor;
        let reach = [temper.box_ahead, temper.box_behind, temper.box_aside].map(|one| one * size);
        Self { reach, partner: (partner, 0.3) }
    }

    /// The share of a fish's centre line that lies inside, 0 to 1.
    pub fn share(&self, other: &Sighting, length: f32) -> f32 {
        let (partner, shrunk) = self.partner;
        let factor = if other.id == partner && partner != NOTHING { shrunk } else { 1.0 } * length;
        let [ahead, behind, aside] = self.reach.map(|one| one * factor);
        let inside = |point: Vec3| {
            point.x.abs() < aside && point.y.abs() < aside && point.z < ahead && point.z > -behind
        };
        let line = (0..CENTER_LINE).map(|index| {
            let along = index as f32 / (CENTER_LINE - 1) as f32 - 0.5;
            other.position + other.heading * (along * other.size)
        });
        line.filter(|&point| inside(point)).count() as f32 / CENTER_LINE as f32
    }
}

/// What threatens to collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threat<'a> {
    /// Something solid ahead.
    Solid(Impact),
    /// Another animal in the region.
    Animal(&'a Sighting),
}

impl<'a> Threat<'a> {
    /// The worst threat: the solid that the feeler meets, else the animal of which most is in the region.
    pub fn worst(situation: &Situation<'a>, region: &Region, temper: &Temper) -> Option<Self> {
        let length = situation.length;
        let solid = situation.percepts.ahead;
        if let Some(impact) = solid.filter(|one| one.distance <= (temper.antenna + SNOUT) * length)
        {
            return Some(Self::Solid(impact));
        }
        let (ahead, aside) =
            (region.reach[0].max(region.reach[1]) * length, region.reach[2] * length);
        let mut worst: Option<(f32, &Sighting)> = None;
        for (relation, one) in situation.others() {
            // Too far for any part of it to be inside, or not to be dodged.
            let reach = ahead + 0.5 * one.size;
            if one.position.length_squared() > reach * reach + 2.0 * aside * aside
                || one.size < NEGLIGIBLE * length
                || relation == Relation::Food
            {
                continue;
            }
            let share = region.share(one, length);
            if share > 0.0 && worst.is_none_or(|(most, _)| share > most) {
                worst = Some((share, one));
            }
        }
        worst.map(|(_, one)| Self::Animal(one))
    }

    /// Where it is, own frame, metres.
    pub fn position(&self) -> Vec3 {
        match self {
            Self::Solid(impact) => Vec3::Z * impact.distance,
            Self::Animal(one) => one.position,
        }
    }
}
