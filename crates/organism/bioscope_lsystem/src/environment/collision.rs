//! Space: branches that stop where leaves of others already are, and plants that crowd each other out.

use bioscope_core::{Vec3, state};
use serde::{Deserialize, Serialize};

use super::cells::Cells;
use super::settings::{Settings, bounded};
use super::{Environment, EnvironmentError, Reply, Request};

/// Clusters of leaves as discs: an apex stops inside a cluster that is not its mother's.
///
/// A message `?E(x)` puts a cluster of vigor x here, for good; the answer is 1 if the apex may
/// grow on and 0 if it may not. Among the clusters of one step the more vigorous wins; of equal
/// ones both stop. The mother of an apex is the cluster straight behind it.
///
/// Source: R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, section 4.1, after H. Honda (1981). That
/// messages of one step are answered together and mothers do not count are choices with which
/// the published numbers of segments come out.
#[derive(Clone, Debug)]
pub struct Collision {
    radius: f32,
    clusters: Vec<Cluster>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Cluster {
    center: Vec3,
    vigor: f32,
    mother: Option<usize>,
}

/// How far from the line behind an apex its mother may be, of its distance.
const STRAIGHT: f32 = 1e-3;
/// Most clusters.
const MOST: usize = 2_000_000;

impl Collision {
    /// Clusters of this radius; the given ones stand from the start.
    pub fn new(radius: f32, standing: &[Vec3]) -> Self {
        let clusters = standing.iter();
        let cluster = |&center: &Vec3| Cluster { center, vigor: f32::INFINITY, mother: None };
        Self { radius, clusters: clusters.map(cluster).collect() }
    }

    /// The built-in process `leaf_discs rho=0.89`; `center: x y z` adds a tier's center.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("leaf_discs", &["rho", "radius", "center", "centers"])?;
        let radius = settings.number(&["rho", "radius"], 0.89);
        let radius = bounded("leaf_discs", "rho", radius, (1e-6, 1e6))?;
        let mut standing = Vec::new();
        for text in settings.all("center").chain(settings.all("centers")) {
            let given = crate::files::numbers(text);
            standing.extend(given.chunks_exact(3).map(Vec3::from_slice));
        }
        Ok(Self::new(radius, &standing))
    }

    /// Centers of all clusters so far.
    pub fn centers(&self) -> impl Iterator<Item = Vec3> {
        self.clusters.iter().map(|cluster| cluster.center)
    }

    /// The older cluster straight behind a place.
    fn mother(&self, place: Vec3, heading: Vec3) -> Option<usize> {
        let behind = |(number, cluster): (usize, &Cluster)| {
            let way = place - cluster.center;
            let along = way.dot(heading);
            let off = (way - heading * along).length();
            (along > 0.0 && off <= STRAIGHT * along.max(self.radius)).then_some((number, along))
        };
        let all = self.clusters.iter().enumerate().filter_map(behind);
        all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|found| found.0)
    }
}

impl Environment for Collision {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let old = self.clusters.len();
        if old + requests.len() > MOST {
            return Err(EnvironmentError::Refused {
                name: "leaf_discs".into(),
                reason: format!("more than {MOST} clusters of leaves"),
            });
        }
        let new = requests.iter().map(|request| Cluster {
            center: request.position,
            vigor: request.parameters.first().copied().unwrap_or(0.0),
            mother: self.mother(request.position, request.heading),
        });
        let new: Vec<Cluster> = new.collect();
        self.clusters.extend(new);
        let places: Vec<[f64; 2]> = self
            .clusters
            .iter()
            .map(|cluster| [cluster.center.x, cluster.center.y].map(f64::from))
            .collect();
        let reach = f64::from(self.radius);
        let cells = Cells::new(&places, reach);
        for (number, reply) in replies.iter_mut().enumerate() {
            let own = old + number;
            let Cluster { center, vigor, mother } = self.clusters[own];
            let stops = |&other: &u32| {
                let index = other as usize;
                let cluster = &self.clusters[index];
                index != own
                    && Some(index) != mother
                    && cluster.center.distance(center) < self.radius
                    && !(index >= old && cluster.vigor < vigor)
            };
            let mut near = cells.near(places[own], reach);
            let stopped = near.any(|range| cells.points[range].iter().any(stops));
            if let Some(answer) = reply.parameters.first_mut() {
                *answer = if stopped { 0.0 } else { 1.0 };
            }
        }
        Ok(())
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        Ok(state::to_bytes(&self.clusters))
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        self.clusters = state::from_bytes("leaf discs", memory)?;
        Ok(())
    }
}

/// Discs or balls of one step that meet each other: the weaker loses.
#[derive(Clone, Debug)]
pub struct Competition {
    rule: Rule,
    /// The plane in which discs lie; none for balls.
    plane: Option<[usize; 2]>,
    water: Option<Water>,
}

/// What a message says and what decides.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rule {
    /// `?E(r,s)`: s becomes 1 if a larger disc overlaps (of equal ones the earlier wins).
    Radius,
    /// `?E(r,c,w,d)`: d becomes 1 if a disc of greater ability c overlaps, w the water here.
    Ability,
    /// cpfg's ecosystem, `?E(r)` or `?E(r,vigor)`: becomes 0 if another that is not weaker overlaps, else 1.
    Ecosystem { vigor: bool },
    /// cpfg's honda81, `?E(vigor)` or `?E(vigor,kind)`: becomes 0 if another of its kind that is not
    /// weaker is within this distance, else 1.
    Distance(f32),
}

/// Water by place: a wet stripe along the second axis.
#[derive(Clone, Copy, Debug)]
struct Water {
    middle: f32,
    width: f32,
}

impl Water {
    /// 1 in the middle, falling like a bell; 0.5 at the width.
    fn at(self, x: f32) -> f32 {
        let off = (x - self.middle) / self.width;
        bioscope_core::math::exp(-std::f32::consts::LN_2 * off * off)
    }
}

#[derive(Clone, Copy)]
struct Rival {
    place: Vec3,
    radius: f32,
    strength: f32,
    kind: f32,
}

impl Competition {
    /// The built-in process `neighborhood`: `?E(r,s)` gets s = 1 where a larger circle overlaps.
    pub fn neighborhood(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("neighborhood", &["rule"])?;
        Ok(Self { rule: Rule::Radius, plane: Some([0, 1]), water: None })
    }

    /// The built-in process `community`: `?E(r,c,w,d)` gets the water w and d = 1 where dominated.
    pub fn community(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("community", &["rule", "water", "middle", "width"])?;
        let water = Water {
            middle: settings.number(&["middle"], 30.0),
            width: settings.number(&["width"], 6.7).abs().max(1e-6),
        };
        Ok(Self { rule: Rule::Ability, plane: Some([0, 1]), water: Some(water) })
    }

    /// The field program ecosystem.
    pub fn ecosystem(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("ecosystem", &["grid size", "3d case", "vigor"])?;
        let vigor = settings.switch(&["vigor"], false);
        let plane = (!settings.switch(&["3d case"], false)).then_some([0, 2]);
        Ok(Self { rule: Rule::Ecosystem { vigor }, plane, water: None })
    }

    /// The field program honda81.
    pub fn honda81(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("honda81", &["radius", "3d case"])?;
        let plane = (!settings.switch(&["3d case"], false)).then_some([0, 2]);
        let radius = settings.number(&["radius"], 0.0);
        let radius = bounded("honda81", "radius", radius, (0.0, 1e6))?;
        Ok(Self { rule: Rule::Distance(radius), plane, water: None })
    }

    fn rival(&self, request: &Request) -> Rival {
        let number = |index: usize| request.parameters.get(index).copied();
        let first = number(0).unwrap_or(0.0);
        let (radius, strength, kind) = match self.rule {
            Rule::Radius => (first, first, 0.0),
            Rule::Ability => (first, number(1).unwrap_or(0.0), 0.0),
            Rule::Ecosystem { vigor: true } => (first, number(1).unwrap_or(1.0), 0.0),
            Rule::Ecosystem { vigor: false } => (first, first, number(1).unwrap_or(0.0)),
            Rule::Distance(radius) => (radius, first, number(1).unwrap_or(0.0)),
        };
        let mut place = request.position;
        if let Some([a, b]) = self.plane {
            place = Vec3::new(place[a], place[b], 0.0);
        }
        let radius = if radius.is_finite() { radius.max(0.0) } else { 0.0 };
        Rival { place, radius, strength, kind }
    }

    /// Whether `other` (of this number) beats the one of number `own`.
    fn beats(&self, rivals: &[Rival], other: usize, own: usize) -> bool {
        let (a, b) = (&rivals[other], &rivals[own]);
        let reach = match self.rule {
            Rule::Distance(radius) => radius,
            _ => a.radius + b.radius,
        };
        let square = a.place.distance_squared(b.place);
        let near = match self.rule {
            Rule::Distance(_) => square <= reach * reach,
            _ => square < reach * reach,
        };
        let stronger = match self.rule {
            Rule::Radius | Rule::Ability => {
                a.strength > b.strength || (a.strength == b.strength && other < own)
            }
            Rule::Ecosystem { .. } | Rule::Distance(_) => a.strength >= b.strength,
        };
        other != own && near && stronger && a.kind == b.kind
    }
}

impl Environment for Competition {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let rivals: Vec<Rival> = requests.iter().map(|request| self.rival(request)).collect();
        let places: Vec<[f64; 2]> =
            rivals.iter().map(|rival| [rival.place.x, rival.place.y].map(f64::from)).collect();
        let largest = rivals.iter().map(|rival| rival.radius).fold(0.0, f32::max);
        let cells = Cells::new(&places, f64::from(2.0 * largest));
        for (own, reply) in replies.iter_mut().enumerate() {
            let reach = f64::from(rivals[own].radius + largest);
            let mut near = cells.near(places[own], reach);
            let beaten = near.any(|range| {
                let mut others = cells.points[range].iter();
                others.any(|&other| self.beats(&rivals, other as usize, own))
            });
            let flag = |set: bool| if set { 1.0 } else { 0.0 };
            match (self.rule, &mut *reply.parameters) {
                (Rule::Radius, [_, answer, ..]) => *answer = flag(beaten),
                (Rule::Ability, [_, _, water, answer, ..]) => {
                    *water = self.water.map_or(0.0, |one| one.at(rivals[own].place.x));
                    *answer = flag(beaten);
                }
                (Rule::Ecosystem { .. } | Rule::Distance(_), [answer, ..]) => {
                    *answer = flag(!beaten);
                }
                _ => {}
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ask;

    /// One axis of the tier model: where it is, where it looks, how long its segments are, on which side it forks.
    #[derive(Clone, Copy)]
    struct Apex {
        place: Vec3,
        angle: f32,
        length: f32,
        vigor: f32,
        side: f32,
    }

    /// Segments of two tiers of *Terminalia* whose clusters collide, after so many steps (model L16).
    fn tiers(radius: f32, centers: &[Vec3], steps: usize) -> usize {
        let mut environment = Collision::new(radius, centers);
        let forward = |angle: f32| {
            let angle = f64::from(angle).to_radians();
            Vec3::new(libm::cos(angle) as f32, libm::sin(angle) as f32, 0.0)
        };
        let mut apices = Vec::new();
        for &center in centers {
            for branch in 0..5 {
                let angle = 138.5 * branch as f32;
                let side = if branch % 2 == 0 { 1.0 } else { -1.0 };
                let place = center + forward(angle);
                apices.push(Apex { place, angle, length: 1.0, vigor: 1.0, side });
            }
        }
        let mut segments = apices.len();
        for _ in 0..steps {
            let words: Vec<[f32; 1]> = apices.iter().map(|apex| [apex.vigor]).collect();
            let asked: Vec<(&[f32], Vec3, Vec3)> = apices
                .iter()
                .zip(&words)
                .map(|(apex, word)| (&word[..], apex.place, forward(apex.angle)))
                .collect();
            let answers = ask(&mut environment, &asked);
            let mut next = Vec::new();
            for (apex, answer) in apices.iter().zip(answers) {
                if answer[0] == 1.0 {
                    for (turn, factor, side) in [(36.9, 0.87, apex.side), (-24.4, 0.94, -apex.side)]
                    {
                        let angle = apex.angle + turn * apex.side;
                        let length = apex.length * factor;
                        let place = apex.place + forward(angle) * length;
                        next.push(Apex { place, angle, length, vigor: factor, side });
                    }
                }
            }
            segments += next.len();
            apices = next;
        }
        segments
    }

    /// The course notes' table 1: 138 segments after five steps; 5, 15, 31 … of a single tier.
    #[test]
    fn tiers_have_the_published_numbers_of_segments() {
        assert_eq!(tiers(0.89, &[Vec3::ZERO, Vec3::X * 4.8], 5), 138);
        let single: Vec<usize> = (0..=6).map(|steps| tiers(0.9, &[Vec3::ZERO], steps)).collect();
        assert_eq!(single, [5, 15, 31, 47, 63, 79, 95]);
    }

    #[test]
    fn the_larger_of_two_circles_wins() {
        let mut environment = Competition::neighborhood(&Settings::default()).unwrap();
        let asked: [(&[f32], Vec3, Vec3); 4] = [
            (&[1.0, 0.0], Vec3::ZERO, Vec3::Y),
            (&[0.5, 0.0], Vec3::X * 1.4, Vec3::Y),
            (&[0.5, 0.0], Vec3::X * 1.6, Vec3::Y),
            (&[0.5, 0.0], Vec3::X * 9.0, Vec3::Y),
        ];
        let answers = ask(&mut environment, &asked);
        assert_eq!(answers.iter().map(|answer| answer[1]).collect::<Vec<_>>(), [0., 1., 1., 0.]);
    }

    #[test]
    fn honda81_compares_vigor_within_a_distance() {
        let mut settings = Settings::default();
        settings.set("radius", "0.5");
        let mut environment = Competition::honda81(&settings).unwrap();
        let asked: [(&[f32], Vec3, Vec3); 3] = [
            (&[0.9], Vec3::ZERO, Vec3::Y),
            (&[0.8], Vec3::new(0.4, 7.0, 0.0), Vec3::Y),
            (&[0.9], Vec3::new(0.0, 0.0, 0.6), Vec3::Y),
        ];
        let answers = ask(&mut environment, &asked);
        assert_eq!(answers.concat(), [1.0, 0.0, 1.0], "height does not count in two dimensions");
    }
}
