//! Floats as 16-bit integers: half a millimetre in a reef of thirty metres.

use bioscope_core::Vec3;
use bioscope_geometry::Transform;

const LARGEST: f32 = 32767.0;

/// Least and greatest corner around the points; a unit box if there are none.
pub fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    let (low, high) = points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| {
        (low.min(point), high.max(point))
    });
    if low.is_finite() && high.is_finite() { (low, high) } else { (Vec3::ZERO, Vec3::ONE) }
}

/// Points as three u16 each, 0 to 65535 across the box.
pub fn points(points: impl Iterator<Item = Vec3>, low: Vec3, high: Vec3) -> Vec<u8> {
    let scale = 65535.0 / (high - low).max(Vec3::splat(1e-6));
    let mut bytes = Vec::with_capacity(6 * points.size_hint().0);
    for point in points {
        for step in ((point - low) * scale).to_array() {
            bytes.extend_from_slice(&unsigned(step).to_le_bytes());
        }
    }
    bytes
}

/// Rotations as four i16 each, quaternion × 32767.
pub fn rotations<'a>(transforms: impl Iterator<Item = &'a Transform>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 * transforms.size_hint().0);
    transforms.for_each(|one| push_rotation(&mut bytes, one));
    bytes
}

/// Sizes as one u16 each, 0 to 65535 from the least to the greatest, which come first.
pub fn scales(scales: impl Iterator<Item = f32> + Clone) -> ([f32; 2], Vec<u8>) {
    let (least, greatest) = scales
        .clone()
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), one| (a.min(one), b.max(one)));
    let step = 65535.0 / (greatest - least).max(1e-12);
    let mut bytes = Vec::with_capacity(2 * scales.size_hint().0);
    for one in scales {
        bytes.extend_from_slice(&unsigned((one - least) * step).to_le_bytes());
    }
    ([least, greatest], bytes)
}

/// Unit vectors as three i16 each, × 32767.
pub fn directions(directions: &[Vec3]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(6 * directions.len());
    for one in directions {
        one.to_array().iter().for_each(|part| push(&mut bytes, part * LARGEST));
    }
    bytes
}

/// Joint poses as seven i16 each: position × 32767 / extent, quaternion × 32767.
pub fn poses<'a>(transforms: impl Iterator<Item = &'a Transform>, extent: f32) -> Vec<u8> {
    let scale = LARGEST / extent.max(1e-6);
    let mut bytes = Vec::with_capacity(14 * transforms.size_hint().0);
    for one in transforms {
        one.position.to_array().iter().for_each(|part| push(&mut bytes, part * scale));
        push_rotation(&mut bytes, one);
    }
    bytes
}

fn push_rotation(bytes: &mut Vec<u8>, transform: &Transform) {
    transform.rotation().to_array().iter().for_each(|part| push(bytes, part * LARGEST));
}

fn push(bytes: &mut Vec<u8>, number: f32) {
    // To the nearest: adding a half and cutting off is much quicker than to round.
    let whole = (number + 0.5_f32.copysign(number)).clamp(-LARGEST, LARGEST) as i16;
    bytes.extend_from_slice(&whole.to_le_bytes());
}

fn unsigned(number: f32) -> u16 {
    (number + 0.5).clamp(0.0, 65535.0) as u16
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn points_come_back_within_a_step(
            list in prop::collection::vec((-40f32..40.0, -9f32..0.0, -40f32..40.0), 1..50)
        ) {
            let list: Vec<Vec3> = list.into_iter().map(Vec3::from).collect();
            let (low, high) = bounds(list.iter().copied());
            let bytes = points(list.iter().copied(), low, high);
            let steps: Vec<u16> = bytes.chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect();
            for (point, step) in list.iter().zip(steps.chunks_exact(3)) {
                let step = Vec3::new(f32::from(step[0]), f32::from(step[1]), f32::from(step[2]));
                let back = low + step / 65535.0 * (high - low);
                prop_assert!((back - *point).length() < 1.5e-3, "{back} {point}");
            }
        }
    }
}
