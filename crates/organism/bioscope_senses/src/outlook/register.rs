use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use bioscope_core::Vec3;

use super::cells::{Cells, Thing};

/// How many times as far as the mean of those that move a thing may move between two surveys without being
/// noted (choice: of a school none does but by a jump).
const BOUND: f32 = 4.0;
/// Share of all things above which so many are noted that every list is better made anew.
const MOST_NOTED: usize = 8;
/// Surveys for which notes are kept.
const KEPT: u64 = 64;

/// All things of one kind in a scene, and how far they can have moved since earlier scenes: what
/// [`Shortlist`](super::Shortlist)s are drawn up from, and what tells them how long they hold.
///
/// The bound on speed is measured, not assumed: no thing has moved farther between two surveys than
/// [`way`](Self::way) has grown, but those that are noted one by one because they moved much farther than others,
/// changed their size, or came in the place of another.
#[derive(Debug)]
pub struct Register {
    things: Vec<Thing>,
    cells: OnceLock<Cells>,
    least_edge: f32,
    /// Number that only registers of the same places in the scene share.
    lineage: u64,
    /// How many surveys there were before in this lineage.
    survey: u64,
    way: f64,
    /// Surveys and the things that each noted, the latest last.
    noted: Vec<(u64, u32)>,
}

impl Register {
    /// These things, of which nothing was known before. Cells in which they are looked up are not smaller than
    /// `least_edge` metres.
    pub(super) fn new(things: Vec<Thing>, least_edge: f32) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let lineage = NEXT.fetch_add(1, Ordering::Relaxed);
        let (cells, noted) = (OnceLock::new(), Vec::new());
        Self { things, cells, least_edge, lineage, survey: 0, way: 0.0, noted }
    }

    /// The same register after these things have moved; a new one if others lie in their places.
    pub(super) fn followed_by(&self, things: Vec<Thing>) -> Self {
        let place = |one: &Thing| (one.group, one.member);
        let alike = self.things.len() == things.len()
            && self.things.iter().zip(&things).all(|(one, other)| place(one) == place(other));
        if !alike {
            return Self::new(things, self.least_edge);
        }
        let moves: Vec<f32> = self.things.iter().zip(&things).map(|(a, b)| moved(a, b)).collect();
        let (sum, count) = moves
            .iter()
            .filter(|one| **one > 0.0 && one.is_finite())
            .fold((0.0, 0usize), |(sum, count), one| (sum + one, count + 1));
        let bound = BOUND * sum / count.max(1) as f32;
        let survey = self.survey + 1;
        let strange = (0..).zip(&moves).filter(|(_, one)| one.is_nan() || **one > bound);
        let strange: Vec<(u64, u32)> = strange.map(|(index, _)| (survey, index)).collect();
        if strange.len() * MOST_NOTED > things.len() {
            return Self::new(things, self.least_edge);
        }
        let farthest = moves.iter().filter(|one| **one <= bound).fold(0.0, |a: f32, &b| a.max(b));
        let kept = self.noted.iter().filter(|(at, _)| at + KEPT > survey).copied();
        Self {
            noted: kept.chain(strange).collect(),
            things,
            cells: OnceLock::new(),
            least_edge: self.least_edge,
            lineage: self.lineage,
            survey,
            way: self.way + f64::from(farthest),
        }
    }

    /// All things in the order of the scene.
    pub fn things(&self) -> &[Thing] {
        &self.things
    }

    /// Its lineage and how many surveys there were in it before.
    pub(super) fn age(&self) -> (u64, u64) {
        (self.lineage, self.survey)
    }

    /// A way in metres that grows from survey to survey by at least as much as any thing that is not noted has moved.
    pub fn way(&self) -> f64 {
        self.way
    }

    /// Those noted after this survey, the latest first; none if it was too long ago to tell.
    pub(super) fn noted_since(&self, survey: u64) -> Option<impl Iterator<Item = u32> + '_> {
        let noted = self.noted.iter().rev().take_while(move |(at, _)| *at > survey);
        (survey + KEPT > self.survey).then(|| noted.map(|&(_, index)| index))
    }

    /// Calls `visit` with the index of every thing that may lie within reach of `center` (metres), in a fixed order.
    /// `reach` says how far a thing of a size is of interest, both in metres; it must not fall with size.
    /// Some things that lie farther are visited too.
    pub fn near(&self, center: Vec3, reach: impl Fn(f32) -> f32, visit: impl FnMut(u32)) {
        let cells = self.cells.get_or_init(|| Cells::new(&self.things, self.least_edge));
        cells.near(center, reach, visit);
    }
}

/// How far a thing has moved, metres; without end if it is another one or has changed its size.
fn moved(before: &Thing, now: &Thing) -> f32 {
    let same = before.id == now.id && before.size == now.size;
    if same { before.position.distance(now.position) } else { f32::INFINITY }
}
