//! What open mouths do to what floats before them: suction feeding.
//!
//! While a mouth is open, everything free and small enough before it is accelerated towards it, the more the nearer and the
//! smaller it is (the vacuum force of Tu, "Artificial Animals for Computer Animation", 1996, sections 6.4.4 and 6.5.1, with a range and a
//! strength of our choice). What gets into contact is bitten and swallowed; see [`bites`](crate::bites). The mouth's owner
//! is not pulled in return: it is the water that it takes in, and lets out behind its gills, that carries the momentum.

use bioscope_core::{Id, Vec3};
use bioscope_geometry::Mouth;

/// Largest thing that goes into a mouth, body lengths.
pub(crate) const MOUTHFUL: f32 = 0.7;
/// Distance from which a mouth draws something in, body lengths (choice).
const RANGE: f32 = 0.4;
/// Cosine of the greatest angle from its direction at which it does: 75 degrees (choice).
const CONE: f32 = 0.258_819;
/// Greatest acceleration, body lengths per second squared (choice: over the range takes about a sixth of a second).
const STRENGTH: f32 = 60.0;

/// All open mouths, sorted so that those near a place are found soon.
pub(crate) struct Mouths<'a> {
    sorted: Vec<&'a Mouth>,
    /// Greatest range, metres.
    reach: f32,
}

impl<'a> Mouths<'a> {
    /// These mouths.
    pub fn new(mouths: &'a [Mouth]) -> Self {
        let mut sorted: Vec<_> = mouths.iter().collect();
        sorted.sort_unstable_by(|a, b| {
            a.position.x.total_cmp(&b.position.x).then(a.owner.cmp(&b.owner))
        });
        let longest = mouths.iter().fold(0.0f32, |longest, one| longest.max(one.body_length));
        Self { sorted, reach: RANGE * longest }
    }

    /// Whether any mouth may draw in something within `radius` metres of this place.
    pub fn reach(&self, place: Vec3, radius: f32) -> bool {
        self.near(place.x, radius).any(|one| one.position.distance(place) <= self.reach + radius)
    }

    /// Acceleration of a free thing of this size (metres) at this place by all mouths but its own, m/s².
    pub fn pull(&self, id: Id, place: Vec3, size: f32) -> Vec3 {
        let near = self.near(place.x, 0.0).filter(|one| one.owner != id);
        near.map(|one| pull(one, place, size)).sum()
    }

    /// Those whose range comes within `radius` metres of a place along x.
    fn near(&self, x: f32, radius: f32) -> impl Iterator<Item = &'a Mouth> + '_ {
        let reach = self.reach + radius;
        let first = self.sorted.partition_point(|one| one.position.x < x - reach);
        let near = self.sorted[first..].iter().copied();
        near.take_while(move |one| one.position.x <= x + reach)
    }
}

fn pull(mouth: &Mouth, place: Vec3, size: f32) -> Vec3 {
    let length = mouth.body_length;
    let way = mouth.position - place;
    let distance = way.length();
    let nearness = 1.0 - distance / (RANGE * length);
    let room = 1.0 - size / (MOUTHFUL * length);
    let before = -way.dot(mouth.ahead) >= CONE * distance;
    if nearness <= 0.0 || room <= 0.0 || !before || distance < 1e-6 {
        return Vec3::ZERO;
    }
    way / distance * (STRENGTH * length * mouth.gape * nearness * room)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mouth(owner: Id, position: Vec3) -> Mouth {
        Mouth { owner, position, ahead: Vec3::Z, body_length: 0.5, gape: 1.0 }
    }

    #[test]
    fn draws_in_what_lies_before_it_and_fits() {
        let open = [mouth(1, Vec3::ZERO)];
        let mouths = Mouths::new(&open);
        let pull = |z: f32, size: f32| mouths.pull(9, Vec3::new(0.0, 0.0, z), size).z;
        assert!(pull(0.1, 0.01) < pull(0.15, 0.01) && pull(0.15, 0.01) < 0.0);
        assert!(pull(0.1, 0.01) < pull(0.1, 0.2), "the small more than the large");
        assert_eq!([pull(0.1, 0.4), pull(0.25, 0.01), pull(-0.1, 0.01)], [0.0; 3]);
        assert_eq!(mouths.pull(1, Vec3::Z * 0.1, 0.01), Vec3::ZERO, "not itself");
    }

    #[test]
    fn finds_every_mouth_that_is_near() {
        let place = |index: u32| {
            let far = index as f32 * 0.37;
            Vec3::new(far.fract() * 2.0, 0.1 * (index % 3) as f32, 0.05 * (index % 7) as f32)
        };
        let open: Vec<_> = (0..200).map(|index| mouth(index, place(index))).collect();
        let mouths = Mouths::new(&open);
        for index in 0..20 {
            let place = Vec3::new(0.1 * index as f32, 0.1, 0.2);
            let all: Vec3 = open.iter().map(|one| pull(one, place, 0.01)).sum();
            assert!((mouths.pull(999, place, 0.01) - all).length() < 1e-3);
            assert!(all.length() > 0.1);
        }
    }
}
