//! What a species must be to be built: every number finite and in its range.

use bioscope_core::{Error, Result};
use bioscope_minds::Nature;

use super::{Eye, FinLook, FishSpecies, Line, Outline, Place, Skin};

/// Greatest size of a species file in bytes.
pub const LONGEST_FILE: usize = 64 * 1024;
/// Greatest number of fins, lines, patches, … and of points in one of them.
const MOST: usize = 64;

const SHARE: [f32; 2] = [0.0, 1.0];
/// Where points of fins may lie, along the body and across.
const ALONG: [f32; 2] = [-0.2, 1.3];
const ACROSS: [f32; 2] = [-0.8, 0.8];

/// Checks every field; the first fault is told with file, field and value.
pub fn check(species: &FishSpecies, file: &str) -> Result<()> {
    let checker = Checker { place: format!("{file}: ") };
    checker.name("name", &species.name)?;
    checker.number("length", species.length, [0.005, 20.0])?;
    checker.number("variation", species.variation, [0.0, 0.5])?;
    let swimming = &species.swimming;
    checker.number("swimming.waves", swimming.waves, [0.3, 3.0])?;
    checker.number("swimming.cruise", swimming.cruise, [0.05, 10.0])?;
    checker.number("swimming.burst", swimming.burst, [swimming.cruise, 40.0])?;
    checker.nature(&species.nature)?;
    checker.outline(&species.outline)?;
    checker.eye(&species.eye)?;
    checker.line("mouth", &species.mouth)?;
    checker.skin(&species.skin)?;
    checker.fins(species)?;
    checker.pattern(species)
}

struct Checker {
    place: String,
}

impl Checker {
    fn fault(&self, field: &str, value: impl ToString, expected: impl Into<String>) -> Error {
        Error::value(format!("{}{field}", self.place), value, expected)
    }

    fn number(&self, field: &str, value: f32, [low, high]: [f32; 2]) -> Result<()> {
        // Not a number fails this too.
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(self.fault(field, value, format!("a number from {low} to {high}")))
    }

    fn name(&self, field: &str, value: &str) -> Result<()> {
        let proper = |one: char| one.is_ascii_lowercase() || one.is_ascii_digit() || one == '_';
        if !value.is_empty() && value.len() <= MOST && value.chars().all(proper) {
            return Ok(());
        }
        Err(self.fault(field, format!("'{value}'"), "small letters, digits and underscores"))
    }

    fn count(&self, field: &str, count: usize, least: usize) -> Result<()> {
        if (least..=MOST).contains(&count) {
            return Ok(());
        }
        Err(self.fault(field, format!("{count} entries"), format!("{least} to {MOST} entries")))
    }

    fn numbers(&self, field: &str, values: &[f32], range: [f32; 2]) -> Result<()> {
        values
            .iter()
            .enumerate()
            .try_for_each(|(index, &value)| self.number(&format!("{field}[{index}]"), value, range))
    }

    fn points(&self, field: &str, points: &[Place], ranges: [[f32; 2]; 2]) -> Result<()> {
        points.iter().enumerate().try_for_each(|(index, point)| {
            self.number(&format!("{field}[{index}][0]"), point[0], ranges[0])?;
            self.number(&format!("{field}[{index}][1]"), point[1], ranges[1])
        })
    }

    fn rising(&self, field: &str, values: &[f32]) -> Result<()> {
        match values.windows(2).position(|two| two[1] - two[0] < 1e-4) {
            None => Ok(()),
            Some(index) => {
                let expected = format!("more than {} before it", values[index]);
                Err(self.fault(&format!("{field}[{}]", index + 1), values[index + 1], expected))
            }
        }
    }

    fn nature(&self, nature: &Nature) -> Result<()> {
        let Nature { enemies, food, leaders, species, .. } = nature;
        if !species.is_empty() {
            return Err(self.fault("nature.species", species, "nothing: `name` says it"));
        }
        [("enemies", enemies), ("food", food), ("leaders", leaders)].into_iter().try_for_each(
            |(list, names)| {
                self.count(&format!("nature.{list}"), names.len(), 0)?;
                let mut names = names.iter().enumerate();
                names.try_for_each(|(index, name)| {
                    self.name(&format!("nature.{list}[{index}]"), name)
                })
            },
        )
    }

    fn outline(&self, outline: &Outline) -> Result<()> {
        let stations = outline.at.len();
        self.count("outline.at", stations, 3)?;
        self.numbers("outline.at", &outline.at, SHARE)?;
        self.rising("outline.at", &outline.at)?;
        if outline.at[0] != 0.0 {
            return Err(self.fault("outline.at[0]", outline.at[0], "0, the tip of the snout"));
        }
        self.number("outline.at (the last)", outline.at[stations - 1], [0.5, 1.0])?;
        let rows = [
            ("back", &outline.back, [-0.5, 0.5], true),
            ("belly", &outline.belly, [-0.5, 0.5], true),
            ("width", &outline.width, [0.0005, 0.5], true),
            ("fullness", &outline.fullness, [1.2, 5.0], false),
            ("widest", &outline.widest, [0.15, 0.85], false),
        ];
        for (row, values, range, needed) in rows {
            let field = format!("outline.{row}");
            if (needed || !values.is_empty()) && values.len() != stations {
                let found = format!("{} numbers", values.len());
                return Err(self.fault(&field, found, format!("{stations}, as in outline.at")));
            }
            self.numbers(&field, values, range)?;
        }
        for (index, (back, belly)) in outline.back.iter().zip(&outline.belly).enumerate() {
            if back + belly < 0.001 {
                let field = format!("outline.back[{index}] + outline.belly[{index}]");
                return Err(self.fault(&field, back + belly, "a height of 0.001 or more"));
            }
        }
        Ok(())
    }

    fn eye(&self, eye: &Eye) -> Result<()> {
        self.number("eye.place[0]", eye.place[0], [0.005, 0.4])?;
        self.number("eye.place[1]", eye.place[1], SHARE)?;
        self.number("eye.radius", eye.radius, [0.001, 0.1])?;
        self.number("eye.bulge", eye.bulge, SHARE)?;
        self.number("eye.pupil", eye.pupil, [0.1, 0.95])
    }

    fn skin(&self, skin: &Skin) -> Result<()> {
        self.numbers("skin.levels", &skin.levels, SHARE)?;
        self.rising("skin.levels", &skin.levels)?;
        self.number("skin.softness", skin.softness, [0.005, 1.0])?;
        self.number("skin.scale", skin.scale, [0.0, 0.2])?;
        self.number("skin.scaling", skin.scaling, SHARE)?;
        self.number("skin.mottle", skin.mottle, SHARE)?;
        self.number("skin.sheen", skin.sheen, SHARE)?;
        self.number("skin.iridescence", skin.iridescence, SHARE)
    }

    fn fins(&self, species: &FishSpecies) -> Result<()> {
        let end = species.outline.at[species.outline.at.len() - 1];
        self.number(
            "fins and pairs (their count)",
            (species.fins.len() + species.pairs.len()) as f32,
            [0.0, 15.0],
        )?;
        if let Some(tail) = &species.tail {
            self.edge("tail", &tail.edge)?;
            self.look("tail", &tail.look)?;
        }
        for (index, fin) in species.fins.iter().enumerate() {
            let field = format!("fins[{index}]");
            self.name(&format!("{field}.name"), &fin.name)?;
            self.numbers(&format!("{field}.base"), &fin.base, [0.0, end])?;
            self.rising(&format!("{field}.base"), &fin.base)?;
            self.edge(&field, &fin.edge)?;
            self.look(&field, &fin.look)?;
        }
        for (index, pair) in species.pairs.iter().enumerate() {
            let field = format!("pairs[{index}]");
            self.name(&format!("{field}.name"), &pair.name)?;
            self.points(&format!("{field}.base"), &pair.base, [[0.0, end], SHARE])?;
            self.number(&format!("{field}.flare"), pair.flare, [-10.0, 100.0])?;
            self.number(&format!("{field}.swing"), pair.swing, [0.0, 90.0])?;
            self.edge(&field, &pair.edge)?;
            self.look(&field, &pair.look)?;
        }
        Ok(())
    }

    fn edge(&self, fin: &str, edge: &[Place]) -> Result<()> {
        let field = format!("{fin}.edge");
        self.count(&field, edge.len(), 2)?;
        self.points(&field, edge, [ALONG, ACROSS])
    }

    fn look(&self, fin: &str, look: &FinLook) -> Result<()> {
        let field = |name: &str| format!("{fin}.look.{name}");
        self.number(&field("seam_width"), look.seam_width, SHARE)?;
        self.number(&field("rays"), look.rays as f32, [0.0, 60.0])?;
        self.number(&field("contrast"), look.contrast, SHARE)?;
        self.number(&field("fray"), look.fray, SHARE)?;
        self.number(&field("bow"), look.bow, [-0.5, 0.5])?;
        self.number(&field("thickness"), look.thickness, [0.0, 0.1])
    }

    fn line(&self, field: &str, line: &Line) -> Result<()> {
        self.count(&format!("{field}.path"), line.path.len(), 2)?;
        self.points(&format!("{field}.path"), &line.path, [SHARE, SHARE])?;
        self.number(&format!("{field}.width"), line.width, [0.0005, 0.5])?;
        self.number(&format!("{field}.strength"), line.strength, SHARE)?;
        self.number(&format!("{field}.softness"), line.softness, SHARE)?;
        self.number(&format!("{field}.taper"), line.taper, SHARE)?;
        self.number(&format!("{field}.relief"), line.relief, SHARE)
    }

    fn pattern(&self, species: &FishSpecies) -> Result<()> {
        let counts = [
            ("patches", species.patches.len()),
            ("bars", species.bars.len()),
            ("stripes", species.stripes.len()),
            ("spots", species.spots.len()),
            ("lines", species.lines.len()),
        ];
        counts.iter().try_for_each(|(field, count)| self.count(field, *count, 0))?;
        for (index, patch) in species.patches.iter().enumerate() {
            let field = |name: &str| format!("patches[{index}].{name}");
            self.numbers(&field("place"), &patch.place, SHARE)?;
            self.numbers(&field("size"), &patch.size, [0.002, 2.0])?;
            self.number(&field("strength"), patch.strength, SHARE)?;
            self.number(&field("softness"), patch.softness, SHARE)?;
        }
        for (index, bar) in species.bars.iter().enumerate() {
            let field = |name: &str| format!("bars[{index}].{name}");
            self.count(&field("at"), bar.at.len(), 1)?;
            self.numbers(&field("at"), &bar.at, SHARE)?;
            self.number(&field("width"), bar.width, [0.001, 0.5])?;
            self.numbers(&field("levels"), &bar.levels, SHARE)?;
            self.number(&field("strength"), bar.strength, SHARE)?;
            self.number(&field("softness"), bar.softness, SHARE)?;
            self.number(&field("ragged"), bar.ragged, SHARE)?;
        }
        for (index, spots) in species.spots.iter().enumerate() {
            let field = |name: &str| format!("spots[{index}].{name}");
            self.numbers(&field("along"), &spots.along, SHARE)?;
            self.numbers(&field("levels"), &spots.levels, SHARE)?;
            self.number(&field("spacing"), spots.spacing, [0.003, 0.5])?;
            self.number(&field("size"), spots.size, [0.01, 0.6])?;
            self.number(&field("strength"), spots.strength, SHARE)?;
        }
        for (kind, lines) in [("stripes", &species.stripes), ("lines", &species.lines)] {
            for (index, line) in lines.iter().enumerate() {
                self.line(&format!("{kind}[{index}]"), line)?;
            }
        }
        Ok(())
    }
}
