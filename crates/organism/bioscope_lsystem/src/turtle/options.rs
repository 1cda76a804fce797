use std::sync::Arc;

use bioscope_core::Vec3;

use crate::files::Shapes;

/// Whose turtle is walked: the two differ where one symbol means two things.
///
/// | symbol | notes | cpfg |
/// |---|---|---|
/// | `@O(r)` `@o(r)` `@c(r)` | radius | diameter |
/// | `F` inside `{ }` | a corner | a corner and a stroke |
/// | `@Gs` `@Ge` | begin, end an axis of strokes | begin, end an axis of control points, with `@Gc` |
/// | `@Ts` `@Td` | strength, direction of the tropism | elasticity of tropism number n set, lessened |
/// | width after a stroke | is that of the next stroke | is where the stroke tapers to |
/// | `?U`, up in `@R` | H × L | L × H |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Conventions {
    /// The course notes "The artificial life of plants".
    #[default]
    Notes,
    /// The program cpfg, version 6.6.
    Cpfg,
}

/// A tropism or torque of cpfg's view file, number 1, 2 … for `@Ti @Td @Ts`.
#[derive(Clone, Debug, PartialEq)]
pub struct Movement {
    /// Whether it turns the turtle's up about its heading, not its heading.
    pub twists: bool,
    /// Where it pulls, as long as its intensity (0 to 1; negative pushes).
    pub direction: Vec3,
    /// The angle to the direction that is sought, degrees.
    pub angle: f32,
    /// How much the turtle gives way at the start.
    pub elasticity: f32,
    /// How much `@Ti` and `@Td` change that.
    pub elasticity_step: f32,
}

/// What the turtle does when a symbol does not say how much.
#[derive(Clone, Debug, PartialEq)]
pub struct TurtleOptions {
    /// Whose turtle it is.
    pub conventions: Conventions,
    /// Where it starts, metres.
    pub position: Vec3,
    /// How it looks there: where it goes, and what is up as nearly as that allows (H × L).
    pub heading: Vec3,
    /// See [`Self::heading`].
    pub up: Vec3,
    /// Length of `F` and `f`, metres.
    pub step: f32,
    /// Angle of turns, degrees.
    pub angle: f32,
    /// Width (diameter) at the start, metres.
    pub width: f32,
    /// By how much `#` and `!` change the width, metres.
    pub width_step: f32,
    /// Color at the start: an index of the palette.
    pub color: i32,
    /// By how much `;` and `,` change it.
    pub color_step: i32,
    /// Size of everything at the start.
    pub scale: f32,
    /// By what `@Di` and `@Dd` multiply and divide it.
    pub scale_step: f32,
    /// Whether `/` rolls to the right (in the direction from U to L reversed) and `\` to the
    /// left, as the standard literature says; the course notes and the program cpfg have it the other way round.
    pub slash_rolls_right: bool,
    /// Direction of the tropism.
    pub tropism: Vec3,
    /// How much of the torque of the tropism turns the heading at each `F`, radians; 0 is none.
    pub susceptibility: f32,
    /// How much `_` raises that.
    pub susceptibility_step: f32,
    /// Numbered tropisms; the first eight count.
    pub movements: Vec<Movement>,
    /// Whether strokes taper to the width that follows them (cpfg).
    pub tapered: bool,
    /// Whether the cross-section of an axis of control points turns with the turtle (cpfg).
    pub twist: bool,
    /// Whether what follows `%` in its branch is still drawn.
    pub past_cuts: bool,
    /// Surfaces and contours by name.
    pub shapes: Arc<Shapes>,
}

impl Default for TurtleOptions {
    fn default() -> Self {
        Self {
            conventions: Conventions::Notes,
            position: Vec3::ZERO,
            heading: Vec3::Y,
            up: Vec3::Z,
            step: 1.0,
            angle: 45.0,
            width: 0.1,
            width_step: 0.01,
            color: 1,
            color_step: 1,
            scale: 1.0,
            scale_step: 1.0,
            slash_rolls_right: false,
            tropism: Vec3::NEG_Y,
            susceptibility: 0.0,
            susceptibility_step: 0.0,
            movements: Vec::new(),
            tapered: true,
            twist: false,
            past_cuts: true,
            shapes: Arc::default(),
        }
    }
}

impl TurtleOptions {
    /// What cpfg does without a view file.
    pub fn cpfg() -> Self {
        Self {
            conventions: Conventions::Cpfg,
            width: 1.0,
            width_step: 0.0,
            color: 128,
            tropism: Vec3::Y,
            ..Self::default()
        }
    }
}
