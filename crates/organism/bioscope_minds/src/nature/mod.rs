//! What a fish is: its role and habits, whom it knows, and its temper in numbers.
//!
//! All of it is innate and stays as it is while the fish lives, unless somebody changes it. The three minds
//! of fishes ([`Intentions`](crate::Intentions), [`BehaviorNetwork`](crate::BehaviorNetwork),
//! [`FreeFlow`](crate::FreeFlow)) are made from the same nature.
//!
//! Tu's model has arbitrary units of length. Its constants are given here in body lengths at 14 units per
//! body length (the length at which her published masses and stiffnesses swim forward), and its
//! times of digestion and libido, counted in steps, at [`Temper::pace`] steps per second.
//!
//! Source: X. Tu, "Artificial animals for computer animation", 1996, chapter 6 (Tu 1996); its short form is
//! Terzopoulos, Tu and Grzeszczuk, "Artificial fishes", Artificial Life 1 (1994).

mod description;
mod temper;

pub use description::{Habits, Nature, Relation, Role};
pub use temper::Temper;
