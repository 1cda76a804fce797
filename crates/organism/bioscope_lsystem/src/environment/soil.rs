//! Water in the soil, which roots drink and which spreads.

use bioscope_core::{Error, Vec3, state};
use glam::DVec3;

use super::settings::{Settings, bounded};
use super::{Amounts, Environment, EnvironmentError, Reply, Request};

/// Most cells of a field.
const MOST: usize = 64 << 20;
/// Most diffusion steps of one exchange.
const STEPS: f64 = 10_000.0;

/// Amounts of water in the cells of a box, flat (one layer) or deep; obstacles hold none and let none through.
///
/// A root tip asks `?E(c,s)` for the amount c: it gets what its cell has, at most that much, and
/// in s the angle (degrees, to the left) from its heading to T = H + s·∇C, where ∇C is the
/// gradient of the amounts per cell. In a deep field `?E(c,s,t)` gets the amount, the roll about
/// H that brings its left into the plane of H and T, and the angle. Tips are served in the order of the
/// string; then water flows between neighboring cells.
///
/// Source: R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, section 4.3.
#[derive(Clone, Debug)]
pub struct SoilWater {
    cells: [usize; 3],
    low: Vec3,
    cell: f32,
    water: Vec<f64>,
    /// Cells that hold no water and let none through.
    blocked: Vec<bool>,
    /// Cells that keep their amount.
    source: Vec<bool>,
    /// Share of a difference that flows to a neighbor in one step of the model.
    diffusion: f64,
    next: Vec<f64>,
    answer: Answer,
}

/// What tips are told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    Angles,
    /// cpfg's soil: the amount, then the gradient.
    Vector {
        depletes: bool,
    },
}

impl SoilWater {
    /// A field of this many cells around the origin, all with this amount.
    pub fn new(cells: [usize; 3], cell: f32, amount: f64, diffusion: f64) -> Self {
        let count = cells.iter().product();
        let size = cells.map(|count| count as f32 * cell);
        Self {
            cells,
            low: Vec3::from_array(size) / -2.0,
            cell,
            water: vec![amount; count],
            blocked: vec![false; count],
            source: vec![false; count],
            diffusion,
            next: Vec::new(),
            answer: Answer::Angles,
        }
    }

    /// The built-in process `soil_water D=0.1 cell=1 size=64 amount=1`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "soil_water";
        settings.check(
            NAME,
            &["D", "diffusion", "cell", "size", "amount", "low", "obstacle", "source"],
        )?;
        let cell = bounded(NAME, "cell", settings.number(&["cell"], 1.0), (1e-6, 1e6))?;
        let diffusion = settings.number(&["D", "diffusion"], 0.1);
        let diffusion = f64::from(bounded(NAME, "D", diffusion, (0.0, 1e3))?);
        let amount = bounded(NAME, "amount", settings.number(&["amount"], 1.0), (0.0, 1e9))?;
        let cells = match settings.numbers(&["size"])[..] {
            [x, y, z, ..] => [x, y, z],
            [x, y] => [x, y, 1.0],
            [both] => [both, both, 1.0],
            [] => [64.0, 64.0, 1.0],
        };
        let mut counts = [1; 3];
        for (count, wanted) in counts.iter_mut().zip(cells) {
            *count = bounded(NAME, "size", wanted, (1.0, 65_536.0))? as usize;
        }
        let fits = counts[0].checked_mul(counts[1]).and_then(|n| n.checked_mul(counts[2]));
        if fits.is_none_or(|count| count > MOST) {
            return Err(refused(NAME, format!("size: at most {MOST} cells")));
        }
        let area = f64::from(cell) * f64::from(cell);
        let mut soil = Self::new(counts, cell, f64::from(amount), diffusion / area);
        if let [x, y, z, ..] = settings.numbers(&["low"])[..] {
            soil.low = Vec3::new(x, y, z);
        }
        for text in settings.all("obstacle") {
            if let [a, b, c, d, e, f] = crate::files::numbers(text)[..] {
                soil.block(Vec3::new(a, b, c), Vec3::new(d, e, f));
            }
        }
        for text in settings.all("source") {
            if let [a, b, c, d, e, f, amount] = crate::files::numbers(text)[..] {
                soil.feed(Vec3::new(a, b, c), Vec3::new(d, e, f), f64::from(amount));
            }
        }
        Ok(soil)
    }

    /// The field program soil, with its field as an array.
    pub fn soil(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "soil";
        settings.check(
            NAME,
            &[
                "domain size",
                "position",
                "array",
                "image",
                "layer thicknesses",
                "geotropic angles",
                "3D primitives",
                "diffusion",
                "depletion",
                "relaxation factor",
                "keep depleted cells",
                "obstacles and sources",
                "frame intervals",
                "output normals",
                "3D output",
                "concentration contour value",
                "contour material",
                "source material",
                "section material",
            ],
        )?;
        let given = settings.numbers(&["array"]);
        let [x, y, z, low, high, ref values @ ..] = given[..] else {
            return Err(refused(NAME, "expected 'array: x y z min max' and as many values".into()));
        };
        let cells = [x, y, z].map(|count| count.clamp(1.0, 4096.0) as usize);
        let count: usize = cells.iter().product();
        if count > MOST || values.len() != count {
            return Err(refused(NAME, format!("array: {} values for {count} cells", values.len())));
        }
        let size = settings.numbers(&["domain size"]);
        let cell = size.first().map_or(1.0, |size| size / cells[0] as f32).abs().max(1e-6);
        let factor = settings.number(&["relaxation factor"], 1.0).clamp(0.0, 1.9);
        let steps = settings.number(&["diffusion"], 1.0).clamp(0.0, 1000.0);
        let mut soil = Self::new(cells, cell, 0.0, f64::from(factor * steps) / 6.0);
        if let [x, y, z, ..] = settings.numbers(&["position"])[..] {
            soil.low = Vec3::new(x, y, z);
        }
        soil.water = values.iter().map(|&value| f64::from(value)).collect();
        if settings.switch(&["obstacles and sources"], false) {
            soil.blocked = values.iter().map(|&value| value == low).collect();
            soil.source = values.iter().map(|&value| value == high).collect();
        }
        soil.answer = Answer::Vector { depletes: settings.switch(&["depletion"], false) };
        Ok(soil)
    }

    /// Gives a cell an amount.
    pub fn set(&mut self, cell: [usize; 3], amount: f64) {
        let index = self.index(cell);
        if let Some(water) = self.water.get_mut(index) {
            *water = amount;
        }
    }

    /// Amounts by cell: x runs first, then y, then z.
    pub fn water(&self) -> &[f64] {
        &self.water
    }

    /// Number of cells in x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.cells
    }

    /// Makes the cells between two corners an obstacle.
    pub fn block(&mut self, low: Vec3, high: Vec3) {
        self.each_between(low, high, |soil, index| {
            soil.blocked[index] = true;
            soil.water[index] = 0.0;
        });
    }

    /// Makes the cells between two corners keep this amount.
    pub fn feed(&mut self, low: Vec3, high: Vec3, amount: f64) {
        self.each_between(low, high, |soil, index| {
            soil.source[index] = true;
            soil.water[index] = amount;
        });
    }

    fn each_between(&mut self, low: Vec3, high: Vec3, mut change: impl FnMut(&mut Self, usize)) {
        for index in 0..self.water.len() {
            let cell = [
                index % self.cells[0],
                index / self.cells[0] % self.cells[1],
                index / (self.cells[0] * self.cells[1]),
            ];
            let middle = Vec3::from_array(cell.map(|one| one as f32 + 0.5)) * self.cell + self.low;
            let flat = self.cells[2] == 1;
            let inside = |axis: usize| {
                (flat && axis == 2) || (low[axis]..=high[axis]).contains(&middle[axis])
            };
            if (0..3).all(inside) {
                change(self, index);
            }
        }
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    fn cell_at(&self, place: Vec3) -> Option<[usize; 3]> {
        let mut cell = [0; 3];
        for axis in 0..3 {
            if axis == 2 && self.cells[2] == 1 {
                continue;
            }
            let part = (place[axis] - self.low[axis]) / self.cell;
            if !(part >= 0.0 && part < self.cells[axis] as f32) {
                return None;
            }
            cell[axis] = part as usize;
        }
        Some(cell)
    }

    /// Amount per cell in each direction, one-sided at borders and obstacles.
    fn gradient(&self, cell: [usize; 3]) -> DVec3 {
        let own = self.water[self.index(cell)];
        let mut gradient = DVec3::ZERO;
        for axis in 0..3 {
            let at = |step: i64| {
                let moved = usize::try_from(cell[axis] as i64 + step).ok()?;
                let mut other = cell;
                other[axis] = moved;
                let inside = moved < self.cells[axis];
                let index = inside.then(|| self.index(other))?;
                (!self.blocked[index]).then(|| self.water[index])
            };
            gradient[axis] = match (at(-1), at(1)) {
                (Some(before), Some(after)) => (after - before) / 2.0,
                (Some(before), None) => own - before,
                (None, Some(after)) => after - own,
                (None, None) => 0.0,
            };
        }
        gradient
    }

    fn drink(&mut self, request: &Request, reply: &mut Reply) {
        let Some(&wanted) = request.parameters.first() else { return };
        let Some(cell) = self.cell_at(request.position) else {
            reply.parameters[0] = 0.0;
            return;
        };
        let index = self.index(cell);
        let wanted = f64::from(wanted).max(0.0);
        let granted = wanted.min(self.water[index]);
        let depletes = self.answer != Answer::Vector { depletes: false };
        if depletes && !self.source[index] {
            self.water[index] -= granted;
        }
        let gradient = self.gradient(cell);
        reply.parameters[0] = granted as f32;
        if let Answer::Vector { .. } = self.answer {
            for (own, part) in reply.parameters.iter_mut().skip(1).take(3).zip(gradient.to_array())
            {
                *own = part as f32;
            }
            return;
        }
        let (heading, left) = (request.heading.as_dvec3(), request.left.as_dvec3());
        let up = heading.cross(left);
        let sensitivity = f64::from(request.parameters.get(1).copied().unwrap_or(0.0));
        let wanted = heading + gradient * sensitivity;
        let (ahead, aside, above) = (wanted.dot(heading), wanted.dot(left), wanted.dot(up));
        match &mut *reply.parameters {
            [_, roll, angle, ..] => {
                let across = aside.hypot(above);
                // Rolling left by r takes L to L cos r − U sin r.
                *roll = -libm::atan2(above, aside).to_degrees() as f32;
                *angle = libm::atan2(across, ahead).to_degrees() as f32;
            }
            [_, angle] => *angle = libm::atan2(aside, ahead).to_degrees() as f32,
            _ => {}
        }
    }

    /// Lets water flow for one step of the model, in as many parts as keep it stable.
    fn flow(&mut self) {
        let deep = self.cells.iter().filter(|&&count| count > 1).count().max(1);
        let stable = 1.0 / (2.0 * deep as f64);
        let parts = (self.diffusion / stable).ceil().clamp(0.0, STEPS);
        if parts < 1.0 {
            return;
        }
        let share = (self.diffusion / parts).min(stable);
        for _ in 0..parts as usize {
            self.spread(share);
        }
    }

    /// Moves this share of the difference between neighbors.
    fn spread(&mut self, share: f64) {
        self.next.clone_from(&self.water);
        let strides = [1, self.cells[0], self.cells[0] * self.cells[1]];
        for (stride, count) in strides.into_iter().zip(self.cells) {
            if count < 2 {
                continue;
            }
            for index in 0..self.water.len() - stride {
                let place = index / stride % count;
                let other = index + stride;
                if place + 1 == count || self.blocked[index] || self.blocked[other] {
                    continue;
                }
                let flow = share * (self.water[index] - self.water[other]);
                self.next[index] -= flow;
                self.next[other] += flow;
            }
        }
        for (index, next) in self.next.iter().enumerate() {
            if !self.source[index] {
                self.water[index] = *next;
            }
        }
    }
}

impl Environment for SoilWater {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        for (request, reply) in requests.iter().zip(replies) {
            self.drink(request, reply);
        }
        self.flow();
        Ok(())
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        Ok(state::to_bytes(&self.water))
    }

    fn amounts(&self) -> Option<Amounts> {
        let values = self.water.iter().map(|&amount| amount as f32).collect();
        Some(Amounts { cells: self.cells, low: self.low, cell: self.cell, values })
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        let water: Vec<f64> = state::from_bytes("water in the soil", memory)?;
        if water.len() != self.water.len() {
            let what = format!("{} cells, not {}", water.len(), self.water.len());
            return Err(Error::format("water in the soil", what));
        }
        self.water = water;
        Ok(())
    }
}

fn refused(name: &str, reason: String) -> EnvironmentError {
    EnvironmentError::Refused { name: name.into(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ask;

    #[test]
    fn no_water_is_lost() {
        for cells in [[20, 30, 1], [9, 11, 7]] {
            let mut soil = SoilWater::new(cells, 1.0, 1.0, 0.1);
            soil.block(Vec3::new(-3.0, -5.0, -9.0), Vec3::new(-1.0, -3.0, 9.0));
            let start: f64 = soil.water().iter().sum();
            let mut drunk = 0.0;
            for step in 0..50 {
                let place = Vec3::new(0.5, -1.5 - 0.1 * step as f32, 0.0);
                let wanted = [0.3_f32, 10.0];
                let answers =
                    ask(&mut soil, &[(&wanted, place, Vec3::NEG_Y), (&wanted, place, Vec3::X)]);
                drunk += f64::from(answers[0][0]) + f64::from(answers[1][0]);
            }
            let rest: f64 = soil.water().iter().sum();
            // Answers are single precision, the field is double.
            assert!((start - rest - drunk).abs() < 1e-5, "{start} {rest} {drunk}");
            let before: f64 = soil.water().iter().sum();
            (0..100).for_each(|_| soil.flow());
            let after: f64 = soil.water().iter().sum();
            assert!((before - after).abs() < 1e-9, "{before} {after}");
        }
    }

    #[test]
    fn tips_turn_to_the_water() {
        let mut soil = SoilWater::new([20, 20, 1], 1.0, 0.0, 0.0);
        for y in 0..20 {
            for x in 0..20 {
                soil.set([x, y, 0], x as f64);
            }
        }
        // More water to the right (+x) of a tip that goes down: its left is +x there.
        let place = Vec3::new(0.5, -5.0, 0.0);
        let answers = ask(&mut soil, &[(&[0.1, 1.0], place, Vec3::NEG_Y)]);
        assert!((answers[0][0] - 0.1).abs() < 1e-6);
        assert!((answers[0][1] - 45.0).abs() < 3.0, "{:?}", answers[0]);
        let none = ask(&mut soil, &[(&[0.1, 1.0], Vec3::Y * 50.0, Vec3::NEG_Y)]);
        assert_eq!(none[0][0], 0.0, "outside the field there is no water");
    }

    #[test]
    fn in_space_roll_and_angle_lead_to_the_gradient() {
        let mut soil = SoilWater::new([10, 10, 10], 1.0, 0.0, 0.0);
        for index in 0..1000 {
            soil.set([index % 10, index / 10 % 10, index / 100], (index / 100) as f64);
        }
        let [answer] =
            &ask(&mut soil, &[(&[0.0, 5.0, 0.0], Vec3::new(0., -5., 0.), Vec3::NEG_Y)])[..]
        else {
            panic!("one answer to one question")
        };
        // Follow the answer with the turtle's own turns.
        let (heading, left, up) = crate::environment::frame(Vec3::NEG_Y);
        let (roll, angle) = (answer[1].to_radians(), answer[2].to_radians());
        let left = left * roll.cos() - up * roll.sin();
        let turned = heading * angle.cos() + left * angle.sin();
        assert!(turned.z > 0.95, "{turned} does not go towards +z");
    }
}
