//! The two surfaces of the ground, sand and rock, cut into tiles.

use std::sync::Arc;

use bioscope_core::{Vec3, math};
use bioscope_geometry::{Mesh, Noise, Terrain};
use rayon::prelude::*;

use super::GroundOptions;
use super::forms::wrap_from_three_sides;

/// Cells along the side of a tile; a power of two, so that coarser versions fit.
const TILE: usize = 32;
/// Depth in metres to which a surface dips under the other one where that one covers it.
const DIP: f32 = 0.6;
/// Samples to each side from which the direction is taken in which crags stand out.
const REACH: f32 = 3.0;
/// Length of the rock's picture, metres.
const ROCK_TEXTURE: f32 = 1.7;
/// Projected diameters in pixels below which each coarser version serves.
const SIZES: [f32; 3] = [260.0, 100.0, 36.0];

/// One tile of one surface.
pub(crate) struct Surface {
    pub mesh: Arc<Mesh>,
    pub rock: bool,
}

/// Both surfaces at every sample of a terrain.
pub(crate) struct Seabed<'a> {
    terrain: &'a Terrain,
    sand: Sheet,
    rock: Sheet,
    /// 0 (sand) to 1 (rock) at every sample.
    cover: Vec<f32>,
    texture_size: f32,
}

/// Positions, normals and colors at every sample.
struct Sheet {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    colors: Vec<[f32; 3]>,
}

impl<'a> Seabed<'a> {
    pub(crate) fn new(terrain: &'a Terrain, options: &GroundOptions) -> Self {
        let samples = terrain.heights.len();
        let cover: Vec<f32> =
            (0..samples).into_par_iter().map(|index| cover(terrain, index, options)).collect();
        let place = |index: usize| {
            let x = terrain.origin[0] + (index % terrain.columns) as f32 * terrain.spacing;
            let z = terrain.origin[1] + (index / terrain.columns) as f32 * terrain.spacing;
            Vec3::new(x, terrain.heights[index], z)
        };
        let sand = |index: usize| place(index) - Vec3::Y * (DIP * (cover[index] - 0.5).max(0.0));
        let rock = |index: usize| {
            let point = place(index);
            let dip = Vec3::Y * (DIP * (0.5 - cover[index]).max(0.0));
            let share = math::smoothstep(0.3, 0.9, cover[index]);
            // Where sand covers the rock nobody sees how it is shaped.
            if share > 0.0 { point - dip + crag(point, terrain) * share } else { point - dip }
        };
        let shade = hollows(terrain);
        let sand_color = |index: usize| match cover[index] {
            hidden if hidden > 0.8 => options.sand_color,
            cover => sand_tone(place(index), cover, options),
        };
        let rock_color = |index: usize| match cover[index] {
            hidden if hidden < 0.2 => options.rock_color,
            _ => rock_tone(place(index), shade[index], options),
        };
        Self {
            terrain,
            sand: Sheet::new(terrain, sand, sand_color),
            rock: Sheet::new(terrain, rock, rock_color),
            texture_size: options.texture_size,
            cover,
        }
    }

    /// All tiles that have anything on them, sand first.
    pub(crate) fn tiles(&self) -> Vec<Surface> {
        let corners: Vec<(usize, usize)> = (0..self.terrain.rows() - 1)
            .step_by(TILE)
            .flat_map(|row| {
                (0..self.terrain.columns - 1).step_by(TILE).map(move |column| (column, row))
            })
            .collect();
        let both = [false, true].into_iter();
        let wanted: Vec<_> =
            both.flat_map(|rock| corners.iter().map(move |&at| (at, rock))).collect();
        let built = wanted.into_par_iter().filter_map(|(corner, rock)| {
            let mut finest = self.tile(corner, rock, 1)?;
            for (level, size) in SIZES.into_iter().enumerate() {
                let coarser = self.tile(corner, rock, 2 << level);
                finest.levels.extend(coarser.map(|mesh| (size, Arc::new(mesh))));
            }
            Some(Surface { mesh: Arc::new(finest), rock })
        });
        built.collect()
    }

    /// One tile with every `step`-th sample; none if nothing of the surface is there.
    fn tile(&self, (column, row): (usize, usize), rock: bool, step: usize) -> Option<Mesh> {
        let sheet = if rock { &self.rock } else { &self.sand };
        let columns = stations(column, self.terrain.columns, step);
        let rows = stations(row, self.terrain.rows(), step);
        let mut mesh = Mesh::default();
        for &row in &rows {
            for &column in &columns {
                let index = row * self.terrain.columns + column;
                let point = sheet.positions[index];
                mesh.positions.push(point);
                mesh.normals.push(sheet.normals[index]);
                mesh.colors.push(sheet.colors[index]);
                mesh.uvs.push([point.x / self.texture_size, point.z / self.texture_size]);
            }
        }
        let width = columns.len() as u32;
        for (v, rows) in rows.windows(2).enumerate() {
            for (u, columns) in columns.windows(2).enumerate() {
                if self.shows([columns[0], columns[1]], [rows[0], rows[1]], rock) {
                    let a = v as u32 * width + u as u32;
                    let (b, c, d) = (a + 1, a + width, a + width + 1);
                    mesh.triangles.extend([[a, c, b], [b, c, d]]);
                }
            }
        }
        if mesh.triangles.is_empty() {
            return None;
        }
        add_skirts(&mut mesh, columns.len(), 0.06 + 0.35 * self.terrain.spacing * step as f32);
        Some(if rock { wrap_from_three_sides(&mesh, ROCK_TEXTURE) } else { without_strays(&mesh) })
    }

    /// Whether a cell of the surface is anywhere not hidden under the other surface.
    fn shows(&self, columns: [usize; 2], rows: [usize; 2], rock: bool) -> bool {
        let mut samples = (rows[0]..=rows[1]).flat_map(|row| {
            (columns[0]..=columns[1]).map(move |column| row * self.terrain.columns + column)
        });
        samples.any(|index| if rock { self.cover[index] > 0.4 } else { self.cover[index] < 0.6 })
    }
}

/// Every `step`-th sample number of a tile that begins at `first`, the tile's last one included.
fn stations(first: usize, count: usize, step: usize) -> Vec<usize> {
    let last = (first + TILE).min(count - 1);
    let mut stations: Vec<usize> = (first..last).step_by(step).collect();
    stations.push(last);
    stations
}

/// Hangs a strip of triangles `drop` metres deep from the rim of a grid mesh, which hides the gaps
/// between tiles of different fineness.
fn add_skirts(mesh: &mut Mesh, width: usize, drop: f32) {
    let height = mesh.positions.len() / width;
    let grid = width * height;
    let on_rim = |index: usize| {
        let (column, row) = (index % width, index / width);
        column == 0 || row == 0 || column == width - 1 || row == height - 1
    };
    let mut below = vec![u32::MAX; grid];
    for index in (0..grid).filter(|&index| on_rim(index)) {
        below[index] = mesh.positions.len() as u32;
        mesh.positions.push(mesh.positions[index] - Vec3::Y * drop);
        mesh.normals.push(mesh.normals[index]);
        mesh.colors.push(mesh.colors[index]);
        mesh.uvs.push(mesh.uvs[index]);
    }
    let along_rim = |a: usize, b: usize| {
        let line = |side: fn(usize, usize) -> usize, at: usize| {
            side(a, width) == at && side(b, width) == at
        };
        line(|index, width| index % width, 0)
            || line(|index, width| index % width, width - 1)
            || line(|index, width| index / width, 0)
            || line(|index, width| index / width, height - 1)
    };
    for index in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.triangles[index];
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if along_rim(from as usize, to as usize) {
                let (low_from, low_to) = (below[from as usize], below[to as usize]);
                mesh.triangles.extend([[from, low_from, to], [to, low_from, low_to]]);
            }
        }
    }
}

/// The same mesh without vertices that no triangle uses.
fn without_strays(mesh: &Mesh) -> Mesh {
    let mut kept = Mesh::default();
    let mut numbers = vec![u32::MAX; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let corners = triangle.map(|index| {
            let index = index as usize;
            if numbers[index] == u32::MAX {
                numbers[index] = kept.positions.len() as u32;
                kept.positions.push(mesh.positions[index]);
                kept.normals.push(mesh.normals[index]);
                kept.colors.push(mesh.colors[index]);
                kept.uvs.push(mesh.uvs[index]);
            }
            numbers[index]
        });
        kept.triangles.push(corners);
    }
    kept
}

impl Sheet {
    fn new(
        terrain: &Terrain,
        position: impl Fn(usize) -> Vec3 + Sync + Send,
        color: impl Fn(usize) -> [f32; 3] + Sync + Send,
    ) -> Self {
        let samples = terrain.heights.len();
        let positions: Vec<Vec3> = (0..samples).into_par_iter().map(position).collect();
        let (columns, rows) = (terrain.columns, terrain.rows());
        let normal = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            let at = |column: usize, row: usize| positions[row * columns + column];
            let along_x =
                at((column + 1).min(columns - 1), row) - at(column.saturating_sub(1), row);
            let along_z = at(column, (row + 1).min(rows - 1)) - at(column, row.saturating_sub(1));
            along_z.cross(along_x).normalize_or(Vec3::Y)
        };
        let normals = (0..samples).into_par_iter().map(normal).collect();
        let colors = (0..samples).into_par_iter().map(color).collect();
        Self { positions, normals, colors }
    }
}

/// 0 (sand) to 1 (rock) at a sample.
fn cover(terrain: &Terrain, index: usize, options: &GroundOptions) -> f32 {
    let x = terrain.origin[0] + (index % terrain.columns) as f32 * terrain.spacing;
    let z = terrain.origin[1] + (index / terrain.columns) as f32 * terrain.spacing;
    let height = terrain.heights[index];
    let steepness = math::acos(terrain.normal(x, z).y.min(1.0)).to_degrees();
    let steep = math::smoothstep(options.rock_slope - 9.0, options.rock_slope + 9.0, steepness);
    let high = math::smoothstep(options.rock_height - 0.5, options.rock_height + 0.5, height);
    let cover = steep.max(high);
    let ragged = Noise::new(81).fractal(Vec3::new(x, height, z) * 0.9, 4);
    (cover + 1.6 * cover * (1.0 - cover) * ragged).clamp(0.0, 1.0)
}

/// How far the rock stands out from the heightfield here: ledges and knobs, square to the ground, so
/// that walls overhang. Never inward, where the sand is.
fn crag(point: Vec3, terrain: &Terrain) -> Vec3 {
    let reach = REACH * terrain.spacing;
    let height = |dx: f32, dz: f32| terrain.height(point.x + dx, point.z + dz);
    let slope_x = height(reach, 0.0) - height(-reach, 0.0);
    let slope_z = height(0.0, reach) - height(0.0, -reach);
    let outward = Vec3::new(-slope_x, 2.0 * reach, -slope_z).normalize();
    let ledge = Noise::new(91).ridged(point * Vec3::new(0.6, 1.4, 0.6), 3);
    let knob = (0.75 - Noise::new(92).cell(point * 1.9).nearest).max(0.0);
    let bend = Noise::new(93).smooth(point * 1.7);
    let aside = Vec3::new(outward.z, 0.0, -outward.x) * (0.5 * bend);
    (outward + aside) * (0.5 * ledge * ledge + 0.34 * knob - 0.1)
}

/// How far each sample lies below its surroundings, metres: where light is scarce.
fn hollows(terrain: &Terrain) -> Vec<f32> {
    let reach = ((0.6 / terrain.spacing) as usize).max(1);
    let (columns, rows) = (terrain.columns, terrain.rows());
    let hollow = |index: usize| {
        let (column, row) = (index % columns, index / columns);
        let (left, right) = (column.saturating_sub(reach), (column + reach).min(columns - 1));
        let (back, front) = (row.saturating_sub(reach), (row + reach).min(rows - 1));
        let around = [(left, row), (right, row), (column, back), (column, front)];
        let sum: f32 = around.iter().map(|(c, r)| terrain.heights[r * columns + c]).sum();
        sum / 4.0 - terrain.heights[index]
    };
    (0..terrain.heights.len()).into_par_iter().map(hollow).collect()
}

/// Color of sand: pale, darker where debris gathers at the foot of rocks and in wide patches.
fn sand_tone(point: Vec3, cover: f32, options: &GroundOptions) -> [f32; 3] {
    let patch = Noise::new(101).fractal(point * 0.35, 3);
    let film = math::smoothstep(0.0, 0.5, Noise::new(102).fractal(point * 0.22, 4));
    let debris = 0.45 * math::smoothstep(0.02, 0.45, cover);
    let bright = 1.0 + 0.14 * patch - debris;
    // A film of diatoms makes sand olive-brown.
    let tone = [1.0 - 0.10 * film, 1.0 - 0.07 * film, 1.0 - 0.22 * film];
    [0, 1, 2].map(|channel| options.sand_color[channel] * tone[channel] * bright)
}

/// Color of rock: fields of different crusts, dark in hollows.
fn rock_tone(point: Vec3, hollow: f32, options: &GroundOptions) -> [f32; 3] {
    let field = |seed: u32, scale: f32| Noise::new(seed).fractal(point * scale, 4);
    let mut tone = math::mix(0.62, 0.92, 0.5 + field(110, 0.35));
    tone *= (1.0 - 1.3 * hollow.max(-0.3)).clamp(0.3, 1.25);
    crusted(tone, &field, options.rock_color)
}

/// Limestone of this brightness under crusts whose places `field` (seed, features per metre) gives.
pub(crate) fn crusted(
    brightness: f32,
    field: &dyn Fn(u32, f32) -> f32,
    tint: [f32; 3],
) -> [f32; 3] {
    let mut color = [0.66, 0.56, 0.43];
    for (seed, scale, crust) in CRUSTS {
        let share = 0.9 * math::smoothstep(0.02, 0.22, field(seed, scale));
        color = [0, 1, 2].map(|channel| math::mix(color[channel], crust[channel], share));
    }
    [0, 1, 2].map(|channel| color[channel] * brightness * tint[channel])
}

/// Seed, features per metre and linear color of olive turf, pink coralline algae, ochre sponge,
/// violet crust, brown weed and bare, pale limestone.
const CRUSTS: [(u32, f32, [f32; 3]); 6] = [
    (111, 0.45, [0.40, 0.42, 0.16]),
    (112, 0.9, [0.86, 0.36, 0.42]),
    (113, 1.5, [0.92, 0.48, 0.12]),
    (114, 1.1, [0.56, 0.33, 0.44]),
    (116, 0.7, [0.34, 0.25, 0.13]),
    (115, 2.0, [0.98, 0.88, 0.72]),
];
