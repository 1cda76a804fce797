use bioscope_core::{
    Annotation, Error, Impact, Intention, Mark, NOTHING, Percepts, Purpose, Quat, Random, Sighting,
};
use bioscope_minds::Mind;
use bioscope_populations::catalog::plain;
use bioscope_populations::fish::{MindRequest, mind};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

use crate::error::to_python;
use crate::mind::{display, display_dict, number, unknown, vector};
use crate::values;

const DECISION: Purpose = Purpose::new("mind by itself");

/// One of the engine's minds of fishes, by itself: percepts in, an intention out.
#[pyclass(module = "bioscope._engine")]
pub struct FishMind {
    mind: Box<dyn Mind>,
}

#[pymethods]
impl FishMind {
    /// A mind as a JSON request asks for it.
    #[new]
    fn new(request: &str) -> PyResult<Self> {
        let request: MindRequest = serde_json::from_str(request)
            .map_err(|error| to_python(Error::format("mind", plain(&error))))?;
        Ok(Self { mind: request.build().map_err(to_python)? })
    }

    /// The mind of this kind that `save` wrote.
    #[staticmethod]
    fn restore(kind: &str, data: &[u8]) -> PyResult<Self> {
        Ok(Self { mind: mind(kind, data).map_err(to_python)? })
    }

    /// What it wants now; chance comes from seed, own id and tick.
    fn decide<'py>(
        &mut self,
        py: Python<'py>,
        percepts: &Bound<'py, PyDict>,
        seed: u64,
        tick: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let percepts = read_percepts(percepts)?;
        let mut random = Random::new(seed, percepts.id, tick, DECISION);
        let mut annotations = Vec::new();
        let wanted =
            self.mind.decide(&percepts, &mut random, &mut annotations).map_err(to_python)?;
        let dict = intention_dict(py, &wanted)?;
        dict.set_item("annotations", annotations_list(py, &annotations)?)?;
        Ok(dict)
    }

    /// Inner life by name.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        values::dict(py, &self.mind.values())
    }

    /// Tunable numbers with their current values: name, unit, minimum, maximum, meaning, source, value.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        let Some(parameters) = self.mind.parameters() else { return Ok(list) };
        for one in parameters.descriptions() {
            let value = parameters.get(&one.name).unwrap_or(one.default);
            list.append((
                one.name,
                one.unit,
                one.minimum,
                one.maximum,
                one.meaning,
                one.source,
                value,
            ))?;
        }
        Ok(list)
    }

    /// Changes one tunable number.
    fn set(&mut self, name: &str, value: f64) -> PyResult<()> {
        match self.mind.parameters_mut() {
            Some(parameters) => parameters.set(name, value).map_err(to_python),
            None => Err(unknown("parameter", name, &[])),
        }
    }

    /// Complete state.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.mind.save().map_err(to_python)?))
    }
}

fn intention_dict<'py>(py: Python<'py>, wanted: &Intention) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("behavior", &*wanted.behavior)?;
    dict.set_item("heading", wanted.heading.to_array())?;
    dict.set_item("turn", wanted.turn())?;
    dict.set_item("pitch", wanted.pitch())?;
    dict.set_item("speed", wanted.speed)?;
    dict.set_item("urgency", wanted.urgency)?;
    dict.set_item("brake", wanted.brake)?;
    dict.set_item("mouth", wanted.mouth)?;
    dict.set_item("gaze", wanted.gaze.map(|gaze| gaze.to_array()))?;
    dict.set_item("target", wanted.target.filter(|&target| target != NOTHING))?;
    dict.set_item("display", display_dict(py, &wanted.display)?)?;
    Ok(dict)
}

fn annotations_list<'py>(
    py: Python<'py>,
    annotations: &[Annotation],
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for one in annotations {
        if let Mark::Line { from, to } = &one.mark {
            list.append((one.role.as_ref(), from.to_array(), to.to_array()))?;
        }
    }
    Ok(list)
}

const PERCEPTS: [&str; 18] = [
    "id",
    "time",
    "dt",
    "velocity",
    "attitude",
    "body_length",
    "depth",
    "home",
    "seen",
    "smelled",
    "fed",
    "ahead",
    "solids",
    "flow",
    "light",
    "temperature",
    "random",
    "other",
];

/// Typed-in percepts; whatever is left out is as for an animal that notices nothing.
fn read_percepts(dict: &Bound<'_, PyDict>) -> PyResult<Percepts> {
    let mut percepts = Percepts { id: 1, dt: 1.0 / 30.0, body_length: 0.1, ..Percepts::default() };
    for (name, value) in dict.iter() {
        match name.extract::<String>()?.as_str() {
            "id" => percepts.id = value.extract()?,
            "time" => percepts.time = value.extract()?,
            "dt" => percepts.dt = number("dt", &value)?,
            "velocity" => percepts.velocity = vector("velocity", &value)?,
            "attitude" => percepts.attitude = attitude(&value)?,
            "body_length" => percepts.body_length = number("body_length", &value)?,
            "depth" => percepts.depth = number("depth", &value)?,
            "home" => percepts.home = vector("home", &value)?,
            "seen" => percepts.seen = sightings(&value)?,
            "smelled" => percepts.smelled = sightings(&value)?,
            "fed" => percepts.fed = value.extract()?,
            "ahead" if value.is_none() => {}
            "ahead" => percepts.ahead = Some(impact(&value.cast_into::<PyDict>()?)?),
            "solids" => percepts.solids = points(&value)?,
            "flow" => percepts.flow = vector("flow", &value)?,
            "light" => percepts.light = number("light", &value)?,
            "temperature" => percepts.temperature = number("temperature", &value)?,
            "other" => {
                percepts.other =
                    values::from_dict(Some(&value.cast_into::<PyDict>()?)).map_err(to_python)?
            }
            "random" | "heard" | "retina" => {}
            other => return Err(unknown("percept", other, &PERCEPTS)),
        }
    }
    if percepts.time.is_finite() {
        return Ok(percepts);
    }
    Err(to_python(Error::value("time", percepts.time, "a finite number of seconds")))
}

fn attitude(value: &Bound<'_, PyAny>) -> PyResult<Quat> {
    let numbers: [f32; 4] = value.extract()?;
    let attitude = Quat::from_array(numbers);
    if attitude.is_finite() && attitude.length_squared() > 1e-12 {
        return Ok(attitude.normalize());
    }
    Err(to_python(Error::value("attitude", attitude, "a quaternion (x, y, z, w) other than zero")))
}

fn points(value: &Bound<'_, PyAny>) -> PyResult<Vec<bioscope_core::Vec3>> {
    value.try_iter()?.map(|one| vector("solids", &one?)).collect()
}

fn impact(dict: &Bound<'_, PyDict>) -> PyResult<Impact> {
    let part = |name: &'static str| {
        dict.get_item(name)?.ok_or_else(|| {
            to_python(Error::format(
                "ahead",
                format!("'{name}' is missing; expected distance and aim"),
            ))
        })
    };
    Ok(Impact {
        distance: number("distance", &part("distance")?)?,
        aim: vector("aim", &part("aim")?)?,
    })
}

fn sightings(value: &Bound<'_, PyAny>) -> PyResult<Vec<Sighting>> {
    value.try_iter()?.map(|one| sighting(&one?.cast_into::<PyDict>()?)).collect()
}

fn sighting(dict: &Bound<'_, PyDict>) -> PyResult<Sighting> {
    let mut sighting = Sighting { size: 0.1, ..Sighting::default() };
    for (name, value) in dict.iter() {
        match name.extract::<String>()?.as_str() {
            "id" => sighting.id = value.extract()?,
            "species" => sighting.species = value.extract::<String>()?.into(),
            "position" => sighting.position = vector("position", &value)?,
            "velocity" => sighting.velocity = vector("velocity", &value)?,
            "heading" => sighting.heading = vector("heading", &value)?,
            "size" => sighting.size = number("size", &value)?,
            "color" => sighting.color = value.extract()?,
            "display" => sighting.display = display(&value.cast_into::<PyDict>()?)?,
            other => {
                let known = [
                    "id", "species", "position", "velocity", "heading", "size", "color", "display",
                ];
                return Err(unknown("part of a sighting", other, &known));
            }
        }
    }
    Ok(sighting)
}
