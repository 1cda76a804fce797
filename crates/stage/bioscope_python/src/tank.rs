use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bioscope_core::{Error, Quat, Result, Vec3};
use bioscope_dynamics::Influence;
use bioscope_dynamics::spring_body::Integrator;
use bioscope_motion::fish::{Command, FishDesign, FishModel, Frame, Swimmers};
use bioscope_populations::fish::FishSpecies;
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Array1, Array2};
use crate::error::to_python;
use crate::field::Field;

/// See `bioscope.fish.Tank`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Tank {
    state: Mutex<State>,
    dt: f64,
}

struct State {
    fish: Swimmers<f64>,
    command: Command,
    repairs: u32,
    /// Water that flows differently from place to place, and the time for it, seconds.
    current: Option<Box<dyn bioscope_dynamics::Field>>,
    time: f64,
}

/// A species by name, or by the name and text of its file.
#[derive(FromPyObject)]
enum Species {
    Name(String),
    File(String, String),
}

impl Species {
    fn get(&self) -> Result<Arc<FishSpecies>> {
        match self {
            Self::Name(name) => FishSpecies::named(name),
            Self::File(name, text) => Ok(Arc::new(FishSpecies::parse(text, name)?)),
        }
    }
}

/// A ready-made design by name, or a design file by name and text.
#[derive(FromPyObject)]
enum Preset {
    Name(String),
    File(String, String),
}

impl Preset {
    fn model(&self) -> Result<FishModel> {
        match self {
            Self::Name(name) => Ok(FishModel::clone(&*FishModel::named(name)?)),
            Self::File(name, text) => FishModel::new(FishDesign::parse(text, name)?),
        }
    }
}

#[pymethods]
impl Tank {
    #[new]
    #[pyo3(signature = (species, preset, dt=None, length=None, integrator=None, water=1.0))]
    fn new(
        species: Species,
        preset: Preset,
        dt: Option<f64>,
        length: Option<f64>,
        integrator: Option<&str>,
        water: f64,
    ) -> PyResult<Self> {
        Self::build(&species, &preset, (dt, length), (integrator, water)).map_err(to_python)
    }

    /// Advances by `steps` steps; with activations, which give the contraction of the 12 muscles, else as the
    /// controllers want.
    #[pyo3(signature = (activations=None, steps=1))]
    fn step(
        &self,
        py: Python<'_>,
        activations: Option<PyReadonlyArray1<'_, f64>>,
        steps: u32,
    ) -> PyResult<()> {
        let activations = activations.map(|values| values.as_array().to_vec());
        let activations = activations.map(checked_activations).transpose().map_err(to_python)?;
        py.detach(|| self.run(activations, steps)).map_err(to_python)
    }

    /// Changes parts of the command; none leaves a part.
    #[pyo3(signature = (speed=None, climb=None, brake=None, backward=None))]
    fn command(
        &self,
        speed: Option<f32>,
        climb: Option<f32>,
        brake: Option<f32>,
        backward: Option<f32>,
    ) -> PyResult<()> {
        let mut state = self.lock();
        let State { fish, command, .. } = &mut *state;
        let wanted = Command {
            speed: speed.unwrap_or(command.speed),
            climb: climb.unwrap_or(command.climb),
            brake: brake.unwrap_or(command.brake),
            backward: backward.unwrap_or(command.backward),
            steer: None,
        };
        fish.command(0, wanted).map_err(to_python)?;
        *command = wanted;
        Ok(())
    }

    fn turn(&self, angle: f32) {
        self.lock().fish.turn(0, angle);
    }

    fn set_feedback(&self, feedback: bool) {
        self.lock().fish.motor_mut(0).feedback = feedback;
    }

    fn set_flow(&self, flow: [f32; 3]) {
        let mut state = self.lock();
        state.current = None;
        state.fish.set_flow(0, Vec3::from_array(flow));
    }

    /// Lets the water flow as a field says at the place of the fish.
    fn set_current(&self, field: &Field) -> PyResult<()> {
        self.lock().current = Some(field.take().map_err(to_python)?);
        Ok(())
    }

    fn deform(&self, nodes: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let nodes = nodes.as_array();
        let shape = format!("{:?}", nodes.shape());
        let whole = nodes.iter().copied().collect::<Vec<f64>>();
        let wrong = || to_python(Error::value("nodes", shape, "finite numbers in shape (23, 3)"));
        if nodes.shape() != [23, 3] || !whole.iter().all(|axis| axis.abs() < 1e6) {
            return Err(wrong());
        }
        let nodes = std::array::from_fn(|node| std::array::from_fn(|axis| whole[3 * node + axis]));
        self.lock().fish.set_nodes(0, &nodes);
        Ok(())
    }

    fn kick(&self, change: [f32; 3]) {
        self.lock().fish.kick(0, Vec3::from_array(change));
    }

    /// Sets the fish down at rest, turned by yaw, pitch and roll.
    fn place(&self, yaw: f32, pitch: f32, roll: f32) -> PyResult<()> {
        let mut state = self.lock();
        let rotation = Quat::from_rotation_y(yaw)
            * Quat::from_rotation_x(-pitch)
            * Quat::from_rotation_z(roll);
        let old = &state.fish;
        let (model, length) = (Arc::clone(old.model()), old.length(0));
        let cruise = model.design.swim.cruise / old.time_unit();
        let feedback = old.motor(0).feedback;
        state.fish = stocked(model, cruise, rotation, length).map_err(to_python)?;
        state.fish.motor_mut(0).feedback = feedback;
        let command = state.command;
        state.fish.command(0, command).map_err(to_python)
    }

    #[getter]
    fn dt(&self) -> f64 {
        self.dt
    }

    #[getter]
    fn time_unit(&self) -> f64 {
        self.lock().fish.time_unit()
    }

    #[getter]
    fn length(&self) -> f64 {
        self.lock().fish.length(0)
    }

    #[getter]
    fn mass(&self) -> f64 {
        let state = self.lock();
        state.fish.model().mass(state.fish.length(0))
    }

    /// Cruising speed and top speed, m/s.
    #[getter]
    fn speeds(&self) -> [f64; 2] {
        let state = self.lock();
        let scale = state.fish.length(0) / state.fish.time_unit();
        let swim = &state.fish.model().design.swim;
        [swim.cruise * scale, swim.top_speed() * scale]
    }

    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        rows(py, self.lock().fish.nodes(0).into_iter().flatten().collect(), 3)
    }

    #[getter]
    fn node_velocities<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        rows(py, self.lock().fish.node_velocities(0).into_iter().flatten().collect(), 3)
    }

    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        self.lock().fish.center(0).to_vec().into_pyarray(py)
    }

    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        let velocity = self.lock().fish.velocity(0).to_array();
        velocity.map(f64::from).to_vec().into_pyarray(py)
    }

    /// Yaw, pitch and roll of the trunk, radians.
    #[getter]
    fn attitude(&self) -> [f32; 3] {
        let nodes = self.lock().fish.nodes(0);
        let frame = Frame::of(|node| nodes[node].map(|axis| axis as f32).into());
        [frame.yaw(), frame.pitch(), frame.roll()]
    }

    #[getter]
    fn energy(&self) -> f64 {
        self.lock().fish.energy(0)
    }

    #[getter]
    fn work(&self) -> f64 {
        self.lock().fish.work(0)
    }

    #[getter]
    fn turning(&self) -> bool {
        self.lock().fish.motor(0).is_turning()
    }

    #[getter]
    fn fins(&self) -> [f32; 2] {
        self.lock().fish.motor(0).fins.angles
    }

    #[getter]
    fn contraction<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        self.lock().fish.contraction(0).to_vec().into_pyarray(py)
    }

    /// Masses of the nodes, kg.
    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        let state = self.lock();
        let model = state.fish.model();
        let whole = model.mass(state.fish.length(0));
        let masses: Vec<f64> = model.mechanics.anatomy.masses.iter().map(|m| m * whole).collect();
        masses.into_pyarray(py)
    }

    /// The units, one row each: ends, length at rest (m), stiffness (N/m), damping (N s/m).
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        let state = self.lock();
        let model = state.fish.model();
        let length = state.fish.length(0);
        let (mass, time) = (model.mass(length), state.fish.time_unit());
        let units = model.mechanics.anatomy.units.iter().flat_map(|unit| {
            [
                unit.ends[0] as f64,
                unit.ends[1] as f64,
                unit.rest * length,
                unit.stiffness * mass / (time * time),
                unit.damping * mass / time,
            ]
        });
        rows(py, units.collect(), 5)
    }

    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        let state = self.lock();
        let faces = state.fish.model().mechanics.anatomy.faces.iter().flatten();
        rows(py, faces.map(|&node| node as i64).collect(), 3)
    }

    /// Half-bandwidth and number of stored entries of its matrices.
    #[getter]
    fn skyline(&self) -> [usize; 2] {
        let state = self.lock();
        let skyline = state.fish.model().mechanics.anatomy.skyline();
        [skyline.half_bandwidth(), skyline.stored()]
    }

    /// The swim table, one row each: speed (m/s), frequency (1/s), amplitudes of both segments.
    #[getter]
    fn strokes<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        let state = self.lock();
        let time = state.fish.time_unit();
        let scale = state.fish.length(0) / time;
        let strokes = &state.fish.model().design.swim.strokes;
        let numbers = strokes.iter().flat_map(|stroke| {
            let [fore, hind] = stroke.amplitudes;
            [stroke.speed * scale, stroke.frequency / time, fore, hind]
        });
        rows(py, numbers.collect(), 4)
    }

    /// The steering map, one row each: angle (radians), depth, hold (s).
    #[getter]
    fn bends<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        let state = self.lock();
        let time = state.fish.time_unit();
        let bends = &state.fish.model().design.turn.bends;
        let numbers = bends.iter().flat_map(|bend| [bend.angle, bend.depth, bend.hold * time]);
        rows(py, numbers.collect(), 3)
    }
}

impl Tank {
    fn build(
        species: &Species,
        preset: &Preset,
        (dt, length): (Option<f64>, Option<f64>),
        (integrator, water): (Option<&str>, f64),
    ) -> Result<Self> {
        let species = species.get()?;
        let mut model = preset.model()?;
        if let Some(name) = integrator {
            model.mechanics.integrator = named_integrator(name)?;
        }
        model.mechanics.medium.thickness = water;
        model.mechanics.medium = model.mechanics.medium.checked()?;
        // The pectoral fins push the same water as the skin.
        model.design.medium = model.mechanics.medium;
        let length = length.unwrap_or(f64::from(species.length));
        let cruise = f64::from(species.swimming.cruise);
        let fish = stocked(Arc::new(model), cruise, Quat::IDENTITY, length)?;
        let dt = dt.unwrap_or(fish.natural_step());
        if !(1e-7..=1.0).contains(&dt) {
            return Err(Error::value("dt", dt, "0.0000001 to 1 second"));
        }
        let command = Command::default();
        let state = State { fish, command, repairs: 0, current: None, time: 0.0 };
        Ok(Self { state: Mutex::new(state), dt })
    }

    fn run(&self, activations: Option<[f32; 12]>, steps: u32) -> Result<()> {
        let mut state = self.lock();
        let State { fish, repairs, current, time, .. } = &mut *state;
        fish.activate(0, activations);
        for _ in 0..steps {
            if let Some(current) = current {
                let mut influence = [Influence::default()];
                let place = fish.center(0).map(|axis| axis as f32);
                current.add_to(&[Vec3::from_array(place)], *time, &mut influence)?;
                fish.set_flow(0, influence[0].flow);
            }
            *time += self.dt;
            fish.advance_in(self.dt, 1);
            if fish.repairs(0) > *repairs {
                *repairs = fish.repairs(0);
                let what = format!("the strain of a body in steps of {} s", self.dt);
                let limit = "what its springs bear: take a smaller dt or integrator='implicit'";
                return Err(Error::Limit { what, limit: limit.to_owned() });
            }
        }
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn stocked(
    model: Arc<FishModel>,
    cruise: f64,
    rotation: Quat,
    length: f64,
) -> Result<Swimmers<f64>> {
    let mut fish = Swimmers::new(model, cruise)?;
    fish.add([0.0; 3], rotation.normalize(), length)?;
    Ok(fish)
}

fn named_integrator(name: &str) -> Result<Integrator> {
    const KNOWN: [(&str, Integrator); 4] = [
        ("implicit", Integrator::Implicit),
        ("semi_implicit", Integrator::SemiImplicit),
        ("symplectic", Integrator::Symplectic),
        ("explicit", Integrator::Explicit),
    ];
    KNOWN.iter().find(|(known, _)| *known == name).map(|(_, found)| *found).ok_or_else(|| {
        let known = KNOWN.map(|(known, _)| known.to_owned()).to_vec();
        Error::Unknown { kind: "integrator", name: name.to_owned(), known }
    })
}

fn checked_activations(values: Vec<f64>) -> Result<[f32; 12]> {
    let found = format!("{} numbers", values.len());
    let values: [f64; 12] = values
        .try_into()
        .map_err(|_| Error::value("activations", found, "12 numbers, one per muscle"))?;
    match values.iter().find(|value| !(0.0..=1.0).contains(*value)) {
        Some(value) => Err(Error::value("activations", value, "numbers of 0 (rest) to 1")),
        None => Ok(values.map(|value| value as f32)),
    }
}

fn rows<'py, T: numpy::Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    width: usize,
) -> PyResult<Array2<'py, T>> {
    let count = numbers.len() / width;
    numbers.into_pyarray(py).reshape([count, width])
}
