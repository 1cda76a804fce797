//! Where the turtle stands when it comes to certain modules.

use bioscope_core::{Result, Vec3};

use super::{Frame, Pose, Turtle, TurtleOptions};
use crate::ModuleString;

/// The turtle at one module, before it obeys it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stance {
    /// Number of the module.
    pub module: usize,
    pub position: Vec3,
    pub frame: Frame,
    pub width: f32,
    pub color: i32,
}

impl Turtle<'_> {
    /// The stances at all modules of the wanted kinds, in the order of the string.
    pub(crate) fn stances(
        string: &ModuleString,
        options: &TurtleOptions,
        wanted: &[bool],
    ) -> Result<Vec<Stance>> {
        let kinds = string.alphabet().kinds();
        let mut turtle = Turtle::walking(string.alphabet(), options);
        let mut rest = string.parameters();
        let mut stances = Vec::new();
        for (module, &code) in string.kinds().iter().enumerate() {
            let (parameters, after) = rest.split_at(kinds[code as usize].arity as usize);
            rest = after;
            if wanted[code as usize] {
                let Pose { position, frame, width, color } = turtle.pose();
                stances.push(Stance { module, position, frame, width, color });
            }
            turtle.read(code, parameters)?;
        }
        Ok(stances)
    }
}
