//! The turtle: walks along a string of modules and leaves a plant behind.
//!
//! It has a place, three axes (heading H, left L, up U, with H × L = U), a width and a color. Unless the options
//! say else it starts at the origin with H up, L towards −X and U towards +Z. Angles are degrees, lengths metres.
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
//! | `@D(s)` `@Di(f)` `@Dd(f)` | sets, multiplies, divides the size of all that follows |
//! | `?(n,s)` `$` | begins a sub-L-system of size s, ends it |
//! | `{` `.` `}` | begins a polygon, adds a corner here, fills it; `F` and `f` add corners too, `G` and `g` do not |
//! | `{(n)` `.` `}(n)` | an axis over control points: 1 and 2 are Hermite curves, 3 and 4 B-splines, 2 and 4 closed |
//! | `@Gs` `@Gc(n)` `@Ge(n)` | begins, continues (by n rings), ends an axis over control points |
//! | `@Gt(a,b)` `@Gr(a,l,b,m)` | how far such an axis keeps to the heading, the slopes of its radius |
//! | `@#(n)` `@!(n)` | the cross-section of what is drawn: 0 round, 1 ribbon, 2 ruffled ribbon, or contour n; its sides |
//! | `@Tx(n)` | texture n |
//! | `~x(s)` `~x(a,b,c)` | a surface scaled by s, or by a to the left, b ahead and c up |
//! | `@PS(i,b)` `@PC(i,r,c)` `@PD(i,s,t)` | begins patch i with basis b, sets its point (r, c) here, draws it with s × t quads |
//! | `@O(r)` | a ball of radius r |
//! | `@o(r)` `@c(r)` `@bo(r)` `@bc(r)` | a disc in the plane of x and y, of H and L; the same as rings |
//! | `@Td(x,y,z)` `@Ts(e)` `_(e)` | the direction of the tropism, how much it turns the heading |
//! | `@Ti(n,e)` `@Td(n,e)` `@Ts(n,e)` | more, less, this elasticity towards the tropism of number n |
//! | `@Tp` `@Tf` | undoes the twist since the last stroke, keeps it |
//! | `@L(n,…)` | text n here |
//! | `%` `@mc(1)` | what follows in this branch is not drawn, if the options say so; always |
//!
//! Where the course notes and the program cpfg differ, [`Conventions`] decides. Other symbols and further
//! parameters mean nothing to it.
//!
//! Sources: *The Algorithmic Beauty of Plants*, appendix C, with the signs of the course notes "The artificial life of plants";
//! R. Měch, *CPFG version 4.0 user's manual* (2005), section 5.1.9.

mod axes;
mod between;
mod command;
mod draw;
mod options;
mod patch;
mod sharing;
mod spelling;
mod spline;
mod stances;
mod state;

use bioscope_core::{Error, Result, Vec3};
use glam::DVec3;

use crate::{Alphabet, ModuleString, interpretation::Interpretation};
use axes::{Angle, Axes};
use command::{Change, Command, Disc, command};
use patch::PatchTable;
use spelling::Spelling;
use spline::Spline;
use state::{MOVEMENTS, State};

pub use axes::Frame;
pub use between::Between;
pub use options::{Conventions, Movement, TurtleOptions};
pub use sharing::{SharedPart, SharedPlant};
pub(crate) use stances::Stance;

/// How deeply brackets may be nested.
const DEPTH_LIMIT: usize = 100_000;
/// How many segments, corners and surfaces may be made together.
const PART_LIMIT: usize = 50_000_000;
/// Turns whose sine and cosine are remembered.
const ANGLES: usize = 64;

/// Where the turtle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its place, metres.
    pub position: Vec3,
    /// Its axes.
    pub frame: Frame,
    /// Width of what it draws, metres.
    pub width: f32,
    /// Index of its color.
    pub color: i32,
}

/// Interprets strings of modules.
pub struct Turtle<'a> {
    options: &'a TurtleOptions,
    commands: Vec<Command>,
    /// Whether it leaves anything behind.
    draws: bool,
    state: State,
    stack: Vec<State>,
    polygons: Vec<Vec<Vec3>>,
    corners: usize,
    spline: Option<Box<Spline>>,
    splines: Vec<Option<Box<Spline>>>,
    patches: PatchTable,
    /// Sizes outside the sub-L-systems that have begun.
    scales: Vec<f32>,
    /// The stroke that tapers to the next width (cpfg).
    tapering: Option<u32>,
    /// Brackets open inside what a cut removes.
    skipped: Option<usize>,
    angles: [(u32, Angle); ANGLES],
    angle: Angle,
    /// How much of itself the present module is: what is only just growing is smaller.
    growing: f32,
    /// Symbols of several letters that are spelled in modules of one letter.
    spelling: Option<Spelling>,
    out: Interpretation,
}

impl<'a> Turtle<'a> {
    /// What the string looks like.
    pub fn interpret(string: &ModuleString, options: &'a TurtleOptions) -> Result<Interpretation> {
        let mut turtle = Self::new(string.alphabet(), options);
        let arities: Vec<u8> = string.alphabet().kinds().iter().map(|kind| kind.arity).collect();
        let mut rest = string.parameters();
        for &code in string.kinds() {
            let (parameters, after) = rest.split_at(arities[code as usize] as usize);
            rest = after;
            turtle.read(code, parameters)?;
        }
        Ok(turtle.finish())
    }

    /// A turtle at the start that draws what modules of this alphabet say.
    pub fn new(alphabet: &Alphabet, options: &'a TurtleOptions) -> Self {
        let kinds = alphabet.kinds().iter();
        let round = options.conventions == Conventions::Notes;
        Self {
            options,
            commands: kinds.map(|kind| command(&kind.symbol, kind.arity, options)).collect(),
            draws: true,
            state: State::new(options),
            stack: Vec::new(),
            polygons: Vec::new(),
            corners: 0,
            spline: None,
            splines: Vec::new(),
            patches: PatchTable::default(),
            scales: Vec::new(),
            tapering: None,
            skipped: None,
            angles: [(u32::MAX, Angle::HALF_TURN); ANGLES],
            angle: Angle::of_degrees(options.angle, round),
            growing: 1.0,
            spelling: Spelling::of(alphabet),
            out: Interpretation { shapes: options.shapes.clone(), ..Interpretation::default() },
        }
    }

    /// A turtle that only walks, to be asked for its [`Self::pose`].
    pub fn walking(alphabet: &Alphabet, options: &'a TurtleOptions) -> Self {
        Self { draws: false, ..Self::new(alphabet, options) }
    }

    /// Does what the module with this code (in the alphabet) and these parameters says.
    pub fn read(&mut self, code: u8, parameters: &[f32]) -> Result<()> {
        let mut command = self.commands.get(code as usize).copied().unwrap_or(Command::Nothing);
        if let Some(spelling) = &mut self.spelling {
            let (before, spelled) = spelling.read(code, parameters.len() as u8, self.options);
            if let Some(before) = before {
                self.follow(before, &[])?;
            }
            command = spelled.unwrap_or(command);
        }
        self.follow(command, parameters)
    }

    fn follow(&mut self, command: Command, parameters: &[f32]) -> Result<()> {
        if self.skipped.is_some() && !self.skip(command) {
            return Ok(());
        }
        self.obey(command, parameters);
        self.check()
    }

    /// Its place and its axes with H × L up, as [`TurtleOptions`] take them.
    pub(crate) fn standing(&self) -> (Vec3, Frame) {
        (self.state.position.as_vec3(), self.state.axes.rounded())
    }

    /// Where it is now.
    pub fn pose(&self) -> Pose {
        let mut frame = self.state.axes.rounded();
        if self.is_cpfg() {
            frame.up = -frame.up;
        }
        Pose {
            position: self.state.position.as_vec3(),
            frame,
            width: self.state.width,
            color: self.state.color,
        }
    }

    /// Ends the walk: what it has left behind.
    pub fn finish(mut self) -> Interpretation {
        let options = self.options;
        if let Some(last) = self.spelling.as_mut().and_then(|spelling| spelling.end(options)) {
            self.obey(last, &[]);
        }
        self.end_stroke();
        self.out
    }

    fn is_cpfg(&self) -> bool {
        self.options.conventions == Conventions::Cpfg
    }

    /// Whether a command counts again after a cut: the bracket that closes the branch does.
    fn skip(&mut self, command: Command) -> bool {
        let Some(open) = &mut self.skipped else { return true };
        match command {
            Command::Push => *open += 1,
            Command::Pop if *open == 0 => {
                self.skipped = None;
                return true;
            }
            Command::Pop => *open -= 1,
            _ => {}
        }
        false
    }

    fn obey(&mut self, command: Command, parameters: &[f32]) {
        let first = parameters.first().copied().map(finite);
        match command {
            Command::Nothing => {}
            Command::Turn(_) | Command::Pitch(_) | Command::Roll(_) => self.rotate(command, first),
            Command::Back => self.state.axes.turn(Angle::HALF_TURN),
            Command::Push => self.push(),
            Command::Pop => self.pop(),
            Command::Draw { corner } => self.draw(self.length(first), corner),
            Command::Move { corner } => self.go(self.length(first), corner),
            Command::Width(sign) => {
                let step = sign * self.options.width_step * self.state.scale;
                let width = first.map(|width| width * self.state.scale);
                self.state.width =
                    (width.unwrap_or(self.state.width + step) * self.growing).max(0.0);
            }
            Command::Color(change) => self.color(change, first),
            Command::Corner if self.polygons.is_empty() => self.control_point(first),
            Command::BeginPolygon if first.is_some_and(|kind| kind != 0.0) => {
                self.begin_spline(first, parameters.get(1).copied());
            }
            Command::EndPolygon if first.is_some_and(|kind| kind != 0.0) => self.end_spline(),
            Command::BeginPolygon => {
                self.end_stroke();
                self.polygons.push(Vec::new());
            }
            Command::Corner => self.corner(),
            Command::EndPolygon => self.end_polygon(),
            Command::Surface(name) => self.surface(name, parameters),
            _ => self.special(command, first, parameters),
        }
    }

    /// The commands that begin with `@`, and the rare ones.
    fn special(&mut self, command: Command, first: Option<f32>, parameters: &[f32]) {
        self.end_stroke();
        match command {
            Command::Level => {
                self.state.axes = Axes::looking(self.state.axes.heading, DVec3::Y);
            }
            Command::Look => self.look(parameters),
            Command::Go => {
                self.leave_axis();
                let place = vector(parameters, 0).map(Vec3::as_dvec3);
                self.state.position = place.unwrap_or(self.state.position);
            }
            Command::Scale => self.state.scale = first.unwrap_or(self.state.scale),
            Command::ScaleStep(sign) => {
                let factor = first.filter(|&one| one != 0.0).unwrap_or(self.options.scale_step);
                let factor = if sign > 0.0 { factor } else { 1.0 / factor };
                self.state.scale = finite(self.state.scale * factor);
            }
            Command::BeginSubsystem => {
                self.scales.push(self.state.scale);
                let factor = parameters.get(1).copied().map_or(1.0, finite);
                self.rescale(self.state.scale * factor);
            }
            Command::EndSubsystem => {
                if let Some(scale) = self.scales.pop() {
                    self.rescale(scale);
                }
            }
            Command::Ball => self.ball(first),
            Command::Disc(disc) => self.disc(disc, first),
            Command::Contour => self.contour(first),
            Command::Sides => {
                self.leave_axis();
                self.state.sides = first.map_or(0, |sides| sides.clamp(3.0, 64.0) as u16);
            }
            Command::Texture => {
                self.leave_axis();
                self.state.texture = first.map_or(0, |texture| texture.max(0.0) as u16);
            }
            Command::BeginPatch | Command::PatchPoint | Command::DrawPatch => {
                self.patch(command, parameters);
            }
            Command::Label => self.label(parameters),
            Command::Cut if !self.options.past_cuts && first.is_none() => self.skipped = Some(0),
            Command::CutIf if first == Some(1.0) => self.skipped = Some(0),
            _ => self.growth(command, first, parameters),
        }
    }

    /// What shapes axes over control points and how the turtle gives way.
    fn growth(&mut self, command: Command, first: Option<f32>, parameters: &[f32]) {
        match command {
            Command::BeginAxis if self.is_cpfg() => {
                self.begin_spline(Some(1.0), None);
                self.control_point(None);
                self.ignore_steps();
            }
            Command::BeginAxis => {
                self.leave_axis();
                self.state.beginning = Some((self.state.width, self.state.color));
            }
            Command::ContinueAxis => self.axis_point(first),
            Command::EndAxis if self.is_cpfg() => {
                self.axis_point(first);
                self.end_spline();
            }
            Command::EndAxis => self.leave_axis(),
            Command::AxisTangents => {
                if let Some(reaching) = first {
                    let leaving = parameters.get(1).copied().map_or(reaching, finite);
                    self.state.tangents = [reaching, leaving];
                }
            }
            Command::RadiusTangents => self.radius_tangents(parameters),
            Command::TropismDirection => {
                let direction = vector(parameters, 0).map(Vec3::as_dvec3);
                let direction = direction.unwrap_or(self.state.tropism);
                self.state.tropism = direction.normalize_or_zero();
            }
            Command::Susceptibility => self.state.susceptibility = first.unwrap_or(0.0).into(),
            Command::SusceptibilityStep => {
                let more = self.state.susceptibility + f64::from(self.options.susceptibility_step);
                self.state.susceptibility = first.map_or(more, f64::from);
            }
            Command::Elasticity(change) => self.elasticity(change, parameters),
            Command::Untwist => {
                let (from, up) = self.state.before;
                let heading = self.state.axes.heading;
                self.state.axes.carry(heading, from, up);
            }
            Command::KeepTwist => self.remember_twist(),
            _ => {}
        }
    }

    fn rotate(&mut self, command: Command, degrees: Option<f32>) {
        let angle = match degrees {
            None if self.growing == 1.0 => self.angle,
            None => self.angle_of(self.options.angle * self.growing),
            Some(degrees) => self.angle_of(degrees * self.growing),
        };
        let signed = |sign: f32| if sign < 0.0 { angle.reversed() } else { angle };
        match command {
            Command::Turn(sign) => self.state.axes.turn(signed(sign)),
            Command::Pitch(sign) => self.state.axes.pitch(signed(sign)),
            Command::Roll(sign) => self.state.axes.roll(signed(sign)),
            _ => {}
        }
    }

    /// Sine and cosine of an angle, from the table if it is there.
    fn angle_of(&mut self, degrees: f32) -> Angle {
        let bits = degrees.to_bits();
        let place = (bits.wrapping_mul(0x9e37_79b9) >> 26) as usize;
        if self.angles[place].0 != bits {
            let round = !self.is_cpfg();
            self.angles[place] = (bits, Angle::of_degrees(degrees, round));
        }
        self.angles[place].1
    }

    fn look(&mut self, parameters: &[f32]) {
        let Some(heading) = vector(parameters, 0).map(Vec3::as_dvec3) else { return };
        match vector(parameters, 3).map(Vec3::as_dvec3) {
            Some(up) if self.is_cpfg() => self.state.axes = Axes::looking(heading, -up),
            Some(up) => self.state.axes = Axes::looking(heading, up),
            None if self.is_cpfg() => {
                let (from, up) = self.state.before;
                self.state.axes.carry(heading.normalize_or(DVec3::Y), from, up);
            }
            None => {}
        }
    }

    fn elasticity(&mut self, change: Change, parameters: &[f32]) {
        let number = parameters.first().copied().map_or(1.0, finite) as i64 - 1;
        let Ok(index) = usize::try_from(number) else { return };
        let Some(movement) = self.options.movements.get(index).filter(|_| index < MOVEMENTS) else {
            return;
        };
        let amount = parameters.get(1).copied().map(finite);
        let step = amount.unwrap_or(movement.elasticity_step);
        let own = &mut self.state.elasticity[index];
        match change {
            Change::More => *own += step,
            Change::Less => *own -= step,
            Change::Set => *own = amount.unwrap_or(0.0),
        }
    }

    fn remember_twist(&mut self) {
        self.state.before = (self.state.axes.heading, self.state.axes.up);
    }

    fn rescale(&mut self, scale: f32) {
        let scale = finite(scale);
        if self.state.scale != 0.0 {
            self.state.width = finite(self.state.width * (scale / self.state.scale));
        }
        self.state.scale = scale;
    }

    fn length(&self, first: Option<f32>) -> f64 {
        let length = first.unwrap_or(self.options.step) * self.growing;
        f64::from(length) * f64::from(self.state.scale)
    }

    fn color(&mut self, change: i32, first: Option<f32>) {
        let next = self.state.color.saturating_add(change * self.options.color_step);
        let color = first.map_or(next, |color| color as i32);
        self.state.color = if self.is_cpfg() { color.rem_euclid(256) } else { color };
    }

    fn push(&mut self) {
        self.end_stroke();
        self.stack.push(self.state);
        self.splines.push(self.spline.clone());
        self.leave_axis();
        self.state.depth += 1;
    }

    fn pop(&mut self) {
        self.end_stroke();
        if let (Some(state), Some(spline)) = (self.stack.pop(), self.splines.pop()) {
            self.state = state;
            self.spline = spline;
        }
    }

    fn check(&self) -> Result<()> {
        let out = &self.out;
        let parts = out.segments.len() + self.corners + out.surfaces.len() + out.balls.len();
        let parts = parts + out.discs.len() + out.patches.len() + out.labels.len();
        let limit = |what: &str, limit: usize| {
            Err(Error::Limit { what: what.into(), limit: limit.to_string() })
        };
        if parts > PART_LIMIT {
            return limit("number of segments, corners and surfaces", PART_LIMIT);
        }
        if self.stack.len() + self.polygons.len() + self.scales.len() > DEPTH_LIMIT {
            return limit("depth of brackets", DEPTH_LIMIT);
        }
        Ok(())
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
