use bioscope_core::math::TAU;
use serde::{Deserialize, Serialize};

use super::tables::TurnTable;

/// What a turn-MC is doing: bending fast to the inner side, holding, recovering slowly (Tu, "Artificial Animals for
/// Computer Animation", section 4.3.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Muscles of the inner side contract.
    Bend,
    /// The bend is held.
    Hold,
    /// Muscles return to rest.
    Recover,
    /// All parts are done.
    Done,
}

/// A turn by a given angle, of one part or several, done blindly by the steering map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turn {
    /// +1 to the left, −1 to the right.
    side: f32,
    /// Angle of each part, radians.
    angle: f32,
    /// Parts left, with the present one.
    parts: u32,
    /// Stage of the present part.
    pub stage: Stage,
    /// Time in this stage, time units.
    time: f32,
}

impl Turn {
    pub(super) fn new(table: &TurnTable, angle: f32) -> Self {
        let size = angle.abs().min(2.0 * TAU);
        let parts = (size / (table.greatest() as f32 + 1e-4)).ceil().max(1.0);
        let side = if angle < 0.0 { -1.0 } else { 1.0 };
        let stage = if size < 1e-4 { Stage::Done } else { Stage::Bend };
        Self { side, angle: size / parts, parts: parts as u32, stage, time: 0.0 }
    }

    pub(super) fn is_done(&self) -> bool {
        self.stage == Stage::Done
    }

    /// Goes on by `dt` time units from this bend; returns the next.
    pub(super) fn advance(&mut self, table: &TurnTable, bend: f32, dt: f32) -> f32 {
        let row = table.bend(f64::from(self.angle));
        let (rate, recovery) = (table.rate as f32 * dt, table.recovery as f32 * dt);
        self.time += dt;
        let depth = self.side * row.depth as f32;
        match self.stage {
            Stage::Bend => {
                let next = bend + (depth - bend).clamp(-rate, rate);
                if next == depth {
                    self.enter(Stage::Hold);
                }
                next
            }
            Stage::Hold => {
                if self.time >= row.hold as f32 {
                    self.enter(Stage::Recover);
                }
                depth
            }
            Stage::Recover => {
                let next = bend + (-bend).clamp(-recovery, recovery);
                if next == 0.0 {
                    self.next_part();
                }
                next
            }
            Stage::Done => bend,
        }
    }

    fn enter(&mut self, stage: Stage) {
        (self.stage, self.time) = (stage, 0.0);
    }

    fn next_part(&mut self) {
        self.parts -= 1;
        self.enter(if self.parts == 0 { Stage::Done } else { Stage::Bend });
    }
}
