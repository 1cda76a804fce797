use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Act, Annotation, Display, Error, Intention, Mark, NOTHING, Percepts, Random, Result, Sex,
    Sighting, Vec3,
};
use bioscope_minds::Mind;
use bioscope_populations::animals::Kinds;
use bioscope_populations::catalog;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

use crate::error::{from_python, to_python};
use crate::population::Resident;
use crate::values;

/// A mind written in Python (`bioscope.Mind`).
pub struct PythonMind {
    object: Py<PyAny>,
    name: String,
}

impl PythonMind {
    /// Brings one of this class back from its saved state.
    fn rebuild(class: &Py<PyAny>, name: &str, bytes: &[u8]) -> Result<Self> {
        let build = |py: Python<'_>| -> PyResult<Py<PyAny>> {
            let state = PyBytes::new(py, bytes);
            class.bind(py).call_method1("_rebuilt", (state,)).map(Bound::unbind)
        };
        let object = Python::attach(build).map_err(|error| from_python(name, "restore", error))?;
        Ok(Self { object, name: name.to_owned() })
    }
}

impl Mind for PythonMind {
    fn name(&self) -> &str {
        &self.name
    }

    fn decide(
        &mut self,
        percepts: &Percepts,
        random: &mut Random,
        annotations: &mut Vec<Annotation>,
    ) -> Result<Intention> {
        let call = |py: Python<'_>| {
            let noticed = percepts_dict(py, percepts, random)?;
            let wanted = self.object.bind(py).call_method1("decide", (noticed,))?;
            let wrong = || to_python(Error::value("decide", &wanted, "a dict of what it wants"));
            intention(wanted.cast::<PyDict>().map_err(|_| wrong())?)
        };
        let intention =
            Python::attach(call).map_err(|error| from_python(&self.name, "decide", error))?;
        let to = intention.heading.normalize_or_zero();
        annotations.push(Annotation {
            subject: bioscope_core::NOTHING,
            role: "heading".into(),
            mark: Mark::Line { from: Vec3::ZERO, to },
        });
        Ok(intention)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Python::attach(|py| self.object.bind(py).call_method0("_save")?.extract())
            .map_err(|error| from_python(&self.name, "save", error))
    }
}

/// Classes of minds by the kinds under which their states are saved.
pub type Classes = BTreeMap<String, Py<PyAny>>;

/// Fish with minds made by a Python function; `options` is a JSON object. Newcomers among them have minds of the
/// same classes, whatever else is called like these.
#[pyfunction]
pub fn fish_with_minds(
    options: &str,
    parameters: BTreeMap<String, f64>,
    make: &Bound<'_, PyAny>,
) -> PyResult<Resident> {
    let mut minds = Vec::new();
    let mut classes = Classes::new();
    let count = serde_json::from_str::<serde_json::Value>(options)
        .ok()
        .and_then(|options| options["count"].as_u64())
        // More are refused below: none is made for them.
        .filter(|&count| count <= catalog::MOST_SINGLE_FISHES as u64)
        .unwrap_or(0);
    for _ in 0..count {
        let object = make.call0()?;
        let class = object.get_type();
        let name: String = class.getattr("kind")?.extract()?;
        let known =
            classes.entry(name.clone()).or_insert_with(|| class.clone().into_any().unbind());
        if !known.bind(make.py()).is(&class) {
            let expected = "one class of this kind: give the other a `kind` of its own";
            return Err(to_python(Error::value("mind", name, expected)));
        }
        minds.push(PythonMind { object: object.unbind(), name });
    }
    minds.reverse();
    let minds = std::cell::RefCell::new(minds);
    let next = || minds.borrow_mut().pop().map(|mind| Box::new(mind) as Box<dyn Mind>);
    let animals = catalog::fish_with_minds(options, &parameters, &next, parts(classes));
    animals.map(Resident::new).map_err(to_python)
}

/// Constructors of the parts of animals, Python minds of these classes among them.
pub fn parts(classes: Classes) -> Arc<Kinds> {
    let mut known = Kinds::default();
    for (kind, class) in classes {
        let name = kind.clone();
        known
            .add_mind(&kind, move |bytes| Ok(Box::new(PythonMind::rebuild(&class, &name, bytes)?)));
    }
    Arc::new(known)
}

fn percepts_dict<'py>(
    py: Python<'py>,
    percepts: &Percepts,
    random: &mut Random,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("id", percepts.id)?;
    dict.set_item("time", percepts.time)?;
    dict.set_item("dt", percepts.dt)?;
    dict.set_item("velocity", percepts.velocity.to_array())?;
    dict.set_item("attitude", percepts.attitude.to_array())?;
    dict.set_item("body_length", percepts.body_length)?;
    dict.set_item("depth", percepts.depth)?;
    dict.set_item("home", percepts.home.to_array())?;
    dict.set_item("flow", percepts.flow.to_array())?;
    dict.set_item("light", percepts.light)?;
    dict.set_item("temperature", percepts.temperature)?;
    dict.set_item("random", [(); 4].map(|()| random.uniform()))?;
    dict.set_item("seen", sightings(py, &percepts.seen)?)?;
    dict.set_item("smelled", sightings(py, &percepts.smelled)?)?;
    dict.set_item("fed", percepts.fed)?;
    dict.set_item("solids", percepts.solids.iter().map(Vec3::to_array).collect::<Vec<_>>())?;
    if let Some(retina) = &percepts.retina {
        let view = PyDict::new(py);
        view.set_item("width", retina.width)?;
        view.set_item("height", retina.height)?;
        view.set_item("color", retina.color.clone())?;
        view.set_item("range", retina.range.clone())?;
        view.set_item("identity", retina.identity.clone())?;
        dict.set_item("retina", view)?;
    }
    let ahead = match percepts.ahead {
        None => py.None().into_bound(py),
        Some(impact) => {
            let ahead = PyDict::new(py);
            ahead.set_item("distance", impact.distance)?;
            ahead.set_item("aim", impact.aim.to_array())?;
            ahead.into_any()
        }
    };
    dict.set_item("ahead", ahead)?;
    let heard = PyList::empty(py);
    for one in &percepts.heard {
        let hearing = PyDict::new(py);
        hearing.set_item("source", one.source)?;
        hearing.set_item("kind", one.kind.as_ref())?;
        hearing.set_item("direction", one.direction.to_array())?;
        hearing.set_item("amplitude", one.amplitude)?;
        heard.append(hearing)?;
    }
    dict.set_item("heard", heard)?;
    dict.set_item("other", values::dict(py, &percepts.other)?)?;
    Ok(dict)
}

fn sightings<'py>(py: Python<'py>, all: &[Sighting]) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for one in all {
        let sighting = PyDict::new(py);
        sighting.set_item("id", one.id)?;
        sighting.set_item("species", &*one.species)?;
        sighting.set_item("position", one.position.to_array())?;
        sighting.set_item("velocity", one.velocity.to_array())?;
        sighting.set_item("heading", one.heading.to_array())?;
        sighting.set_item("size", one.size)?;
        sighting.set_item("color", one.color)?;
        sighting.set_item("display", display_dict(py, &one.display)?)?;
        list.append(sighting)?;
    }
    Ok(list)
}

/// What an animal shows, as a dict.
pub fn display_dict<'py>(py: Python<'py>, display: &Display) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("sex", sex_name(display.sex))?;
    dict.set_item("act", display.act.name())?;
    dict.set_item("partner", (display.partner != NOTHING).then_some(display.partner))?;
    Ok(dict)
}

fn sex_name(sex: Sex) -> Option<&'static str> {
    match sex {
        Sex::Unknown => None,
        Sex::Female => Some("female"),
        Sex::Male => Some("male"),
    }
}

/// What an animal shows, from a dict with any of `sex`, `act` and `partner`.
pub fn display(asked: &Bound<'_, PyDict>) -> PyResult<Display> {
    let mut display = Display::NONE;
    for (name, value) in asked.iter() {
        match name.extract::<String>()?.as_str() {
            "sex" if value.is_none() => display.sex = Sex::Unknown,
            "sex" => display.sex = sex(&word("display: sex", &value)?)?,
            "act" => display.act = act(&word("display: act", &value)?)?,
            "partner" => {
                display.partner = identity("display: partner", &value)?.unwrap_or(NOTHING);
            }
            other => return Err(unknown("part of a display", other, &["sex", "act", "partner"])),
        }
    }
    Ok(display)
}

fn sex(name: &str) -> PyResult<Sex> {
    match name {
        "female" => Ok(Sex::Female),
        "male" => Ok(Sex::Male),
        other => Err(unknown("sex", other, &["female", "male"])),
    }
}

fn act(name: &str) -> PyResult<Act> {
    let known = Act::ALL.map(Act::name);
    Act::ALL.into_iter().find(|act| act.name() == name).ok_or_else(|| unknown("act", name, &known))
}

/// The error for a name that is not known.
pub fn unknown(kind: &'static str, name: &str, known: &[&str]) -> PyErr {
    let known = known.iter().map(|&one| one.to_owned()).collect();
    to_python(Error::Unknown { kind, name: name.to_owned(), known })
}

/// An intention from the dict that a Python mind returned; every number must be finite.
fn intention(wanted: &Bound<'_, PyDict>) -> PyResult<Intention> {
    let mut intention = Intention { speed: 1.0, urgency: 0.5, ..Intention::default() };
    for (name, value) in wanted.iter() {
        match name.extract::<String>()?.as_str() {
            "behavior" => intention.behavior = word("behavior", &value)?.into(),
            "heading" => intention.heading = vector("heading", &value)?,
            "speed" => intention.speed = number("speed", &value)?,
            "urgency" => intention.urgency = number("urgency", &value)?,
            "gaze" => intention.gaze = Some(vector("gaze", &value)?),
            "target" => intention.target = identity("target", &value)?,
            "brake" => intention.brake = number("brake", &value)?.clamp(0.0, 1.0),
            "mouth" => intention.mouth = number("mouth", &value)?.clamp(0.0, 1.0),
            "display" => intention.display = shown(&value)?,
            other => {
                let known = [
                    "behavior", "heading", "speed", "urgency", "gaze", "target", "brake", "mouth",
                    "display",
                ];
                return Err(unknown("part of an intention", other, &known));
            }
        }
    }
    Ok(intention)
}

fn shown(value: &Bound<'_, PyAny>) -> PyResult<Display> {
    let wrong = |_| to_python(Error::value("display", value, "a dict with sex, act, partner"));
    display(value.cast::<PyDict>().map_err(wrong)?)
}

fn word(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    value.extract().map_err(|_| to_python(Error::value(name, value, "a word")))
}

fn identity(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    value.extract().map_err(|_| to_python(Error::value(name, value, "an id, or None")))
}

/// Three finite numbers.
pub fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec3> {
    let wrong = |_| to_python(Error::value(name, value, "three finite numbers"));
    let vector = Vec3::from_array(value.extract().map_err(wrong)?);
    if vector.is_finite() {
        return Ok(vector);
    }
    Err(to_python(Error::value(name, vector, "three finite numbers")))
}

/// A finite number.
pub fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f32> {
    let wrong = |_| to_python(Error::value(name, value, "a finite number"));
    let number: f32 = value.extract().map_err(wrong)?;
    if number.is_finite() {
        return Ok(number);
    }
    Err(to_python(Error::value(name, number, "a finite number")))
}
