use std::sync::{Mutex, PoisonError};

use bioscope_stream::Status;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::scene::Scene;

/// Turns the scenes of one world into the messages of the live stream.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Encoder {
    encoder: Mutex<bioscope_stream::Encoder>,
}

/// Revision of the layout, the layout if it is new, the frame.
type Encoded<'py> = (u64, Option<Bound<'py, PyBytes>>, Bound<'py, PyBytes>);

#[pymethods]
impl Encoder {
    #[new]
    fn new() -> Self {
        Self { encoder: Mutex::default() }
    }

    /// Encodes a scene; `speed` none means as fast as possible.
    #[pyo3(signature = (scene, *, running=true, speed=None, rate=0.0, annotations=false))]
    fn encode<'py>(
        &self,
        py: Python<'py>,
        scene: &Bound<'py, Scene>,
        running: bool,
        speed: Option<f64>,
        rate: f64,
        annotations: bool,
    ) -> Encoded<'py> {
        let scene = scene.get().scene.clone();
        let status = Status { running, speed, rate, annotations };
        let update = py.detach(|| self.lock().encode(&scene, &status));
        let layout = update.layout.map(|bytes| PyBytes::new(py, &bytes));
        (update.revision, layout, PyBytes::new(py, &update.frame))
    }

    /// Keys of everything that the present layout uses, each before its first use.
    fn keys(&self) -> Vec<u64> {
        self.lock().keys().collect()
    }

    /// The message of one of them; none for another key.
    fn asset<'py>(&self, py: Python<'py>, key: u64) -> Option<Bound<'py, PyBytes>> {
        self.lock().asset(key).map(|bytes| PyBytes::new(py, bytes))
    }
}

impl Encoder {
    fn lock(&self) -> std::sync::MutexGuard<'_, bioscope_stream::Encoder> {
        self.encoder.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
