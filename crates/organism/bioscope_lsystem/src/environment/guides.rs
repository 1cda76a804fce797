//! Things that stand in the way, or hold up: poles, walls, and the shapes that plants are cut to.

use bioscope_core::Vec3;

use super::settings::Settings;
use super::{Environment, EnvironmentError, Reply, Request};

/// A solid; its distance function is negative inside.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A ball.
    Ball {
        /// Its middle.
        center: Vec3,
        /// Its radius.
        radius: f32,
    },
    /// A box along the axes.
    Box {
        /// Its lowest corner.
        low: Vec3,
        /// Its highest corner.
        high: Vec3,
    },
    /// An upright cone that ends in its tip.
    Cone {
        /// Middle of its base.
        base: Vec3,
        /// Radius of its base.
        radius: f32,
        /// Its height.
        height: f32,
    },
    /// An upright cylinder.
    Cylinder {
        /// Middle of its base.
        base: Vec3,
        /// Its radius.
        radius: f32,
        /// Its height.
        height: f32,
    },
    /// Everything on the far side of a plane.
    Beyond {
        /// A point of the plane.
        point: Vec3,
        /// Out of the solid, a unit vector.
        normal: Vec3,
    },
    /// What is in any of these.
    Union(Vec<Shape>),
}

impl Shape {
    /// Distance to the surface (or less), negative inside.
    pub fn distance(&self, place: Vec3) -> f32 {
        match self {
            Self::Ball { center, radius } => place.distance(*center) - radius,
            Self::Box { low, high } => {
                let outside = (*low - place).max(place - *high);
                outside.max(Vec3::ZERO).length() + outside.max_element().min(0.0)
            }
            Self::Cone { base, radius, height } => {
                let way = place - *base;
                let across = Vec3::new(way.x, 0.0, way.z).length();
                let slant = (radius * radius + height * height).sqrt().max(1e-9);
                let side = (across * height + (way.y - height) * radius) / slant;
                side.max(-way.y)
            }
            Self::Cylinder { base, radius, height } => {
                let way = place - *base;
                let across = Vec3::new(way.x, 0.0, way.z).length() - radius;
                across.max(-way.y).max(way.y - height)
            }
            Self::Beyond { point, normal } => (place - *point).dot(*normal),
            Self::Union(parts) => {
                parts.iter().map(|part| part.distance(place)).fold(f32::INFINITY, f32::min)
            }
        }
    }

    /// Away from the surface, by differences.
    pub fn normal(&self, place: Vec3) -> Vec3 {
        const STEP: f32 = 1e-3;
        let slope =
            |axis: Vec3| self.distance(place + axis * STEP) - self.distance(place - axis * STEP);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or(Vec3::Y)
    }

    /// The shapes of settings: `ball: x y z r`, `box: x y z x y z`, `cone: x y z r h`,
    /// `cylinder: x y z r h`, `plane: x y z nx ny nz`.
    pub fn from_settings(settings: &Settings) -> Self {
        let mut parts = Vec::new();
        for name in Self::NAMES {
            for text in settings.all(name) {
                let given = crate::files::numbers(text);
                let point = |first: usize| given.get(first..first + 3).map(Vec3::from_slice);
                let shape = match (name, &given[..], point(0)) {
                    ("ball", [_, _, _, radius, ..], Some(center)) => {
                        Some(Self::Ball { center, radius: *radius })
                    }
                    ("box", _, Some(low)) => point(3).map(|high| Self::Box { low, high }),
                    ("cone", [_, _, _, radius, height, ..], Some(base)) => {
                        Some(Self::Cone { base, radius: *radius, height: *height })
                    }
                    ("cylinder", [_, _, _, radius, height, ..], Some(base)) => {
                        Some(Self::Cylinder { base, radius: *radius, height: *height })
                    }
                    ("plane", _, Some(start)) => point(3).map(|normal| Self::Beyond {
                        point: start,
                        normal: normal.normalize_or(Vec3::Y),
                    }),
                    _ => None,
                };
                parts.extend(shape);
            }
        }
        Self::Union(parts)
    }

    const NAMES: [&'static str; 5] = ["ball", "box", "cone", "cylinder", "plane"];
}

/// A shape that plants are cut to: `?E(x)` becomes 1 outside and 0 inside, and `?E(x,d)` gets the distance too.
#[derive(Clone, Debug)]
pub struct Pruning {
    shape: Shape,
}

impl Pruning {
    /// The built-in process `pruning ball="0 6 0 6"`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("pruning", &Shape::NAMES)?;
        Ok(Self { shape: Shape::from_settings(settings) })
    }
}

impl Environment for Pruning {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        for (request, reply) in requests.iter().zip(replies) {
            let distance = self.shape.distance(request.position);
            for (index, value) in reply.parameters.iter_mut().take(2).enumerate() {
                *value = if index == 0 { f32::from(u8::from(distance > 0.0)) } else { distance };
            }
        }
        Ok(())
    }
}

/// Obstacles that growth goes around.
///
/// `?E(l,yaw,pitch)` asks where a piece of length l may grow from here. The first answer is how
/// long it may be, yaw (for `+`) and then pitch (for `&`) turn it along the obstacle if it would
/// enter one. A tip that is already inside is led out.
#[derive(Clone, Debug)]
pub struct Obstacles {
    shape: Shape,
    gap: f32,
}

impl Obstacles {
    /// Goes around this shape at this distance.
    pub fn new(shape: Shape, gap: f32) -> Self {
        Self { shape, gap }
    }

    /// The built-in process `obstacles ball="0 1 0 0.5" gap=0.01`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        let known: Vec<&str> = Shape::NAMES.iter().copied().chain(["gap"]).collect();
        settings.check("obstacles", &known)?;
        Ok(Self::new(Shape::from_settings(settings), settings.number(&["gap"], 1e-3).max(0.0)))
    }

    /// The direction nearest to `heading` in which a piece stays outside, and how long it may be.
    fn free(&self, place: Vec3, heading: Vec3, length: f32) -> (Vec3, f32) {
        let mut direction = heading;
        for _ in 0..8 {
            if self.clear(place, direction, length) >= length {
                return (direction, length);
            }
            // Slide along the surface where the way ends, and a little off it.
            let end = place + direction * length;
            let normal = self.shape.normal(end);
            let inside = (self.gap - self.shape.distance(end)).max(0.0);
            let pushed = end + normal * (inside + 0.02 * length) - place;
            direction = pushed.normalize_or(normal);
        }
        (direction, self.clear(place, direction, length))
    }

    /// How far one may go without coming nearer than the gap.
    fn clear(&self, place: Vec3, direction: Vec3, length: f32) -> f32 {
        let mut way = 0.0;
        for _ in 0..64 {
            let room = self.shape.distance(place + direction * way) - self.gap;
            let leaves = self.shape.distance(place + direction * (way + 1e-3 * length))
                > self.shape.distance(place + direction * way);
            if room <= 0.0 && !leaves {
                return way;
            }
            way += room.max(1e-2 * length);
            if way >= length {
                let ends = self.shape.distance(place + direction * length);
                return if ends >= self.gap || leaves { length } else { way.min(length) * 0.5 };
            }
        }
        way
    }
}

impl Environment for Obstacles {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        for (request, reply) in requests.iter().zip(replies) {
            let Some(&length) = request.parameters.first() else { continue };
            if !(length > 0.0 && length.is_finite()) {
                continue;
            }
            let (direction, free) = self.free(request.position, request.heading, length);
            reply.parameters[0] = free;
            let (yaw, pitch) = turns(request, direction);
            if let [_, first, rest @ ..] = &mut *reply.parameters {
                *first = yaw;
                if let Some(second) = rest.first_mut() {
                    *second = pitch;
                }
            }
        }
        Ok(())
    }
}

/// The angles of `+` and then `&` that turn the turtle to a direction, degrees.
pub(super) fn turns(request: &Request, direction: Vec3) -> (f32, f32) {
    use bioscope_core::math;
    let up = request.heading.cross(request.left);
    let yaw = math::atan2(direction.dot(request.left), direction.dot(request.heading));
    let pitch = -math::asin(direction.dot(up).clamp(-1.0, 1.0));
    (yaw.to_degrees(), pitch.to_degrees())
}

/// An upright pole that a stem winds around.
///
/// `?E(c,yaw,pitch)` gets c = 1 where the tip touches, with the angles of `+` and `&` that lead it on.
/// Source: the climbing plant of the course notes (figure 26), reconstructed as model R08.
#[derive(Clone, Debug)]
pub struct Pole {
    axis: [f32; 2],
    /// From the axis to the middle of a stem that touches.
    distance: f32,
    pitch: f32,
    /// Length of a piece of the stem, metres.
    piece: f32,
}

impl Pole {
    /// The built-in process `pole px=1 pz=0 radius=0.3 stem=0.05 pitch=35`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check("pole", &["px", "pz", "radius", "stem", "pitch", "piece"])?;
        Ok(Self {
            axis: [settings.number(&["px"], 1.0), settings.number(&["pz"], 0.0)],
            distance: settings.number(&["radius"], 0.3) + settings.number(&["stem"], 0.05),
            pitch: settings.number(&["pitch"], 35.0),
            piece: settings.number(&["piece"], 0.25).abs().max(1e-6),
        })
    }
}

impl Environment for Pole {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        use bioscope_core::math;
        /// How near the tip must come to the surface.
        const TOUCH: f32 = 0.2;
        for (request, reply) in requests.iter().zip(replies) {
            let [touch, yaw, pitch, ..] = &mut *reply.parameters else { continue };
            let way = request.position - Vec3::new(self.axis[0], request.position.y, self.axis[1]);
            let distance = way.length();
            *touch = f32::from(u8::from(distance < self.distance + TOUCH));
            if *touch == 0.0 {
                continue;
            }
            let outward = way.normalize_or(Vec3::X);
            let mut around = Vec3::Y.cross(outward);
            // On the way it has.
            if around.dot(request.heading) < 0.0 {
                around = -around;
            }
            let slope = self.pitch.to_radians();
            let off = ((self.distance - distance) / self.piece).clamp(-1.0, 1.0);
            let wanted = around * math::cos(slope) + Vec3::Y * math::sin(slope) + outward * off;
            (*yaw, *pitch) = turns(request, wanted.normalize_or(Vec3::Y));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::{ask, frame};

    #[test]
    fn growth_never_enters_an_obstacle() {
        let shape = Shape::Union(vec![
            Shape::Ball { center: Vec3::new(0.1, 1.0, 0.0), radius: 0.5 },
            Shape::Box { low: Vec3::new(-3.0, 2.5, -3.0), high: Vec3::new(0.4, 3.0, 3.0) },
        ]);
        let mut obstacles = Obstacles::new(shape.clone(), 0.0);
        let (mut place, mut heading) = (Vec3::ZERO, Vec3::Y);
        let mut deepest = f32::INFINITY;
        for _ in 0..120 {
            let answers = ask(&mut obstacles, &[(&[0.05, 0.0, 0.0], place, heading)]);
            let [length, yaw, pitch] = answers[0][..] else { panic!("three numbers") };
            let (ahead, left, up) = frame(heading);
            let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
            let ahead = ahead * yaw.cos() + left * yaw.sin();
            let turned = ahead * pitch.cos() - up * pitch.sin();
            place += turned * length;
            // It looks up again, as a shoot does.
            heading = (turned + Vec3::Y * 0.3).normalize();
            deepest = deepest.min(shape.distance(place));
        }
        assert!(deepest > -1e-3, "it went {deepest} deep");
        assert!(place.y > 2.0, "and got around: {place}");
    }

    #[test]
    fn shapes_know_their_inside() {
        let mut settings = Settings::default();
        settings.set("cone", "0 0 0 2 4");
        let mut pruning = Pruning::from_settings(&settings).unwrap();
        let at =
            |x: f32, y: f32| -> (&[f32], Vec3, Vec3) { (&[9.0], Vec3::new(x, y, 0.0), Vec3::Y) };
        let asked = [at(0.0, 1.0), at(0.0, 4.1), at(1.4, 1.0), at(1.6, 1.0), at(0.0, -0.1)];
        assert_eq!(ask(&mut pruning, &asked).concat(), [0.0, 1.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn a_stem_winds_around_a_pole() {
        let mut pole = Pole::from_settings(&Settings::default()).unwrap();
        let mut place = Vec3::new(0.6, 1.0, 0.1);
        let mut heading = Vec3::new(0.3, 0.5, 0.8).normalize();
        let (mut turned, mut last) = (0.0, None);
        for _ in 0..80 {
            let answers = ask(&mut pole, &[(&[0.0, 0.0, 0.0], place, heading)]);
            let [touch, yaw, pitch] = answers[0][..] else { panic!("three numbers") };
            assert_eq!(touch, 1.0, "it never lets go");
            let (ahead, left, up) = frame(heading);
            let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
            heading = (ahead * yaw.cos() + left * yaw.sin()) * pitch.cos() - up * pitch.sin();
            place += heading * 0.25;
            let angle = place.z.atan2(place.x - 1.0);
            if let Some(before) = last {
                let step: f32 = angle - before;
                turned += (step + std::f32::consts::PI).rem_euclid(std::f32::consts::TAU)
                    - std::f32::consts::PI;
            }
            last = Some(angle);
            let off = Vec3::new(place.x - 1.0, 0.0, place.z).length();
            assert!((0.2..0.6).contains(&off), "{off} from the axis");
        }
        assert!(turned.abs() / std::f32::consts::TAU > 2.0, "{turned} radians");
    }
}
