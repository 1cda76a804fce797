use bioscope_core::{Parameters, Result, Vec3};

/// What acts on things at one point and time; contributions of several fields add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// Velocity of the medium, metres per second.
    pub flow: Vec3,
    /// Acceleration of free bodies, metres per second squared.
    pub force: Vec3,
    /// Additional light, 0 to 1.
    pub light: f32,
    /// Difference from the world's base temperature, kelvin.
    pub temperature: f32,
    /// Concentration of scent, 1 at its source.
    pub scent: f32,
}

/// Something that acts everywhere: a current, a lamp, a warm spring, a scent.
pub trait Field: Send + Sync {
    /// Word under which saved worlds find the constructor.
    fn kind(&self) -> &str;
    /// What acts at each of these points (metres) at `time` (seconds); adds to `out`, which has
    /// the same length.
    fn add_to(&self, points: &[Vec3], time: f64, out: &mut [Influence]) -> Result<()>;
    /// Tunable numbers, if it has any.
    fn parameters(&self) -> Option<&dyn Parameters> {
        None
    }
    /// Tunable numbers for changing.
    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        None
    }
    /// A copy for observers that outlive the tick.
    fn boxed_clone(&self) -> Box<dyn Field>;
    /// Complete state as bytes.
    fn save(&self) -> Result<Vec<u8>>;
    /// Goes back to a state that [`save`](Self::save) gave.
    fn restore(&mut self, bytes: &[u8]) -> Result<()>;
}

impl Clone for Box<dyn Field> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}
