//! Patches whose control points the turtle sets.

use std::collections::BTreeMap;

use bioscope_core::Vec3;

use super::{Turtle, command::Command, finite};
use crate::interpretation::{Basis, Patch};

/// Most patches at once, and most quads along a side of one.
const PATCHES: usize = 4096;
const QUADS: f32 = 64.0;

/// The patches in the making, by number.
#[derive(Default)]
pub(super) struct PatchTable(BTreeMap<i32, Draft>);

#[derive(Clone, Copy, Default)]
struct Draft {
    points: [[Vec3; 4]; 4],
    basis: Basis,
}

impl Turtle<'_> {
    /// Begins a patch, sets a point of one, or draws one.
    pub(super) fn patch(&mut self, command: Command, parameters: &[f32]) {
        let number = |index: usize| parameters.get(index).copied().map(finite);
        let Some(id) = number(0).map(|id| id as i32) else { return };
        let patches = &mut self.patches.0;
        if patches.len() >= PATCHES && !patches.contains_key(&id) {
            return;
        }
        let draft = patches.entry(id).or_default();
        match command {
            Command::BeginPatch => {
                let basis = match number(1).map_or(1, |basis| basis as i32) {
                    2 => Basis::BSpline,
                    3 => Basis::Cardinal,
                    _ => Basis::Bezier,
                };
                *draft = Draft { points: [[Vec3::ZERO; 4]; 4], basis };
            }
            Command::PatchPoint => {
                if let (Some(row), Some(column)) = (number(1), number(2))
                    && (0.0..4.0).contains(&row)
                    && (0.0..4.0).contains(&column)
                {
                    draft.points[row as usize][column as usize] = self.state.position.as_vec3();
                }
            }
            _ => {
                let quads = |index: usize| number(index).unwrap_or(5.0).clamp(1.0, QUADS) as u32;
                let (points, basis) = (draft.points, draft.basis);
                if self.draws {
                    self.out.patches.push(Patch {
                        points,
                        basis,
                        quads: [quads(1), quads(2)],
                        color: self.state.color,
                        texture: self.state.texture,
                        anchor: self.anchor(),
                    });
                }
            }
        }
    }
}
