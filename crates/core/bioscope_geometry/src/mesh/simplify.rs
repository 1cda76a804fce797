//! Fewer triangles for the same shape: edges collapse into one of their ends, cheapest first, the
//! cost being the mean squared distance to the planes that met at the vertex (quadric error, Garland and
//! Heckbert 1997). Vertices never move, so texture coordinates, colors and skin weights stay true.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec3, Vec3};

use super::{Mesh, Skin};

/// How much more the outline of an open sheet counts than its surface.
const OUTLINE: f64 = 4.0;

/// A vertex may take the place of another at most so far away in the texture's width or height, unless
/// they share a triangle that goes.
const STRETCH: f32 = 0.35;

/// A mesh while it loses triangles. Vertices at one place (seams) count as one node.
pub(super) struct Simplifier<'a> {
    mesh: &'a Mesh,
    /// Node of each vertex.
    nodes: Vec<u32>,
    places: Vec<DVec3>,
    quadrics: Vec<Quadric>,
    /// Triangles that touch each node.
    touching: Vec<Vec<u32>>,
    /// Vertices of each triangle; none once it is gone.
    triangles: Vec<Option<[u32; 3]>>,
    count: usize,
    /// Nodes on the outline of an open sheet.
    outline: Vec<bool>,
    /// Nodes that stay.
    locked: Vec<bool>,
    /// Changes whenever something next to the node changes.
    stamps: Vec<u32>,
    queue: BinaryHeap<Reverse<Candidate>>,
    /// Greatest distance so far between a removed vertex and the shape, metres.
    pub error: f32,
}

/// A collapse in waiting; ordered by cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    /// Bits of the cost, which is positive, so that they order like the number.
    cost: u64,
    from: u32,
    to: u32,
    stamps: [u32; 2],
}

/// Sum of weighted squared distances to planes: pᵀAp + 2bᵀp + c.
#[derive(Clone, Copy, Debug, Default)]
struct Quadric {
    diagonal: DVec3,
    mixed: DVec3,
    linear: DVec3,
    constant: f64,
    weight: f64,
}

impl Quadric {
    fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let offset = -normal.dot(point);
        Self {
            diagonal: normal * normal * weight,
            mixed: DVec3::new(normal.y * normal.z, normal.z * normal.x, normal.x * normal.y)
                * weight,
            linear: normal * (offset * weight),
            constant: offset * offset * weight,
            weight,
        }
    }

    fn add(&mut self, other: &Self) {
        self.diagonal += other.diagonal;
        self.mixed += other.mixed;
        self.linear += other.linear;
        self.constant += other.constant;
        self.weight += other.weight;
    }

    /// Mean squared distance of a point.
    fn error(&self, p: DVec3) -> f64 {
        let squares = self.diagonal.dot(p * p);
        let mixed = self.mixed.dot(DVec3::new(p.y * p.z, p.z * p.x, p.x * p.y));
        let sum = squares + 2.0 * (mixed + self.linear.dot(p)) + self.constant;
        (sum / self.weight.max(1e-30)).max(0.0)
    }
}

impl<'a> Simplifier<'a> {
    /// Starts from a whole mesh; vertices for which `locked` holds stay.
    pub fn new(mesh: &'a Mesh, locked: impl Fn(usize) -> bool) -> Self {
        let (nodes, places) = weld(&mesh.positions);
        let count = places.len();
        let mut simplifier = Self {
            mesh,
            nodes,
            places,
            quadrics: vec![Quadric::default(); count],
            touching: vec![Vec::new(); count],
            triangles: Vec::with_capacity(mesh.triangles.len()),
            count: 0,
            outline: vec![false; count],
            locked: vec![false; count],
            stamps: vec![0; count],
            queue: BinaryHeap::new(),
            error: 0.0,
        };
        for triangle in &mesh.triangles {
            simplifier.enter(*triangle);
        }
        simplifier.find_outline();
        for vertex in (0..mesh.positions.len()).filter(|&vertex| locked(vertex)) {
            simplifier.locked[simplifier.nodes[vertex] as usize] = true;
        }
        for node in 0..count as u32 {
            simplifier.offer(node);
        }
        simplifier
    }

    /// Triangles left.
    pub fn count(&self) -> usize {
        self.count
    }

    fn enter(&mut self, triangle: [u32; 3]) {
        let nodes = triangle.map(|vertex| self.nodes[vertex as usize]);
        let [a, b, c] = nodes.map(|node| self.places[node as usize]);
        let area = (b - a).cross(c - a);
        let size = area.length();
        let flat = nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0];
        if flat || !(size > 0.0 && size.is_finite()) {
            self.triangles.push(None);
            return;
        }
        let quadric = Quadric::plane(area / size, a, size);
        for node in nodes {
            self.quadrics[node as usize].add(&quadric);
            self.touching[node as usize].push(self.triangles.len() as u32);
        }
        self.triangles.push(Some(triangle));
        self.count += 1;
    }

    fn nodes_of(&self, triangle: u32) -> Option<[u32; 3]> {
        self.triangles[triangle as usize]
            .map(|corners| corners.map(|corner| self.nodes[corner as usize]))
    }

    /// Marks nodes on edges that only one triangle has, and makes leaving those edges costly.
    fn find_outline(&mut self) {
        let mut edges = Vec::new();
        for triangle in 0..self.triangles.len() as u32 {
            let Some([a, b, c]) = self.nodes_of(triangle) else { continue };
            for [from, to] in [[a, b], [b, c], [c, a]] {
                edges.push((from.min(to), from.max(to), triangle));
            }
        }
        edges.sort_unstable();
        for (index, &(from, to, triangle)) in edges.iter().enumerate() {
            let same = |other: Option<&(u32, u32, u32)>| {
                other.is_some_and(|&(a, b, _)| (a, b) == (from, to))
            };
            let before = index.checked_sub(1).and_then(|index| edges.get(index));
            if same(before) || same(edges.get(index + 1)) {
                continue;
            }
            let Some(nodes) = self.nodes_of(triangle) else { continue };
            let [a, b, c] = nodes.map(|node| self.places[node as usize]);
            let [start, end] = [from, to].map(|node| self.places[node as usize]);
            let normal = (b - a).cross(c - a).cross(end - start).normalize_or_zero();
            let weight = (end - start).length_squared() * OUTLINE;
            let quadric = Quadric::plane(normal, start, weight);
            for node in [from as usize, to as usize] {
                self.outline[node] = true;
                self.quadrics[node].add(&quadric);
            }
        }
    }

    fn neighbors(&self, node: u32) -> Vec<u32> {
        let triangles = self.touching[node as usize].iter();
        let mut found: Vec<u32> =
            triangles.filter_map(|&triangle| self.nodes_of(triangle)).flatten().collect();
        found.sort_unstable();
        found.dedup();
        found.retain(|&other| other != node);
        found
    }

    /// Queues the cheapest collapse of a node into a neighbor.
    fn offer(&mut self, node: u32) {
        if self.locked[node as usize] {
            return;
        }
        let cost = |to: u32| {
            let mut sum = self.quadrics[node as usize];
            sum.add(&self.quadrics[to as usize]);
            let place = self.places[to as usize];
            // A trace of the length lets flat regions shrink evenly.
            let length = (place - self.places[node as usize]).length_squared();
            (sum.error(place) + 1e-6 * length).to_bits()
        };
        let ways = self.neighbors(node).into_iter();
        let ways = ways.filter(|&to| !self.outline[node as usize] || self.outline[to as usize]);
        for (cost, to) in ways.map(|to| (cost(to), to)) {
            let stamps = [self.stamps[node as usize], self.stamps[to as usize]];
            self.queue.push(Reverse(Candidate { cost, from: node, to, stamps }));
        }
    }

    /// Collapses edges until at most `target` triangles are left or no edge can go.
    pub fn reduce(&mut self, target: usize) {
        while self.count > target {
            let Some(Reverse(candidate)) = self.queue.pop() else { return };
            let Candidate { cost, from, to, stamps } = candidate;
            let fresh = stamps == [self.stamps[from as usize], self.stamps[to as usize]];
            if fresh && self.may_collapse(from, to) {
                self.error = self.error.max(f64::from_bits(cost).sqrt() as f32);
                self.collapse(from, to);
            }
        }
    }

    /// Whether the surface stays a surface and no triangle turns over.
    fn may_collapse(&self, from: u32, to: u32) -> bool {
        let around = self.neighbors(to);
        let common =
            self.neighbors(from).iter().filter(|node| around.binary_search(node).is_ok()).count();
        let mut shared = 0;
        for &triangle in &self.touching[from as usize] {
            let Some(nodes) = self.nodes_of(triangle) else { continue };
            if nodes.contains(&to) {
                shared += 1;
                continue;
            }
            let place = |node: u32| self.places[node as usize];
            let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
            let before = normal(nodes.map(place));
            let after = normal(nodes.map(|node| place(if node == from { to } else { node })));
            let turned = before.dot(after) <= 0.25 * before.length() * after.length();
            let outward = self.outward(triangle);
            if turned || (after.dot(outward) <= 0.0 && before.dot(outward) > 0.0) {
                return false;
            }
        }
        if !self.keeps_seams(from, to) {
            return false;
        }
        let along_outline = !self.outline[from as usize] || shared == 1;
        shared > 0 && common <= shared && along_outline
    }

    /// Sum of the normals of a triangle's vertices.
    fn outward(&self, triangle: u32) -> DVec3 {
        let normal =
            |corner: u32| self.mesh.normals.get(corner as usize).copied().unwrap_or_default();
        let corners = self.triangles[triangle as usize].into_iter().flatten();
        corners.map(normal).sum::<Vec3>().as_dvec3()
    }

    /// Vertices of two nodes that triangles have in common, with those triangles.
    fn pairs(&self, from: u32, to: u32) -> Vec<(u32, u32, u32)> {
        let mut pairs = Vec::new();
        for &triangle in &self.touching[from as usize] {
            let Some(corners) = self.triangles[triangle as usize] else { continue };
            let corner_at =
                |node: u32| corners.into_iter().find(|&corner| self.nodes[corner as usize] == node);
            if let (Some(old), Some(new)) = (corner_at(from), corner_at(to)) {
                pairs.push((old, new, triangle));
            }
        }
        pairs
    }

    /// Whether no triangle would be stretched over a part of the texture that it did not show.
    fn keeps_seams(&self, from: u32, to: u32) -> bool {
        if self.mesh.uvs.is_empty() {
            return true;
        }
        let pairs = self.pairs(from, to);
        let corners = self.touching[from as usize]
            .iter()
            .filter_map(|&triangle| self.triangles[triangle as usize]);
        let kept = |corner: u32| {
            if pairs.iter().any(|&(old, ..)| old == corner) {
                return true;
            }
            let [u, v] = self.mesh.uvs[corner as usize];
            let [s, t] = self.mesh.uvs[self.counterpart(corner, &pairs) as usize];
            (u - s).abs() < STRETCH && (v - t).abs() < STRETCH
        };
        corners.flatten().filter(|&corner| self.nodes[corner as usize] == from).all(kept)
    }

    fn collapse(&mut self, from: u32, to: u32) {
        let pairs = self.pairs(from, to);
        for &(_, _, triangle) in &pairs {
            self.triangles[triangle as usize] = None;
            self.count -= 1;
        }
        let moved = std::mem::take(&mut self.touching[from as usize]);
        for triangle in moved {
            let Some(mut corners) = self.triangles[triangle as usize] else { continue };
            for corner in &mut corners {
                if self.nodes[*corner as usize] == from {
                    *corner = self.counterpart(*corner, &pairs);
                }
            }
            self.triangles[triangle as usize] = Some(corners);
            self.touching[to as usize].push(triangle);
        }
        let quadric = self.quadrics[from as usize];
        self.quadrics[to as usize].add(&quadric);
        let triangles = &self.triangles;
        self.touching[to as usize].retain(|&triangle| triangles[triangle as usize].is_some());
        self.stamps[from as usize] += 1;
        self.stamps[to as usize] += 1;
        self.offer(to);
        for neighbor in self.neighbors(to) {
            self.stamps[neighbor as usize] += 1;
            self.offer(neighbor);
        }
    }

    /// The vertex at the new node that continues a vertex of the old one on its side of a seam.
    fn counterpart(&self, vertex: u32, pairs: &[(u32, u32, u32)]) -> u32 {
        if let Some(&(_, new, _)) = pairs.iter().find(|&&(old, ..)| old == vertex) {
            return new;
        }
        let uv = |vertex: u32| self.mesh.uvs.get(vertex as usize).copied().unwrap_or_default();
        let normal =
            |vertex: u32| self.mesh.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO);
        let distance = |other: u32| {
            let ([u, v], [s, t]) = (uv(vertex), uv(other));
            (u - s).abs() + (v - t).abs() + 0.1 * (normal(vertex) - normal(other)).length()
        };
        let news = pairs.iter().map(|&(_, new, _)| new);
        news.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(vertex)
    }

    /// The triangles left.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.triangles.iter().flatten().copied().collect()
    }
}

impl Mesh {
    /// A mesh of some of this one's triangles, with the vertices they need and no levels; and which
    /// vertices those are.
    pub(super) fn part(&self, triangles: &[[u32; 3]]) -> (Mesh, Vec<usize>) {
        let mut numbers = vec![u32::MAX; self.positions.len()];
        let mut kept = Vec::new();
        let mut number = |vertex: u32| {
            let number = &mut numbers[vertex as usize];
            if *number == u32::MAX {
                *number = kept.len() as u32;
                kept.push(vertex as usize);
            }
            *number
        };
        let triangles = triangles.iter().map(|triangle| triangle.map(&mut number)).collect();
        let mesh = Mesh {
            positions: taken(&self.positions, &kept),
            normals: taken(&self.normals, &kept),
            uvs: taken(&self.uvs, &kept),
            colors: taken(&self.colors, &kept),
            triangles,
            skin: self.skin.as_ref().map(|skin| Skin {
                joints: skin.joints.clone(),
                indices: taken(&skin.indices, &kept),
                weights: taken(&skin.weights, &kept),
            }),
            ..Mesh::default()
        };
        (mesh, kept)
    }
}

/// The values of the vertices that are kept; none if there are none at all.
pub(super) fn taken<T: Copy>(values: &[T], kept: &[usize]) -> Vec<T> {
    if values.is_empty() { Vec::new() } else { kept.iter().map(|&vertex| values[vertex]).collect() }
}

/// Numbers the places of vertices; vertices at exactly one place get one number.
pub(super) fn weld(positions: &[Vec3]) -> (Vec<u32>, Vec<DVec3>) {
    let bits = |vertex: u32| (positions[vertex as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_by_key(|&vertex| (bits(vertex), vertex));
    let mut nodes = vec![0; positions.len()];
    let mut places = Vec::new();
    for (index, &vertex) in order.iter().enumerate() {
        if index == 0 || bits(order[index - 1]) != bits(vertex) {
            places.push(positions[vertex as usize].as_dvec3());
        }
        nodes[vertex as usize] = places.len() as u32 - 1;
    }
    (nodes, places)
}
