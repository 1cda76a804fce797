//! What populations say alike of where they keep their state and their parameters.

/// The methods of a [`Population`](bioscope_world::Population) whose whole state is its field `state`, and that has a
/// constructor `from_saved`.
macro_rules! saved_as_state {
    () => {
        fn save(&self) -> bioscope_core::Result<Vec<u8>> {
            Ok(bioscope_core::state::to_bytes(&self.state))
        }

        fn restore(&mut self, bytes: &[u8]) -> bioscope_core::Result<()> {
            *self = Self::from_saved(bytes)?;
            Ok(())
        }
    };
}

/// The methods of a [`Population`](bioscope_world::Population) whose parameters lie in this field.
macro_rules! parameters_in {
    ($($field:ident).+) => {
        fn parameters(&self) -> Option<&dyn bioscope_core::Parameters> {
            Some(&self.$($field).+)
        }

        fn parameters_mut(&mut self) -> Option<&mut dyn bioscope_core::Parameters> {
            Some(&mut self.$($field).+)
        }
    };
}

pub(crate) use {parameters_in, saved_as_state};
