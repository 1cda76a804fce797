//! The turtle: walks along a string of modules and leaves a plant behind.
//!
//! It has a place, three axes (heading H, left L, up U, with H × L = U), a width and a color. It starts at
//! the origin with H up, L towards −X and U towards +Z. Angles are degrees, lengths metres.
//!
//! | symbol | what the turtle does |
//! |---|---|
//! | `F(s)` `G(s)` | goes s ahead and draws; without parameter the step of the options |
//! | `f(s)` `g(s)` | goes s ahead and does not draw |
//! | `+(a)` `-(a)` | turns left, right about U |
//! | `&(a)` `^(a)` | pitches down, up about L |
//! | `/(a)` `\(a)` | rolls about H, see [`TurtleOptions::slash_rolls_right`] |
//! | `\|` | turns back (180° about U) |
//! | `@v` | rolls so that L is level and U up |
//! | `@R(hx,hy,hz,ux,uy,uz)` | looks that way; `@M(x,y,z)` goes there |
//! | `[` `]` | remembers, returns to the state of the matching bracket |
//! | `!(w)` `#(w)` | sets the width (diameter); without parameter thinner, thicker by the step of the options |
//! | `;(n)` `,(n)` | sets the color; without parameter the next, the previous; `'` is `;` |
//! | `{` `.` `}` | begins a polygon, adds a corner here, fills it; `F` and `f` add corners too, `G` and `g` do not |
//! | `~x(s)` `~x(a,b,c)` | a surface scaled by s, or by a to the left, b ahead and c up |
//! | `@O(r)` | a ball of radius r |
//! | `@#(n)` | the cross-section of what is drawn: 0 round, 1 ribbon, 2 ruffled ribbon |
//! | `@Gs` `@Ge` | begins (with the present width and color), ends an axis |
//! | `@Td(x,y,z)` `@Ts(e)` | the direction of the tropism, how much it turns the heading |
//!
//! Other symbols and further parameters mean nothing to it.
//! Source: *The Algorithmic Beauty of Plants*, appendix C, with the signs of the course notes "The artificial life of plants".

mod stances;

pub(crate) use stances::Stance;

use bioscope_core::{Error, Result, Vec3, math};

use crate::{
    ModuleString,
    interpretation::{Anchor, Axis, Ball, Contour, Interpretation, Polygon, Segment, Surface},
};

/// How deeply brackets may be nested.
const DEPTH_LIMIT: usize = 100_000;
/// How many segments, corners and surfaces may be made together.
const PART_LIMIT: usize = 50_000_000;

/// What the turtle does when a symbol does not say how much.
#[derive(Clone, Debug, PartialEq)]
pub struct TurtleOptions {
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
    /// Whether `/` rolls to the right (in the direction from U to L reversed) and `\` to the
    /// left, as in the standard literature; the course notes have it the other way round.
    pub slash_rolls_right: bool,
    /// Direction of the tropism.
    pub tropism: Vec3,
    /// How much of the torque of the tropism turns the heading at each `F`, radians; 0 is none.
    pub susceptibility: f32,
}

impl Default for TurtleOptions {
    fn default() -> Self {
        Self {
            step: 1.0,
            angle: 45.0,
            width: 0.1,
            width_step: 0.01,
            color: 1,
            slash_rolls_right: false,
            tropism: Vec3::NEG_Y,
            susceptibility: 0.0,
        }
    }
}

/// Three perpendicular unit vectors, H × L = U.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where the turtle goes.
    pub heading: Vec3,
    /// Its left.
    pub left: Vec3,
    /// Its up.
    pub up: Vec3,
}

impl Frame {
    const START: Self = Self { heading: Vec3::Y, left: Vec3::NEG_X, up: Vec3::Z };

    /// The frame with this heading whose up is as near as possible to `up`.
    fn looking(heading: Vec3, up: Vec3) -> Self {
        let heading = heading.normalize_or(Vec3::Y);
        let left = up.cross(heading).normalize_or(heading.any_orthonormal_vector());
        Self { heading, left, up: heading.cross(left) }
    }

    fn turn(&mut self, degrees: f32) {
        rotate(&mut self.heading, &mut self.left, degrees);
        self.straighten();
    }

    fn pitch(&mut self, degrees: f32) {
        rotate(&mut self.up, &mut self.heading, degrees);
        self.straighten();
    }

    fn roll(&mut self, degrees: f32) {
        rotate(&mut self.up, &mut self.left, degrees);
        self.straighten();
    }

    /// Turns the heading towards `direction` by `strength` radians times the sine of the angle between.
    fn bend(&mut self, direction: Vec3, strength: f32) {
        let torque = self.heading.cross(direction);
        let heading = self.heading + torque.cross(self.heading) * strength;
        self.heading = heading.normalize_or(self.heading);
        self.straighten();
    }

    /// Removes what rounding has bent.
    fn straighten(&mut self) {
        self.heading = self.heading.normalize();
        let left = self.left - self.heading * self.heading.dot(self.left);
        self.left = left.normalize_or(self.heading.any_orthonormal_vector());
        self.up = self.heading.cross(self.left);
    }
}

/// Turns `a` towards `b`, and `b` away from `a`.
fn rotate(a: &mut Vec3, b: &mut Vec3, degrees: f32) {
    let angle = (degrees % 360.0).to_radians();
    let (sine, cosine) = (math::sin(angle), math::cos(angle));
    (*a, *b) = (*a * cosine + *b * sine, *b * cosine - *a * sine);
}

/// What a symbol tells the turtle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Command {
    Nothing,
    Draw { corner: bool },
    Move { corner: bool },
    Turn(f32),
    Pitch(f32),
    Roll(f32),
    Back,
    Level,
    Look,
    Go,
    Push,
    Pop,
    Width(f32),
    Color(i32),
    BeginPolygon,
    Corner,
    EndPolygon,
    Surface(char),
    Ball,
    Contour,
    BeginAxis,
    EndAxis,
    TropismDirection,
    Susceptibility,
}

fn command(symbol: &str, options: &TurtleOptions) -> Command {
    let slash = if options.slash_rolls_right { -1.0 } else { 1.0 };
    match symbol {
        "F" => Command::Draw { corner: true },
        "G" => Command::Draw { corner: false },
        "f" => Command::Move { corner: true },
        "g" => Command::Move { corner: false },
        "+" => Command::Turn(1.0),
        "-" => Command::Turn(-1.0),
        "&" => Command::Pitch(1.0),
        "^" => Command::Pitch(-1.0),
        "/" => Command::Roll(slash),
        "\\" => Command::Roll(-slash),
        "|" => Command::Back,
        "@v" => Command::Level,
        "@R" => Command::Look,
        "@M" => Command::Go,
        "[" => Command::Push,
        "]" => Command::Pop,
        "#" => Command::Width(1.0),
        "!" => Command::Width(-1.0),
        ";" | "'" => Command::Color(1),
        "," => Command::Color(-1),
        "{" => Command::BeginPolygon,
        "." => Command::Corner,
        "}" => Command::EndPolygon,
        "@O" => Command::Ball,
        "@#" => Command::Contour,
        "@Gs" => Command::BeginAxis,
        "@Ge" => Command::EndAxis,
        "@Td" => Command::TropismDirection,
        "@Ts" => Command::Susceptibility,
        _ => match symbol.strip_prefix('~').and_then(|name| name.chars().next()) {
            Some(name) => Command::Surface(name),
            None => Command::Nothing,
        },
    }
}

/// What brackets remember.
#[derive(Clone, Copy, Debug)]
struct State {
    position: Vec3,
    frame: Frame,
    width: f32,
    color: i32,
    contour: Contour,
    tropism: Vec3,
    susceptibility: f32,
    /// How many brackets are open.
    depth: u32,
    /// The axis that the next segment continues.
    axis: Option<u32>,
    /// Where the next axis begins on another.
    anchor: Option<Anchor>,
    /// Width and color with which the next axis begins, if not with those of its first segment.
    beginning: Option<(f32, i32)>,
}

/// Interprets strings of modules.
pub struct Turtle<'a> {
    options: &'a TurtleOptions,
    state: State,
    stack: Vec<State>,
    polygons: Vec<Vec<Vec3>>,
    corners: usize,
    out: Interpretation,
}

impl<'a> Turtle<'a> {
    /// What the string looks like.
    pub fn interpret(string: &ModuleString, options: &'a TurtleOptions) -> Result<Interpretation> {
        let mut turtle = Self::new(options);
        let commands: Vec<Command> =
            string.alphabet().kinds().iter().map(|kind| command(&kind.symbol, options)).collect();
        let mut rest = string.parameters();
        for &code in string.kinds() {
            let arity = string.alphabet().kinds()[code as usize].arity as usize;
            let (parameters, after) = rest.split_at(arity);
            rest = after;
            turtle.obey(commands[code as usize], parameters);
            turtle.check()?;
        }
        Ok(turtle.out)
    }

    fn new(options: &'a TurtleOptions) -> Self {
        let state = State {
            position: Vec3::ZERO,
            frame: Frame::START,
            width: options.width,
            color: options.color,
            contour: Contour::Round,
            tropism: options.tropism,
            susceptibility: options.susceptibility,
            depth: 0,
            axis: None,
            anchor: None,
            beginning: None,
        };
        Self {
            options,
            state,
            stack: Vec::new(),
            polygons: Vec::new(),
            corners: 0,
            out: Interpretation::default(),
        }
    }

    fn obey(&mut self, command: Command, parameters: &[f32]) {
        let first = parameters.first().copied().map(finite);
        let angle = first.unwrap_or(self.options.angle);
        let step = first.unwrap_or(self.options.step);
        match command {
            Command::Nothing => {}
            Command::Draw { corner } if self.polygons.is_empty() || !corner => self.draw(step),
            Command::Draw { .. } => self.go(step, true),
            Command::Move { corner } => self.go(step, corner),
            Command::Turn(sign) => self.state.frame.turn(sign * angle),
            Command::Pitch(sign) => self.state.frame.pitch(sign * angle),
            Command::Roll(sign) => self.state.frame.roll(sign * angle),
            Command::Back => self.state.frame.turn(180.0),
            Command::Level => self.state.frame = Frame::looking(self.state.frame.heading, Vec3::Y),
            Command::Look => {
                if let (Some(heading), Some(up)) = (vector(parameters, 0), vector(parameters, 3)) {
                    self.state.frame = Frame::looking(heading, up);
                }
            }
            Command::Go => {
                self.leave_axis();
                self.state.position = vector(parameters, 0).unwrap_or(self.state.position);
            }
            Command::Push => self.push(),
            Command::Pop => self.state = self.stack.pop().unwrap_or(self.state),
            Command::Width(sign) => {
                let width = self.state.width + sign * self.options.width_step;
                self.state.width = first.unwrap_or(width).max(0.0);
            }
            Command::Color(change) => {
                let next = self.state.color.saturating_add(change);
                self.state.color = first.map_or(next, |color| color as i32);
            }
            Command::BeginPolygon => self.polygons.push(Vec::new()),
            Command::Corner => self.corner(),
            Command::EndPolygon => self.end_polygon(),
            Command::Surface(name) => self.surface(name, parameters),
            Command::Ball => self.ball(first.unwrap_or(self.state.width / 2.0)),
            Command::Contour => self.contour(first),
            Command::BeginAxis => {
                self.leave_axis();
                self.state.beginning = Some((self.state.width, self.state.color));
            }
            Command::EndAxis => self.leave_axis(),
            Command::TropismDirection => {
                let direction = vector(parameters, 0).unwrap_or(self.state.tropism);
                self.state.tropism = direction.normalize_or_zero();
            }
            Command::Susceptibility => self.state.susceptibility = first.unwrap_or(0.0),
        }
    }

    fn check(&self) -> Result<()> {
        let out = &self.out;
        let parts = out.segments.len() + self.corners + out.surfaces.len() + out.balls.len();
        let limit = |what: &str, limit: usize| {
            Err(Error::Limit { what: what.into(), limit: limit.to_string() })
        };
        if parts > PART_LIMIT {
            return limit("number of segments, corners and surfaces", PART_LIMIT);
        }
        if self.stack.len() + self.polygons.len() > DEPTH_LIMIT {
            return limit("depth of brackets", DEPTH_LIMIT);
        }
        Ok(())
    }

    fn push(&mut self) {
        self.stack.push(self.state);
        self.leave_axis();
        self.state.depth += 1;
    }

    /// What is drawn next begins a new axis that grows out of the present one.
    fn leave_axis(&mut self) {
        self.state.anchor = self.anchor();
        self.state.axis = None;
        self.state.beginning = None;
    }

    /// The place of the turtle on the plant.
    fn anchor(&self) -> Option<Anchor> {
        let on_axis = |axis: u32| Anchor { axis, node: self.out.axes[axis as usize].segments };
        self.state.axis.map(on_axis).or(self.state.anchor)
    }

    fn draw(&mut self, length: f32) {
        let state = &mut self.state;
        let start = state.position;
        let end = start + state.frame.heading * length;
        if !end.is_finite() || length == 0.0 {
            return;
        }
        let radius = state.width / 2.0;
        let last = state.axis.map(|axis| self.out.axes[axis as usize].last);
        let last = last.map(|index| &self.out.segments[index as usize]);
        let (start_radius, start_color) = match (last, state.beginning.take()) {
            (Some(segment), _) => (segment.end_radius, segment.color),
            (None, Some((width, color))) => (width / 2.0, color),
            (None, None) => (radius, state.color),
        };
        let index = self.out.segments.len() as u32;
        let axis = state.axis.unwrap_or_else(|| {
            self.out.axes.push(Axis {
                parent: state.anchor,
                contour: state.contour,
                segments: 0,
                last: index,
            });
            self.out.axes.len() as u32 - 1
        });
        self.out.axes[axis as usize].segments += 1;
        self.out.axes[axis as usize].last = index;
        self.out.segments.push(Segment {
            start,
            end,
            start_radius,
            end_radius: radius,
            start_color,
            color: state.color,
            axis,
            depth: state.depth,
            left: state.frame.left,
        });
        state.axis = Some(axis);
        state.position = end;
        self.grow_towards_tropism();
    }

    fn grow_towards_tropism(&mut self) {
        let State { tropism, susceptibility, .. } = self.state;
        if susceptibility != 0.0 {
            self.state.frame.bend(tropism, susceptibility);
        }
    }

    fn go(&mut self, length: f32, corner: bool) {
        let end = self.state.position + self.state.frame.heading * length;
        if !end.is_finite() {
            return;
        }
        self.leave_axis();
        self.state.position = end;
        if corner {
            self.corner();
        }
    }

    fn corner(&mut self) {
        if let Some(polygon) = self.polygons.last_mut() {
            polygon.push(self.state.position);
            self.corners += 1;
        }
    }

    fn end_polygon(&mut self) {
        let Some(corners) = self.polygons.pop() else { return };
        if corners.len() >= 3 {
            let (color, anchor) = (self.state.color, self.anchor());
            self.out.polygons.push(Polygon { corners, color, anchor });
        }
    }

    fn surface(&mut self, name: char, parameters: &[f32]) {
        let scale = match *parameters {
            [] => Vec3::ONE,
            [scale] => Vec3::splat(finite(scale)),
            [left, ahead, ..] => {
                let up = parameters.get(2).copied().unwrap_or(left);
                Vec3::new(finite(left), finite(ahead), finite(up))
            }
        };
        let State { position, frame, color, .. } = self.state;
        let anchor = self.anchor();
        self.out.surfaces.push(Surface { name, position, frame, scale, color, anchor });
    }

    fn ball(&mut self, radius: f32) {
        let State { position: center, frame, color, .. } = self.state;
        let anchor = self.anchor();
        self.out.balls.push(Ball { center, radius, axis: frame.heading, color, anchor });
    }

    fn contour(&mut self, number: Option<f32>) {
        let contour = match number.unwrap_or(0.0) as i32 {
            1 => Contour::Ribbon,
            2 => Contour::Ruffle,
            _ => Contour::Round,
        };
        if contour != self.state.contour {
            self.leave_axis();
            self.state.contour = contour;
        }
    }
}

/// The number within what a world can hold, or zero in place of what is none.
fn finite(number: f32) -> f32 {
    const FARTHEST: f32 = 1e9;
    if number.is_finite() { number.clamp(-FARTHEST, FARTHEST) } else { 0.0 }
}

fn vector(parameters: &[f32], first: usize) -> Option<Vec3> {
    let parts = parameters.get(first..first + 3)?;
    Some(Vec3::new(finite(parts[0]), finite(parts[1]), finite(parts[2])))
}
