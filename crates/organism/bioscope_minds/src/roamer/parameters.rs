use bioscope_core::parameters;

parameters! {
    /// How a [`Roamer`](crate::Roamer) lives.
    pub struct RoamerParameters {
        /// Speed of calm swimming; bursts and glides vary about it.
        cruise_speed: f32 = 0.7, "BL/s", 0.05..=5.0, "choice";
        /// Speed of a dash.
        dash_speed: f32 = 3.0, "BL/s", 0.1..=12.0, "choice";
        /// How far from home it roams before it turns back.
        home_range: f32 = 8.0, "m", 0.5..=1000.0, "choice";
        /// Least depth it keeps below the surface.
        shallowest: f32 = 0.8, "m", 0.0..=1000.0, "choice";
        /// Greatest depth it goes to.
        deepest: f32 = 30.0, "m", 0.5..=10000.0, "choice";
        /// Height it keeps above the seabed, where a sense reports its `altitude`.
        altitude: f32 = 0.8, "m", 0.0..=100.0, "choice";
        /// Distance ahead at which it begins to steer round an obstacle.
        foresight: f32 = 5.0, "BL", 1.0..=50.0, "choice";
        /// How strongly it wanders.
        restlessness: f32 = 0.5, "rad/s^0.5", 0.0..=3.0, "choice";
        /// How often it goes to inspect a school in view.
        curiosity: f32 = 4.0, "1/min", 0.0..=60.0, "choice";
        /// Probability that an inspection ends in a dash.
        boldness: f32 = 0.5, "1", 0.0..=1.0, "choice";
        /// Mean duration of an inspection.
        inspection: f32 = 5.0, "s", 0.5..=60.0, "choice";
        /// Mean duration of a pause before it changes its mind.
        hesitation: f32 = 0.6, "s", 0.0..=5.0, "choice";
        /// Mean duration of a burst and of a glide.
        stroke: f32 = 2.5, "s", 0.2..=30.0, "choice";
    }
}
