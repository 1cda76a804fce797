use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bioscope_core::{Annotation, Error, Event, Mark, Quat, Result, SoundEvent, Vec3};
use bioscope_geometry as geometry;
use bioscope_world::Moment;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::error::to_python;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::values;

/// See `bioscope.Publication`: where a population written in Python shows itself.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Publication {
    moment: Moment,
    parts: Mutex<Parts>,
}

/// What one population has published so far.
#[derive(Default)]
struct Parts {
    batches: Vec<geometry::Batch>,
    points: Vec<geometry::Points>,
    annotations: Vec<Annotation>,
    sounds: Vec<SoundEvent>,
    events: Vec<Event>,
}

impl Publication {
    pub fn new(moment: Moment) -> Self {
        Self { moment, parts: Mutex::default() }
    }

    fn parts(&self) -> MutexGuard<'_, Parts> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Hands over what was published to the world's publication.
    pub fn deliver(&self, publication: &mut bioscope_world::Publication) {
        let mut parts = self.parts();
        publication.scene.batches.append(&mut parts.batches);
        publication.scene.points.append(&mut parts.points);
        publication.scene.annotations.append(&mut parts.annotations);
        publication.sounds.append(&mut parts.sounds);
        publication.events.append(&mut parts.events);
    }
}

#[pymethods]
impl Publication {
    /// Of no world: what is shown here can be looked at by itself (`scene`).
    #[new]
    fn alone() -> Self {
        Self::new(Moment { seed: 0, tick: 0, time: 0.0, dt: 0.0 })
    }

    /// What was shown so far as a scene: by itself in white light, which leaves colors their hue, or in the scene
    /// of a world without these individuals.
    #[pyo3(signature = (around=None, *, without=Vec::new()))]
    fn scene(&self, around: Option<&Bound<'_, Scene>>, without: Vec<u32>) -> Scene {
        let mut scene =
            around.map_or_else(in_white_light, |around| around.get().scene.without(&without));
        let parts = self.parts();
        scene.batches.extend(parts.batches.iter().cloned());
        scene.points.extend(parts.points.iter().cloned());
        Scene { scene: Arc::new(scene) }
    }

    #[getter]
    fn tick(&self) -> u64 {
        self.moment.tick
    }

    #[getter]
    fn time(&self) -> f64 {
        self.moment.time
    }

    #[pyo3(signature = (
        name, mesh, material, *, ids, positions, rotations=None, scales=None, velocities=None,
        tints=None, poses=None, species=None, alive=true
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords of a Python call.
    fn instances(
        &self,
        name: &str,
        mesh: &Bound<'_, Mesh>,
        material: &Bound<'_, Material>,
        ids: PyReadonlyArray1<'_, u32>,
        positions: PyReadonlyArray2<'_, f32>,
        rotations: Option<PyReadonlyArray2<'_, f32>>,
        scales: Option<PyReadonlyArray1<'_, f32>>,
        velocities: Option<PyReadonlyArray2<'_, f32>>,
        tints: Option<PyReadonlyArray2<'_, f32>>,
        poses: Option<PyReadonlyArray3<'_, f32>>,
        species: Option<&str>,
        alive: bool,
    ) -> PyResult<()> {
        let (mesh, material) = (mesh.get().mesh.clone(), material.get().material.clone());
        let build = || -> Result<geometry::Batch> {
            let mut batch = geometry::Batch::new(name, species.unwrap_or(name), mesh, material);
            batch.alive = alive;
            batch.ids = ids.as_array().to_vec();
            let count = batch.ids.len();
            let positions = arrays::vectors("positions", &positions)?;
            arrays::same_count("positions", positions.len(), count)?;
            let rotations = match &rotations {
                Some(rotations) => quaternions(rotations, count)?,
                None => vec![Quat::IDENTITY; count],
            };
            let scales = match &scales {
                Some(scales) => positive(scales, count)?,
                None => vec![1.0; count],
            };
            let places = positions.into_iter().zip(rotations).zip(scales);
            batch.transforms = places
                .map(|((position, rotation), scale)| {
                    geometry::Transform::new(position, rotation, scale)
                })
                .collect();
            if let Some(velocities) = &velocities {
                batch.velocities = arrays::vectors("velocities", velocities)?;
                arrays::same_count("velocities", batch.velocities.len(), count)?;
            }
            if let Some(tints) = &tints {
                let rows = arrays::rows("tints", tints, 3)?;
                batch.tints = rows.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect();
                arrays::same_count("tints", batch.tints.len(), count)?;
            }
            if let Some(poses) = &poses {
                batch.poses = joint_poses(poses, &batch)?;
            }
            Ok(batch)
        };
        let batch = build().map_err(to_python)?;
        self.parts().batches.push(batch);
        Ok(())
    }

    #[pyo3(signature = (
        name, *, ids, positions, radii, color=[1.0, 1.0, 1.0], opacity=1.0, glassy=false,
        species=None
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords of a Python call.
    fn points(
        &self,
        name: &str,
        ids: PyReadonlyArray1<'_, u32>,
        positions: PyReadonlyArray2<'_, f32>,
        radii: PyReadonlyArray1<'_, f32>,
        color: [f32; 3],
        opacity: f32,
        glassy: bool,
        species: Option<&str>,
    ) -> PyResult<()> {
        let build = || -> Result<geometry::Points> {
            let ids = ids.as_array().to_vec();
            let positions = arrays::vectors("positions", &positions)?;
            arrays::same_count("positions", positions.len(), ids.len())?;
            let radii = positive(&radii, ids.len())?;
            let (name, species) = (name.to_owned(), species.unwrap_or(name).into());
            Ok(geometry::Points { name, species, ids, positions, radii, color, opacity, glassy })
        };
        let points = build().map_err(to_python)?;
        self.parts().points.push(points);
        Ok(())
    }

    #[pyo3(signature = (kind, subject, object=None, **data))]
    fn event(
        &self,
        kind: &str,
        subject: u32,
        object: Option<u32>,
        data: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let data = values::from_dict(data).map_err(to_python)?;
        let (tick, time) = (self.moment.tick, self.moment.time);
        let kind = kind.to_owned().into();
        self.parts().events.push(Event { tick, time, kind, subject, object, data });
        Ok(())
    }

    #[pyo3(signature = (
        kind, source, position, *, velocity=[0.0; 3], amplitude=0.1, pitch=440.0, duration=0.2
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords of a Python call.
    fn sound(
        &self,
        kind: &str,
        source: u32,
        position: [f32; 3],
        velocity: [f32; 3],
        amplitude: f32,
        pitch: f32,
        duration: f32,
    ) {
        self.parts().sounds.push(SoundEvent {
            source,
            kind: kind.to_owned().into(),
            time: self.moment.time,
            duration,
            position: Vec3::from_array(position),
            velocity: Vec3::from_array(velocity),
            amplitude,
            pitch,
        });
    }

    /// A line from one point to another, drawn by overlays.
    fn line(&self, subject: u32, role: &str, start: [f32; 3], end: [f32; 3]) {
        let (from, to) = (Vec3::from_array(start), Vec3::from_array(end));
        self.annotate(subject, role, Mark::Line { from, to });
    }

    /// A short text at a point, drawn by overlays.
    fn label(&self, subject: u32, role: &str, position: [f32; 3], text: &str) {
        let position = Vec3::from_array(position);
        self.annotate(subject, role, Mark::Label { position, text: text.to_owned() });
    }
}

impl Publication {
    fn annotate(&self, subject: u32, role: &str, mark: Mark) {
        self.parts().annotations.push(Annotation { subject, role: role.to_owned().into(), mark });
    }
}

fn in_white_light() -> geometry::Scene {
    let sun = geometry::Sun { color: [3.0; 3], ..geometry::Sun::default() };
    let sky = geometry::Sky { zenith: [0.5; 3], horizon: [0.7; 3], nadir: [0.2; 3] };
    geometry::Scene { sun, sky, ..geometry::Scene::default() }
}

fn quaternions(array: &PyReadonlyArray2<'_, f32>, count: usize) -> Result<Vec<Quat>> {
    let rows = arrays::rows("rotations", array, 4)?;
    arrays::same_count("rotations", rows.len() / 4, count)?;
    let unit = |(index, row): (usize, &[f32])| {
        let rotation = Quat::from_slice(row);
        if rotation.length_squared() < 1e-12 {
            return Err(Error::value(format!("rotations[{index}]"), "zero", "a quaternion xyzw"));
        }
        Ok(rotation.normalize())
    };
    rows.chunks_exact(4).enumerate().map(unit).collect()
}

fn positive(array: &PyReadonlyArray1<'_, f32>, count: usize) -> Result<Vec<f32>> {
    let numbers = array.as_array().to_vec();
    arrays::same_count("scales or radii", numbers.len(), count)?;
    match numbers.iter().find(|number| !(number.is_finite() && **number > 0.0)) {
        Some(number) => Err(Error::value("scales or radii", number, "finite positive numbers")),
        None => Ok(numbers),
    }
}

/// Poses from an array (instances, joints, 7): x, y, z, qx, qy, qz, qw in mesh space.
fn joint_poses(
    poses: &PyReadonlyArray3<'_, f32>,
    batch: &geometry::Batch,
) -> Result<Vec<geometry::Transform>> {
    let joints = batch.mesh.skin.as_ref().map_or(0, |skin| skin.joints.len());
    let array = poses.as_array();
    let expected = (batch.ids.len(), joints, 7);
    if array.dim() != expected {
        let found = format!("shape {:?}", array.dim());
        return Err(Error::value("poses", found, format!("shape {expected:?}")));
    }
    let numbers: Vec<f32> = array.iter().copied().collect();
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err(Error::value("poses", "not finite", "finite numbers only"));
    }
    let pose = |row: &[f32]| {
        let rotation = Quat::from_slice(&row[3..7]).normalize();
        geometry::Transform::new(Vec3::from_slice(row), rotation, 1.0)
    };
    Ok(numbers.chunks_exact(7).map(pose).collect())
}
