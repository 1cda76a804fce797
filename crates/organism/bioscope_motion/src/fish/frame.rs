use bioscope_core::{Quat, Vec3, math};

/// The frame of a fish, from its first three rings, so that neither the beat of the tail nor the nose shake it: +Z ahead
/// from ring 3 to ring 1, +Y from its lower to its upper nodes, +X to its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Unit vector ahead.
    pub ahead: Vec3,
    /// Unit vector to the left.
    pub left: Vec3,
    /// Unit vector up.
    pub up: Vec3,
}

impl Frame {
    /// The frame of these nodes.
    pub fn of(node: impl Fn(usize) -> Vec3) -> Self {
        let (ahead, rise) = Self::axes(node, |a, b| a + b, |a, b| a - b);
        Self::along(ahead, rise)
    }

    /// The ways from ring 3 to ring 1 and from the lower to the upper nodes, as multiples; of one body or of several.
    pub(super) fn axes<T: Copy>(
        node: impl Fn(usize) -> T,
        add: impl Fn(T, T) -> T,
        sub: impl Fn(T, T) -> T,
    ) -> (T, T) {
        let corner = |at: usize| add(add(node(1 + at), node(5 + at)), node(9 + at));
        let ring = |first: usize| (1..4).fold(node(first), |sum, at| add(sum, node(first + at)));
        let rise = sub(sub(add(corner(0), corner(3)), corner(1)), corner(2));
        (sub(ring(1), ring(9)), rise)
    }

    /// The frame that looks along `ahead` and whose upper side is that of `rise`, of any lengths.
    pub(super) fn along(ahead: Vec3, rise: Vec3) -> Self {
        let ahead = ahead.normalize_or(Vec3::Z);
        let left = rise.cross(ahead).normalize_or(Vec3::X);
        Self { ahead, left, up: ahead.cross(left) }
    }

    /// Heading about the vertical, from +Z towards +X, which is to the left, radians.
    pub fn yaw(&self) -> f32 {
        math::atan2(self.ahead.x, self.ahead.z)
    }

    /// Climb, radians.
    pub fn pitch(&self) -> f32 {
        math::atan2(self.ahead.y, self.ahead.xz_length())
    }

    /// Lean to the right, radians: the left side is up.
    pub fn roll(&self) -> f32 {
        math::atan2(self.left.y, self.up.y)
    }

    /// The rotation that turns +Z ahead, +X left, +Y up.
    pub fn rotation(&self) -> Quat {
        let axes = bioscope_core::Mat3::from_cols(self.left, self.up, self.ahead);
        Quat::from_mat3(&axes).normalize()
    }
}

trait Level {
    fn xz_length(&self) -> f32;
}

impl Level for Vec3 {
    fn xz_length(&self) -> f32 {
        math::sqrt(self.x * self.x + self.z * self.z)
    }
}

/// The same direction as an angle between −π and π.
pub(crate) fn wrapped(angle: f32) -> f32 {
    let turns = angle / math::TAU;
    (turns - (turns + 0.5).floor()) * math::TAU
}
