//! A behavior-choice network after Maes, as an alternative mind on the same percepts.
//!
//! Behaviors are nodes. Activation flows into them from what is the case (binary predicates) and from what is
//! wanted, forward to nodes that they make possible, backward to nodes that would make them possible, and is
//! taken from those that they conflict with. The executable node with most activation above a threshold
//! wins; if there is none, the threshold falls. The routines are those of [`Intentions`](crate::Intentions);
//! what Tu's mind has beyond it (memory, preferences, persistence beyond activation) this one lacks.
//!
//! Source: P. Maes, "How to do the right thing", Connection Science 1 (1989), and "A bottom-up mechanism for
//! behavior selection in an artificial creature", From Animals to Animats (1991). As in the latter a winner
//! keeps its activation, for an animal's behaviors have no end of their own.

mod mind;
mod network;

pub use mind::BehaviorNetwork;
