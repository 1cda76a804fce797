//! A free-flow hierarchy after Tyrrell, as an alternative mind on the same percepts.
//!
//! No behavior wins. Every subsystem (avoiding, fleeing, schooling, feeding, mating, leaving, wandering) passes
//! its preferences on to the motor level, where each of 36 directions collects what is to be said for and
//! against it; only there one is chosen. So everything always has its say, at the price of attention: each
//! stimulus is weighed against each direction in every tick.
//!
//! Source: J. K. Rosenblatt and D. W. Payton, "A fine-grained alternative to the subsumption architecture",
//! IJCNN 1989; T. Tyrrell, "The use of hierarchies for action selection", Adaptive Behavior 1 (1993). As in
//! the latter, reasons of one sign do not add up: the strongest counts wholly, the others a part.

mod hierarchy;
mod mind;

pub use mind::FreeFlow;
