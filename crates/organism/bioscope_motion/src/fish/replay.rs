use bioscope_core::{Error, Quat, Result, Vec3, math};
use bioscope_dynamics::spring_body::fish::NODES;
use rayon::prelude::*;

use super::frame::{Frame, wrapped};
use super::motor::Command;
use super::{FishModel, Swimmers};
use crate::undulation::ORIGIN;

/// Nodes of one moment as columns x, y, z, filled up to a multiple of eight.
type Columns = [[f32; 24]; 3];

/// One moment of a segment: where its frame is, and the deformed body within that frame.
#[derive(Clone, Debug, PartialEq)]
struct Moment {
    /// Center of mass since the beginning of the segment, body lengths.
    center: [f32; 3],
    /// Heading since the beginning, radians, not wrapped.
    yaw: f32,
    /// Nodes in the frame: relative to the center, turned back by the heading.
    nodes: Columns,
}

/// A captured motion: rigid motion of a frame, and deformation within it.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    moments: Vec<Moment>,
    /// Time units from one moment to the next.
    interval: f32,
    /// Whether its end joins its beginning.
    pub cyclic: bool,
}

/// Moments in a beat.
const MOMENTS: usize = 48;
/// Time units over which one segment passes into the next.
const BLEND: f32 = 1.5;

/// Captured motions of the muscle-driven fish: synthetic motion capture (Terzopoulos, "Artificial Life for Computer
/// Graphics", 1999; Grzeszczuk and Terzopoulos).
#[derive(Clone, Debug)]
pub struct Repertoire {
    segments: Vec<Segment>,
    /// Speeds of the forward segments, body lengths per time unit, rising; they come first.
    speeds: Vec<f32>,
    /// Angles of the turn segments, radians, positive to the left; they follow.
    angles: Vec<f32>,
    /// Deformed bodies over a beat at rest and at each of the speeds, swaying about their way.
    beats: Vec<Vec<Columns>>,
}

impl Repertoire {
    /// Captures forward swimming at slow, easy and fast speed, and turns to both sides.
    ///
    /// # Errors
    /// For models that cannot be simulated.
    pub fn capture(model: &std::sync::Arc<FishModel>) -> Result<Self> {
        let swim = &model.design.swim;
        let speeds = [0.5 * swim.cruise, swim.cruise, 0.9 * swim.top_speed()];
        let angles = [30.0, -30.0, 90.0, -90.0].map(|degrees: f32| degrees * math::PI / 180.0);
        let mut segments = Vec::new();
        for speed in speeds {
            segments.push(forward(model, speed)?);
        }
        for angle in angles {
            segments.push(turn(model, angle)?);
        }
        let speeds = speeds.map(|speed| speed as f32).to_vec();
        let still = swimming_at_rest(model)?;
        let ahead = ORIGIN - model.center() as f32;
        let moving = segments[..speeds.len()].iter().map(|segment| segment.beat(ahead));
        let beats = std::iter::once(still.beat(ahead)).chain(moving).collect();
        Ok(Self { segments, speeds, angles: angles.to_vec(), beats })
    }

    /// The body in steady swimming at a speed in body lengths per time unit, `phase` (0 to 1) after the beginning of a beat: nodes
    /// in the frame of its form ([`Swimmers::local_nodes`]), body lengths.
    pub fn beat(&self, speed: f32, phase: f32) -> [Vec3; NODES] {
        let upper =
            self.speeds.iter().position(|&one| one > speed).unwrap_or(self.speeds.len() - 1);
        let low = if upper == 0 { 0.0 } else { self.speeds[upper - 1] };
        let share = ((speed - low) / (self.speeds[upper] - low)).clamp(0.0, 1.0);
        let mut nodes = [[0.0; 24]; 3];
        for (beat, weight) in [(upper, 1.0 - share), (upper + 1, share)] {
            let beat = &self.beats[beat];
            let at = (phase - phase.floor()) * (beat.len() - 1) as f32;
            let index = (at as usize).min(beat.len() - 2);
            let late = weight * (at - index as f32);
            for axis in 0..3 {
                for node in 0..24 {
                    nodes[axis][node] += (weight - late) * beat[index][axis][node]
                        + late * beat[index + 1][axis][node];
                }
            }
        }
        rows(&nodes)
    }

    /// The captured segments: forward ones, then turns.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The forward segment nearest to a speed in body lengths per time unit.
    pub fn forward(&self, speed: f32) -> usize {
        nearest(&self.speeds, speed)
    }

    /// The turn nearest to an angle in radians.
    pub fn turn(&self, angle: f32) -> usize {
        self.speeds.len() + nearest(&self.angles, angle)
    }
}

fn nearest(values: &[f32], wanted: f32) -> usize {
    let distance = |index: &usize| (values[*index] - wanted).abs();
    (0..values.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// A fish in steady swimming at a speed, heading along +Z.
fn swimming(model: &std::sync::Arc<FishModel>, speed: f64) -> Result<Swimmers<f64>> {
    let mut fish = Swimmers::new(std::sync::Arc::clone(model), model.design.swim.cruise)?;
    fish.add([0.0; 3], Quat::IDENTITY, 1.0)?;
    fish.kick(0, Vec3::Z * speed as f32);
    fish.command(0, Command { speed: speed as f32, ..Command::default() })?;
    let period = 1.0 / model.design.swim.stroke(speed).frequency;
    fish.advance(12.0 * period);
    // Over one beat the speed is not corrected, so that its end meets its beginning.
    fish.motor_mut(0).feedback = false;
    fish.advance(3.0 * period);
    Ok(fish)
}

/// A fish that does not move, as a segment of two moments.
fn swimming_at_rest(model: &std::sync::Arc<FishModel>) -> Result<Segment> {
    let mut fish = Swimmers::new(std::sync::Arc::clone(model), model.design.swim.cruise)?;
    fish.add([0.0; 3], Quat::IDENTITY, 1.0)?;
    Ok(record(&mut fish, model.design.step, |_, moments| moments > 1))
}

fn forward(model: &std::sync::Arc<FishModel>, speed: f64) -> Result<Segment> {
    let mut fish = swimming(model, speed)?;
    let interval = 1.0 / f64::from(fish.motor(0).frequency) / MOMENTS as f64;
    while fish.motor(0).phase >= fish.motor(0).frequency * interval as f32 {
        fish.advance(interval);
    }
    let mut segment = record(&mut fish, interval, |_, moments| moments > MOMENTS);
    segment.close();
    Ok(segment)
}

/// A turn, from the beginning of a beat until the heading has settled and a beat begins again, so that the swing of the
/// trunk is the same at both ends.
fn turn(model: &std::sync::Arc<FishModel>, angle: f32) -> Result<Segment> {
    let mut fish = swimming(model, model.design.swim.cruise)?;
    let interval = 2.0 * model.design.step;
    let begins =
        |fish: &Swimmers<f64>| fish.motor(0).phase < fish.motor(0).frequency * interval as f32;
    while !begins(&fish) {
        fish.advance(interval);
    }
    fish.motor_mut(0).feedback = true;
    fish.turn(0, angle);
    let settle = (2.0 / f64::from(fish.motor(0).frequency) / interval) as usize;
    let mut ended = None;
    Ok(record(&mut fish, interval, |fish, moments| {
        if ended.is_none() && !fish.motor(0).is_turning() {
            ended = Some(moments);
        }
        let settled = ended.is_some_and(|end| moments > end + settle);
        (settled && begins(fish)) || moments > 5000
    }))
}

fn record(
    fish: &mut Swimmers<f64>,
    interval: f64,
    mut done: impl FnMut(&Swimmers<f64>, usize) -> bool,
) -> Segment {
    let heading = |fish: &Swimmers<f64>| {
        let nodes = fish.nodes(0);
        Frame::of(|node| nodes[node].map(|axis| axis as f32).into()).yaw()
    };
    let (start, first) = (fish.center(0), heading(fish));
    let (mut yaw, mut last) = (0.0, first);
    let mut moments = Vec::new();
    while moments.is_empty() || !done(fish, moments.len()) {
        let now = heading(fish);
        yaw += wrapped(now - last);
        last = now;
        moments.push(moment(fish, start, first, yaw));
        fish.advance(interval);
    }
    Segment { moments, interval: interval as f32, cyclic: false }
}

fn moment(fish: &Swimmers<f64>, start: [f64; 3], first: f32, yaw: f32) -> Moment {
    let center = fish.center(0);
    let (sine, cosine) = (f64::from(math::sin(first + yaw)), f64::from(math::cos(first + yaw)));
    let mut nodes = [[0.0; 24]; 3];
    for (index, node) in fish.nodes(0).into_iter().enumerate() {
        let [x, y, z] = [0, 1, 2].map(|axis| node[axis] - center[axis]);
        nodes[0][index] = (x * cosine - z * sine) as f32;
        nodes[1][index] = y as f32;
        nodes[2][index] = (x * sine + z * cosine) as f32;
    }
    let way = [0, 1, 2].map(|axis| center[axis] - start[axis]);
    let (sine, cosine) = (f64::from(math::sin(first)), f64::from(math::cos(first)));
    let way = [way[0] * cosine - way[2] * sine, way[1], way[0] * sine + way[2] * cosine];
    Moment { center: way.map(|axis| axis as f32), yaw, nodes }
}

impl Segment {
    /// Makes the last moment the first one again, the small rest of a beat spread over all of it.
    fn close(&mut self) {
        let count = (self.moments.len() - 1) as f32;
        let (first, last) = (self.moments[0].clone(), self.moments[self.moments.len() - 1].clone());
        for (index, moment) in self.moments.iter_mut().enumerate() {
            let share = index as f32 / count;
            moment.yaw -= share * (last.yaw - first.yaw);
            moment.center[0] -= share * last.center[0];
            moment.center[1] -= share * last.center[1];
            for axis in 0..3 {
                for node in 0..24 {
                    moment.nodes[axis][node] -=
                        share * (last.nodes[axis][node] - first.nodes[axis][node]);
                }
            }
        }
        self.cyclic = true;
    }

    /// Its nodes turned by how much the trunk sways about the mean of its headings, moved `ahead`.
    fn beat(&self, ahead: f32) -> Vec<Columns> {
        let count = self.moments.len() as f32;
        let mean = self.moments.iter().map(|moment| moment.yaw).sum::<f32>() / count;
        let swayed = self.moments.iter().map(|moment| {
            let mut nodes = moment.nodes;
            carry(&mut nodes, moment.yaw - mean, 1.0, [0.0, 0.0, ahead]);
            nodes
        });
        swayed.collect()
    }

    /// Time units it lasts.
    pub fn duration(&self) -> f32 {
        self.interval * (self.moments.len() - 1) as f32
    }

    /// Moment before a time, and the share of the way to the next.
    fn place(&self, time: f32) -> (usize, f32) {
        let at = (time / self.interval).clamp(0.0, (self.moments.len() - 1) as f32 - 1e-3);
        (at as usize, at - (at as usize) as f32)
    }

    /// Way `[left, up, ahead]` and change of heading since its beginning.
    fn way(&self, time: f32) -> [f32; 4] {
        let (index, share) = self.place(time);
        let (a, b) = (&self.moments[index], &self.moments[index + 1]);
        let mix = |a: f32, b: f32| a + (b - a) * share;
        let [left, up, ahead] = [0, 1, 2].map(|axis| mix(a.center[axis], b.center[axis]));
        [left, up, ahead, mix(a.yaw, b.yaw)]
    }

    /// Adds `weight` of the deformed nodes at a time.
    #[inline]
    fn add(&self, time: f32, weight: f32, out: &mut Columns) {
        let (index, share) = self.place(time);
        let (early, late) = (weight * (1.0 - share), weight * share);
        let (a, b) = (&self.moments[index].nodes, &self.moments[index + 1].nodes);
        for axis in 0..3 {
            for node in 0..24 {
                out[axis][node] += early * a[axis][node] + late * b[axis][node];
            }
        }
    }

    /// Nodes at one of its moments as they were captured, relative to the beginning; body lengths.
    pub fn nodes(&self, index: usize) -> Option<[Vec3; NODES]> {
        let moment = self.moments.get(index)?;
        let mut nodes = moment.nodes;
        carry(&mut nodes, moment.yaw, 1.0, moment.center);
        Some(rows(&nodes))
    }

    /// How many moments it has.
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }
}

#[inline]
fn carry(nodes: &mut Columns, yaw: f32, length: f32, to: [f32; 3]) {
    let (sine, cosine) = (length * math::sin(yaw), length * math::cos(yaw));
    let [x, y, z] = nodes;
    for node in 0..24 {
        let (left, ahead) = (x[node], z[node]);
        x[node] = left * cosine + ahead * sine + to[0];
        y[node] = y[node] * length + to[1];
        z[node] = ahead * cosine - left * sine + to[2];
    }
}

fn rows(nodes: &Columns) -> [Vec3; NODES] {
    std::array::from_fn(|node| Vec3::new(nodes[0][node], nodes[1][node], nodes[2][node]))
}

/// A fish that replays captured segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Replica {
    /// Center of mass, metres.
    pub position: Vec3,
    /// Heading, radians.
    pub yaw: f32,
    /// Metres.
    pub length: f32,
    segment: usize,
    time: f32,
    /// The segment it comes from, the time in it, and the share it still has.
    fading: Option<(usize, f32, f32)>,
    nodes: Columns,
}

impl Replica {
    /// A fish that begins this segment at a share of its duration.
    ///
    /// # Errors
    /// For segments that do not exist.
    pub fn new(
        repertoire: &Repertoire,
        (position, yaw, length): (Vec3, f32, f32),
        (segment, share): (usize, f32),
    ) -> Result<Self> {
        let Some(found) = repertoire.segments.get(segment) else {
            let expected = format!("below {}", repertoire.segments.len());
            return Err(Error::value("segment", segment, expected));
        };
        let time = share.clamp(0.0, 1.0) * found.duration();
        let nodes = [[0.0; 24]; 3];
        Ok(Self { position, yaw, length, segment, time, fading: None, nodes })
    }

    /// Passes into another segment.
    pub fn play(&mut self, segment: usize) {
        if segment != self.segment {
            self.fading = Some((self.segment, self.time, 1.0));
            (self.segment, self.time) = (segment, 0.0);
        }
    }

    /// Advances by `dt` time units; after a turn it swims on with `next`.
    pub fn advance(&mut self, repertoire: &Repertoire, next: usize, dt: f32) {
        let (mut move_, over) = passed(&repertoire.segments[self.segment], &mut self.time, dt);
        if let Some((old, time, share)) = &mut self.fading {
            let (other, _) = passed(&repertoire.segments[*old], time, dt);
            // The heading is the new segment's alone: else a turn would lose its beginning.
            for (mine, theirs) in move_[..3].iter_mut().zip(other) {
                *mine += (theirs - *mine) * *share;
            }
            *share -= dt / BLEND;
        }
        self.fading = self.fading.filter(|(_, _, share)| *share > 0.0);
        let (sine, cosine) = (math::sin(self.yaw), math::cos(self.yaw));
        let [left, up, ahead, turned] = move_;
        let way = Vec3::new(left * cosine + ahead * sine, up, ahead * cosine - left * sine);
        self.position += way * self.length;
        self.yaw = wrapped(self.yaw + turned);
        self.nodes = [[0.0; 24]; 3];
        let faded = self.fading.map_or(0.0, |(_, _, share)| share);
        repertoire.segments[self.segment].add(self.time, 1.0 - faded, &mut self.nodes);
        if let Some((old, time, share)) = self.fading {
            repertoire.segments[old].add(time, share, &mut self.nodes);
        }
        carry(&mut self.nodes, self.yaw, self.length, self.position.to_array());
        if over {
            self.play(next);
        }
    }

    /// Places of its nodes in metres.
    pub fn nodes(&self) -> [Vec3; NODES] {
        rows(&self.nodes)
    }
}

/// Goes on in a segment; returns the way in the frame at its beginning turned into the present one, and whether a
/// segment that is not cyclic is over.
fn passed(segment: &Segment, time: &mut f32, dt: f32) -> ([f32; 4], bool) {
    let before = segment.way(*time);
    let duration = segment.duration();
    *time += dt;
    let mut whole = [0.0; 4];
    let mut over = false;
    if *time >= duration {
        if segment.cyclic {
            let laps = (*time / duration).floor();
            *time -= laps * duration;
            whole = segment.way(duration).map(|part| part * laps);
        } else {
            (*time, over) = (duration, true);
        }
    }
    let after = segment.way(*time);
    let change: [f32; 4] = std::array::from_fn(|part| after[part] - before[part] + whole[part]);
    // The way was recorded in the frame at the beginning: turn it back by the heading reached since.
    let (sine, cosine) = (math::sin(before[3]), math::cos(before[3]));
    let [left, up, ahead, turned] = change;
    ([left * cosine - ahead * sine, up, left * sine + ahead * cosine, turned], over)
}

/// Advances many replicas in parallel, each by itself.
pub fn advance_replicas(replicas: &mut [Replica], repertoire: &Repertoire, next: usize, dt: f32) {
    replicas
        .par_iter_mut()
        .with_min_len(256)
        .for_each(|replica| replica.advance(repertoire, next, dt));
}
