//! Species of fish as data: outline, fins, colors and swimming, read from TOML text.
//!
//! Lengths in a file are shares of the whole length (snout to end of tail) unless a unit is named. A place
//! on the body is `[at, level]`: share of the length from the snout, and share of the girth from the
//! middle of the belly (0) over the flank (0.5) to the middle of the back (1). A point of a fin is `[at, y]` in
//! side view, y upward from the long axis.

use std::sync::{Arc, OnceLock};

use bioscope_core::{Error, Result};
use bioscope_minds::Nature;
use bioscope_motion::undulation::{Gait, Style};
use serde::{Deserialize, Serialize};

use super::color::Color;
use super::form::FishForm;

mod check;
mod library;

/// A place on the body `[at, level]`, or a point in side view `[at, y]`.
pub type Place = [f32; 2];

/// One species of fish.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FishSpecies {
    /// Short name, as worlds use it.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// Scientific name.
    #[serde(default)]
    pub scientific: String,
    /// Whole length of an average grown fish, metres.
    pub length: f32,
    /// Individuals differ in length by up to this share.
    #[serde(default = "tenth")]
    pub variation: f32,
    /// How finely it is built.
    #[serde(default)]
    pub detail: Detail,
    /// How it swims.
    pub swimming: Swimming,
    /// How it lives, if it has a mind that is not told otherwise.
    #[serde(default)]
    pub nature: Nature,
    /// Shape of the trunk.
    pub outline: Outline,
    /// The eyes.
    pub eye: Eye,
    /// The mouth, a line from the tip of the snout to its corner.
    pub mouth: Line,
    /// The tail fin, fanned out from the end of the trunk; sharks have the trunk run on into the tail instead.
    pub tail: Option<TailFin>,
    /// Unpaired fins on back and belly.
    #[serde(default)]
    pub fins: Vec<MidlineFin>,
    /// Paired fins, given for the left side.
    #[serde(default)]
    pub pairs: Vec<PairFin>,
    /// Skin.
    pub skin: Skin,
    /// Soft spots of color, painted in order.
    #[serde(default)]
    pub patches: Vec<Patch>,
    /// Upright bars.
    #[serde(default)]
    pub bars: Vec<Bar>,
    /// Lengthwise stripes.
    #[serde(default)]
    pub stripes: Vec<Line>,
    /// Scattered spots.
    #[serde(default)]
    pub spots: Vec<Spots>,
    /// Thin dark or light lines drawn on top: gill covers, lateral line.
    #[serde(default)]
    pub lines: Vec<Line>,
    #[serde(skip)]
    form: OnceLock<Arc<FishForm>>,
    #[serde(skip)]
    text: String,
}

/// How finely a fish is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Detail {
    /// One of a school: about 700 triangles near by.
    #[default]
    Plain,
    /// One to look at: about 2,500 triangles near by.
    Fine,
}

/// How a fish swims.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swimming {
    /// Growth of the wave along the body.
    pub style: Style,
    /// Waves on the body.
    #[serde(default = "one")]
    pub waves: f32,
    /// Speed of easy swimming, body lengths per second.
    pub cruise: f32,
    /// Speed of flight, body lengths per second.
    pub burst: f32,
}

/// The trunk as cross sections at stations from snout to the root of the tail.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outline {
    /// Stations, rising from 0.
    pub at: Vec<f32>,
    /// Height of the back above the long axis.
    pub back: Vec<f32>,
    /// Depth of the belly below the long axis.
    pub belly: Vec<f32>,
    /// Half the width.
    pub width: Vec<f32>,
    /// Exponent of the cross section: 2 is an ellipse, less is keeled, more is boxy.
    #[serde(default)]
    pub fullness: Vec<f32>,
    /// Height of the widest place, from 0 (belly) to 1 (back).
    #[serde(default)]
    pub widest: Vec<f32>,
}

/// An eye.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Eye {
    /// Where it sits.
    pub place: Place,
    /// Its radius.
    pub radius: f32,
    /// How far it stands out, as a share of the radius.
    #[serde(default = "third")]
    pub bulge: f32,
    /// Share of the radius that is pupil.
    #[serde(default = "half")]
    pub pupil: f32,
    /// Color of the ring round the pupil.
    pub iris: Color,
}

/// A line on the skin.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Places it runs through.
    pub path: Vec<Place>,
    /// Its width.
    pub width: f32,
    /// Its color.
    pub color: Color,
    /// How opaque it is.
    #[serde(default = "one")]
    pub strength: f32,
    /// Share of the width over which it fades.
    #[serde(default = "half")]
    pub softness: f32,
    /// How much it thins out towards its end, 0 to 1.
    #[serde(default)]
    pub taper: f32,
    /// How much the skin in front of it catches the light, as at the free edge of a gill cover, 0 to 1.
    #[serde(default)]
    pub relief: f32,
}

/// The tail fin.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TailFin {
    /// Its free edge from the upper tip to the lower one.
    pub edge: Vec<Place>,
    /// How it looks.
    pub look: FinLook,
}

/// A fin on the middle of back or belly.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MidlineFin {
    /// What it is called.
    pub name: String,
    /// Where it stands.
    pub on: Side,
    /// Where its base begins and ends.
    pub base: [f32; 2],
    /// Its free edge from the front tip to the rear end.
    pub edge: Vec<Place>,
    /// How it looks.
    pub look: FinLook,
}

/// The two sides of the midline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// On the back.
    Back,
    /// Under the belly.
    Belly,
}

/// A pair of fins.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairFin {
    /// What they are called.
    pub name: String,
    /// Front and rear end of the base, as places on the body.
    pub base: [Place; 2],
    /// Free edge of the fin laid flat against the flank, from the front tip to the rear end.
    pub edge: Vec<Place>,
    /// By how many degrees it stands off from the flank.
    pub flare: f32,
    /// By how many degrees it beats.
    #[serde(default)]
    pub swing: f32,
    /// Whether they row instead of flapping.
    #[serde(default)]
    pub rows: bool,
    /// How it looks.
    pub look: FinLook,
}

/// How a fin looks.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FinLook {
    /// Color at the base.
    pub color: Color,
    /// Color at the free edge; none for that of the base.
    pub outer: Option<Color>,
    /// Color of a seam along the free edge.
    pub seam: Option<Color>,
    /// Width of the seam.
    #[serde(default = "hundredth")]
    pub seam_width: f32,
    /// Number of rays.
    #[serde(default)]
    pub rays: u32,
    /// How much the rays stand out in color, 0 to 1.
    #[serde(default = "third")]
    pub contrast: f32,
    /// How deeply the free edge is frayed between the rays, 0 to 1.
    #[serde(default)]
    pub fray: f32,
    /// How far the rays curve forward, as a share of their length.
    #[serde(default)]
    pub bow: f32,
    /// Thickness at the base; 0 is a sheet.
    #[serde(default)]
    pub thickness: f32,
}

/// The skin: countershading, scales, sheen.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Color of the back.
    pub back: Color,
    /// Color of the flank.
    pub flank: Color,
    /// Color of the belly.
    pub belly: Color,
    /// Levels at which belly turns into flank and flank into back.
    pub levels: [f32; 2],
    /// Softness of these transitions, in levels.
    #[serde(default = "tenth")]
    pub softness: f32,
    /// Length of a scale; 0 for none.
    #[serde(default)]
    pub scale: f32,
    /// How much the scales stand out, 0 to 1.
    #[serde(default)]
    pub scaling: f32,
    /// Strength of irregular mottling, 0 to 1.
    #[serde(default)]
    pub mottle: f32,
    /// Mirror-like sheen of the scales, 0 (wet skin) to 1 (silver).
    #[serde(default)]
    pub sheen: f32,
    /// Play of hues on the flank, 0 to 1.
    #[serde(default)]
    pub iridescence: f32,
}

/// A soft spot of color.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Patch {
    /// Its middle.
    pub place: Place,
    /// Its half length and, in levels, half height.
    pub size: Place,
    /// Its color.
    pub color: Color,
    /// How opaque it is.
    #[serde(default = "one")]
    pub strength: f32,
    /// Share of the size over which it fades.
    #[serde(default = "half")]
    pub softness: f32,
}

/// Upright bars.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// The middle of each bar.
    pub at: Vec<f32>,
    /// Their width.
    pub width: f32,
    /// Lower and upper end, as levels.
    pub levels: [f32; 2],
    /// Their color.
    pub color: Color,
    /// How opaque they are.
    #[serde(default = "one")]
    pub strength: f32,
    /// Share of the width over which they fade.
    #[serde(default = "half")]
    pub softness: f32,
    /// How ragged they are, 0 to 1.
    #[serde(default)]
    pub ragged: f32,
}

/// Scattered spots.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spots {
    /// Where they begin and end, as shares of the length.
    pub along: [f32; 2],
    /// Lower and upper end, as levels.
    pub levels: [f32; 2],
    /// Mean distance between neighbors.
    pub spacing: f32,
    /// Radius of a spot as a share of the spacing.
    pub size: f32,
    /// Their color.
    pub color: Color,
    /// How opaque they are.
    #[serde(default = "one")]
    pub strength: f32,
}

fn hundredth() -> f32 {
    0.01
}
fn tenth() -> f32 {
    0.1
}
fn third() -> f32 {
    0.33
}
fn half() -> f32 {
    0.5
}
fn one() -> f32 {
    1.0
}

impl FishSpecies {
    /// The ready-made species of this name.
    pub fn named(name: &str) -> Result<Arc<Self>> {
        library::named(name)
    }

    /// The names of the ready-made species that are called so: one (`Butterfly fish`), or all of a family
    /// (`shark`); none if the name is of another kind of thing.
    pub fn meant(name: &str) -> Vec<&'static str> {
        library::meant(name)
    }

    /// The names of all ready-made species.
    pub fn names() -> Vec<&'static str> {
        library::names()
    }

    /// Reads a species; `file` is named in error messages.
    pub fn parse(text: &str, file: &str) -> Result<Self> {
        if text.len() > check::LONGEST_FILE {
            let limit = format!("{} bytes", check::LONGEST_FILE);
            return Err(Error::Limit { what: format!("{file}: size of the file"), limit });
        }
        let mut species: Self =
            toml::from_str(text).map_err(|error| located(&error, text, file))?;
        species.text = text.to_owned();
        check::check(&species, file)?;
        Ok(species)
    }

    /// The ready-made species of this name if it was read from this text, so that its form is built
    /// only once; else the species that the text describes.
    pub fn named_or_parsed(name: &str, text: &str) -> Result<Arc<Self>> {
        match Self::named(name) {
            Ok(species) if species.text() == text => Ok(species),
            _ => Ok(Arc::new(Self::parse(text, name)?)),
        }
    }

    /// The text it was read from: all that is needed to read it again.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Mesh, material and spine of an average individual; made once.
    pub fn form(&self) -> Arc<FishForm> {
        Arc::clone(self.form.get_or_init(|| Arc::new(FishForm::new(self))))
    }

    /// How it swims, as the spine needs it.
    pub fn gait(&self) -> Gait {
        let Swimming { style, waves, cruise, .. } = self.swimming;
        Gait { style, waves, cruise }
    }
}

/// A message with file, line and column.
/// Most characters of a line that an error repeats.
const LONGEST_QUOTE: usize = 60;

fn located(error: &toml::de::Error, text: &str, file: &str) -> Error {
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = &text.as_bytes()[..start];
    let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
    let column = 1 + before.iter().rev().take_while(|&&byte| byte != b'\n').count();
    let found = text.lines().nth(line - 1).unwrap_or_default().trim();
    let found: String = found.chars().take(LONGEST_QUOTE).collect();
    Error::format(format!("{file}:{line}:{column}"), format!("{} in `{found}`", error.message()))
}

#[cfg(test)]
mod tests;
