//! The trunk of a fish as a smooth surface through its stations, in body lengths.

use std::f32::consts::PI;

use bioscope_core::Vec3;
use bioscope_motion::undulation::ORIGIN;

use super::species::{Outline, Place};

/// A monotone cubic through knots (Fritsch & Carlson 1980): it never swings beyond its knots. The
/// abscissa is the square root of the place, so that a blunt snout is round.
#[derive(Clone, Debug)]
struct Curve {
    knots: Vec<[f32; 2]>,
    slopes: Vec<f32>,
}

impl Curve {
    fn new(at: &[f32], values: &[f32]) -> Self {
        let knots: Vec<[f32; 2]> =
            at.iter().zip(values).map(|(at, value)| [at.sqrt(), *value]).collect();
        let secants: Vec<f32> =
            knots.windows(2).map(|two| (two[1][1] - two[0][1]) / (two[1][0] - two[0][0])).collect();
        let last = secants.len() - 1;
        let slopes = (0..knots.len()).map(|knot| match knot {
            0 => secants[0],
            knot if knot > last => secants[last],
            knot if secants[knot - 1] * secants[knot] <= 0.0 => 0.0,
            knot => {
                let (before, after) = (secants[knot - 1], secants[knot]);
                2.0 * before * after / (before + after)
            }
        });
        Self { slopes: slopes.collect(), knots }
    }

    fn constant(value: f32) -> Self {
        Self { knots: vec![[0.0, value], [1.0, value]], slopes: vec![0.0; 2] }
    }

    fn sample(&self, at: f32) -> f32 {
        let last = self.knots.len() - 1;
        let x = at.max(0.0).sqrt().min(self.knots[last][0]);
        let segment = self.knots[1..last].iter().filter(|knot| knot[0] <= x).count();
        let ([x0, y0], [x1, y1]) = (self.knots[segment], self.knots[segment + 1]);
        let width = x1 - x0;
        let t = (x - x0) / width;
        let (m0, m1) = (self.slopes[segment] * width, self.slopes[segment + 1] * width);
        let (t2, t3) = (t * t, t * t * t);
        y0 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + m0 * (t3 - 2.0 * t2 + t)
            + y1 * (3.0 * t2 - 2.0 * t3)
            + m1 * (t3 - t2)
    }
}

/// The surface of the trunk.
#[derive(Clone, Debug)]
pub struct Trunk {
    /// Where it ends, as a share of the length.
    pub end: f32,
    back: Curve,
    belly: Curve,
    width: Curve,
    fullness: Curve,
    widest: Curve,
}

impl Trunk {
    /// The surface through the stations of an outline.
    pub fn new(outline: &Outline) -> Self {
        let curve = |values: &[f32], missing: f32| {
            if values.is_empty() {
                Curve::constant(missing)
            } else {
                Curve::new(&outline.at, values)
            }
        };
        Self {
            end: outline.at[outline.at.len() - 1],
            back: curve(&outline.back, 0.0),
            belly: curve(&outline.belly, 0.0),
            width: curve(&outline.width, 0.0),
            fullness: curve(&outline.fullness, 2.0),
            widest: curve(&outline.widest, 0.5),
        }
    }

    /// Height of the back.
    pub fn top(&self, at: f32) -> f32 {
        self.back.sample(at)
    }

    /// Height of the belly (below the axis it is negative).
    pub fn bottom(&self, at: f32) -> f32 {
        -self.belly.sample(at)
    }

    /// Area of the cross section, but for a factor.
    pub fn area(&self, at: f32) -> f32 {
        self.width.sample(at) * (self.top(at) - self.bottom(at))
    }

    /// The point of the left side at a place; the snout looks along +Z, the origin is that of the spine.
    pub fn point(&self, [at, level]: Place) -> Vec3 {
        let at = at.clamp(0.0, self.end);
        let angle = PI * (1.0 - level);
        let power = 2.0 / self.fullness.sample(at);
        let aside = angle.sin().max(0.0).powf(power);
        let above = angle.cos().abs().powf(power).copysign(angle.cos());
        let (top, bottom) = (self.top(at), self.bottom(at));
        let middle = bottom + (top - bottom) * self.widest.sample(at);
        let reach = if above > 0.0 { top - middle } else { middle - bottom };
        Vec3::new(self.width.sample(at) * aside, middle + reach * above, ORIGIN - at)
    }

    /// Body lengths along the skin per level at a place.
    pub fn girth(&self, [at, level]: Place) -> f32 {
        const STEP: f32 = 0.02;
        let ends =
            [level - STEP, level + STEP].map(|level| self.point([at, level.clamp(0.0, 1.0)]));
        (ends[0].distance(ends[1]) / (2.0 * STEP)).max(1e-4)
    }

    /// The outward normal of the left side at a place, and the direction up along the skin.
    pub fn frame(&self, [at, level]: Place) -> (Vec3, Vec3) {
        const STEP: f32 = 0.004;
        let at = at.clamp(STEP, self.end - STEP);
        let level = level.clamp(STEP, 1.0 - STEP);
        let back = self.point([at + STEP, level]) - self.point([at - STEP, level]);
        let up = self.point([at, level + STEP]) - self.point([at, level - STEP]);
        let normal = back.cross(up).normalize_or(Vec3::X);
        (normal, up.normalize_or(Vec3::Y))
    }
}
