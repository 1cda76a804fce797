//! Beams of sunlight in the water: a march along each ray of a small picture, through the
//! pattern of the waves and the shadows of things.

use bioscope_core::Vec3;
use rayon::prelude::*;

use super::arithmetic::{Rgb, channels, exp_rgb, rgb};
use super::lens::Lens;
use super::prepare::Prepared;
use super::shade::Shader;
use super::view::View;

/// Pixels per side of a cell that is marched once.
const CELL: usize = 5;

/// Steps along a ray.
const STEPS: usize = 11;

/// Beams are followed this far, metres.
const REACH: f32 = 16.0;

/// Adds the beams to a finished picture; `samples` is the number of the lens's samples per pixel.
pub(crate) fn add_shafts(view: &mut View, shader: &Shader, lens: &Lens, samples: usize) {
    let light = &shader.prepared.light;
    let bounds = [view.width.div_ceil(CELL) + 1, view.height.div_ceil(CELL) + 1];
    if light.shafts <= 0.0 || light.depth(shader.stand.eye.y) <= 0.0 {
        return;
    }
    let depth = &view.depth;
    let cells: Vec<Rgb> = (0..bounds[0] * bounds[1])
        .into_par_iter()
        .map(|index| {
            let (column, row) = (index % bounds[0], index / bounds[0]);
            let pixel = [(column * CELL).min(view.width - 1), (row * CELL).min(view.height - 1)];
            let Some(ray) = lens.ray(pixel[0] * samples, pixel[1] * samples) else {
                return Rgb::ZERO;
            };
            let distance = depth[pixel[1] * view.width + pixel[0]];
            let start = ((column % 4) * 4 + (row + column) % 4) as f32 / 16.0;
            march(shader, shader.stand.outward(ray), distance, start)
        })
        .collect();
    let cells = smoothed(&smoothed(&cells, bounds, 1), bounds, bounds[0]);
    let width = view.width;
    view.color.par_chunks_mut(width).enumerate().for_each_init(Vec::new, |beams, (row, line)| {
        let (top, v) = (row / CELL * bounds[0], (row % CELL) as f32 / CELL as f32);
        let [near, far] = [top, top + bounds[0]].map(|first| &cells[first..first + bounds[0]]);
        beams.clear();
        beams.extend(near.iter().zip(far).map(|(&near, &far)| near.lerp(far, v)));
        for (pixels, ends) in line.chunks_mut(CELL).zip(beams.windows(2)) {
            let step = (ends[1] - ends[0]) * (1.0 / CELL as f32);
            let mut beam: Rgb = ends[0];
            for color in pixels {
                *color = channels((rgb(*color) + beam).max(Rgb::ZERO));
                beam += step;
            }
        }
    });
}

/// Light scattered towards the eye along a ray, as difference from still water's; `start` in 0..1
/// shifts the steps, so that neighboring rays fill each other's gaps.
fn march(shader: &Shader, direction: Vec3, distance: f32, start: f32) -> Rgb {
    let Prepared { light, waves, shadow, .. } = shader.prepared;
    let eye = shader.stand.eye;
    let surface = light.depth(eye.y) / direction.y.max(1e-6);
    let length = distance.min(REACH).min(surface);
    let towards = direction.dot(light.sun_below).max(0.0);
    let strength = light.shafts * (0.012 + 0.05 * towards * towards * towards);
    let step = length / STEPS as f32;
    let mut sum = Rgb::ZERO;
    for number in 0..STEPS {
        let run = (number as f32 + start) * step;
        let point = eye + direction * run;
        let depth = light.depth(point.y).max(0.0);
        let pattern = waves.pattern(light, point, depth, 8 + (run * 1.5) as usize);
        let lit = shadow.as_ref().map_or(1.0, |shadow| shadow.reached(point));
        let path = run + depth / light.sun_below.y;
        let change = pattern * lit - 1.0;
        // Light that went several ways fills the dark beams.
        let softened = if change < 0.0 { 0.4 * change } else { 0.8 * change };
        sum += exp_rgb(light.extinction * -path) * softened;
    }
    light.sun_color * sum * (strength * step)
}

/// Means of four neighboring cells along one axis, over which the marches' starts are spread evenly; `step`
/// is the distance of neighbors along it.
fn smoothed(cells: &[Rgb], bounds: [usize; 2], step: usize) -> Vec<Rgb> {
    let count = if step == 1 { bounds[0] } else { bounds[1] };
    let mean = |index: usize| {
        let along = index / step % count;
        let line = index - along * step;
        let near = (0..4).map(|offset| (along + offset).saturating_sub(1).min(count - 1));
        near.map(|place| cells[line + place * step]).sum::<Rgb>() * 0.25
    };
    (0..cells.len()).map(mean).collect()
}
