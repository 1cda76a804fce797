use std::{path::Path, sync::Arc};

use bioscope_core::{Error, Vec3};

use super::text::{Line, Text, number, numbers};
use super::{ContourShape, Curve, Function, Shapes, SurfaceShape};
use crate::turtle::{Movement, TurtleOptions};
use crate::{Diagnostic, Diagnostics};

/// Most files that one view may name, and most bytes of each.
const FILES: usize = 200;
const LARGEST_FILE: u64 = 16 << 20;

/// A view file (.v): how a model's strings become pictures.
#[derive(Clone, Debug)]
pub struct View {
    /// What the turtle does when a symbol does not say how much, with surfaces and contours.
    pub turtle: TurtleOptions,
    /// Sides of cylinders.
    pub sides: u32,
    /// Functions in the order of the file: number 1 is the first.
    pub functions: Vec<Arc<Function>>,
    /// Curves in the order of the file: number 1 is the first.
    pub curves: Vec<Arc<Curve>>,
    /// Textures in the order of the file: number 1 is the first.
    pub textures: Vec<TextureFile>,
    /// Where one looks from.
    pub camera: ViewCamera,
    /// Lights.
    pub lights: Vec<ViewLight>,
    /// `wireframe`, `filled`, `flat`, `interpolated`, `shaded`, `fast` or `shadows`.
    pub render_mode: String,
    /// `pixel`, `polygon` or `cylinder`.
    pub line_style: String,
    /// What was not understood, or is missing.
    pub warnings: Vec<Diagnostic>,
}

/// Where one looks from.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCamera {
    /// Place of the eye (perspective), or direction from the reference point to it (parallel).
    pub viewpoint: Vec3,
    /// What the eye looks at.
    pub reference: Vec3,
    /// Turn about the line of sight, degrees.
    pub twist: f32,
    /// Whether far things are smaller.
    pub perspective: bool,
    /// Height of what is seen in perspective, degrees.
    pub angle: f32,
    /// Nearest and farthest distance.
    pub distances: [f32; 2],
    /// Share of the window that the model fills.
    pub scale: f32,
    /// What the window shows, if the file says so.
    pub volume: Option<(Vec3, Vec3)>,
}

/// A light of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewLight {
    /// Its place, or the direction to it if `directional`.
    pub place: Vec3,
    /// Whether it is infinitely far.
    pub directional: bool,
    /// Linear color of its diffuse part.
    pub color: [f32; 3],
}

/// A texture of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureFile {
    /// Name of the picture.
    pub file: String,
    /// Width over height of one repetition, relative to the picture's own.
    pub ratio: f32,
}

impl Default for View {
    fn default() -> Self {
        Self {
            turtle: TurtleOptions::cpfg(),
            sides: 8,
            functions: Vec::new(),
            curves: Vec::new(),
            textures: Vec::new(),
            camera: ViewCamera {
                viewpoint: Vec3::Z,
                reference: Vec3::ZERO,
                twist: 0.0,
                perspective: false,
                angle: 45.0,
                distances: [-100_000.0, 100_000.0],
                scale: 1.0,
                volume: None,
            },
            lights: Vec::new(),
            render_mode: "filled".into(),
            line_style: "pixel".into(),
            warnings: Vec::new(),
        }
    }
}

/// Gives the bytes of a file that a view names.
type Load<'a> = &'a dyn Fn(&str) -> std::io::Result<Vec<u8>>;

/// Commands that change nothing here: what they set belongs to cpfg's window.
const IGNORED: [&str; 26] = [
    "z buffer",
    "cue range",
    "diffuse reflection",
    "surface ambient",
    "surface diffuse",
    "background color",
    "ambient light",
    "font",
    "winfont",
    "interpretation step",
    "environment display",
    "rayshade objects",
    "rayshade scale",
    "antialiasing",
    "min zoom",
    "max zoom",
    "generate on view change",
    "concave polygons",
    "shadow map",
    "PS linecap",
    "corrected rotation",
    "stationary view",
    "gradient",
    "capping",
    "window",
    "axiom",
];

/// Commands whose files are not read.
const UNREAD: [&str; 6] =
    ["tsurface", "background scene", "terrain", "blob", "mesh", "surface obj"];

impl View {
    /// Reads a view file and the files beside it that it names.
    pub fn read(path: impl AsRef<Path>) -> bioscope_core::Result<Self> {
        let path = path.as_ref();
        let name = path.to_string_lossy();
        let broken = |error: std::io::Error| Error::format(name.to_string(), error.to_string());
        let bytes = limited(path).map_err(broken)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let load = |name: &str| {
            let inside = Path::new(name).components();
            let is_inside = inside.clone().all(|part| {
                matches!(part, std::path::Component::Normal(_) | std::path::Component::CurDir)
            });
            if !is_inside {
                return Err(std::io::Error::other("it lies outside the folder of the view"));
            }
            limited(&folder.join(name))
        };
        Ok(Self::parse(&bytes, &name, &load)?)
    }

    /// Reads a view from its text; `load` gives the files that it names.
    pub fn parse(bytes: &[u8], file: &str, load: Load) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let mut view = Self::default();
        let mut shapes = Shapes::default();
        let mut files = 0;
        for line in text.lines() {
            let Some((name, value)) = line.command() else {
                view.warn(&text, &line, "expected 'command: value'");
                continue;
            };
            let name_lower = name.split_whitespace().collect::<Vec<_>>().join(" ");
            match name_lower.as_str() {
                "surface" | "line" | "contour" | "function" | "function set" | "curve" => {
                    files += 1;
                    if files > FILES {
                        return Err(text.error(&line, "a view names at most 200 files"));
                    }
                    if let Err(problem) = view.load(&name_lower, value, &mut shapes, load) {
                        view.warn(&text, &line, problem);
                    }
                }
                known => {
                    if !view.set(known, value) {
                        view.warn(&text, &line, problem_with(known, value));
                    }
                }
            }
        }
        view.turtle.shapes = Arc::new(shapes);
        Ok(view)
    }

    fn warn(&mut self, text: &Text, line: &Line, message: impl Into<String>) {
        self.warnings.push(text.diagnostic(line, message));
    }

    /// Sets what a command says; whether it is known and its value makes sense.
    fn set(&mut self, name: &str, value: &str) -> bool {
        let given = numbers(value);
        let word = value.split_whitespace().next().unwrap_or("");
        if let Some(&first) = given.first()
            && self.set_number(name, first)
        {
            return true;
        }
        match (name, &given[..]) {
            ("viewpoint", [x, y, z, ..]) => self.camera.viewpoint = Vec3::new(*x, *y, *z),
            ("view reference point", [x, y, z, ..]) => {
                self.camera.reference = Vec3::new(*x, *y, *z);
            }
            ("tropism direction", [x, y, z, ..]) => {
                self.turtle.tropism = Vec3::new(*x, *y, *z).normalize_or_zero();
            }
            ("light direction", [x, y, z, ..]) => self.lights.push(ViewLight {
                place: Vec3::new(*x, *y, *z).normalize_or(Vec3::Y),
                directional: true,
                color: [1.0; 3],
            }),
            ("projection", _) => self.camera.perspective = word.starts_with("perspective"),
            ("render mode", _) => self.render_mode = word.to_string(),
            ("line style", _) => self.line_style = word.to_string(),
            ("tapered lines", _) => self.turtle.tapered = word == "on",
            ("twist of cylinders", _) => self.turtle.twist = word.starts_with("on"),
            ("interpretation past %", _) => self.turtle.past_cuts = !word.starts_with("off"),
            ("light", _) => self.light(value),
            ("texture", _) => self.texture(value),
            ("tropism", _) => return self.movement(value, false),
            ("torque", _) => return self.movement(value, true),
            ("box", _) => return self.volume(value),
            _ => return IGNORED.contains(&name),
        }
        true
    }

    /// Commands with one number.
    fn set_number(&mut self, name: &str, first: f32) -> bool {
        let turtle = &mut self.turtle;
        match name {
            "angle factor" => turtle.angle = if first == 0.0 { 0.0 } else { 360.0 / first },
            "angle increment" => turtle.angle = first,
            "initial color" => turtle.color = first as i32,
            "color increment" => turtle.color_step = first as i32,
            "initial line width" => turtle.width = first.max(0.0),
            "line width increment" => turtle.width_step = first,
            "initial scale" => turtle.scale = if first == 0.0 { 1.0 } else { first },
            "scale multiplier" => turtle.scale_step = if first == 0.0 { 1.0 } else { first },
            "initial elasticity" => turtle.susceptibility = first,
            "elasticity increment" => turtle.susceptibility_step = first,
            "contour sides" => self.sides = first.clamp(3.0, 64.0) as u32,
            "polygonization level" => self.sides = (2 << (first.clamp(0.0, 5.0) as u32)).max(3),
            "twist" => self.camera.twist = first / 10.0,
            "viewing angle" => self.camera.angle = first,
            "front distance" => self.camera.distances[0] = first,
            "back distance" => self.camera.distances[1] = first,
            "scale factor" => self.camera.scale = if first == 0.0 { 1.0 } else { first },
            "shade mode" => {
                let mode = match first as i32 {
                    2 => "interpolated",
                    3 | 6 => "shaded",
                    4 | 5 | 7 => "wireframe",
                    _ => "filled",
                };
                self.render_mode = mode.into();
            }
            _ => return false,
        }
        true
    }

    fn light(&mut self, value: &str) {
        let mut light = ViewLight { place: Vec3::Y, directional: true, color: [1.0; 3] };
        for (letter, rest) in lettered(value) {
            let [x, y, z, ..] = numbers(rest)[..] else { continue };
            match letter {
                'V' => {
                    light.directional = true;
                    light.place = Vec3::new(x, y, z).normalize_or(Vec3::Y);
                }
                'P' | 'O' => {
                    light.directional = false;
                    light.place = Vec3::new(x, y, z);
                }
                'D' => light.color = [x, y, z].map(|part| part.clamp(0.0, 100.0)),
                _ => {}
            }
        }
        self.lights.push(light);
    }

    fn texture(&mut self, value: &str) {
        let mut texture = TextureFile { file: String::new(), ratio: 1.0 };
        for (letter, rest) in lettered(value) {
            let word = rest.split_whitespace().next().unwrap_or("");
            match letter {
                'F' => texture.file = word.to_string(),
                'R' => texture.ratio = number(word).filter(|&one| one > 0.0).unwrap_or(1.0),
                _ => {}
            }
        }
        self.textures.push(texture);
    }

    fn movement(&mut self, value: &str, twists: bool) -> bool {
        let mut movement = Movement {
            twists,
            direction: Vec3::ZERO,
            angle: 0.0,
            elasticity: 0.0,
            elasticity_step: 0.0,
        };
        let mut intensity = 1.0;
        for (letter, rest) in lettered(value) {
            let given = numbers(rest);
            match (letter, &given[..]) {
                ('T', [x, y, z, ..]) => {
                    movement.direction = Vec3::new(*x, *y, *z).normalize_or_zero();
                }
                ('I', [one, ..]) => intensity = one.clamp(-1.0, 1.0),
                ('A', [one, ..]) => movement.angle = *one,
                ('E', [one, ..]) => movement.elasticity = *one,
                ('S', [one, ..]) => movement.elasticity_step = *one,
                _ => return false,
            }
        }
        movement.direction *= intensity;
        if movement.direction == Vec3::ZERO {
            return false;
        }
        self.turtle.movements.push(movement);
        true
    }

    fn volume(&mut self, value: &str) -> bool {
        let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
        let mut found = 0;
        for (letter, rest) in lettered(value) {
            let axis = match letter {
                'x' => 0,
                'y' => 1,
                'z' => 2,
                _ => return false,
            };
            let [from, to, ..] = numbers(rest)[..] else { return false };
            (low[axis], high[axis]) = (from, to);
            found += 1;
        }
        self.camera.volume = Some((low, high));
        found == 3
    }

    /// Reads a file that a command names.
    fn load(
        &mut self,
        name: &str,
        value: &str,
        shapes: &mut Shapes,
        load: Load,
    ) -> Result<(), String> {
        let words: Vec<&str> = value.split_whitespace().collect();
        let bytes = |file: &str| load(file).map_err(|error| format!("cannot read {file}: {error}"));
        let told = |error: Diagnostics| error.to_string();
        let given = |index: usize| words.get(index).copied().and_then(number);
        match (name, &words[..]) {
            ("surface" | "line", [letter, file, ..]) => {
                let letter = letter.chars().next().unwrap_or('~');
                let size = given(2).filter(|&size| size > 0.0).unwrap_or(1.0);
                let mut shape = SurfaceShape::parse(&bytes(file)?, file, size).map_err(told)?;
                if let (Some(s), Some(t)) = (given(3), given(4)) {
                    shape.tessellate([s, t].map(|quads| quads.clamp(1.0, 10.0) as u32));
                    shape.texture = given(5).filter(|&one| one >= 0.0).map(|one| one as u16);
                } else {
                    shape.texture = given(3).filter(|&one| one >= 0.0).map(|one| one as u16);
                }
                shapes.surfaces.insert(letter, Arc::new(shape));
            }
            ("contour", [id, file, ..]) => {
                let id =
                    id.parse().map_err(|_| "expected the number of the contour".to_string())?;
                let shape = ContourShape::parse(&bytes(file)?, file).map_err(told)?;
                shapes.contours.insert(id, Arc::new(shape));
            }
            ("function", [file, ..]) => {
                let samples = given(1).map_or(0, |samples| samples.max(0.0) as usize);
                let function = Function::parse(&bytes(file)?, file, samples).map_err(told)?;
                self.functions.push(Arc::new(function));
            }
            ("function set", [file, ..]) => {
                let set = Function::parse_set(&bytes(file)?, file).map_err(told)?;
                self.functions.extend(set.into_iter().map(Arc::new));
            }
            ("curve", [file, ..]) => {
                let samples = given(1).map_or(100, |samples| samples.max(2.0) as usize);
                let curve = Curve::parse(&bytes(file)?, file, samples).map_err(told)?;
                self.curves.push(Arc::new(curve));
            }
            _ => return Err(format!("'{name}' needs the name of a file")),
        }
        Ok(())
    }
}

/// Why a command has no effect.
fn problem_with(name: &str, value: &str) -> String {
    if UNREAD.contains(&name) {
        format!("'{name}' has no effect: such files are not read")
    } else {
        format!("unknown view command or value '{name}: {value}'")
    }
}

/// Parts of a text that begin with a letter (or word) and a colon: `T: 1,0,0 E: 0.2`.
fn lettered(text: &str) -> Vec<(char, &str)> {
    let mut parts: Vec<(char, usize, usize)> = Vec::new();
    for (colon, _) in text.match_indices(':') {
        let word = text[..colon].trim_end();
        let start = word.rfind(char::is_whitespace).map_or(0, |space| space + 1);
        if let Some(letter) = word[start..].chars().next().filter(|one| one.is_alphabetic()) {
            parts.push((letter, start, colon + 1));
        }
    }
    let ends = parts.iter().skip(1).map(|part| part.1).chain([text.len()]);
    let ends: Vec<usize> = ends.collect();
    parts
        .iter()
        .zip(ends)
        .map(|(part, end)| (part.0, text[part.2..end.max(part.2)].trim()))
        .collect()
}

fn limited(path: &Path) -> std::io::Result<Vec<u8>> {
    use std::io::Read;
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(std::io::Error::other("it is larger than 16 MiB"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nothing(name: &str) -> std::io::Result<Vec<u8>> {
        Err(std::io::Error::other(format!("no {name}")))
    }

    #[test]
    fn a_view_sets_the_turtle() {
        let text = "angle factor: 12\ninitial color: 3 7\ncolor increment: 2\n\
            initial line width: 0.072   /* 0.06, 0.72, or 0.08 */\nline width increment: .5\n\
            viewpoint: 1.1,-60,0\nviewing angle: 10\nprojection: perspective\ntwist: 900\n\
            contour sides: 24\nlight: V: 10 -10 5\ntapered lines: off\nz buffer: on\n\
            tropism: T: 0,-2,0 A: 30 I: 0.5 E: 0.2 S: 0.1\ntorque: T: 1,0,0 E: 0.4\n\
            box: x: 0,1 y: -2,3 z: 4,5\nscale factor: 0.95\n";
        let view = View::parse(text.as_bytes(), "plant.v", &nothing).unwrap();
        assert_eq!(view.warnings, []);
        let turtle = &view.turtle;
        assert_eq!((turtle.angle, turtle.color, turtle.color_step), (30.0, 3, 2));
        assert_eq!((turtle.width, turtle.width_step, turtle.tapered), (0.072, 0.5, false));
        assert_eq!((view.sides, view.camera.perspective, view.camera.twist), (24, true, 90.0));
        assert_eq!(turtle.movements.len(), 2);
        assert!(turtle.movements[0].direction.distance(Vec3::new(0.0, -0.5, 0.0)) < 1e-6);
        assert!(turtle.movements[1].twists && turtle.movements[1].elasticity == 0.4);
        assert_eq!(view.camera.volume.unwrap().1, Vec3::new(1.0, 3.0, 5.0));
    }

    #[test]
    fn what_is_not_known_is_a_warning_with_its_line() {
        let text = "angle factor: 12\nsparkle: on\nsurface: l leaf.s 2\n\nfunction: f.func 10\n";
        let view = View::parse(text.as_bytes(), "plant.v", &nothing).unwrap();
        let told: Vec<String> = view.warnings.iter().map(ToString::to_string).collect();
        assert!(told[0].starts_with("plant.v:2:1: unknown view command"), "{told:?}");
        assert!(told[1].starts_with("plant.v:3:1: cannot read leaf.s: no leaf.s"), "{told:?}");
        assert!(told[2].starts_with("plant.v:5:1: cannot read f.func"), "{told:?}");
    }
}
