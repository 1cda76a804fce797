use std::collections::BTreeMap;

use bioscope_core::{Error, Event, Result, Value};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

/// A plain value as a Python object.
pub fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Flag(flag) => flag.into_bound_py_any(py),
        Value::Number(number) => number.into_bound_py_any(py),
        Value::Text(text) => text.into_bound_py_any(py),
        Value::Numbers(numbers) => numbers.into_bound_py_any(py),
    }
}

/// A map of plain values as a dict.
pub fn dict<'py>(
    py: Python<'py>,
    values: &BTreeMap<String, Value>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in values {
        dict.set_item(name, to_python(py, value)?)?;
    }
    Ok(dict)
}

/// A plain value from a Python object; `name` is for the error.
pub fn from_python(name: &str, object: &Bound<'_, PyAny>) -> Result<Value> {
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Flag(flag.is_true()));
    }
    if let Ok(number) = object.extract::<f64>() {
        return Ok(Value::Number(number));
    }
    if let Ok(text) = object.extract::<String>() {
        return Ok(Value::Text(text));
    }
    object
        .extract::<Vec<f64>>()
        .map(Value::Numbers)
        .map_err(|_| Error::value(name, object, "a truth value, number, text or list of numbers"))
}

/// A map of plain values from a dict.
pub fn from_dict(dict: Option<&Bound<'_, PyDict>>) -> Result<BTreeMap<String, Value>> {
    let mut values = BTreeMap::new();
    for (key, value) in dict.into_iter().flat_map(|dict| dict.iter()) {
        let key = key.to_string();
        values.insert(key.clone(), from_python(&key, &value)?);
    }
    Ok(values)
}

/// An event as the tuple (tick, time, kind, subject, object, data).
pub fn event<'py>(py: Python<'py>, event: &Event) -> PyResult<Bound<'py, PyAny>> {
    let data = dict(py, &event.data)?;
    (event.tick, event.time, &*event.kind, event.subject, event.object, data).into_bound_py_any(py)
}
