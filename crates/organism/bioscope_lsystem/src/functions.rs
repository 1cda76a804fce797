//! What models look up in the function and curve files that belong to them.

/// Functions of one variable and curves in space, by number.
pub trait Functions: Send + Sync {
    /// Value of function `id` at `x`, as `func(id, x)` asks for it; none if there is no such function.
    fn value(&self, id: usize, x: f64) -> Option<f64>;

    /// Point of curve `id` at `t` from 0 to 1, as `curveX(id, t)` and its like ask for it; none if
    /// there is no such curve.
    fn curve(&self, id: usize, t: f64) -> Option<[f64; 3]>;

    /// Length of curve `id`, as `curveGAL(id)` asks for it.
    fn curve_length(&self, id: usize) -> Option<f64> {
        const PIECES: usize = 256;
        let mut last = self.curve(id, 0.0)?;
        let mut length = 0.0;
        for piece in 1..=PIECES {
            let point = self.curve(id, piece as f64 / PIECES as f64)?;
            let square: f64 = (0..3).map(|axis| (point[axis] - last[axis]).powi(2)).sum();
            length += square.sqrt();
            last = point;
        }
        Some(length)
    }

    /// The corners (x, y, z) of the view volume, least and greatest, and its scale, as `vvXmin(0)`,
    /// `vvScale(0)` and their like ask for them; none without a view.
    fn view_volume(&self) -> Option<([f64; 3], [f64; 3], f64)> {
        None
    }
}
