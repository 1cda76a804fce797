use std::sync::{Mutex, MutexGuard, PoisonError};

use bioscope_acoustics::{ListenerPath, ListenerPose, Medium};
use bioscope_core::{Error, Quat, SoundEvent, Vec3};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Array2;
use crate::error::to_python;

/// A stereo sound track rendered block by block, as heard along a listener's path.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct SoundTrack {
    state: Mutex<State>,
}

struct State {
    track: bioscope_acoustics::SoundTrack,
    path: Option<ListenerPath>,
}

#[pymethods]
impl SoundTrack {
    #[new]
    fn new(sample_rate: u32, seed: u64, under_water: bool) -> PyResult<Self> {
        let medium = if under_water { Medium::WATER } else { Medium::AIR };
        let track = bioscope_acoustics::SoundTrack::new(sample_rate, seed, medium);
        let track = track.map_err(to_python)?;
        Ok(Self { state: Mutex::new(State { track, path: None }) })
    }

    /// Adds sound events, as `World.sounds` gives them.
    fn add(&self, sounds: Vec<Bound<'_, PyDict>>) -> PyResult<()> {
        let events = sounds.iter().map(event).collect::<PyResult<Vec<_>>>()?;
        self.lock().track.add(&events).map_err(to_python)
    }

    /// Says where the listener is at a time (a camera's position and rotation); `cut` jumps there.
    fn listen(&self, time: f64, position: [f32; 3], rotation: [f32; 4], cut: bool) -> PyResult<()> {
        let (position, rotation) = (Vec3::from_array(position), Quat::from_array(rotation));
        let pose = ListenerPose { time, position, rotation };
        let mut state = self.lock();
        let outcome = match &mut state.path {
            None => ListenerPath::starting(pose).map(|path| state.path = Some(path)),
            Some(path) if cut => path.cut(pose),
            Some(path) => path.push(pose),
        };
        outcome.map_err(to_python)
    }

    /// Left and right samples (frames, 2) from this time on; 1 is full scale.
    fn render<'py>(
        &self,
        py: Python<'py>,
        from_time: f64,
        frames: usize,
    ) -> PyResult<Array2<'py, f32>> {
        let block = py.detach(|| {
            let mut state = self.lock();
            let State { track, path } = &mut *state;
            match path {
                Some(path) => track.render(path, from_time, frames),
                None => Err(Error::value("listener", "nowhere", "listen() before render()")),
            }
        });
        let block = block.map_err(to_python)?;
        block.into_flattened().into_pyarray(py).reshape([frames, 2])
    }
}

impl SoundTrack {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn event(dict: &Bound<'_, PyDict>) -> PyResult<SoundEvent> {
    fn part<'py, T>(dict: &Bound<'py, PyDict>, name: &str) -> PyResult<T>
    where
        T: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
    {
        let found = dict.get_item(name)?;
        let missing = || to_python(Error::value("sound", "incomplete", format!("a '{name}'")));
        found.ok_or_else(missing)?.extract()
    }
    Ok(SoundEvent {
        source: part(dict, "source")?,
        kind: part::<String>(dict, "kind")?.into(),
        time: part(dict, "time")?,
        duration: part(dict, "duration")?,
        position: Vec3::from_array(part(dict, "position")?),
        velocity: Vec3::from_array(part(dict, "velocity")?),
        amplitude: part(dict, "amplitude")?,
        pitch: part(dict, "pitch")?,
    })
}
