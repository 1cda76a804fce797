//! Hunger, libido and fear: the mental state of a fish (Tu 1996, section 6.2).
//!
//! Repaired: scanning turned the bar over "internal urge" into a fraction; the lower bounds follow from the
//! author's remark that hunger vanishes when twice the appetite has been eaten.
//!
//! * `H = clamp(1 − n r(Δt) / a + α_h S_h, 0, 1)` with `r(x) = 1 − p0 x`,
//! * `L = clamp(l(Δt) (1 − H) + α_l S_l, 0, 1)` with `l(x) = p1 x`,
//! * `F = min(Σ min(D0 / d_i, 1), 1)` over the predators in view; chosen: it fades when they are out of sight.

mod state;
mod stimulus;
#[cfg(test)]
mod tests;

pub use state::{Drives, Stirring, fear_of};
pub use stimulus::stimulus;
