//! Where the turtle stands when it comes to certain modules.

use bioscope_core::{Result, Vec3};

use super::{Frame, Turtle, TurtleOptions, command};
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
        let mut turtle = Turtle::new(options);
        let kinds = string.alphabet().kinds();
        let commands: Vec<_> = kinds.iter().map(|kind| command(&kind.symbol, options)).collect();
        let mut rest = string.parameters();
        let mut stances = Vec::new();
        for (module, &code) in string.kinds().iter().enumerate() {
            let (parameters, after) = rest.split_at(kinds[code as usize].arity as usize);
            rest = after;
            if wanted[code as usize] {
                let state = &turtle.state;
                let (position, frame) = (state.position, state.frame);
                let (width, color) = (state.width, state.color);
                stances.push(Stance { module, position, frame, width, color });
            }
            turtle.obey(commands[code as usize], parameters);
            turtle.check()?;
        }
        Ok(stances)
    }
}
