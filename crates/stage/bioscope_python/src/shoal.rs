use std::sync::{Mutex, MutexGuard, PoisonError};

use bioscope_core::{Error, Quat, Result, Vec3};
use bioscope_motion::fish::{Command, FishModel, Repertoire, Replica, Swimmers, advance_replicas};
use bioscope_populations::fish::FishSpecies;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::Array3;
use crate::error::to_python;

/// Most fishes of one shoal.
const MOST: usize = 1_000_000;

/// See `bioscope.fish.Shoal`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Shoal {
    fishes: Mutex<Fishes>,
}

enum Fishes {
    Driven(Swimmers),
    Replayed {
        replicas: Vec<Replica>,
        repertoire: Repertoire,
        cruise: usize,
        time_unit: f64,
        step: f64,
    },
}

#[pymethods]
impl Shoal {
    #[new]
    fn new(species: &str, count: usize, replayed: bool) -> PyResult<Self> {
        let fishes = Fishes::new(species, count, replayed).map_err(to_python)?;
        Ok(Self { fishes: Mutex::new(fishes) })
    }

    /// Advances all by `seconds`, `ticks` times.
    fn step(&self, py: Python<'_>, seconds: f64, ticks: u32) -> PyResult<()> {
        if !(1e-6..=1.0).contains(&seconds) {
            return Err(to_python(Error::value("dt", seconds, "0.000001 to 1 second")));
        }
        py.detach(|| {
            let mut fishes = self.lock();
            for _ in 0..ticks {
                match &mut *fishes {
                    Fishes::Driven(swimmers) => swimmers.advance(seconds),
                    Fishes::Replayed { replicas, repertoire, cruise, time_unit, .. } => {
                        let dt = (seconds / *time_unit) as f32;
                        advance_replicas(replicas, repertoire, *cruise, dt);
                    }
                }
            }
        });
        Ok(())
    }

    /// Lets one fish turn, radians, positive to the left.
    fn turn(&self, index: usize, angle: f32) -> PyResult<()> {
        match &mut *self.lock() {
            Fishes::Driven(swimmers) if index < swimmers.len() => swimmers.turn(index, angle),
            Fishes::Replayed { replicas, repertoire, .. } if index < replicas.len() => {
                replicas[index].play(repertoire.turn(angle));
            }
            _ => return Err(to_python(Error::value("index", index, "that of a fish"))),
        }
        Ok(())
    }

    /// Seconds of the natural step.
    #[getter]
    fn natural_step(&self) -> f64 {
        match &*self.lock() {
            Fishes::Driven(swimmers) => swimmers.natural_step(),
            Fishes::Replayed { time_unit, step, .. } => step * time_unit,
        }
    }

    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Array3<'py, f32>> {
        let mut numbers: Vec<f32> = Vec::new();
        let count = match &*self.lock() {
            Fishes::Driven(swimmers) => {
                for index in 0..swimmers.len() {
                    numbers.extend(swimmers.nodes(index).as_flattened().iter().map(|&x| x as f32));
                }
                swimmers.len()
            }
            Fishes::Replayed { replicas, .. } => {
                for replica in replicas {
                    numbers.extend(replica.nodes().iter().flat_map(|node| node.to_array()));
                }
                replicas.len()
            }
        };
        numbers.into_pyarray(py).reshape([count, 23, 3])
    }
}

impl Shoal {
    fn lock(&self) -> MutexGuard<'_, Fishes> {
        self.fishes.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Fishes {
    /// Fishes of a species at their cruising speed, a body length apart along X.
    fn new(species: &str, count: usize, replayed: bool) -> Result<Self> {
        if count > MOST {
            let limit = format!("{MOST} fishes");
            return Err(Error::Limit { what: format!("a shoal of {count}"), limit });
        }
        let species = FishSpecies::named(species)?;
        let model = FishModel::named("calibrated")?;
        let length = species.length;
        let mut swimmers = Swimmers::new(model.clone(), f64::from(species.swimming.cruise))?;
        let time_unit = swimmers.time_unit();
        if replayed {
            let repertoire = Repertoire::capture(&model)?;
            let cruise = repertoire.forward(model.design.swim.cruise as f32);
            let replicas = (0..count).map(|index| {
                let place = Vec3::X * (length * index as f32);
                let share = (index as f32 * 0.618).fract();
                Replica::new(&repertoire, (place, 0.0, length), (cruise, share))
            });
            let replicas = replicas.collect::<Result<_>>()?;
            let step = model.design.step;
            return Ok(Self::Replayed { replicas, repertoire, cruise, time_unit, step });
        }
        let speed = species.swimming.cruise * length;
        for index in 0..count {
            let place = [f64::from(length) * index as f64, 0.0, 0.0];
            swimmers.add(place, Quat::IDENTITY, f64::from(length))?;
            swimmers.motor_mut(index).phase = (index as f32 * 0.618).fract();
            swimmers.kick(index, Vec3::Z * speed);
            swimmers.command(index, Command { speed, ..Command::default() })?;
        }
        Ok(Self::Driven(swimmers))
    }
}
