//! How sounds travel, what they are made of, what tracks and ears hear.

mod ear;
mod measure;
mod propagation;
mod synthesis;
mod track;
