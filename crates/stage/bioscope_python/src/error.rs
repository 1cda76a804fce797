use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use bioscope_core::Error;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

static NEXT_TRACE: AtomicU64 = AtomicU64::new(1);
static TRACES: Mutex<BTreeMap<u64, PyErr>> = Mutex::new(BTreeMap::new());

/// The Python exception for an engine error: one of the tree under `bioscope.BioscopeError`, or the
/// user's own exception if a callback raised it.
pub fn to_python(error: Error) -> PyErr {
    let message = error.to_string();
    let class = match &error {
        Error::Callback { trace, .. } => {
            if let Some(original) = lock().remove(trace) {
                return annotated(original, &message);
            }
            "CallbackError"
        }
        Error::Value { .. } => "InvalidValueError",
        Error::Unknown { .. } => "UnknownNameError",
        Error::Format { .. } => "FormatError",
        Error::Limit { .. } => "LimitError",
    };
    Python::attach(|py| {
        let build = || py.import("bioscope.errors")?.getattr(class)?.call1((message.as_str(),));
        match build() {
            Ok(exception) => PyErr::from_value(exception),
            Err(_) => PyRuntimeError::new_err(message),
        }
    })
}

/// Keeps an exception of the user's code while the engine unwinds the tick.
pub fn from_python(name: &str, verb: &'static str, error: PyErr) -> Error {
    let message = error.to_string();
    let trace = NEXT_TRACE.fetch_add(1, Ordering::Relaxed);
    lock().insert(trace, error);
    Error::Callback { name: name.to_owned(), verb, message, trace }
}

fn annotated(error: PyErr, message: &str) -> PyErr {
    Python::attach(|py| {
        let place = message.split(": ").next().unwrap_or(message);
        let note = format!("bioscope: {place}; the world is at its last complete tick");
        // A note is a courtesy: an exception that refuses it is still raised.
        let _ = error.value(py).call_method1("add_note", (note,));
    });
    error
}

fn lock() -> std::sync::MutexGuard<'static, BTreeMap<u64, PyErr>> {
    TRACES.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
