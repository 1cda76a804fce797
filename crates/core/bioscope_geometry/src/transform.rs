use bioscope_core::{Quat, Vec3};
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

/// A similarity: scale, then rotate, then move. Eight floats, as the wire and numpy see it:
/// x, y, z, scale, qx, qy, qz, qw.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
pub struct Transform {
    /// Where the origin goes, metres.
    pub position: Vec3,
    /// Uniform scale.
    pub scale: f32,
    /// Unit quaternion, components x, y, z, w.
    rotation: [f32; 4],
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// Leaves everything where it is.
    pub const IDENTITY: Self =
        Self { position: Vec3::ZERO, scale: 1.0, rotation: [0.0, 0.0, 0.0, 1.0] };

    /// The similarity of these parts.
    pub fn new(position: Vec3, rotation: Quat, scale: f32) -> Self {
        Self { position, scale, rotation: rotation.to_array() }
    }

    /// Only moves.
    pub fn at(position: Vec3) -> Self {
        Self { position, ..Self::IDENTITY }
    }

    /// The rotation.
    pub fn rotation(&self) -> Quat {
        Quat::from_array(self.rotation)
    }

    /// Where a point goes.
    pub fn point(&self, point: Vec3) -> Vec3 {
        self.position + self.vector(point)
    }

    /// What becomes of a difference of points.
    pub fn vector(&self, vector: Vec3) -> Vec3 {
        self.rotation() * (vector * self.scale)
    }

    /// First `inner`, then this.
    pub fn compose(&self, inner: &Self) -> Self {
        Self::new(
            self.point(inner.position),
            self.rotation() * inner.rotation(),
            self.scale * inner.scale,
        )
    }

    /// The similarity that undoes this one.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation().inverse();
        let scale = 1.0 / self.scale;
        Self::new(rotation * (-self.position * scale), rotation, scale)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn inverse_undoes(x in -9f32..9.0, y in -9f32..9.0, angle in -3f32..3.0, scale in 0.1f32..9.0) {
            let transform = Transform::new(
                Vec3::new(x, y, 1.0), Quat::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), angle), scale,
            );
            let point = Vec3::new(y, 2.0, x);
            let back = transform.inverse().point(transform.point(point));
            prop_assert!((back - point).length() < 1e-3, "{back} {point}");
            let there = transform.compose(&transform.inverse()).point(point);
            prop_assert!((there - point).length() < 1e-3);
        }
    }
}
