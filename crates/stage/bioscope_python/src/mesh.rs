use std::sync::Arc;

use bioscope_geometry as geometry;
use numpy::PyReadonlyArray2;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::{self, Array2, Floats};
use crate::error::to_python;
use crate::skin;

/// See `bioscope.Mesh`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Mesh {
    pub mesh: Arc<geometry::Mesh>,
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (
        positions, triangles, *, normals=None, uvs=None, colors=None, joints=None,
        joint_indices=None, joint_weights=None
    ))]
    #[allow(clippy::too_many_arguments, clippy::type_complexity)] // Keywords of a Python call.
    fn new(
        positions: PyReadonlyArray2<'_, f32>,
        triangles: PyReadonlyArray2<'_, u32>,
        normals: Option<PyReadonlyArray2<'_, f32>>,
        uvs: Option<PyReadonlyArray2<'_, f32>>,
        colors: Option<PyReadonlyArray2<'_, f32>>,
        joints: Option<Vec<(String, Option<u8>, [f32; 8])>>,
        joint_indices: Option<PyReadonlyArray2<'_, u8>>,
        joint_weights: Option<PyReadonlyArray2<'_, f32>>,
    ) -> PyResult<Self> {
        let build = || {
            let positions = arrays::vectors("positions", &positions)?;
            let triangles = triangle_rows(&triangles, positions.len())?;
            let mut mesh = geometry::Mesh { positions, triangles, ..Default::default() };
            match &normals {
                Some(normals) => mesh.normals = arrays::vectors("normals", normals)?,
                None => mesh.compute_normals(),
            }
            arrays::same_count("normals", mesh.normals.len(), mesh.positions.len())?;
            if let Some(uvs) = &uvs {
                let rows = arrays::rows("uvs", uvs, 2)?;
                mesh.uvs = rows.chunks_exact(2).map(|row| [row[0], row[1]]).collect();
                arrays::same_count("uvs", mesh.uvs.len(), mesh.positions.len())?;
            }
            if let Some(colors) = &colors {
                let rows = arrays::rows("colors", colors, 3)?;
                mesh.colors = rows.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect();
                arrays::same_count("colors", mesh.colors.len(), mesh.positions.len())?;
            }
            if let Some(joints) = &joints {
                let (Some(indices), Some(weights)) = (&joint_indices, &joint_weights) else {
                    let expected = "joint_indices and joint_weights with them";
                    return Err(bioscope_core::Error::value("joints", "alone", expected));
                };
                mesh.skin = Some(skin::skin(joints, indices, weights, mesh.positions.len())?);
            }
            Ok(mesh)
        };
        Ok(Self { mesh: Arc::new(build().map_err(to_python)?) })
    }

    /// Key by which the same mesh is recognized in two scenes.
    #[getter]
    fn key(&self) -> u64 {
        self.mesh.key.number()
    }

    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let positions = &slf.get().mesh.positions;
        arrays::view(slf.as_any(), positions.as_flattened_floats(), [positions.len(), 3])
    }

    #[getter]
    fn normals<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let normals = &slf.get().mesh.normals;
        arrays::view(slf.as_any(), normals.as_flattened_floats(), [normals.len(), 3])
    }

    #[getter]
    fn uvs<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let uvs = &slf.get().mesh.uvs;
        arrays::view(slf.as_any(), uvs.as_flattened(), [uvs.len(), 2])
    }

    #[getter]
    fn colors<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let colors = &slf.get().mesh.colors;
        arrays::view(slf.as_any(), colors.as_flattened(), [colors.len(), 3])
    }

    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, u32>> {
        let triangles = &slf.get().mesh.triangles;
        arrays::view(slf.as_any(), triangles.as_flattened(), [triangles.len(), 3])
    }

    /// The joints as (name, parent or none, rest transform of 8 numbers); empty for a rigid mesh.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let joints = self.mesh.skin.iter().flat_map(|skin| &skin.joints);
        let tuple = |joint: &geometry::Joint| {
            let rest: [f32; 8] = bytemuck::cast(joint.rest);
            (&joint.name, joint.parent, rest).into_bound_py_any(py)
        };
        joints.map(tuple).collect()
    }

    #[getter]
    fn joint_indices<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, u8>> {
        let indices = slf.get().mesh.skin.as_ref().map_or(&[][..], |skin| &skin.indices);
        arrays::view(slf.as_any(), indices.as_flattened(), [indices.len(), 4])
    }

    #[getter]
    fn joint_weights<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let weights = slf.get().mesh.skin.as_ref().map_or(&[][..], |skin| &skin.weights);
        arrays::view(slf.as_any(), weights.as_flattened(), [weights.len(), 4])
    }
}

fn triangle_rows(
    triangles: &PyReadonlyArray2<'_, u32>,
    vertices: usize,
) -> bioscope_core::Result<Vec<[u32; 3]>> {
    let array = triangles.as_array();
    if array.shape()[1] != 3 {
        let found = format!("rows of {}", array.shape()[1]);
        return Err(bioscope_core::Error::value("triangles", found, "shape (n, 3)"));
    }
    if let Some(&index) = array.iter().find(|&&index| index as usize >= vertices) {
        let expected = format!("vertex numbers below {vertices}");
        return Err(bioscope_core::Error::value("triangles", index, expected));
    }
    Ok(array.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
}
