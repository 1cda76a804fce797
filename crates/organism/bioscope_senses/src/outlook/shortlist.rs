use bioscope_core::Vec3;

use super::cells::Thing;
use super::register::Register;

/// For about how many times of asking a list is to hold (choice: longer lists cost more at each).
const HOLDS: f32 = 8.0;
/// Metres by which lists are longer than they need be, and share of the greatest coordinate: more than is lost
/// in rounding.
const ROUNDING: (f32, f32) = (1e-3, 1e-6);

/// How far things are noticed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Distance up to which anything is noticed, metres.
    pub range: f32,
    /// Least angle under which a thing is noticed, as size by distance; 0 for any.
    pub least: f32,
}

impl Reach {
    /// How far a thing of this size is noticed, both in metres.
    pub fn of(&self, size: f32) -> f32 {
        if self.least > 0.0 { self.range.min(size / self.least) } else { self.range }
    }
}

/// The things that one animal may notice for some time to come: a list of potentially visible objects, which
/// makes use of the coherence of space and time (Tu, "Artificial Animals for Computer Animation", 1996, section 5.4).
///
/// It holds everything within reach and a margin. As long as the animal and the fastest of the things together have not
/// used up the margin, nothing else can have come within reach, and only the list need be gone through; what broke the
/// bound (by a jump, by being new) is looked at one by one. When the margin is used up, or others lie in the places
/// of the scene, the list is made anew, with a margin for as much motion as there was lately. What is noticed is the same
/// with and without a list, so that it is no part of the animal's state.
#[derive(Clone, Debug, Default)]
pub struct Shortlist {
    members: Vec<u32>,
    reach: Reach,
    margin: f32,
    /// Lineage of the register, and its survey up to which what it noted is known.
    age: (u64, u64),
    /// Where the animal was, and the register's way, when the list was made and when it was asked last.
    made: (Vec3, f64),
    asked: (Vec3, f64),
}

/// All are equal: they differ only in when they will be made anew.
impl PartialEq for Shortlist {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Shortlist {
    /// Calls `visit` for every thing of the register within reach of `center` (metres) that `keep` keeps, in no
    /// particular order; some that lie farther are visited too. `keep` must keep the same things at all times.
    pub fn near<'a>(
        &mut self,
        register: &'a Register,
        (center, reach): (Vec3, Reach),
        keep: impl Fn(&Thing) -> bool,
        mut visit: impl FnMut(&'a Thing),
    ) {
        let left = self.margin - used(self.made, (center, register.way()));
        let holds = register.age().0 == self.age.0 && reach == self.reach && left >= 0.0;
        let noted = if holds { register.noted_since(self.age.1) } else { None };
        match noted {
            Some(noted) => {
                for index in noted {
                    let thing = &register.things()[index as usize];
                    let far = thing.position.distance(center)
                        > reach.of(thing.size) + left + spare(center);
                    if !far && keep(thing) && !self.members.contains(&index) {
                        self.members.push(index);
                    }
                }
            }
            None => self.make(register, (center, reach), keep),
        }
        self.age = register.age();
        self.asked = (center, register.way());
        self.members.iter().for_each(|&index| visit(&register.things()[index as usize]));
    }

    fn make(
        &mut self,
        register: &Register,
        (center, reach): (Vec3, Reach),
        keep: impl Fn(&Thing) -> bool,
    ) {
        let known = register.age().0 == self.age.0 && reach == self.reach;
        let lately = if known { used(self.asked, (center, register.way())) } else { 0.0 };
        self.margin = (HOLDS * lately).min(reach.range);
        (self.reach, self.made) = (reach, (center, register.way()));
        let all = |size: f32| reach.of(size) + self.margin + spare(center);
        let members = &mut self.members;
        members.clear();
        register.near(center, all, |index| {
            let thing = &register.things()[index as usize];
            // Whatever is no number is looked at by whoever asks.
            let far = thing.position.distance(center) > all(thing.size);
            if !far && keep(thing) {
                members.push(index);
            }
        });
    }
}

/// How much of a margin motion has used up since then, metres.
fn used((place, way): (Vec3, f64), now: (Vec3, f64)) -> f32 {
    place.distance(now.0) + (now.1 - way) as f32
}

fn spare(center: Vec3) -> f32 {
    ROUNDING.0.max(ROUNDING.1 * center.abs().max_element())
}
