use super::text::{Text, numbers};
use crate::{Diagnostic, Diagnostics};

/// Most intervals of one file.
const INTERVALS: usize = 1000;

/// Which derivation steps a model shows, and how: an animate file (.a).
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// First step that is shown.
    pub first_frame: i64,
    /// Last step that is shown; negative for that of the model.
    pub last_frame: i64,
    /// Steps from one frame to the next.
    pub step: u32,
    /// How long each frame stays, in refreshes of a screen.
    pub swap_interval: u32,
    /// Steps that are shown instead, if there are any.
    pub intervals: Vec<Interval>,
    /// Switches by name that are on, such as `clear between frames`.
    pub switches: Vec<String>,
    /// What was not understood.
    pub warnings: Vec<Diagnostic>,
}

/// Steps `from` to `to`, every `step`-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    /// First step.
    pub from: i64,
    /// Last step.
    pub to: i64,
    /// Steps between frames.
    pub step: u32,
}

const SWITCHES: [&str; 9] = [
    "double buffer",
    "clear between frames",
    "scale between frames",
    "new view between frames",
    "center between frames",
    "hcenter between frames",
    "display on request",
    "frame numbers",
    "generate on view change",
];

impl Default for Animation {
    fn default() -> Self {
        Self {
            first_frame: 1,
            last_frame: 1,
            step: 1,
            swap_interval: 1,
            intervals: Vec::new(),
            switches: vec!["double buffer".into(), "clear between frames".into()],
            warnings: Vec::new(),
        }
    }
}

impl Animation {
    /// Reads an animate file; commands that are not known are warnings.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let mut animation = Self::default();
        for line in text.lines() {
            let known = line.command().is_some_and(|(name, value)| animation.set(name, value));
            if !known {
                let message = format!("unknown animate command '{}'", line.text.trim());
                animation.warnings.push(text.diagnostic(&line, message));
            }
        }
        if animation.last_frame >= 0 {
            animation.last_frame = animation.last_frame.max(animation.first_frame);
        }
        if let (Some(first), Some(last)) = (animation.intervals.first(), animation.intervals.last())
        {
            (animation.first_frame, animation.last_frame) = (first.from, last.to);
        }
        Ok(animation)
    }

    fn set(&mut self, name: &str, value: &str) -> bool {
        let number = numbers(value).first().copied();
        match (name, number) {
            ("swap interval", Some(number)) => self.swap_interval = number.max(0.0) as u32,
            ("first frame", Some(number)) => self.first_frame = number.max(0.0) as i64,
            ("last frame", Some(number)) => self.last_frame = number as i64,
            ("step", Some(number)) => self.step = number.max(1.0) as u32,
            ("frame intervals", _) => {
                let parts = value.split(',').take(INTERVALS);
                self.intervals = parts.filter_map(|part| self.interval(part)).collect();
            }
            _ if SWITCHES.contains(&name) => {
                self.switches.retain(|on| on != name);
                if value.starts_with("on") {
                    self.switches.push(name.to_string());
                }
            }
            _ => return false,
        }
        true
    }

    /// One interval: `n`, `n-m` or `n-m step k`.
    fn interval(&self, text: &str) -> Option<Interval> {
        let mut words = text.split_whitespace();
        let range = words.next()?;
        let (from, to) = range.split_once('-').unwrap_or((range, range));
        let from: i64 = from.parse().ok()?;
        let to: i64 = to.parse().unwrap_or(from);
        let rest: Vec<&str> = words.collect();
        let step = match rest[..] {
            ["step", step, ..] => step.parse().unwrap_or(self.step),
            _ => self.step,
        };
        Some(Interval { from, to: to.max(from), step: step.max(1) })
    }

    /// The steps that are shown, the last of which is `length` if the file does not say.
    pub fn frames(&self, length: u64) -> Vec<u64> {
        const MOST: usize = 1_000_000;
        let last = if self.last_frame < 0 { length as i64 } else { self.last_frame };
        let whole = [Interval { from: self.first_frame, to: last, step: self.step }];
        let intervals = if self.intervals.is_empty() { &whole[..] } else { &self.intervals };
        let steps = |one: &Interval| (one.from.max(0)..=one.to).step_by(one.step as usize);
        intervals.iter().flat_map(steps).take(MOST).map(|step| step as u64).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_follow_the_file() {
        let text = b"double buffer: off\nfirst frame: 2\nlast frame: 8\nstep: 3\nwobble: on\n";
        let animation = Animation::parse(text, "a.a").unwrap();
        assert_eq!(animation.frames(99), [2, 5, 8]);
        assert_eq!(animation.switches, ["clear between frames"]);
        assert!(animation.warnings[0].to_string().starts_with("a.a:5:1: unknown animate"));
        let some = Animation::parse(b"frame intervals: 1-3, 10-20 step 5, 30\n", "b.a").unwrap();
        assert_eq!(some.frames(0), [1, 2, 3, 10, 15, 20, 30]);
    }
}
