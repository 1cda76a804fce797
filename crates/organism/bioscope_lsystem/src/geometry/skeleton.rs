//! Joints along the main axes of a plant, and the weights that bind its mesh to them.
//!
//! The plant is divided into ways from the root to the tips, the longest first (each way follows
//! the axis, or the branch, from which one gets farthest). The longest ways get chains of joints;
//! everything else moves with the chain it grows out of, as far along it as its own distance from
//! the root, so that the ends of leaves and twigs lag like the end of a stem.

use bioscope_core::{Error, Quat, Result, Vec3};
use bioscope_geometry::{Joint, Mesh, Skin, Transform};

use super::{Binding, Builder, Layout, MeshOptions};
use crate::{Interpretation, Surface};

/// How a skeleton is laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonOptions {
    /// At most so many joints, 1 to 255; the first is the root, which stays.
    pub joints: u32,
    /// At most so many chains of joints.
    pub chains: u32,
    /// Ways shorter than this share of the longest get no chain of their own.
    pub shortest: f32,
}

impl Default for SkeletonOptions {
    fn default() -> Self {
        Self { joints: 20, chains: 6, shortest: 0.35 }
    }
}

/// A plant that can be bent.
#[derive(Clone, Debug)]
pub struct PlantShape {
    /// The mesh, with its skin. Joint 0 is the root; all joints rest without rotation.
    pub mesh: Mesh,
    /// How easily each joint gives way: 0 at the root, 1 at the tip of its chain.
    pub flexibility: Vec<f32>,
    /// Way from the root to each joint along the plant, metres.
    pub paths: Vec<f32>,
    /// Height of the plant above its root, metres.
    pub height: f32,
    /// Longest way from the root to a tip, metres.
    pub length: f32,
}

/// A way along several axes, and its joints.
struct Chain {
    /// The points it passes, with their distances from the root.
    points: Vec<(f32, Vec3)>,
    /// The chain it grows out of.
    parent: Option<usize>,
    /// Joints from the root to its tip (those of its ancestors first) and where their bones begin.
    bones: Vec<(u8, f32)>,
}

impl Chain {
    fn base(&self) -> f32 {
        self.points[0].0
    }

    fn tip(&self) -> f32 {
        self.points[self.points.len() - 1].0
    }

    fn length(&self) -> f32 {
        self.tip() - self.base()
    }

    fn end(&self) -> Vec3 {
        self.points[self.points.len() - 1].1
    }

    /// The point at this distance from the root.
    fn at(&self, path: f32) -> Vec3 {
        let after = self.points.partition_point(|&(distance, _)| distance < path);
        let (Some(b), Some(a)) = (self.points.get(after), self.points.get(after.wrapping_sub(1)))
        else {
            return if after == 0 { self.points[0].1 } else { self.end() };
        };
        a.1.lerp(b.1, ((path - a.0) / (b.0 - a.0).max(1e-9)).clamp(0.0, 1.0))
    }
}

/// The chains of a plant and which of them each axis moves with.
struct Skeleton {
    chains: Vec<Chain>,
    chain_of_axis: Vec<usize>,
    joints: Vec<Joint>,
    flexibility: Vec<f32>,
    paths: Vec<f32>,
}

/// A predefined surface of a plant and what it moves with.
#[derive(Clone, Debug)]
pub struct Held {
    /// The surface.
    pub surface: Surface,
    /// The joints that move it.
    pub joints: [u8; 4],
    /// Their weights, sum 1.
    pub weights: [f32; 4],
}

/// The plant without its surfaces, and these apart.
pub(super) fn shape_and_leaves(
    mut interpretation: Interpretation,
    mesh: &MeshOptions,
    options: &SkeletonOptions,
) -> Result<(PlantShape, Vec<Held>)> {
    let surfaces = std::mem::take(&mut interpretation.surfaces);
    let (shape, skeleton, layout) = bent(&interpretation, mesh, options)?;
    let held = |surface: Surface| {
        let binding = match surface.anchor {
            Some(anchor) => Binding { axis: Some(anchor.axis), path: layout.path(anchor) },
            None => Binding { axis: None, path: 0.0 },
        };
        let (joints, weights) = skeleton.weights(&binding);
        Held { surface, joints, weights }
    };
    let leaves = surfaces.into_iter().map(held).collect();
    Ok((shape, leaves))
}

pub(super) fn shape(
    interpretation: &Interpretation,
    mesh: &MeshOptions,
    options: &SkeletonOptions,
) -> Result<PlantShape> {
    Ok(bent(interpretation, mesh, options)?.0)
}

fn bent(
    interpretation: &Interpretation,
    mesh: &MeshOptions,
    options: &SkeletonOptions,
) -> Result<(PlantShape, Skeleton, Layout)> {
    if !(1..=255).contains(&options.joints) {
        return Err(Error::value("joints", options.joints, "1 to 255"));
    }
    let Builder { mut mesh, bindings, layout, .. } =
        Builder::build(interpretation, mesh, None, true);
    let skeleton = Skeleton::new(interpretation, &layout, options);
    let bound = bindings.iter().map(|binding| skeleton.weights(binding));
    let (indices, weights) = bound.unzip();
    let length = bindings.iter().map(|binding| binding.path).fold(0.0, f32::max);
    let height = if mesh.positions.is_empty() { 0.0 } else { mesh.bounds().1.y.max(0.0) };
    mesh.skin = Some(Skin { joints: skeleton.joints.clone(), indices, weights });
    let (flexibility, paths) = (skeleton.flexibility.clone(), skeleton.paths.clone());
    Ok((PlantShape { mesh, flexibility, paths, height, length }, skeleton, layout))
}

impl Skeleton {
    fn new(interpretation: &Interpretation, layout: &Layout, options: &SkeletonOptions) -> Self {
        let ways = Ways::new(interpretation, layout);
        let chosen = ways.choose(options);
        let mut skeleton = Self {
            chains: Vec::new(),
            chain_of_axis: vec![usize::MAX; interpretation.axes.len()],
            joints: Vec::new(),
            flexibility: Vec::new(),
            paths: Vec::new(),
        };
        skeleton.joint("root", None, Vec3::ZERO, 0.0, 0.0);
        let total: f32 = chosen.iter().map(|&way| ways.length(way)).sum();
        let free = (options.joints as usize - 1).saturating_sub(chosen.len());
        let spacing = total / free.max(1) as f32;
        for &way in &chosen {
            let chain = ways.chain(way, &skeleton.chain_of_axis, interpretation, layout);
            skeleton.add(chain, spacing);
            let number = skeleton.chains.len() - 1;
            for &axis in &ways.list[way].axes {
                skeleton.chain_of_axis[axis as usize] = number;
            }
        }
        skeleton.attach_rest(interpretation, layout);
        skeleton
    }

    /// Gives a chain its joints, about `spacing` apart.
    fn add(&mut self, mut chain: Chain, spacing: f32) {
        let mut bones = match chain.parent {
            Some(parent) => {
                let bones = &self.chains[parent].bones;
                bones.iter().copied().filter(|&(_, start)| start <= chain.base()).collect()
            }
            None => vec![(0, 0.0)],
        };
        let count = (chain.length() / spacing.max(1e-6)).floor().max(0.0) as usize + 1;
        let name = self.chains.len();
        let mut parent = bones.last().map_or(0, |&(joint, _)| joint);
        for number in 0..count {
            let path = chain.base() + chain.length() * number as f32 / count as f32;
            let flexibility = if chain.tip() > 0.0 {
                (path + chain.length() / count as f32) / chain.tip()
            } else {
                0.0
            };
            let name = format!("chain{name}_{number}");
            parent = self.joint(&name, Some(parent), chain.at(path), path, flexibility);
            bones.push((parent, path));
        }
        chain.bones = bones;
        self.chains.push(chain);
    }

    fn joint(
        &mut self,
        name: &str,
        parent: Option<u8>,
        place: Vec3,
        path: f32,
        flexibility: f32,
    ) -> u8 {
        let rest = Transform::new(place, Quat::IDENTITY, 1.0);
        self.joints.push(Joint { name: name.into(), parent, rest });
        self.flexibility.push(flexibility);
        self.paths.push(path);
        (self.joints.len() - 1) as u8
    }

    /// Lets every axis without a chain move with its parent's, or with that whose tip is nearest to its own.
    fn attach_rest(&mut self, interpretation: &Interpretation, layout: &Layout) {
        for (number, axis) in interpretation.axes.iter().enumerate() {
            if self.chain_of_axis[number] != usize::MAX {
                continue;
            }
            self.chain_of_axis[number] = match axis.parent {
                Some(anchor) => self.chain_of_axis[anchor.axis as usize],
                None => {
                    let last = layout.list[layout.starts[number + 1] - 1];
                    self.nearest(interpretation.segments[last as usize].end)
                }
            };
        }
    }

    fn nearest(&self, place: Vec3) -> usize {
        let far = |chain: &Chain| chain.end().distance_squared(place);
        let order = |a: &usize, b: &usize| far(&self.chains[*a]).total_cmp(&far(&self.chains[*b]));
        (0..self.chains.len()).min_by(order).unwrap_or(usize::MAX)
    }

    /// The joints that move a vertex: a quadratic B-spline over the bones of its chain.
    fn weights(&self, binding: &Binding) -> ([u8; 4], [f32; 4]) {
        let chain = binding.axis.map_or(usize::MAX, |axis| self.chain_of_axis[axis as usize]);
        let Some(chain) = self.chains.get(chain) else { return ([0; 4], [1.0, 0.0, 0.0, 0.0]) };
        let bones = &chain.bones;
        let bone = bones.partition_point(|&(_, start)| start <= binding.path).max(1) - 1;
        let start = bones[bone].1;
        let end = bones.get(bone + 1).map_or(chain.tip(), |&(_, start)| start);
        let t = ((binding.path - start) / (end - start).max(1e-6)).clamp(0.0, 1.0);
        let before = bones[bone.saturating_sub(1)].0;
        let after = bones[(bone + 1).min(bones.len() - 1)].0;
        let (first, last) = (0.5 * (1.0 - t) * (1.0 - t), 0.5 * t * t);
        ([before, bones[bone].0, after, 0], [first, 1.0 - first - last, last, 0.0])
    }
}

/// One way from where it branches off to a tip.
struct Way {
    /// The axes it follows, from its base on.
    axes: Vec<u32>,
    /// Where on each of them it goes over to the next: a distance from the root.
    leaves: Vec<f32>,
    /// Distance of its end from the root.
    end: f32,
}

/// All ways of a plant.
struct Ways {
    list: Vec<Way>,
    /// Distance of the base of each way from the root.
    bases: Vec<f32>,
    tips: Vec<Vec3>,
}

impl Ways {
    fn new(interpretation: &Interpretation, layout: &Layout) -> Self {
        let count = interpretation.axes.len();
        // How far from the root one gets by each axis, and by which branch.
        let mut reach: Vec<f32> =
            (0..count).map(|axis| layout.bases[axis] + layout.length(axis as u32)).collect();
        let mut onward: Vec<Option<u32>> = vec![None; count];
        for axis in (0..count).rev() {
            if let Some(anchor) = interpretation.axes[axis].parent {
                let parent = anchor.axis as usize;
                if reach[axis] > reach[parent] {
                    reach[parent] = reach[axis];
                    onward[parent] = Some(axis as u32);
                }
            }
        }
        let mut ways = Self { list: Vec::new(), bases: Vec::new(), tips: Vec::new() };
        for axis in 0..count as u32 {
            let parent = interpretation.axes[axis as usize].parent;
            if parent.is_some_and(|anchor| onward[anchor.axis as usize] == Some(axis)) {
                continue;
            }
            ways.bases.push(layout.bases[axis as usize]);
            let mut way = Way { axes: vec![axis], leaves: Vec::new(), end: reach[axis as usize] };
            let mut last = axis;
            while let Some(next) = onward[last as usize] {
                way.leaves.push(layout.bases[next as usize]);
                way.axes.push(next);
                last = next;
            }
            let segment = layout.list[layout.starts[last as usize + 1] - 1];
            ways.tips.push(interpretation.segments[segment as usize].end);
            ways.list.push(way);
        }
        ways
    }

    fn length(&self, way: usize) -> f32 {
        self.list[way].end - self.bases[way]
    }

    /// The ways that get joints, in the order of the plant (parents first).
    fn choose(&self, options: &SkeletonOptions) -> Vec<usize> {
        let most = (options.chains as usize).min((options.joints as usize - 1) / 2);
        let mut order: Vec<usize> = (0..self.list.len()).collect();
        order.sort_by(|&a, &b| self.length(b).total_cmp(&self.length(a)).then(a.cmp(&b)));
        let Some(&first) = order.first().filter(|_| most > 0) else { return Vec::new() };
        let shortest = self.length(first) * options.shortest;
        let mut chosen = vec![first];
        order.retain(|&way| way != first && self.length(way) >= shortest);
        // Of the long ones those whose tips are far from each other.
        order.truncate(CANDIDATE_LIMIT);
        while chosen.len() < most && !order.is_empty() {
            let apart = |way: usize| {
                let near = chosen.iter().map(|&other| self.tips[way].distance(self.tips[other]));
                near.fold(f32::INFINITY, f32::min)
            };
            let best = (0..order.len())
                .max_by(|&a, &b| apart(order[a]).total_cmp(&apart(order[b])).then(b.cmp(&a)));
            chosen.push(order.remove(best.unwrap_or(0)));
        }
        chosen.sort_unstable();
        chosen
    }

    /// The points of a way, without joints yet.
    fn chain(
        &self,
        way: usize,
        chain_of_axis: &[usize],
        interpretation: &Interpretation,
        layout: &Layout,
    ) -> Chain {
        let Way { axes, leaves, .. } = &self.list[way];
        let mut points = Vec::new();
        for (index, &axis) in axes.iter().enumerate() {
            let leave = leaves.get(index).copied().unwrap_or(f32::INFINITY);
            let base = layout.bases[axis as usize];
            let range = layout.starts[axis as usize]..layout.starts[axis as usize + 1];
            for number in range.clone() {
                let segment = &interpretation.segments[layout.list[number] as usize];
                if number == range.start && points.is_empty() {
                    points.push((base, segment.start));
                }
                let path = base + layout.arcs[number];
                if path <= leave {
                    points.push((path, segment.end));
                }
            }
        }
        Chain {
            points,
            parent: ancestor(axes[0], chain_of_axis, interpretation),
            bones: Vec::new(),
        }
    }
}

/// How many of the longest ways are looked at.
const CANDIDATE_LIMIT: usize = 200;

/// The nearest chain among those of the axes that an axis grows out of.
fn ancestor(axis: u32, chain_of_axis: &[usize], interpretation: &Interpretation) -> Option<usize> {
    let mut parent = interpretation.axes[axis as usize].parent;
    while let Some(anchor) = parent {
        let chain = chain_of_axis[anchor.axis as usize];
        if chain != usize::MAX {
            return Some(chain);
        }
        parent = interpretation.axes[anchor.axis as usize].parent;
    }
    None
}
