//! Sound: how noises are made, how they travel, what an ear and a film's sound track hear.
//!
//! A [`SoundEvent`](bioscope_core::SoundEvent) says what sounds where and when. From the same
//! events [`SoundTrack`] renders stereo for a moving listener, and [`hear`] tells an animal what
//! reaches its ear. Both let sound travel at finite speed from where the source was when it made
//! the noise, and let it fade with distance. All noises are computed ([`synthesis`]), so nothing
//! is loaded, and the same seed gives the same samples.
//!
//! ```
//! use bioscope_acoustics::{ListenerPath, ListenerPose, Medium, SoundTrack};
//! use bioscope_core::{Quat, SoundEvent, Vec3};
//!
//! let mut track = SoundTrack::new(48_000, 7, Medium::WATER)?;
//! track.add(&[SoundEvent {
//!     source: 12,
//!     kind: "bubble".into(),
//!     time: 0.5,
//!     duration: 0.0,
//!     position: Vec3::new(3.0, 0.0, -4.0),
//!     velocity: Vec3::new(0.0, 0.3, 0.0),
//!     amplitude: 0.3,
//!     pitch: 0.0,
//! }])?;
//! let pose = ListenerPose { time: 0.0, position: Vec3::ZERO, rotation: Quat::IDENTITY };
//! let listener = ListenerPath::starting(pose)?;
//! let frames = track.render(&listener, 0.0, 48_000)?;
//! assert_eq!(frames.len(), 48_000);
//! # Ok::<(), bioscope_core::Error>(())
//! ```

mod ear;
mod event;
mod limiter;
mod listener;
mod medium;
mod panning;
mod propagation;
mod sound_track;
pub mod synthesis;
mod voice;

pub use ear::{Ear, has_passed, hear};
pub use event::check;
pub use listener::{ListenerPath, ListenerPose};
pub use medium::Medium;
pub use propagation::{Arrival, arrival};
pub use sound_track::{Notices, SoundTrack};
