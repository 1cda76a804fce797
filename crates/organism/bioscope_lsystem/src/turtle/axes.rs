use bioscope_core::Vec3;
use glam::DVec3;

/// Three perpendicular unit vectors, H × L = U.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where the turtle goes.
    pub heading: Vec3,
    /// Its left.
    pub left: Vec3,
    /// Its up.
    pub up: Vec3,
}

/// The frame of the turtle while it walks: in double precision, so that a million turns do not bend it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    pub heading: DVec3,
    pub left: DVec3,
    pub up: DVec3,
}

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angle {
    pub sine: f64,
    pub cosine: f64,
}

impl Angle {
    pub const HALF_TURN: Self = Self { sine: 0.0, cosine: -1.0 };

    /// The angle of so many degrees; right angles are exact if `round`.
    pub fn of_degrees(degrees: f32, round: bool) -> Self {
        let degrees = f64::from(degrees);
        if round && degrees % 90.0 == 0.0 {
            let quarters = (degrees / 90.0).rem_euclid(4.0) as usize;
            let (sine, cosine) =
                [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarters.min(3)];
            return Self { sine, cosine };
        }
        let radians = degrees.to_radians();
        Self { sine: libm::sin(radians), cosine: libm::cos(radians) }
    }

    pub fn reversed(self) -> Self {
        Self { sine: -self.sine, cosine: self.cosine }
    }
}

impl Axes {
    pub const START: Self = Self { heading: DVec3::Y, left: DVec3::NEG_X, up: DVec3::Z };

    /// The frame with this heading whose up is as near as possible to `up`.
    pub fn looking(heading: DVec3, up: DVec3) -> Self {
        let heading = heading.normalize_or(DVec3::Y);
        let left = up.cross(heading).normalize_or(heading.any_orthonormal_vector());
        Self { heading, left, up: heading.cross(left) }
    }

    /// Turns left about up.
    pub fn turn(&mut self, angle: Angle) {
        rotate(&mut self.heading, &mut self.left, angle);
    }

    /// Pitches down about left.
    pub fn pitch(&mut self, angle: Angle) {
        rotate(&mut self.up, &mut self.heading, angle);
    }

    /// Rolls left about the heading (left goes down).
    pub fn roll(&mut self, angle: Angle) {
        rotate(&mut self.up, &mut self.left, angle);
    }

    /// Takes a new heading and turns the rest with it the short way: without twist.
    pub fn carry(&mut self, heading: DVec3, from: DVec3, up: DVec3) {
        let up = rotated(up, from, heading);
        self.heading = heading;
        self.left = up.cross(heading).normalize_or(heading.any_orthonormal_vector());
        self.up = heading.cross(self.left);
    }

    pub fn rounded(&self) -> Frame {
        Frame { heading: self.heading.as_vec3(), left: self.left.as_vec3(), up: self.up.as_vec3() }
    }
}

/// Turns `a` towards `b`, and `b` away from `a`.
fn rotate(a: &mut DVec3, b: &mut DVec3, angle: Angle) {
    let Angle { sine, cosine } = angle;
    (*a, *b) = (*a * cosine + *b * sine, *b * cosine - *a * sine);
}

/// `vector` turned as the short way from the unit vector `from` to the unit vector `to` turns.
pub(super) fn rotated(vector: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let axis = from.cross(to);
    let cosine = from.dot(to);
    if axis.length_squared() < 1e-24 {
        return if cosine < 0.0 { -vector } else { vector };
    }
    // Rodrigues' formula with the sine inside the axis.
    vector * cosine + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + cosine).max(1e-12))
}
