use std::collections::BTreeMap;

use bioscope_core::{
    Annotation, Id, Intention, Mark, Parameters, Percepts, Quat, Random, Result, Value, Vec3,
};

/// What one animal wants, decided once a tick from what it notices.
pub trait Mind: Send + Sync {
    /// Word under which saved worlds find the constructor: `roamer`.
    fn name(&self) -> &str;

    /// What the animal wants now. Everything that lasts is in the mind's own state; chance comes
    /// only from `random`, the stream of this individual at this tick. Annotations are pushed in
    /// the animal's own frame and without subject; whoever runs the mind calls [`place`].
    fn decide(
        &mut self,
        percepts: &Percepts,
        random: &mut Random,
        annotations: &mut Vec<Annotation>,
    ) -> Result<Intention>;

    /// Inner life for inspectors: drives and the like, by name.
    fn values(&self) -> BTreeMap<String, Value> {
        BTreeMap::new()
    }

    /// Tunable numbers, if it has any.
    fn parameters(&self) -> Option<&dyn Parameters> {
        None
    }

    /// Tunable numbers for changing.
    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        None
    }

    /// Complete state, parameters included, as bytes.
    fn save(&self) -> Result<Vec<u8>>;
}

/// Carries annotations from the own frame of `subject` into the world: its place in metres and
/// its rotation from the own frame to the world's.
pub fn place(annotations: &mut [Annotation], subject: Id, position: Vec3, attitude: Quat) {
    let carry = |point: &mut Vec3| *point = position + attitude * *point;
    for annotation in annotations {
        annotation.subject = subject;
        match &mut annotation.mark {
            Mark::Line { from, to } => {
                carry(from);
                carry(to);
            }
            Mark::Sphere { center, .. } => carry(center),
            Mark::Label { position, .. } => carry(position),
        }
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::NOTHING;

    use super::*;

    #[test]
    fn what_lies_ahead_of_the_animal_is_placed_ahead_of_it_in_the_world() {
        let mark = Mark::Line { from: Vec3::ZERO, to: 2.0 * Vec3::Z };
        let mut notes = [Annotation { subject: NOTHING, role: "target".into(), mark }];
        let facing_x = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
        place(&mut notes, 9, Vec3::new(1.0, 5.0, 0.0), facing_x);
        assert_eq!(notes[0].subject, 9);
        let Mark::Line { from, to } = &notes[0].mark else { panic!("still a line") };
        assert_eq!(*from, Vec3::new(1.0, 5.0, 0.0));
        assert!((*to - Vec3::new(3.0, 5.0, 0.0)).length() < 1e-5);
    }
}
