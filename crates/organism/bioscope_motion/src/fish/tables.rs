use bioscope_core::{Error, Result};
use serde::{Deserialize, Serialize};

/// Steady swimming at one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// Body lengths per time unit.
    pub speed: f64,
    /// Tail beats per time unit.
    pub frequency: f64,
    /// Contraction of the anterior and of the posterior swim segment, 0 to 1 (1 − r of the source).
    pub amplitudes: [f64; 2],
}

/// The swim controller's table: which stroke gives which speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwimTable {
    /// By how many beats the posterior segment lags the anterior one.
    pub lag: f64,
    /// Speed of easy swimming, body lengths per time unit.
    pub cruise: f64,
    /// Strokes with rising speed, the first at rest.
    pub strokes: Vec<Stroke>,
}

impl SwimTable {
    /// The stroke for a speed, between the rows of the table; the fastest beyond its end.
    pub fn stroke(&self, speed: f64) -> Stroke {
        let upper = self.strokes.iter().position(|stroke| stroke.speed > speed);
        let Some(upper) = upper else { return self.strokes[self.strokes.len() - 1] };
        let (a, b) = (self.strokes[upper.max(1) - 1], self.strokes[upper.max(1)]);
        let share = ((speed - a.speed) / (b.speed - a.speed)).max(0.0);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let amplitudes = [0, 1].map(|segment| mix(a.amplitudes[segment], b.amplitudes[segment]));
        Stroke {
            speed: mix(a.speed, b.speed),
            frequency: mix(a.frequency, b.frequency),
            amplitudes,
        }
    }

    /// Greatest speed, body lengths per time unit.
    pub fn top_speed(&self) -> f64 {
        self.strokes[self.strokes.len() - 1].speed
    }

    pub(super) fn check(&self) -> Result<()> {
        let rising = self.strokes.windows(2).all(|two| two[0].speed < two[1].speed);
        let sane = |stroke: &Stroke| {
            (0.0..=10.0).contains(&stroke.frequency)
                && stroke.amplitudes.iter().all(|amplitude| (0.0..=1.0).contains(amplitude))
        };
        if self.strokes.len() < 2 || !rising || !self.strokes.iter().all(sane) {
            let expected = "two or more with rising speed, frequencies 0 to 10, amplitudes 0 to 1";
            return Err(Error::value("swim strokes", format!("{:?}", self.strokes), expected));
        }
        if !(0.0..=1.0).contains(&self.lag) || !(0.0..=self.top_speed()).contains(&self.cruise) {
            let found = format!("lag {}, cruise {}", self.lag, self.cruise);
            return Err(Error::value("swim table", found, "a lag of 0 to 1, cruise below the top"));
        }
        Ok(())
    }
}

/// One turn of the steering map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bend {
    /// Change of heading, radians.
    pub angle: f64,
    /// Contraction of the two turning segments on the inner side, 0 to 1.
    pub depth: f64,
    /// How long it is held, time units.
    pub hold: f64,
}

/// The turn controllers' table, the steering map: which bend gives which turn, begun at cruising speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurnTable {
    /// Change of contraction per time unit while bending.
    pub rate: f64,
    /// The same while recovering, slower.
    pub recovery: f64,
    /// Share of the bend that the posterior swim segment takes part in, so that the tail is a rudder.
    pub tail: f64,
    /// Bends with rising angles, the first of no turn.
    pub bends: Vec<Bend>,
}

impl TurnTable {
    /// The bend for an angle of up to the last of the table, by linear interpolation.
    pub fn bend(&self, angle: f64) -> Bend {
        let upper = self.bends.iter().position(|bend| bend.angle > angle);
        let Some(upper) = upper else { return self.bends[self.bends.len() - 1] };
        let (a, b) = (self.bends[upper.max(1) - 1], self.bends[upper.max(1)]);
        let share = ((angle - a.angle) / (b.angle - a.angle)).max(0.0);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Bend { angle, depth: mix(a.depth, b.depth), hold: mix(a.hold, b.hold) }
    }

    /// Greatest angle of a single turn, radians.
    pub fn greatest(&self) -> f64 {
        self.bends[self.bends.len() - 1].angle
    }

    pub(super) fn check(&self) -> Result<()> {
        let rising = self.bends.windows(2).all(|two| two[0].angle < two[1].angle);
        let sane =
            |bend: &Bend| (0.0..=1.0).contains(&bend.depth) && (0.0..=1e3).contains(&bend.hold);
        let rates = [self.rate, self.recovery].iter().all(|rate| (1e-3..=1e3).contains(rate))
            && (0.0..=1.0).contains(&self.tail);
        if self.bends.len() < 2 || !rising || !self.bends.iter().all(sane) || !rates {
            let expected = "rising angles, depths 0 to 1, rates 0.001 to 1,000";
            return Err(Error::value("turn table", format!("{self:?}"), expected));
        }
        Ok(())
    }
}

/// The pectoral fins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FinSettings {
    /// Force of one fin on the water per speed squared, body masses per body length.
    pub area: f64,
    /// Share of the force on each of the first three rings.
    pub weights: [f64; 3],
    /// Distance of the middle of a fin from the axis of the body, body lengths; 0 puts its force on the flank.
    pub arm: f64,
    /// How far the inner fin is spread against the water in the sharpest turn, 0 to 1.
    pub yaw: f64,
    /// Fin angle per error of pitch, and per pitch rate times time unit.
    pub pitch: [f64; 2],
    /// Fin angle per error of roll, and per roll rate times time unit.
    pub roll: [f64; 2],
    /// Greatest force of a fin up or down to keep upright at any speed, body masses times body lengths per time unit squared.
    pub righting: f64,
    /// Greatest force of oaring, body masses times body lengths per time unit squared.
    pub oar: f64,
}

impl FinSettings {
    pub(super) fn check(&self) -> Result<()> {
        let numbers = [self.area, self.oar, self.righting, self.arm, self.yaw].into_iter();
        let numbers = numbers.chain(self.weights).chain(self.pitch).chain(self.roll);
        for number in numbers {
            if !(0.0..=1e3).contains(&number) {
                return Err(Error::value("fin settings", number, "0 to 1,000"));
            }
        }
        Ok(())
    }
}
