use std::collections::BTreeMap;

use bioscope_core::Value;
use bioscope_crowds::statistics;
use bioscope_senses::eye_camera;
use bioscope_world::Inspection;

use super::FishSchool;

/// What fishes see, degrees (Tu and Terzopoulos 1994).
const FIELD_OF_VIEW: f32 = 300.0;
/// Farthest neighbor that statistics look for, body lengths.
const FARTHEST: f32 = 20.0;

impl FishSchool {
    /// What can be known of one fish.
    pub(super) fn inspect_one(&self, index: usize) -> Inspection {
        let fish = &self.fishes[index];
        let placement = self.placement(index);
        let length = self.flock.parameters.body_length * fish.scale;
        let speed = self.flock.velocities()[index].length();
        let values = [
            ("body_length_m", length.into()),
            ("speed_m_per_s", fish.motion.length().into()),
            ("speed_body_lengths_per_s", (speed / length).into()),
            ("tail_beat_hz", self.form.spine.gait().tail_beat(speed / length).into()),
            ("tail_amplitude", fish.swim.amplitude.into()),
            ("alarm", self.flock.alarms()[index].into()),
        ];
        Inspection {
            species: self.options.species.name.clone(),
            behavior: Some(fish.mode.name().to_owned()),
            values: named(values),
            percepts: self.percepts(index),
            eye: Some(eye_camera(&placement, length, FIELD_OF_VIEW.to_radians())),
            ..Inspection::default()
        }
    }

    /// Neighbors as the flock's rules count them, in the fish's own frame.
    fn percepts(&self, index: usize) -> BTreeMap<String, Value> {
        let place = self.flock.positions()[index];
        let radius = self.flock.parameters.radius_metres();
        let back = self.flock.rotation(index).inverse();
        let others = self.flock.positions().iter().enumerate();
        let near = others
            .filter(|&(other, _)| other != index)
            .map(|(_, other)| back * (*other - place))
            .filter(|offset| offset.length() < radius);
        let near: Vec<_> = near.collect();
        let nearest = near.iter().map(|offset| offset.length()).fold(f32::INFINITY, f32::min);
        let mut percepts = named([
            ("neighbors", (near.len() as f64).into()),
            ("goal", (back * (self.course.goal - place)).into()),
        ]);
        if !near.is_empty() {
            let middle = near.iter().sum::<bioscope_core::Vec3>() / near.len() as f32;
            percepts.insert("neighbors_middle_m".into(), middle.into());
            percepts.insert("nearest_neighbor_m".into(), nearest.into());
        }
        percepts
    }

    /// Figures of the school for charts.
    pub(super) fn figures(&self) -> BTreeMap<String, f64> {
        let count = self.fishes.len();
        let mean = |sum: f64, number: usize| sum / number.max(1) as f64;
        let speeds = self.flock.velocities().iter().map(|one| f64::from(one.length())).sum();
        let reach = FARTHEST * self.flock.parameters.body_length;
        let nearest = statistics::nearest_neighbor_distances(self.flock.positions(), reach);
        let near: Vec<f64> =
            nearest.into_iter().filter(|one| one.is_finite()).map(f64::from).collect();
        let alarm = self.flock.alarms().iter().map(|&one| f64::from(one)).sum();
        let polarization = statistics::polarization(self.flock.velocities());
        BTreeMap::from([
            ("count".into(), count as f64),
            ("driven".into(), self.bodies.driven() as f64),
            ("polarization".into(), f64::from(polarization)),
            ("mean_speed_m_per_s".into(), mean(speeds, count)),
            ("nearest_neighbor_m".into(), mean(near.iter().sum(), near.len())),
            ("groups".into(), self.groups as f64),
            ("alarm".into(), mean(alarm, count)),
        ])
    }
}

fn named<const COUNT: usize>(values: [(&str, Value); COUNT]) -> BTreeMap<String, Value> {
    values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
