//! Where the parts of a fish lie in its texture: the trunk unrolled on top (both sides share it), fins
//! and eye in a row of cells below.

/// Pixels per row.
pub const WIDTH: u32 = 512;
/// Rows.
pub const HEIGHT: u32 = 256;

/// Rows of the trunk; the rest are cells.
const TRUNK_ROWS: f32 = 160.0;
/// Width of the cell of the eye.
const EYE_WIDTH: f32 = 80.0;
/// Pixels round every part that repeat its edge, so that coarser versions of the texture do not bleed.
const MARGIN: f32 = 3.0;

/// A rectangle of the texture in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Left, top, right, bottom.
    pub bounds: [f32; 4],
}

impl Cell {
    /// Texture coordinates of a point of the part, both shares from 0 to 1.
    pub fn uv(&self, x: f32, y: f32) -> [f32; 2] {
        let [left, top, right, bottom] = self.bounds;
        let place = |low: f32, high: f32, share: f32| {
            low + MARGIN + (high - low - 2.0 * MARGIN) * share.clamp(0.0, 1.0)
        };
        [place(left, right, x) / WIDTH as f32, place(top, bottom, y) / HEIGHT as f32]
    }

    /// The point of the part shown at the middle of a pixel.
    pub fn place(&self, column: usize, row: usize) -> [f32; 2] {
        let [left, top, right, bottom] = self.bounds;
        let share = |low: f32, high: f32, pixel: usize| {
            ((pixel as f32 + 0.5 - low - MARGIN) / (high - low - 2.0 * MARGIN)).clamp(0.0, 1.0)
        };
        [share(left, right, column), share(top, bottom, row)]
    }
}

/// The cells of one species.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// The trunk: across from snout to tail, down from back to belly.
    pub trunk: Cell,
    /// The eye, seen from the left.
    pub eye: Cell,
    /// The fins: across from the front ray to the rear one, down from edge to base.
    pub fins: Vec<Cell>,
}

impl Atlas {
    /// Shares the row of cells among fins of these sizes.
    pub fn new(sizes: &[f32]) -> Self {
        let (width, height) = (WIDTH as f32, HEIGHT as f32);
        let total: f32 = sizes.iter().sum::<f32>().max(1e-6);
        let least = 16.0;
        let shared = width - EYE_WIDTH - least * sizes.len() as f32;
        let mut left = EYE_WIDTH;
        let fins = sizes.iter().map(|size| {
            let right = left + (least + shared * size / total).floor();
            let cell = Cell { bounds: [left, TRUNK_ROWS, right, height] };
            left = right;
            cell
        });
        Self {
            fins: fins.collect(),
            trunk: Cell { bounds: [0.0, 0.0, width, TRUNK_ROWS] },
            eye: Cell { bounds: [0.0, TRUNK_ROWS, EYE_WIDTH, height] },
        }
    }
}
