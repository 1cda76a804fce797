use bioscope_core::{Error, Result, Vec3};
use bioscope_geometry::{Motion, Rig};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::camera::Camera;
use crate::error::to_python;
use crate::world::World;

#[pymethods]
impl World {
    /// Adds a camera that stands still.
    fn add_fixed_rig(
        &self,
        py: Python<'_>,
        name: String,
        field_of_view: f32,
        position: [f32; 3],
        target: [f32; 3],
    ) -> PyResult<()> {
        let (position, target) = (Vec3::from_array(position), Vec3::from_array(target));
        self.add_rig(py, Rig { name, field_of_view, motion: Motion::Fixed { position, target } })
    }

    /// Adds a camera that circles.
    #[allow(clippy::too_many_arguments)] // Keywords of a Python call.
    fn add_orbit_rig(
        &self,
        py: Python<'_>,
        name: String,
        field_of_view: f32,
        target: [f32; 3],
        radius: f32,
        height: f32,
        period: f32,
    ) -> PyResult<()> {
        let motion = Motion::Orbit { target: Vec3::from_array(target), radius, height, period };
        self.add_rig(py, Rig { name, field_of_view, motion })
    }

    /// Adds a camera that follows.
    fn add_follow_rig(
        &self,
        py: Python<'_>,
        name: String,
        field_of_view: f32,
        species: String,
        index: usize,
        offset: [f32; 3],
    ) -> PyResult<()> {
        let motion = Motion::Follow { species, index, offset: Vec3::from_array(offset) };
        self.add_rig(py, Rig { name, field_of_view, motion })
    }

    /// The rigs as dicts, as the live stream has them.
    #[getter]
    fn rigs<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let rigs = self.with(py, |world| Ok(world.rigs.clone()))?;
        rigs.iter().map(|rig| rig_dict(py, rig)).collect()
    }

    /// The camera of a rig now; `previous` is its camera `dt` seconds ago. None if it has nothing
    /// to follow.
    #[pyo3(signature = (name, previous=None, dt=0.0))]
    fn camera(
        &self,
        py: Python<'_>,
        name: &str,
        previous: Option<&Bound<'_, Camera>>,
        dt: f32,
    ) -> PyResult<Option<Camera>> {
        let previous = previous.map(|camera| camera.get().camera);
        self.with(py, |world| {
            let rig = known(world, name)?;
            let camera = rig.camera(world.scene(), previous.as_ref(), dt);
            Ok(camera.map(|camera| Camera { camera }))
        })
    }

    /// The film the world suggests: names of cameras and seconds to stay with each.
    #[getter]
    fn get_shots(&self, py: Python<'_>) -> PyResult<Vec<(String, f32)>> {
        self.with(py, |world| Ok(world.shots.clone()))
    }

    #[setter]
    fn set_shots(&self, py: Python<'_>, shots: Vec<(String, f32)>) -> PyResult<()> {
        self.with(py, |world| {
            for (name, seconds) in &shots {
                known(world, name)?;
                if !(*seconds > 0.0 && seconds.is_finite()) {
                    return Err(Error::value("shots", seconds, "seconds above 0"));
                }
            }
            world.shots = shots;
            Ok(())
        })
    }
}

fn known<'a>(world: &'a bioscope_world::World, name: &str) -> Result<&'a Rig> {
    let unknown = || Error::Unknown {
        kind: "camera",
        name: name.to_owned(),
        known: world.rigs.iter().map(|rig| rig.name.clone()).collect(),
    };
    world.rigs.iter().find(|rig| rig.name == name).ok_or_else(unknown)
}

impl World {
    fn add_rig(&self, py: Python<'_>, rig: Rig) -> PyResult<()> {
        if !(rig.field_of_view > 0.0 && rig.field_of_view < 3.1) {
            let expected = "an angle in radians above 0 and below 3.1";
            return Err(to_python(Error::value("field_of_view", rig.field_of_view, expected)));
        }
        self.with(py, |world| {
            world.rigs.retain(|one| one.name != rig.name);
            world.rigs.push(rig);
            world.publish_again()
        })
    }
}

fn rig_dict<'py>(py: Python<'py>, rig: &Rig) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", &rig.name)?;
    dict.set_item("field_of_view", rig.field_of_view)?;
    match &rig.motion {
        Motion::Fixed { position, target } => {
            dict.set_item("kind", "fixed")?;
            dict.set_item("position", position.to_array())?;
            dict.set_item("target", target.to_array())?;
        }
        Motion::Orbit { target, radius, height, period } => {
            dict.set_item("kind", "orbit")?;
            dict.set_item("target", target.to_array())?;
            dict.set_item("radius", radius)?;
            dict.set_item("height", height)?;
            dict.set_item("period", period)?;
        }
        Motion::Follow { species, index, offset } => {
            dict.set_item("kind", "follow")?;
            dict.set_item("species", species)?;
            dict.set_item("index", index)?;
            dict.set_item("offset", offset.to_array())?;
        }
    }
    Ok(dict)
}
