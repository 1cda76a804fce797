use bioscope_core::Result;

use super::real::{Lanes, Real, Triple};
use super::solver::{Body, Mechanics, Workspace};

/// Numbers whose bodies are advanced with the widest instructions that this machine has. They round every operation
/// alike, so the results are the same bits with any.
pub trait Dispatch: Real {
    /// [`Mechanics::step`].
    ///
    /// # Errors
    /// As there.
    fn step(
        mechanics: &Mechanics,
        body: &mut Body<Self>,
        flow: &[Triple<Self>],
        push: &[Triple<Self>],
        dt: f64,
        work: &mut Workspace<Self>,
    ) -> Result<()> {
        mechanics.step(body, flow, push, dt, work)
    }
}

impl Dispatch for f32 {}

impl Dispatch for f64 {}

impl Dispatch for Lanes {
    fn step(
        mechanics: &Mechanics,
        body: &mut Body<Self>,
        flow: &[Triple<Self>],
        push: &[Triple<Self>],
        dt: f64,
        work: &mut Workspace<Self>,
    ) -> Result<()> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: this machine has AVX2, as was just asked.
            return unsafe { step_avx2(mechanics, body, flow, push, dt, work) };
        }
        mechanics.step(body, flow, push, dt, work)
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn step_avx2(
    mechanics: &Mechanics,
    body: &mut Body<Lanes>,
    flow: &[Triple<Lanes>],
    push: &[Triple<Lanes>],
    dt: f64,
    work: &mut Workspace<Lanes>,
) -> Result<()> {
    mechanics.step(body, flow, push, dt, work)
}
