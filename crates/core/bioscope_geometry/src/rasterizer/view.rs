//! What a look gives.

use bioscope_core::Id;
use rayon::prelude::*;

use super::arithmetic::{channels, rgb};
use super::light::filmic;
use super::texture::encoded;

/// A picture with what is in it: rows from the top, `width` × `height` pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear radiance, RGB.
    pub color: Vec<[f32; 3]>,
    /// Distance in metres from the eye along the pixel's ray, infinite where there is nothing.
    pub depth: Vec<f32>,
    /// Identity of what is seen, 0 where there is nothing.
    pub identity: Vec<Id>,
}

/// Some rows of a view.
pub(crate) struct Strip<'a> {
    pub width: usize,
    /// First row and the row after the last.
    pub rows: [usize; 2],
    pub color: &'a mut [[f32; 3]],
    pub depth: &'a mut [f32],
    pub identity: &'a mut [Id],
}

impl View {
    /// A view of nothing.
    pub(crate) fn empty(width: usize, height: usize) -> Self {
        let count = width * height;
        Self {
            width,
            height,
            color: vec![[0.0; 3]; count],
            depth: vec![f32::INFINITY; count],
            identity: vec![0; count],
        }
    }

    /// The view cut into strips of so many rows, to be painted independently.
    pub(crate) fn strips(&mut self, rows: usize) -> Vec<Strip<'_>> {
        let Self { width, height, color, depth, identity } = self;
        let count = (rows * *width).max(1);
        let parts =
            color.chunks_mut(count).zip(depth.chunks_mut(count)).zip(identity.chunks_mut(count));
        parts
            .enumerate()
            .map(|(number, ((color, depth), identity))| {
                let first = number * rows;
                let rows = [first, (first + rows).min(*height)];
                Strip { width: *width, rows, color, depth, identity }
            })
            .collect()
    }

    /// The picture for a screen: exposed, filmic tone curve, sRGB bytes, three per pixel.
    /// `exposure` multiplies the radiance; 1 suits a sunlit scene.
    pub fn developed(&self, exposure: f32) -> Vec<u8> {
        let width = self.width.max(1);
        let mut pixels = vec![0; 3 * self.color.len()];
        let rows = pixels.par_chunks_mut(3 * width).zip(self.color.par_chunks(width));
        rows.for_each(|(bytes, colors)| {
            for (bytes, &radiance) in bytes.chunks_mut(3).zip(colors) {
                let display = filmic(rgb(radiance) * exposure);
                bytes.copy_from_slice(&channels(display).map(encoded));
            }
        });
        pixels
    }
}
