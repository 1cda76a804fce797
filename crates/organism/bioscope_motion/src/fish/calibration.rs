//! Measuring how a design swims and turns, and filling its tables from the measurements.

use std::sync::Arc;

use bioscope_core::math::{PI, TAU};
use bioscope_core::{Quat, Result, Vec3};
use bioscope_dynamics::spring_body::Lanes;
use bioscope_dynamics::spring_body::fish::CENTER_LINE;

use super::frame::wrapped;
use super::motor::Command;
use super::tables::{Bend, Stroke};
use super::{FishDesign, FishModel, Swimmers};

/// How a fish swims with a stroke, averaged over the last beats. Body lengths and time units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Swimming {
    /// Speed along its way.
    pub speed: f64,
    /// Way per beat.
    pub stride: f64,
    /// Tail-beat frequency times peak-to-peak tail amplitude over speed.
    pub strouhal: f64,
    /// Peak-to-peak amplitude of the tail across its way.
    pub tail: f64,
    /// Peak-to-peak amplitude of the snout across its way.
    pub recoil: f64,
    /// Change of heading per beat, radians.
    pub drift: f64,
    /// Correlation of the bends in the anterior and the posterior swim segment; −1 is an S.
    pub bends: f64,
    /// Work of the muscles per way, body masses times body lengths per time unit squared.
    pub cost: f64,
    /// Whether it kept its shape.
    pub whole: bool,
}

/// Beats that are swum in at least, and beats that are measured.
const BEATS: [f64; 2] = [7.0, 4.0];
/// Relative change of speed from one measurement to the next below which a fish swims steadily.
const STEADY: f64 = 0.01;
/// Most measurements until all swim steadily: a body without friction coasts for a hundred beats.
const MEASUREMENTS: usize = 100;

/// Measures strokes, begun at half a body length per beat, without feedback, once they have become steady.
///
/// # Errors
/// For impossible designs.
pub fn measure_strokes(design: &FishDesign, strokes: &[Stroke]) -> Result<Vec<Swimming>> {
    let mut design = design.clone();
    // Pseudo speeds 1, 2, … name the strokes to the swim controller.
    let named = strokes.iter().enumerate();
    let named = named.map(|(index, &stroke)| Stroke { speed: index as f64 + 1.0, ..stroke });
    design.swim.strokes = std::iter::once(Stroke::default()).chain(named).collect();
    design.swim.cruise = 1.0;
    let step = design.step;
    let model = Arc::new(FishModel::new(design)?);
    let mut school = Swimmers::<Lanes>::new(model, 1.0)?;
    for (index, stroke) in strokes.iter().enumerate() {
        school.add([0.0; 3], Quat::IDENTITY, 1.0)?;
        school.motor_mut(index).feedback = false;
        school.kick(index, Vec3::Z * (0.5 * stroke.frequency) as f32);
        let speed = index as f32 + 1.0;
        school.command(index, Command { speed, ..Command::default() })?;
    }
    let slowest = strokes.iter().map(|stroke| stroke.frequency).fold(f64::MAX, f64::min);
    let steps = |beats: f64| (beats / slowest / step) as usize;
    school.advance_in(step * steps(BEATS[0]) as f64, steps(BEATS[0]));
    let mut found = measured(&mut school, strokes, (step, steps(BEATS[1])));
    for _ in 1..MEASUREMENTS {
        let later = measured(&mut school, strokes, (step, steps(BEATS[1])));
        let steady = found.iter().zip(&later).all(|(earlier, later)| {
            (later.speed - earlier.speed).abs() <= STEADY * later.speed.abs() || !later.whole
        });
        found = later;
        if steady {
            break;
        }
    }
    Ok(found)
}

/// How all swim during so many steps.
fn measured(
    school: &mut Swimmers<Lanes>,
    strokes: &[Stroke],
    (step, count): (f64, usize),
) -> Vec<Swimming> {
    let mut tracks: Vec<Vec<Track>> = vec![Vec::with_capacity(count); strokes.len()];
    for _ in 0..count {
        school.advance_in(step, 1);
        for (index, track) in tracks.iter_mut().enumerate() {
            track.push(Track::of(school, index));
        }
    }
    let whole = |index| school.repairs(index) == 0;
    let each = strokes.iter().zip(&tracks).enumerate();
    each.map(|(index, (stroke, track))| summary(stroke, track, step, whole(index))).collect()
}

/// Places on the level at one moment: `[x, z]`.
#[derive(Clone, Copy, Debug)]
struct Track {
    center: [f64; 2],
    snout: [f64; 2],
    tail: [f64; 2],
    yaw: f64,
    bends: [f64; 2],
    work: f64,
}

impl Track {
    fn of(school: &Swimmers<Lanes>, index: usize) -> Self {
        let nodes = school.nodes(index);
        let mean = |ring: usize| {
            let share = 1.0 / CENTER_LINE[ring].len() as f64;
            [0, 2].map(|axis| {
                CENTER_LINE[ring].iter().map(|&node| nodes[node][axis]).sum::<f64>() * share
            })
        };
        let bend = |ring: usize| {
            let [a, b, c] = [mean(ring - 1), mean(ring), mean(ring + 1)];
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
        };
        let center = school.center(index);
        let yaw = super::Frame::of(|node| nodes[node].map(|axis| axis as f32).into()).yaw();
        Self {
            center: [center[0], center[2]],
            snout: mean(0),
            tail: mean(6),
            yaw: f64::from(yaw),
            bends: [bend(2), bend(3)],
            work: school.work(index) / school.model().mass(1.0),
        }
    }
}

fn summary(stroke: &Stroke, track: &[Track], step: f64, whole: bool) -> Swimming {
    let count = ((BEATS[1] / stroke.frequency / step) as usize).clamp(2, track.len());
    let track = &track[track.len() - count..];
    let (first, last) = (track[0], track[count - 1]);
    let way = [0, 1].map(|axis| last.center[axis] - first.center[axis]);
    let length = way[0].hypot(way[1]).max(1e-9);
    let across = |place: [f64; 2]| {
        ((place[0] - first.center[0]) * way[1] - (place[1] - first.center[1]) * way[0]) / length
    };
    let swing = |place: fn(&Track) -> [f64; 2]| {
        let (low, high) = track
            .iter()
            .map(|moment| across(place(moment)))
            .fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    let yaws =
        |part: &[Track]| part.iter().map(|moment| moment.yaw).sum::<f64>() / part.len() as f64;
    let (early, late) = track.split_at(count / 2);
    let ahead = yaws(track);
    let forward = (way[0] * ahead.sin() + way[1] * ahead.cos()).signum();
    let moment = |a: usize, b: usize| {
        track.iter().map(|moment| moment.bends[a] * moment.bends[b]).sum::<f64>()
    };
    let speed = forward * length / (count as f64 * step);
    let tail = swing(|moment| moment.tail);
    Swimming {
        speed,
        stride: speed / stroke.frequency,
        strouhal: stroke.frequency * tail / speed,
        tail,
        recoil: swing(|moment| moment.snout),
        drift: (yaws(late) - yaws(early)) / (0.5 * BEATS[1]),
        bends: moment(0, 1) / (moment(0, 0) * moment(1, 1)).sqrt().max(1e-30),
        cost: (last.work - first.work) / length,
        whole: whole && speed.is_finite(),
    }
}

/// Measures the change of heading, radians, that a bend makes in cruise without feedback: the mean of eight phases of
/// the beat, half of them to the left and half to the right.
///
/// # Errors
/// For impossible designs.
pub fn measure_bend(design: &FishDesign, depth: f64, hold: f64) -> Result<f64> {
    let mut design = design.clone();
    let angle = f64::from(PI);
    design.turn.bends = vec![Bend::default(), Bend { angle, depth, hold }];
    let step = design.step;
    let cruise = design.swim.cruise;
    let period = 1.0 / design.swim.stroke(cruise).frequency;
    let beat = (period / step) as usize;
    let model = Arc::new(FishModel::new(design)?);
    let mut school = Swimmers::<Lanes>::new(model, cruise)?;
    let speed = cruise as f32;
    for index in 0..8 {
        school.add([0.0; 3], Quat::IDENTITY, 1.0)?;
        school.motor_mut(index).phase = index as f32 / 8.0;
        school.kick(index, Vec3::Z * speed);
        school.command(index, Command { speed, ..Command::default() })?;
    }
    school.advance_in(step * (4 * beat) as f64, 4 * beat);
    for index in 0..8 {
        school.motor_mut(index).feedback = false;
    }
    let before = mean_headings(&mut school, beat, step);
    for index in 0..8 {
        school.turn(index, if index % 2 == 0 { PI } else { -PI });
    }
    // Angles beyond a half turn are followed as they grow.
    let mut turned = [0.0; 8];
    let mut last = before;
    let lasting = (hold + 2.0 / school.model().design.turn.recovery + period) / step;
    let rounds = (lasting as usize).div_ceil(beat) + 1;
    for _ in 0..rounds {
        let now = mean_headings(&mut school, beat, step);
        for index in 0..8 {
            turned[index] += f64::from(wrapped((now[index] - last[index]) as f32));
        }
        last = now;
    }
    let side = |index: usize| if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    Ok((0..8).map(|index| side(index) * turned[index]).sum::<f64>() / 8.0)
}

/// Mean headings over the next beat.
fn mean_headings(school: &mut Swimmers<Lanes>, beat: usize, step: f64) -> [f64; 8] {
    let mut sums = [[0.0; 2]; 8];
    for _ in 0..beat {
        school.advance_in(step, 1);
        for (index, sum) in sums.iter_mut().enumerate() {
            let ahead = school.placement(index).vector(Vec3::Z);
            *sum = [sum[0] + f64::from(ahead.x), sum[1] + f64::from(ahead.z)];
        }
    }
    sums.map(|[x, z]| x.atan2(z))
}

/// A stroke of this effort: one of easy swimming has 1, slower ones beat more seldom and less widely, faster ones more often
/// and, up to what the muscles can do, more widely.
pub fn harder(easy: &Stroke, effort: f64) -> Stroke {
    Stroke {
        speed: 0.0,
        frequency: easy.frequency * (0.35 + 0.65 * effort),
        amplitudes: easy.amplitudes.map(|amplitude| (amplitude * effort.sqrt()).min(1.0)),
    }
}

/// Most radians by which a stroke of the swim table may turn a fish in a beat, without feedback.
const STRAIGHT: f64 = 0.15;

/// Fills the tables of a design from measurements, going out from its stroke of easy swimming: slower and faster swimming is of less
/// and more effort ([`harder`]). The steering map takes bends of growing depth and then of growing duration.
///
/// # Errors
/// For impossible designs, and for designs that do not swim forward or do not turn.
pub fn calibrate(mut design: FishDesign, easy: Stroke) -> Result<FishDesign> {
    let efforts =
        [0.12, 0.2, 0.3, 0.4, 0.55, 0.7, 0.85, 1.0, 1.2, 1.5, 1.8, 2.2, 2.6, 3.1, 3.7, 4.5];
    let strokes = efforts.map(|effort| harder(&easy, effort));
    let measured = measure_strokes(&design, &strokes)?;
    let mut rows = vec![Stroke { frequency: strokes[0].frequency, ..Stroke::default() }];
    for ((stroke, swimming), effort) in strokes.iter().zip(&measured).zip(efforts) {
        let faster = swimming.speed > rows[rows.len() - 1].speed * 1.02 + 1e-4;
        if swimming.whole && faster && swimming.drift.abs() < STRAIGHT {
            rows.push(Stroke { speed: swimming.speed, ..*stroke });
        }
        if effort == 1.0 {
            design.swim.cruise = swimming.speed;
        }
    }
    design.swim.strokes = rows;
    design.swim.check()?;
    design.turn.bends = steering_map(&design)?;
    design.turn.check()?;
    Ok(design)
}

fn steering_map(design: &FishDesign) -> Result<Vec<Bend>> {
    let period = 1.0 / design.swim.stroke(design.swim.cruise).frequency;
    let depths = [0.25, 0.5, 0.75].map(|depth| (depth, 0.1 * period));
    let holds = [0.1, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0].map(|beats| (1.0, beats * period));
    let mut rows = vec![Bend::default()];
    for (depth, hold) in depths.into_iter().chain(holds) {
        let angle = measure_bend(design, depth, hold)?;
        if angle > rows[rows.len() - 1].angle + 0.02 {
            rows.push(Bend { angle, depth, hold });
        }
        if angle > 0.25 * f64::from(TAU) {
            break;
        }
    }
    Ok(rows)
}
