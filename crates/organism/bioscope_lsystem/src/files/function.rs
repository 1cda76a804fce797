use super::text::{Line, Text, number, numbers};
use crate::Diagnostics;

/// Most control points of a function, and most of its samples.
const POINTS: usize = 10_000;

/// A function of one variable from 0 to 1: a B-spline over control points, in a .func file.
///
/// Outside 0 to 1 it has the values of its ends. As in cpfg it is tabulated at `samples` places
/// and linear between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: String,
    points: Vec<[f64; 2]>,
    samples: Vec<f64>,
}

impl Function {
    /// Reads a .func file (`fver 1 1`, or `range:` of older ones; `samples` counts for those).
    pub fn parse(bytes: &[u8], file: &str, samples: usize) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let lines: Vec<Line> = text.lines().collect();
        Ok(Self::read(&text, &mut lines.iter(), samples)?.0)
    }

    /// Reads the functions of a function set (`funcgalleryver 1 1`).
    pub fn parse_set(bytes: &[u8], file: &str) -> Result<Vec<Self>, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let lines: Vec<Line> = text.lines().collect();
        let mut rest = lines.iter();
        let head = rest.next().ok_or_else(|| text.ends("'funcgalleryver 1 1'"))?;
        if !head.text.trim().starts_with("funcgalleryver") {
            return Err(text.error(head, "expected 'funcgalleryver 1 1'"));
        }
        let count = rest.next().ok_or_else(|| text.ends("'items: n'"))?;
        let items = count.command().and_then(|(_, rest)| rest.parse::<usize>().ok());
        let items = items.ok_or_else(|| text.error(count, "expected 'items: n'"))?;
        let mut functions = Vec::new();
        for _ in 0..items.min(POINTS) {
            functions.push(Self::read(&text, &mut rest, 0)?.0);
        }
        Ok(functions)
    }

    fn read<'a>(
        text: &Text,
        lines: &mut impl Iterator<Item = &'a Line>,
        samples: usize,
    ) -> Result<(Self, usize), Diagnostics> {
        let (mut name, mut samples) = (String::new(), samples);
        let count = loop {
            let line = lines.next().ok_or_else(|| text.ends("'points: n'"))?;
            match line.command() {
                Some(("name", given)) => name = given.to_string(),
                Some(("samples", given)) => samples = given.parse().unwrap_or(samples),
                Some(("points", given)) => {
                    let count = given.split_whitespace().next().and_then(|n| n.parse().ok());
                    break count
                        .filter(|count| (4..=POINTS).contains(count))
                        .ok_or_else(|| text.error(line, "expected at least 4 points"))?;
                }
                // Versions, ranges, markers, backgrounds and what is shown flipped.
                _ => {}
            }
        };
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let line = lines.next().ok_or_else(|| text.ends("a control point"))?;
            let [x, y, rest @ ..] = &numbers(&line.text)[..] else {
                return Err(text.error(line, "expected x and y of a control point"));
            };
            let times = rest.first().map_or(1, |&times| times.clamp(0.0, 16.0) as usize);
            points.extend(std::iter::repeat_n([f64::from(*x), f64::from(*y)], times));
        }
        if points.len() < 4 {
            return Err(text.ends("at least 4 control points"));
        }
        let mut function = Self { name, points, samples: Vec::new() };
        if samples > 2 {
            let last = samples.min(POINTS) - 1;
            let at = |index: usize| function.search(index as f64 / last as f64);
            function.samples = (0..=last).map(at).collect();
        }
        Ok((function, count))
    }

    /// Its value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        let x = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
        if self.samples.is_empty() {
            return self.search(x);
        }
        let place = x * (self.samples.len() - 1) as f64;
        let index = place.floor() as usize;
        let share = place - index as f64;
        match self.samples.get(index + 1) {
            Some(next) => (1.0 - share) * self.samples[index] + share * next,
            None => self.samples[index],
        }
    }

    /// The height of the curve where it is within a thousandth of `x`, found by halving.
    fn search(&self, x: f64) -> f64 {
        const TOLERANCE: f64 = 0.001;
        let (mut low, mut high) = (0.0, 1.0);
        let mut point = [0.0; 2];
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            point = clamped_spline(&self.points, middle);
            if point[0] > x {
                high = middle;
            } else {
                low = middle;
            }
            if (point[0] - x).abs() <= TOLERANCE {
                break;
            }
        }
        point[1]
    }
}

/// A cubic B-spline that begins in its first point (t = 0) and ends in its last (t = 1).
pub(super) fn clamped_spline<const N: usize>(points: &[[f64; N]], t: f64) -> [f64; N] {
    let pieces = points.len() - 3;
    let knot = |index: usize| index.saturating_sub(3).min(pieces) as f64;
    let u = t.clamp(0.0, 1.0) * pieces as f64;
    let piece = (u.floor() as usize).min(pieces - 1);
    // De Boor's algorithm over the four points of the piece.
    let mut row: [[f64; N]; 4] = std::array::from_fn(|index| points[piece + index]);
    for level in 1..4 {
        for index in (level..4).rev() {
            let (from, to) = (knot(piece + index), knot(piece + index + 4 - level));
            let share = if to > from { (u - from) / (to - from) } else { 0.0 };
            let (before, here) = (row[index - 1], row[index]);
            row[index] =
                std::array::from_fn(|axis| (1.0 - share) * before[axis] + share * here[axis]);
        }
    }
    row[3]
}

/// The x of the word, for readers whose lines mix words and numbers.
pub(super) fn word_number(words: &[&str], index: usize) -> Option<f32> {
    words.get(index).copied().and_then(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LILAC: &str = "fver 1 1\nname: br_ang\nsamples: 10\nflip: off\npoints: 4\n\
        0.000000 0.531316 1\n0.323810 0.502745 1\n0.647619 0.450364 1\n1.000000 0.417031 1\n";

    #[test]
    fn a_function_begins_and_ends_in_its_points() {
        let function = Function::parse(LILAC.as_bytes(), "br_ang.func", 100).unwrap();
        assert_eq!(function.name, "br_ang");
        assert!((function.value(0.0) - 0.531316).abs() < 1e-3, "{}", function.value(0.0));
        assert!((function.value(1.0) - 0.417031).abs() < 1e-3);
        assert_eq!(function.value(-5.0), function.value(0.0));
        let rising = (0..50).map(|x| function.value(f64::from(x) / 50.0));
        let values: Vec<f64> = rising.collect();
        assert!(values.windows(2).all(|pair| pair[1] <= pair[0] + 1e-4), "{values:?}");
    }

    #[test]
    fn a_straight_spline_is_straight() {
        let line: Vec<[f64; 2]> = (0..7).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        for step in 0..=20 {
            let [x, y] = clamped_spline(&line, f64::from(step) / 20.0);
            assert!((y - 2.0 * x).abs() < 1e-12);
        }
        assert_eq!(clamped_spline(&line, 0.0), [0.0, 0.0]);
        assert_eq!(clamped_spline(&line, 1.0), [6.0, 12.0]);
    }

    #[test]
    fn errors_name_the_line() {
        let broken = LILAC.replace("0.647619 0.450364 1", "oops");
        let error = Function::parse(broken.as_bytes(), "a.func", 0).unwrap_err().to_string();
        assert!(error.starts_with("a.func:8:1: expected x and y"), "{error}");
    }
}
