use bioscope_core::parameters;

parameters! {
    /// How a fish feels and acts, in numbers.
    pub struct Temper {
        /// Food that fills it, `n^a`; more for larger fish.
        appetite: f32 = 5.0, "1", 0.1..=1000.0, "choice";
        /// Rate of digestion, `p0`; 0.005 makes a fish ravenous.
        digestion: f32 = 0.00067, "1/step", 0.0..=1.0, "Tu 1996, 6.2";
        /// Rate at which libido grows after mating, `p1`; 0.01 is a mania.
        libido_growth: f32 = 0.0025, "1/step", 0.0..=1.0, "Tu 1996, 6.2";
        /// Steps per second of `digestion` and `libido_growth`.
        pace: f32 = 30.0, "1/s", 0.0..=1000.0, "choice: film rate";
        /// Weight of food in view in hunger, `alpha_h`.
        food_weight: f32 = 0.8, "1", 0.0..=2.0, "Tu 1996, 6.2";
        /// Weight of mates in view in libido, `alpha_l`.
        mate_weight: f32 = 0.5, "1", 0.0..=2.0, "Tu 1996, 6.2";
        /// Distance at which food begins to tempt (20 units).
        food_far: f32 = 1.4286, "BL", 0.01..=1000.0, "Tu 1996, 6.2.1";
        /// Distance at which food tempts most (5 units).
        food_near: f32 = 0.35714, "BL", 0.001..=1000.0, "Tu 1996, 6.2.1";
        /// Distance at which a mate begins to tempt (40 units).
        mate_far: f32 = 2.8571, "BL", 0.01..=1000.0, "Tu 1996, 6.2.1";
        /// Distance at which a mate tempts most (10 units).
        mate_near: f32 = 0.71429, "BL", 0.001..=1000.0, "Tu 1996, 6.2.1";
        /// Distance at which one predator causes all fear there is, `D0` (200 units); 35.7 makes a coward.
        fear_distance: f32 = 14.2857, "BL", 0.0..=1000.0, "Tu 1996, 6.2";
        /// Time after which the fear of what is out of sight has lost 63 percent.
        alarm_time: f32 = 4.0, "s", 0.0..=1000.0, "choice: a hunter behind is out of sight, not gone";
        /// Share of a random meal and of a random wait for a mate with which its life begins.
        stagger: f32 = 1.0, "1", 0.0..=1.0, "choice: else all are hungry at once";
        /// Fear above which it cares, `f0`.
        fear_threshold: f32 = 0.3, "1", 0.0..=1.0, "choice within Tu 1996, 6.3";
        /// Fear of one predator above which it flees rather than schools, `f1`.
        panic_threshold: f32 = 0.8, "1", 0.0..=1.0, "choice within Tu 1996, 6.3";
        /// Hunger or libido above which it cares, `r`.
        drive_threshold: f32 = 0.3, "1", 0.0..=1.0, "choice within Tu 1996, 6.3";
        /// Time after which a drive that is followed in vain has lost 63 percent.
        fatigue_time: f32 = 20.0, "s", 0.1..=100000.0, "choice: 600 steps";
        /// Handicap of what competes with a resumed behavior.
        inhibition: f32 = 0.2, "1", 0.0..=1.0, "Tu 1996, 6.3.2";
        /// How much nearer another target must be to be preferred: 0 is fickle, 5 devoted.
        persistence: f32 = 0.5, "BL", 0.0..=1000.0, "choice; Tu 1996, 6.3.2";
        /// Weight of motor preferences in the choice of a target, `p`.
        preference_weight: f32 = 0.2, "1", 0.0..=1.0, "Tu 1996, 5.4";
        /// Reach of the box in which others threaten to collide, ahead of its middle.
        box_ahead: f32 = 1.0, "BL", 0.0..=100.0, "choice";
        /// Its reach behind.
        box_behind: f32 = 0.3, "BL", 0.0..=100.0, "choice";
        /// Its reach to the sides, up and down.
        box_aside: f32 = 0.5, "BL", 0.0..=100.0, "choice";
        /// Factor on that box: less than 1 is bold, more is timid.
        timidity: f32 = 1.0, "1", 0.0..=10.0, "Tu 1996, 5.5";
        /// Length of the feeler before its snout; what it meets threatens to collide.
        antenna: f32 = 1.0, "BL", 0.0..=100.0, "Tu 1996, 5.5";
        /// Speed of calm swimming.
        cruise_speed: f32 = 1.0, "BL/s", 0.0..=20.0, "choice";
        /// Speed at full strength.
        full_speed: f32 = 3.0, "BL/s", 0.0..=40.0, "choice";
        /// Mean time from one whim to the next.
        whim_time: f32 = 1.3333, "s", 0.05..=100.0, "choice: 40 steps";
        /// Greatest turn of a whim.
        whim_turn: f32 = 60.0, "deg", 0.0..=180.0, "choice";
        /// How far from home it wanders before it turns back.
        home_range: f32 = 8.0, "m", 0.1..=100000.0, "choice";
        /// Distance within which others belong to its school, `R_s`.
        school_radius: f32 = 5.0, "BL", 0.1..=1000.0, "choice";
        /// Distance that it keeps from the nearest of its school.
        spacing: f32 = 1.0, "BL", 0.1..=100.0, "Tu 1996, 6.5.2";
        /// Whether it schools without fear, where its habits say so (0 or 1).
        sociable: f32 = 1.0, "1", 0.0..=1.0, "choice: Tu's schools need fear, her film does not";
        /// Brightness above which a lover of brightness is content.
        bright: f32 = 0.6, "1", 0.0..=10.0, "choice";
        /// Brightness below which a lover of darkness is content.
        dark: f32 = 0.3, "1", 0.0..=10.0, "choice";
        /// Temperature above which a lover of warmth is content.
        warm: f32 = 25.0, "degC", -5.0..=60.0, "choice";
        /// Temperature below which a lover of cold is content.
        cold: f32 = 22.0, "degC", -5.0..=60.0, "choice";
        /// Range of sight as the choice of prey and mates weighs it, `V_r`.
        sight_range: f32 = 15.0, "BL", 0.1..=1000.0, "choice";
        /// Range of smell as the choice of food weighs it, `O_r`.
        smell_range: f32 = 20.0, "BL", 0.1..=1000.0, "choice";
        /// How much dearer schooling prey is, `beta1`.
        school_cost: f32 = 0.5, "1", 0.0..=10.0, "Tu 1996, 6.5.1";
        /// How much dearer prey straight behind is, `beta2`.
        turn_cost: f32 = 0.2, "1", 0.0..=10.0, "Tu 1996, 6.5.1";
        /// How far a hunter turns beyond moving prey, per radian that it moves while being reached.
        lead: f32 = 0.5, "1", 0.0..=3.0, "choice; Tu 1996, 6.4.2";
        /// Distance of food from the mouth at which it sucks.
        suck_distance: f32 = 0.15, "BL", 0.001..=10.0, "choice";
        /// Time for which it displays before one that wants another.
        display_time: f32 = 8.0, "s", 0.0..=1000.0, "choice";
        /// Loops of the male before the female's head.
        loops: f32 = 6.0, "1", 0.0..=100.0, "Terzopoulos, Tu and Grzeszczuk 1994";
        /// Full turns of the female while the pair circles.
        turns: f32 = 3.0, "1", 0.0..=100.0, "choice";
        /// Touches of the male at the end.
        touches: f32 = 3.0, "1", 1.0..=100.0, "Tu 1996, 8.2";
        /// Time for which the male backs off after a touch.
        back_off: f32 = 0.8, "s", 0.0..=100.0, "choice";
        /// Depth at which the ascent to spawn ends.
        spawning_depth: f32 = 0.6, "m", 0.0..=1000.0, "choice";
    }
}
