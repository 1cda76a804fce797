use bioscope_core::{Percepts, Result, state};
use serde::{Deserialize, Serialize};

use crate::{Sense, Surroundings};

/// The feeling for flow along the flanks: how the medium moves past the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LateralLine;

impl Sense for LateralLine {
    fn kind(&self) -> &str {
        "lateral_line"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        let relative = surroundings.influence.flow - surroundings.velocity;
        percepts.flow = surroundings.own_vector(relative);
        Ok(())
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
