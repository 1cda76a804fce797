//! Numpy views of engine memory: no copies, read only, kept alive by the Python object that owns it.

use bioscope_core::{Error, Result, Vec3};
use numpy::ndarray::{ArrayView, Dimension, StrideShape};
use numpy::{Element, PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

pub type Array1<'py, T> = Bound<'py, PyArray1<T>>;
pub type Array2<'py, T> = Bound<'py, PyArray2<T>>;
pub type Array3<'py, T> = Bound<'py, PyArray3<T>>;

/// A read-only view of `data` in this shape (and these strides, in elements), which must lie
/// within memory that `owner` keeps alive and unchanged.
pub fn view<'py, T: Element, D: Dimension>(
    owner: &Bound<'py, PyAny>,
    data: &[T],
    shape: impl Into<StrideShape<D>>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let array = ArrayView::from_shape(shape, data)
        .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    // SAFETY: all callers pass memory inside an `Arc` held by the frozen class `owner`.
    let array = unsafe { PyArray::borrow_from_array(&array, owner.clone()) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// Rows of `width` numbers, flattened, from an array of shape (n, width).
pub fn rows<'a>(
    name: &str,
    array: &'a PyReadonlyArray2<'_, f32>,
    width: usize,
) -> Result<std::borrow::Cow<'a, [f32]>> {
    let shape = array.as_array().raw_dim();
    if shape[1] != width {
        let found = format!("an array of shape ({}, {})", shape[0], shape[1]);
        return Err(Error::value(name, found, format!("shape (n, {width})")));
    }
    finite(name, array.as_array().iter().copied().collect::<Vec<_>>().into())
}

/// Points or directions from an array of shape (n, 3).
pub fn vectors(name: &str, array: &PyReadonlyArray2<'_, f32>) -> Result<Vec<Vec3>> {
    Ok(rows(name, array, 3)?.chunks_exact(3).map(Vec3::from_slice).collect())
}

fn finite<'a>(
    name: &str,
    numbers: std::borrow::Cow<'a, [f32]>,
) -> Result<std::borrow::Cow<'a, [f32]>> {
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(Error::value(name, numbers[index], "finite numbers only")),
        None => Ok(numbers),
    }
}

/// Fails unless `found` equals `expected`.
pub fn same_count(name: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::value(name, format!("{found} rows"), format!("{expected} rows, one per id")))
    }
}

/// Vectors as their numbers.
pub trait Floats {
    fn as_flattened_floats(&self) -> &[f32];
}

impl Floats for [Vec3] {
    fn as_flattened_floats(&self) -> &[f32] {
        bytemuck::cast_slice(self)
    }
}
