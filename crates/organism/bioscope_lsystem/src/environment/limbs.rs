//! Stems and branches that a climber creeps along.

use bioscope_core::{Vec3, math, state};
use rayon::prelude::*;

use super::guides::turns;
use super::settings::Settings;
use super::{Environment, EnvironmentError, Reply, Request};

/// Most limbs of one tree.
const MOST: usize = 200_000;

/// A tapering piece of a stem or branch, with round ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limb {
    start: Vec3,
    end: Vec3,
    radii: [f32; 2],
}

/// The nearest place on a surface.
#[derive(Clone, Copy, Debug)]
struct Footing {
    place: Vec3,
    /// Out of the wood, a unit vector.
    normal: Vec3,
    /// Of the asking point from the surface; negative inside.
    distance: f32,
}

/// The wood of a tree as the support of a climber that creeps along its surface and keeps off its own like.
///
/// `?E(l,yaw,pitch,roll,crowd)` asks where a piece of length l may grow from here: `+(yaw)&(pitch)/(roll)` turns
/// the turtle along the surface, a little upward, with its up away from the wood; crowd is how many pieces
/// have begun within `reach` of here before (the climber's memory of where it has been).
///
/// Source: R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, section 8, figure 13, which describes the climber and lists no
/// model; the rule of headings is that of our reconstruction (R10), crowding as in their clonal plant.
#[derive(Clone, Debug)]
pub struct Limbs {
    limbs: Vec<Limb>,
    /// From the surface to the middle of the climber's stem.
    stem: f32,
    /// Within which others crowd.
    reach: f32,
    /// How much it looks upward.
    up: f32,
    /// Where pieces have begun.
    nodes: Vec<Vec3>,
}

impl Limb {
    fn footing(&self, place: Vec3) -> Footing {
        let way = self.end - self.start;
        let along =
            ((place - self.start).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
        let middle = self.start + way * along;
        let radius = self.radii[0] + (self.radii[1] - self.radii[0]) * along;
        let normal =
            (place - middle).normalize_or(way.any_orthonormal_vector().normalize_or(Vec3::X));
        Footing {
            place: middle + normal * radius,
            normal,
            distance: place.distance(middle) - radius,
        }
    }
}

impl Limbs {
    /// The built-in process `limbs limb="0 0 0 0 2 0 0.1 0.08" stem=0.01 reach=0.15 up=0.35`: two ends and radii of
    /// each limb.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("limbs", &["limb", "stem", "reach", "up"])?;
        let refused = |reason: String| EnvironmentError::Refused { name: "limbs".into(), reason };
        let limb = |text: &str| match crate::files::numbers(text)[..] {
            [x, y, z, to_x, to_y, to_z, first, last] => Ok(Limb {
                start: Vec3::new(x, y, z),
                end: Vec3::new(to_x, to_y, to_z),
                radii: [first.max(0.0), last.max(0.0)],
            }),
            _ => Err(refused(format!("limb: {text}: expected two ends and two radii"))),
        };
        let limbs: Vec<Limb> = settings.all("limb").map(limb).collect::<Result<_, _>>()?;
        if limbs.is_empty() || limbs.len() > MOST {
            return Err(refused(format!("{} limbs: expected 1 to {MOST}", limbs.len())));
        }
        Ok(Self {
            limbs,
            stem: settings.number(&["stem"], 0.01).max(0.0),
            reach: settings.number(&["reach"], 0.15).max(0.0),
            up: settings.number(&["up"], 0.35),
            nodes: Vec::new(),
        })
    }

    /// The nearest place on the wood; of equally near ones that of the first limb.
    fn footing(&self, place: Vec3) -> Footing {
        let first = self.limbs[0].footing(place);
        self.limbs[1..].iter().fold(first, |nearest, limb| {
            let other = limb.footing(place);
            if other.distance < nearest.distance { other } else { nearest }
        })
    }

    /// Where a piece that begins here goes, and the side that is away from the wood there.
    fn way(&self, place: Vec3, heading: Vec3, length: f32) -> (Vec3, Vec3) {
        let Footing { normal, .. } = self.footing(place);
        let wish = heading + Vec3::Y * self.up;
        let along = wish - normal * wish.dot(normal);
        let ahead = along.normalize_or(normal.any_orthonormal_vector());
        let mut end = place + ahead * length;
        let mut outward = normal;
        // Where it ends, it lies on the surface: of another limb, perhaps.
        for _ in 0..4 {
            let footing = self.footing(end);
            outward = footing.normal;
            let target = footing.place + outward * self.stem;
            end = place + (target - place).normalize_or(ahead) * length;
        }
        ((end - place).normalize_or(ahead), outward)
    }

    fn crowd(&self, place: Vec3) -> usize {
        let near = self.reach * self.reach;
        self.nodes.iter().filter(|node| node.distance_squared(place) < near).count()
    }
}

/// The angle of `/` that brings the turtle's up to a side, after the turns of `+` and `&`, degrees.
fn roll(request: &Request, yaw: f32, pitch: f32, outward: Vec3) -> f32 {
    let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
    let Request { heading, left, .. } = *request;
    let up = heading.cross(left);
    let ahead = heading * math::cos(yaw) + left * math::sin(yaw);
    let left = left * math::cos(yaw) - heading * math::sin(yaw);
    let up = up * math::cos(pitch) + ahead * math::sin(pitch);
    math::atan2(outward.dot(left), outward.dot(up)).to_degrees()
}

impl Environment for Limbs {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let pairs = requests.par_iter().zip(&mut *replies);
        pairs.for_each(|(request, reply)| {
            let [length, yaw, pitch, rest @ ..] = &mut *reply.parameters else { return };
            if !request.position.is_finite() {
                return;
            }
            let (ahead, outward) = self.way(request.position, request.heading, length.max(1e-6));
            (*yaw, *pitch) = turns(request, ahead);
            if let Some(own) = rest.first_mut() {
                *own = roll(request, *yaw, *pitch, outward);
            }
            if let Some(own) = rest.get_mut(1) {
                *own = self.crowd(request.position) as f32;
            }
        });
        self.nodes.extend(requests.iter().map(|one| one.position).filter(|one| one.is_finite()));
        Ok(())
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        Ok(state::to_bytes(&self.nodes))
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        self.nodes = state::from_bytes("nodes of climbers", memory)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ask;

    #[test]
    fn a_stem_creeps_up_a_trunk_and_out_along_a_branch() {
        let mut settings = Settings::default();
        settings.set("limb", "0 0 0 0 2 0 0.2 0.15");
        settings.set("limb", "0 2 0 1.5 2.6 0 0.1 0.05");
        settings.set("limb", "0 2 0 -1 3 0.4 0.1 0.05");
        let mut limbs = Limbs::from_settings(&settings).unwrap();
        let (mut place, mut heading) = (Vec3::new(0.21, 0.0, 0.0), Vec3::Y);
        for _ in 0..60 {
            let answers = ask(&mut limbs, &[(&[0.05, 0.0, 0.0, 0.0, 0.0], place, heading)]);
            let [_, yaw, pitch, _, _] = answers[0][..] else { panic!("five numbers") };
            let (ahead, left, up) = crate::environment::frame(heading);
            let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
            heading = (ahead * yaw.cos() + left * yaw.sin()) * pitch.cos() - up * pitch.sin();
            place += heading * 0.05;
            let off = limbs.footing(place).distance;
            assert!((off - 0.01).abs() < 0.02, "{off} off the wood at {place}");
        }
        assert!(place.y > 2.2, "it has climbed: {place}");
        let asked: &[f32] = &[0.05, 0.0, 0.0, 0.0, 0.0];
        let crowd = ask(&mut limbs, &[(asked, Vec3::new(0.21, 1.0, 0.0), Vec3::Y)])[0][4];
        assert!((5.0..8.0).contains(&crowd), "it has been here: {crowd}");
    }

    #[test]
    fn wood_without_ends_is_refused() {
        let mut settings = Settings::default();
        assert!(Limbs::from_settings(&settings).is_err());
        settings.set("limb", "0 0 0 1");
        let error = Limbs::from_settings(&settings).err().unwrap().to_string();
        assert!(error.contains("two ends and two radii"), "{error}");
    }
}
