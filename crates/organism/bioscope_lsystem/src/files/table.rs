use std::sync::Arc;

use super::{Curve, Function, View};
use crate::Functions;

/// The functions and curves of a view, as models ask for them: number 1 is the first.
#[derive(Clone, Debug, Default)]
pub struct FunctionTable {
    functions: Vec<Arc<Function>>,
    curves: Vec<Arc<Curve>>,
    volume: Option<([f64; 3], [f64; 3], f64)>,
}

impl FunctionTable {
    /// Those of a view.
    pub fn new(view: &View) -> Self {
        let volume = view.camera.volume.map(|(low, high)| {
            let wide = |corner: bioscope_core::Vec3| corner.to_array().map(f64::from);
            (wide(low), wide(high), f64::from(view.camera.scale))
        });
        Self { functions: view.functions.clone(), curves: view.curves.clone(), volume }
    }
}

impl Functions for FunctionTable {
    fn value(&self, id: usize, x: f64) -> Option<f64> {
        Some(self.functions.get(id.checked_sub(1)?)?.value(x))
    }

    fn curve(&self, id: usize, t: f64) -> Option<[f64; 3]> {
        Some(self.curves.get(id.checked_sub(1)?)?.at(t))
    }

    fn curve_length(&self, id: usize) -> Option<f64> {
        Some(self.curves.get(id.checked_sub(1)?)?.length())
    }

    fn view_volume(&self) -> Option<([f64; 3], [f64; 3], f64)> {
        self.volume
    }
}
