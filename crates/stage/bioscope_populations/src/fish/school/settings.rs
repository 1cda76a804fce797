use bioscope_core::{Error, Parameter, Parameters, Result};

use super::FishSchool;

/// Those of the flock and those of the school, as one set.
impl Parameters for FishSchool {
    fn descriptions(&self) -> Vec<Parameter> {
        let mut all = self.flock.parameters.descriptions();
        all.append(&mut self.options.parameters.descriptions());
        all
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.flock.parameters.get(name).or_else(|| self.options.parameters.get(name))
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        if self.options.parameters.get(name).is_some() {
            return self.options.parameters.set(name, value);
        }
        if self.flock.parameters.get(name).is_none() {
            let known = self.descriptions().into_iter().map(|one| one.name).collect();
            return Err(Error::Unknown { kind: "parameter", name: name.to_owned(), known });
        }
        let mut changed = self.flock.parameters.clone();
        changed.set(name, value)?;
        changed.check()?;
        self.flock.parameters = changed;
        Ok(())
    }
}
